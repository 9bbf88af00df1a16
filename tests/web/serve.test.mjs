/** The server of the page outlives whatever it is asked. */
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { serve } from '../../scripts/serve.mjs';

let server;
let folder;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'lucent-serve-'));
  writeFileSync(join(folder, 'index.html'), 'here');
  mkdirSync(join(folder, 'empty'));
  mkdirSync(join(folder, 'elsewhere'));
  writeFileSync(join(folder, 'elsewhere/index.json'), '[]');
  server = await serve(folder, 0, join(folder, 'elsewhere'));
});
after(() => {
  server.close();
  rmSync(folder, { recursive: true });
});

/** The first line of the answer; fetch() would mend the address first. */
function statusOf(path) {
  const { port } = new URL(server.address);
  return new Promise((done, failed) => {
    const socket = connect(Number(port), '127.0.0.1', () =>
      socket.write(`GET ${path} HTTP/1.1\r\nHost: here\r\nConnection: close\r\n\r\n`),
    );
    let text = '';
    socket.on('data', (data) => (text += data));
    socket.on('end', () => done(text.split('\r\n')[0]));
    socket.on('error', failed);
  });
}

test('addresses that name no file are answered, and the next one as well', async () => {
  const long = '/' + 'a'.repeat(5000);
  for (const path of ['/%00', '/%', '/%ff', '//', '/..%2f..%2fetc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/empty', long])
    assert.match(await statusOf(path), /^HTTP\/1\.1 404/, path);
  assert.match(await statusOf('/'), /^HTTP\/1\.1 200/);
});

test('another folder stands in for the gallery, and what comes into it is served at once', async () => {
  assert.match(await statusOf('/gallery/index.json'), /^HTTP\/1\.1 200/);
  assert.match(await statusOf('/gallery/new.json'), /^HTTP\/1\.1 404/);
  writeFileSync(join(folder, 'elsewhere/new.json'), '{}');
  assert.match(await statusOf('/gallery/new.json'), /^HTTP\/1\.1 200/);
  for (const path of ['/gallery/..%2findex.html', '/gallery/%2e%2e/index.htm', '/gallery/'])
    assert.match(await statusOf(path), /^HTTP\/1\.1 404/, path);
});
