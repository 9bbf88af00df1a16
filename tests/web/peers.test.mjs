/** Lucent and three.js before the same exact pictures, small: scripts/peers/three.mjs is the whole comparison. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
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
