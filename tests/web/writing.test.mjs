/** A page of somebody else's, made of nothing but the lines of the README, under the policy that stands there. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { serve } from '../../scripts/serve.mjs';
import { openPage, openStage } from './support.mjs';

const kReadme = readFileSync('README.md', 'utf8').split('\n## The element\n')[1].split('\n## ')[0];
/** The first block of code of a kind. */
const blockOf = (kind) => kReadme.match(new RegExp('```' + kind + '\\n([^]*?)```'))[1];

let stage;
let folder;
before(async () => {
  stage = await openStage();
  folder = mkdtempSync(join(tmpdir(), 'lucent-readme-'));
});
after(() => {
  stage.close();
  rmSync(folder, { recursive: true });
});

test("the README's commands, tag and policy make a page that shows its scene", async () => {
  mkdirSync(join(folder, 'build/web'), { recursive: true });
  symlinkSync(resolve(process.env.LUCENT_SITE ?? 'build/web/site'), join(folder, 'build/web/site'));
  execFileSync('sh', ['-eu', '-c', blockOf('sh')], { cwd: folder });
  writeFileSync(join(folder, 'page/index.html'), blockOf('html'));
  const policy = blockOf('http').match(/^Content-Security-Policy: (.*)$/m)[1];
  assert.doesNotMatch(policy, /unsafe-inline|'unsafe-eval'|\*/);

  const server = await serve(join(folder, 'page'));
  const page = await openPage({ ...stage, address: server.address }, 'about:blank', { gallery: 'own' });
  await page.route(new URL('index.html', server.address).href, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, headers: { ...response.headers(), 'content-security-policy': policy } });
  });
  const answers = [];
  page.on('response', (response) => answers.push(response.status()));
  await page.goto(new URL('index.html', server.address).href);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').stats?.().complete);
  assert.ok(answers.every((status) => status === 200), `${answers}`);
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle), 'Medal under a lamp');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
  server.close();
});
