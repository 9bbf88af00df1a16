/**
 * Serves a folder on this machine with the policy that the page promises to live under.
 *
 *   node scripts/serve.mjs [FOLDER] [--port N] [--gallery FOLDER]
 *
 * FOLDER is build/web/site unless given; the port is a free one. Another folder may stand in for its gallery, so that
 * what is made there is served at once. Prints the address.
 */
import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, resolve, sep } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

const kTypes = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json; charset=utf-8',
  '.wasm': 'application/wasm',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
  '.svg': 'image/svg+xml',
};
export const kPolicy =
  "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:";

const kGallery = '/gallery/';

/** The file that an address names, or nothing when it lies outside of the folder, is not there or is no address. */
function fileAt(site, gallery, address) {
  try {
    const name = decodeURIComponent(new URL(address, 'http://localhost').pathname);
    const isPart = gallery && name.startsWith(kGallery);
    const root = isPart ? gallery : site;
    let path = join(root, isPart ? name.slice(kGallery.length) : name);
    if (path !== root && !path.startsWith(root + sep)) return undefined;
    if (statSync(path).isDirectory()) path = join(path, 'index.html');
    return statSync(path).isFile() ? path : undefined;
  } catch {
    return undefined;
  }
}

/**
 * @param gallery  folder that stands in for the site's own
 * @return {Promise<{address: string, close: () => void}>}  once the server listens on 127.0.0.1
 */
export function serve(folder, port = 0, gallery) {
  const [site, other] = [resolve(folder), gallery && resolve(gallery)];
  const server = createServer((request, response) => {
    const path = fileAt(site, other, request.url);
    if (!path) return response.writeHead(404, { 'Content-Type': 'text/plain' }).end('not found\n');
    response.writeHead(200, {
      'Content-Type': kTypes[extname(path)] ?? 'application/octet-stream',
      'Content-Length': statSync(path).size,
      'Content-Security-Policy': kPolicy,
      'Access-Control-Allow-Origin': '*', // a sandboxed frame has no origin, and modules are fetched with one
      'Cache-Control': 'no-cache',
    });
    const file = createReadStream(path);
    file.on('error', () => response.destroy()); // the answer has begun: cut, it is known to be no whole file
    file.pipe(response);
  });
  return new Promise((done, failed) => {
    server.on('error', failed);
    server.listen(port, '127.0.0.1', () =>
      done({ address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() }),
    );
  });
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const { values, positionals } = parseArgs({
    options: { port: { type: 'string' }, gallery: { type: 'string' } },
    allowPositionals: true,
  });
  const folder = positionals[0] ?? 'build/web/site';
  if (!statSync(join(folder, 'index.html'), { throwIfNoEntry: false })) {
    console.error(`serve: ${folder}/index.html: is not there; scripts/run builds the page`);
    process.exit(1);
  }
  const { address } = await serve(folder, Number(values.port ?? 0), values.gallery);
  console.log(`serve: ${address}`);
}
