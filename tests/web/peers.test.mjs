/** Lucent and its peers before the same exact pictures, small: scripts/peers/ holds the whole comparisons. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { sceneOf as waterSceneOf } from '../../scripts/peers/caustics.mjs';
import { sceneOf as glassSceneOf } from '../../scripts/peers/refraction.mjs';
import { bringIn } from '../../scripts/peers/shared.mjs';
import { sceneOf as marbleSceneOf } from '../../scripts/peers/translucency.mjs';
import { compare, kComparison } from '../../scripts/peers/three.mjs';
import { directionOf, solveWaves, wavesAt } from '../../scripts/peers/waves.mjs';
import { openPage, openStage } from './support.mjs';

const kSmall = {
  ...kComparison,
  n: 64,
  repeats: 1,
  knobs: { type: ['basic'], side: ['front'], bias: [0.25], normalBias: [0] },
};

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

test('no texel is wrong against the sampled field, and three.js sees the same field', async () => {
  const page = await openPage(stage, 'blank.html');
  const found = await compare(page, kSmall);
  assert.equal(found.lucent.sampled.wrongShare, 0); // the target, 0.001 %, is less than one texel of 64 x 64
  assert.ok(found.lucent.sampled.rmse <= 1e-6, `RMSE of the cosine is ${found.lucent.sampled.rmse}`); // float rounding
  // What is left against the smooth field is what 64 x 64 samples cannot know.
  assert.equal(found.lucent.exact.wrongShare, found.sampling.wrongShare);
  // A shadow map's teeth are about a texel wide along the shadows' edges; a field turned or mirrored would be wrong by
  // a third.
  const [three] = found.three;
  assert.ok(three.sampled.wrongShare < 0.1, `three.js is wrong on ${three.sampled.wrongShare}`);
  assert.ok(three.sampled.rmse <= 1e-6, `three.js's cosine is off by ${three.sampled.rmse}`);
  await page.leave();
});

test('the smooth field is lit where no step along the ray is inside', () => {
  const [n, scale, light] = [32, 0.2, directionOf(20, 40)];
  const exact = solveWaves(n, scale, light);
  const kStep = 1e-4; // m; no slope of the field is above 3, so between two steps the ray gains or loses less than 4
  let lit = 0;
  for (let i = 0; i < n * n; ++i) {
    const [x, y] = [((i % n) + 0.5) / n - 0.5, 0.5 - (Math.floor(i / n) + 0.5) / n];
    const start = wavesAt(x, y).height * scale;
    let highest = -Infinity; // above the ray
    for (let s = kStep; Math.max(Math.abs(x + s * light[0]), Math.abs(y + s * light[1])) < 0.5; s += kStep)
      highest = Math.max(highest, wavesAt(x + s * light[0], y + s * light[1]).height * scale - start - s * light[2]);
    if (exact[i] > 0) lit += 1;
    if (Math.abs(highest) > 4 * kStep) assert.equal(exact[i] > 0, highest < 0, `texel ${i}: ${highest} above the ray`);
  }
  assert.ok(lit > 0.2 * n * n && lit < 0.8 * n * n, `${lit} texels are lit`);
});

/** A picture as the program writes it, of pixel(x, y) => [red, green, blue] with row 0 at the top. */
function pfmOf(size, pixel) {
  const values = new Float32Array(3 * size * size);
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x) values.set(pixel(x, y), 3 * ((size - 1 - y) * size + x));
  return Buffer.concat([Buffer.from(`PF\n${size} ${size}\n-1.0\n`), Buffer.from(values.buffer)]);
}

/** Runs a peer's page script on pictures that are given to it by name. */
async function compareIn(script, pictures, options) {
  const page = await openPage(stage, 'blank.html');
  await page.route('**/peers/*', (route) =>
    route.fulfill({ body: pictures[new URL(route.request().url()).pathname.split('/').pop()] }),
  );
  await bringIn(page, script);
  const found = await page.evaluate((given) => window.compare(given), options);
  await page.leave();
  return found;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const sum = (a, b, factor) => a.map((value, i) => value + factor * b[i]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));

/** Snell's law in double precision; the normal faces the ray. */
function refract(direction, normal, eta) {
  const cosine = -dot(direction, normal);
  const inside = Math.sqrt(1 - eta * eta * (1 - cosine * cosine));
  return sum(direction.map((value) => eta * value), normal, eta * cosine - inside);
}

/** Where a ray through a pixel leaves a ball of glass around the origin, radius 1, ior 1.5; nothing where it misses. */
function throughBall({ eye, fov }, size, x, y) {
  const back = unit(eye); // the eye looks at the origin
  const right = unit([back[2], 0, -back[0]]);
  const up = cross(back, right);
  const half = Math.tan((fov * Math.PI) / 360);
  const [across, above] = [(2 * (x + 0.5)) / size - 1, 1 - (2 * (y + 0.5)) / size];
  const ray = unit(sum(sum(back.map((value) => -value), right, half * across), up, half * above));
  const along = -dot(eye, ray);
  const root = along * along - dot(eye, eye) + 1;
  if (root <= 0) return null;
  const entry = sum(eye, ray, along - Math.sqrt(root));
  const within = refract(ray, entry, 1 / 1.5);
  const exit = sum(entry, within, -2 * dot(entry, within));
  return refract(within, exit.map((value) => -value), 1.5);
}

test('a glass ball bends light as it must by Lucent and by rays through a tree, not by transmission', async () => {
  const size = 48;
  const scene = glassSceneOf('sphere', size);
  const rayAt = (x, y) => throughBall(scene.camera, size, x, y);
  const pictures = {
    exact: pfmOf(size, (x, y) => rayAt(x, y) ?? [0, 0, -1]),
    layers: pfmOf(size, (x, y) => Array(3).fill(rayAt(x, y) ? 2 : 0)),
  };
  const { lucent, swept } = await compareIn('refraction_page.js', pictures, {
    scene,
    size,
    files: { exact: 'exact', layers: 'layers' },
    targets: { median: 0.1, p95: 2 },
    repeats: 1,
    knobs: {
      transmission: { thickness: [2], side: ['front'] },
      tree: { strategy: ['sah'], leaf: [4] },
      rays: { segments: [128], bounces: [2], normals: ['smooth'], reenters: [false, true] },
      flat: { segments: [] },
    },
  });
  assert.ok(lucent.all.median <= 0.1 && lucent.all.p95 <= 2, `Lucent is off by ${JSON.stringify(lucent.all)}`);
  // Between vertices a 128th of a turn apart the triangles lie up to 1 - cos(pi / 128) = 3e-4 below the ball, and the
  // ray is bent there at the normal of a place as far beside: some hundredths of a degree.
  for (const { error } of [...swept.example, ...swept.reentering])
    assert.ok(error.all.median <= 0.1, `three-mesh-bvh is off by ${JSON.stringify(error.all)}`);
  // Its ray leaves at the entry's normal: not bent a second time, it lacks half of the turn, which is 2 (a - b) with
  // sin a = 1.5 sin b: 23 degrees at a = 45.
  const [{ error }] = swept.transmission;
  assert.ok(error.all.median > 10, `three.js is off by only ${JSON.stringify(error.all)}`);
});

test('flat water lights its floor evenly, by Lucent and by area ratios', async () => {
  const size = 50;
  const scene = waterSceneOf('water', size);
  scene.objects[1].shape.amplitude = 0;
  const transmitted = 1 - (0.33 / 2.33) ** 2; // straight down from air into water of ior 1.33
  const pictures = { exact: pfmOf(size, () => Array(3).fill(transmitted)), noise: pfmOf(size, () => [0, 0, 0]) };
  const { swept } = await compareIn('caustics_page.js', pictures, {
    scene,
    files: { exact: 'exact', noise: 'noise' },
    knobs: { peer: { cells: [64], map: [256] }, lucent: { cells: [32], grid: [256], mapSize: [512] } },
    target: 0.01,
    repeats: 1,
  });
  const misplaced = ([{ error }]) => error.flux.misplaced;
  assert.ok(misplaced(swept.lucent) <= 0.01, `Lucent misplaces ${misplaced(swept.lucent)}`); // the target on water
  assert.ok(misplaced(swept.peer) <= 1e-3, `area ratios misplace ${misplaced(swept.peer)}`); // rounding of derivatives
});

/** Radiosity of a ball of marble, 10 mm, at whole degrees from the light: the dipole summed over what is lit. */
function solveMarble() {
  const [radius, ior, polars, azimuths] = [10, 1.5, 240, 90]; // mm
  const mirrored = -1.44 / ior ** 2 + 0.71 / ior + 0.668 + 0.0636 * ior;
  const media = [[2.19, 0.0021], [2.62, 0.0041], [3, 0.0071]].map(([scattering, absorption]) => {
    const depth = 1 / (scattering + absorption);
    const above = depth * (1 + (4 / 3) * ((1 + mirrored) / (1 - mirrored)));
    return { depths: [depth, above], fading: Math.sqrt((3 * absorption) / depth), albedo: scattering * depth };
  });
  const entering = (cosine) => {
    const inside = Math.sqrt(1 - (1 - cosine ** 2) / ior ** 2);
    const across = (cosine - ior * inside) / (cosine + ior * inside);
    const along = (ior * cosine - inside) / (ior * cosine + inside);
    return 1 - (across ** 2 + along ** 2) / 2;
  };
  return Array.from({ length: 181 }, (_, degrees) => {
    const to = [radius * Math.sin((degrees * Math.PI) / 180), 0, radius * Math.cos((degrees * Math.PI) / 180)];
    const light = [0, 0, 0];
    for (let i = 0; i < polars; ++i)
      for (let k = 0; k < azimuths; ++k) { // half of them: the other half is the same
        const [polar, azimuth] = [(Math.PI * (i + 0.5)) / (2 * polars), (Math.PI * (k + 0.5)) / azimuths];
        const normal = [Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar)];
        const flux = 2 * radius ** 2 * Math.sin(polar) * (Math.PI / 2 / polars) * (Math.PI / azimuths);
        const square = normal.reduce((all, part, j) => all + (to[j] - radius * part) ** 2, 0);
        media.forEach(({ depths, fading, albedo }, c) => {
          for (const depth of depths) {
            const away = Math.sqrt(square + depth * depth);
            const response = (depth * (1 + fading * away) * Math.exp(-fading * away)) / away ** 3;
            light[c] += (flux * normal[2] * entering(normal[2]) * albedo * response) / (4 * Math.PI);
          }
        });
      }
    return light;
  });
}

test('a ball of marble is as bright as a dipole says by Lucent; matt peers misplace what they must', async () => {
  const size = 64;
  const scene = marbleSceneOf(size);
  const solved = solveMarble();
  const half = Math.tan((scene.camera.fov * Math.PI) / 360);
  const [away, radius] = [scene.camera.eye[2], scene.objects[0].shape.radius];
  // Cosine between a pixel's normal and the light from the right; nothing beside the ball.
  const cosineAt = (x, y) => {
    const [across, above] = [half * ((2 * (x + 0.5)) / size - 1), half * (1 - (2 * (y + 0.5)) / size)];
    const square = across ** 2 + above ** 2 + 1;
    const root = away ** 2 - square * (away ** 2 - radius ** 2);
    return root < 0 ? null : (((away - Math.sqrt(root)) / square) * across) / radius;
  };
  const exactAt = (x, y) => {
    const cosine = cosineAt(x, y);
    if (cosine === null) return [0, 0, 0];
    const degrees = (Math.acos(cosine) * 180) / Math.PI;
    const [low, share] = [Math.min(179, Math.floor(degrees)), degrees % 1];
    return solved[low].map((light, c) => light + share * (solved[low + 1][c] - light));
  };
  const plain = { intensity: [0], distance: [[1, 1, 1]], tint: [[1, 1, 1]] };
  const { swept } = await compareIn('translucency_page.js', { exact: pfmOf(size, exactAt) }, {
    scene,
    files: { exact: 'exact' },
    titles: {},
    knobs: {
      lucent: { epsilon: [0.03] },
      babylon: { mode: ['scattering'], metersPerUnit: [0.03], profile: [[1, 1, 1]] },
      wrapped: { mode: ['translucency'], ...plain },
      scattering: { distortion: [0], ambient: [0], power: [1], scale: [0] },
      transmission: { transmission: [0], thickness: [0], attenuationDistance: [1] },
    },
    rounds: [],
    target: 0.02,
    sideTarget: 0.05,
    repeats: 1,
  });
  const misplaced = (name) => swept[name][0].error.flux.misplaced;
  assert.ok(misplaced('lucent') <= 0.02, `Lucent misplaces ${misplaced('lucent')}`); // the target
  // Matt light of each colour's sum, where the light comes from only.
  let [apart, all] = [0, 0];
  const pixels = Array.from({ length: size * size }, (_, i) => [i % size, Math.floor(i / size)]);
  for (const c of [0, 1, 2]) {
    const pairs = pixels.map(([x, y]) => [Math.max(0, cosineAt(x, y) ?? 0), exactAt(x, y)[c]]);
    const [matt, light] = [0, 1].map((k) => pairs.reduce((total, pair) => total + pair[k], 0));
    pairs.forEach(([cosine, wanted]) => (apart += Math.abs((cosine * light) / matt - wanted)));
    all += light;
  }
  // Their balls have corners; Babylon's canvas has 8 bits, of which dark places lack some.
  for (const [name, tolerance] of Object.entries({ transmission: 0.003, scattering: 0.003, wrapped: 0.01 }))
    assert.ok(Math.abs(misplaced(name) - apart / (2 * all)) < tolerance, `${name} misplaces ${misplaced(name)}`);
  assert.ok(misplaced('babylon') > 0.02, `Babylon.js misplaces only ${misplaced('babylon')}`);
});
