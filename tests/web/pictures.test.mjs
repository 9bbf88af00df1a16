/**
 * The browser against the native program: the same scenes, the same pixels.
 *
 * LUCENT_NATIVE names a folder with SCENE.png for scenes of the gallery and of hard_scenes.mjs, rendered by `lucent
 * render` in their own shape. Values that reach the screen may differ by 1/255, in at most 0.1 % of the pixels by more.
 *
 * On SwiftShader more pixels may where triangles are traced through: it rounds their corners to 1/16 pixel, and what a
 * lens or a mirror shows moves by many times that. On llvmpipe, which rounds as the program does, none does.
 */
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { kHardScenes } from './hard_scenes.mjs';
import { complete, decodePng, difference, eventOf, kDriver, openStage, openViewers, pictureOf, spread } from './support.mjs';

const kFolder = process.env.LUCENT_NATIVE;
const kShare = 0.001;
const kRoundedShare = { 'glass-sphere': 0.015, prism: 0.03, 'metal-ring': 0.03 }; // found: 0.010, 0.023, 0.029

// One page shows all of them, one after the other: its module and programs are compiled once.
let stage;
let page;
before(async () => {
  stage = await openStage();
  page = await openViewers(stage, '<lucent-viewer view-light-dot="false" accuracy="full"></lucent-viewer>', { gallery: 'own' });
  await page.evaluate(() => (document.querySelector('lucent-viewer').style.maxHeight = 'none'));
});
after(() => stage.close());

for (const file of readdirSync(kFolder)
  .filter((name) => name.endsWith('.png'))
  .sort()) {
  const id = file.replace('.png', '');
  test(`${id} looks in the browser as it does natively`, async () => {
    const png = readFileSync(join(kFolder, file));
    const size = [png.readUInt32BE(16), png.readUInt32BE(20)]; // of the chunk IHDR
    const folder = `${id}.json` in kHardScenes ? 'made' : 'gallery';
    await eventOf(page, 'load', () =>
      page.evaluate(
        ([src, [width, height]]) => {
          const viewer = document.querySelector('lucent-viewer');
          Object.assign(viewer.style, { width: `${width}px`, height: `${height}px` });
          viewer.src = src;
        },
        [`${folder}/${id}.json`, size],
      ),
    );
    if (id in kRoundedShare) // as the program rendered it
      await page.evaluate(() => document.querySelector('lucent-viewer').set('technique.sampling.pixelSamples', 1));
    await complete(page);
    const picture = await pictureOf(page);
    const { max, mean, share } = difference(await decodePng(page, png), picture);
    const over = (100 * share).toFixed(3);
    const found = `${kDriver}: ${id}: max ${max}/255, mean ${mean.toFixed(4)}/255, ${over} % above 1/255`;
    console.log(found);
    const allowed = kDriver === 'swiftshader' ? (kRoundedShare[id] ?? kShare) : kShare;
    assert.ok(share <= allowed, found);
    if (folder === 'gallery') assert.ok(spread(picture) > 40, `values spread over ${spread(picture)} of 255`);
    assert.deepEqual(page.problems.splice(0), []);
  });
}
