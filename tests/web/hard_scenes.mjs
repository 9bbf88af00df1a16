/**
 * The hard cases of the relief model as scene files, for the browser and the program alike. File name -> content.
 *
 *   node tests/web/hard_scenes.mjs DIR    writes them there
 */
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

/** Heights as PFM, rows upwards. @param height  of column and row from the top */
function pfm(width, height, heightAt) {
  const texels = new Float32Array(width * height);
  for (let row = 0; row < height; ++row)
    for (let column = 0; column < width; ++column) texels[(height - 1 - row) * width + column] = heightAt(column, row);
  return Buffer.concat([Buffer.from(`Pf\n${width} ${height}\n-1.0\n`), Buffer.from(texels.buffer)]);
}

const waves = (x, y) => 0.5 + 0.3 * Math.sin(x * 0.37 + y * 0.11) + 0.2 * Math.sin(y * 0.53 - x * 0.19);

const distant = (elevation, azimuth) => {
  const [e, a] = [elevation, azimuth].map((degrees) => (degrees * Math.PI) / 180);
  return { type: 'distant', direction: [-Math.cos(e) * Math.cos(a), -Math.cos(e) * Math.sin(a), -Math.sin(e)] };
};
const lamp = (...position) => ({ type: 'point', position });

const sky = (technique) => ({ lights: [], environment: { source: 'sky', rotation: [70, 20, 0] }, technique });

// name: [width, height, heights, heightScale, depth, light, what else differs]
const kCases = {
  'hard-cliff': [64, 64, (x) => (x < 32 ? 1 : 0), 0.5, 0.05, distant(30, 20)],
  'hard-spikes': [64, 64, (x, y) => Number(x % 8 === 3 && y % 8 === 5), 0.4, 0.05, distant(20, 77)],
  'hard-constant': [64, 64, () => 0.7, 0.3, 0.05, distant(25, 0)],
  'hard-texel': [1, 1, () => 0.5, 0.3, 0.2, distant(40, 30)],
  'hard-row': [64, 1, (x) => (x % 5) / 5, 0.01, 0.005, distant(40, 30)],
  'hard-odd': [37, 23, (x, y) => ((x * 7 + y * 3) % 11) / 11, 0.1, 0.05, distant(33, 100)],
  'hard-level': [64, 64, waves, 0, 0.05, distant(45, 10)],
  'hard-tall': [64, 64, waves, 1e4, 10, distant(50, 10)],
  'hard-deep': [64, 64, waves, 0.2, 10, distant(15, 200)],
  'hard-thin': [64, 64, waves, 0.2, 1e-6, distant(35, 140)],
  'hard-grazing': [64, 64, waves, 0.1, 0.03, distant(0.1, 45)],
  'hard-horizon': [64, 64, waves, 0.1, 0.03, distant(0, 0)],
  'hard-below': [64, 64, waves, 0.1, 0.03, distant(-30, 60)],
  'hard-over-texel': [64, 64, waves, 0.1, 0.03, lamp(0.5 / 64, 0.5 / 64, 2)],
  'hard-inside': [64, 64, waves, 0.2, 0.03, lamp(0.1, 0.1, 0.05)],
  'hard-near': [64, 64, waves, 0.1, 0.03, lamp(1e-4, 0, 1e-4)],
  'hard-far': [64, 64, waves, 0.1, 0.03, lamp(6e5, 0, 8e5)],
  'hard-wide-sun': [64, 64, waves, 0.2, 0.03, { ...distant(4, 30), angle: 20 }], // half of it below the horizon
  'hard-wide-lamp': [64, 64, waves, 0.2, 0.03, { ...lamp(0.1, 0, 0.3), radius: 0.6 }],
  'hard-importance': [64, 64, waves, 0.2, 0.03, null, sky({ sampling: { environmentSampling: 'importance', directions: 60 } })],
  'hard-transfer': [64, 64, waves, 0.2, 0.03, null, sky({ relief: { method: 'transfer' } })],
};

const scene = (name, [width, height, , heightScale, depth, light, other]) => ({
  lucent: 1,
  title: name,
  size: [64, Math.max(1, Math.round((64 * height) / width))],
  camera: { type: 'orthographic', eye: [0, 0, 2 + 2 * heightScale], target: [0, 0, 0], up: [0, 1, 0], height: height / width },
  view: { show: 'd', lightDot: false },
  lights: [light],
  objects: [
    {
      name: 'field',
      shape: { type: 'heightfield', heights: `${name}.pfm`, heightScale },
      material: { depth },
    },
  ],
  ...other,
});

export const kHardScenes = Object.fromEntries(
  Object.entries(kCases).flatMap(([name, field]) => [
    [`${name}.json`, JSON.stringify(scene(name, field))],
    [`${name}.pfm`, pfm(...field.slice(0, 3))],
  ]),
);

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  mkdirSync(process.argv[2], { recursive: true });
  for (const [name, content] of Object.entries(kHardScenes)) writeFileSync(join(process.argv[2], name), content);
  console.log(`${Object.keys(kCases).length} scenes in ${process.argv[2]}`);
}
