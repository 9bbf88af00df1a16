/** A server and a browser for the tests of the page, and what they ask of both. */
import { chromium } from 'playwright-core';
import { kPolicy, serve } from '../../scripts/serve.mjs';
import { kScenes } from './scenes.mjs';

const kDrivers = {
  swiftshader: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  llvmpipe: ['--use-gl=angle', '--use-angle=gles-egl'],
};
const kFlags = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--ignore-gpu-blocklist',
  '--disable-features=LocalNetworkAccessChecks', // a frame without an origin must reach our server on this machine
];
const kSite = process.env.LUCENT_SITE ?? 'build/web/site';
const kPatience = Number(process.env.LUCENT_PATIENCE ?? 120000); // ms that a software driver may take for a picture
const kBlank =
  '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><link rel="stylesheet" href="page.css">' +
  '<script type="module" src="lucent-viewer.js"></script>';
export const kDriver = process.env.LUCENT_DRIVER ?? 'swiftshader';

/** One server and one browser for a test file; close() ends both. */
export async function openStage() {
  if (!kDrivers[kDriver])
    throw new Error(`LUCENT_DRIVER is "${kDriver}"; must be ${Object.keys(kDrivers).join(' or ')}`);
  const server = await serve(kSite);
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [...kFlags, ...kDrivers[kDriver]],
  });
  const close = async () => {
    await browser.close();
    server.close();
  };
  return { browser, address: server.address, close };
}

// Runs in the page before its own scripts: notes contexts, frames, those that are still to come, and violations of the
// policy; encode() gives the pixels of a picture.
function watch() {
  const seen = (window.seen = { contexts: [], frames: 0, wanted: new Set(), violations: [] });
  for (const kind of [self.OffscreenCanvas, HTMLCanvasElement].filter(Boolean)) {
    const getContext = kind.prototype.getContext;
    kind.prototype.getContext = function (type, ...rest) {
      const context = getContext.call(this, type, ...rest);
      if (type === 'webgl2' && !seen.contexts.includes(context)) seen.contexts.push(context);
      return context;
    };
  }
  const [ask, cancel] = [window.requestAnimationFrame.bind(window), window.cancelAnimationFrame.bind(window)];
  window.requestAnimationFrame = (callback) => {
    const number = ask((now) => {
      seen.wanted.delete(number);
      callback(now);
    });
    seen.frames++;
    seen.wanted.add(number);
    return number;
  };
  window.cancelAnimationFrame = (number) => {
    seen.wanted.delete(number);
    cancel(number);
  };
  window.encode = (source) => {
    const { width, height } = source;
    const sheet = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
    sheet.drawImage(source, 0, 0);
    const { data } = sheet.getImageData(0, 0, width, height);
    let text = '';
    for (let at = 0; at < data.length; at += 8192) text += String.fromCharCode(...data.subarray(at, at + 8192));
    return { width, height, base64: btoa(text) };
  };
  document.addEventListener('securitypolicyviolation', (event) =>
    seen.violations.push(`${event.violatedDirective} ${event.blockedURI}`),
  );
}

/**
 * Opens a page of the site. `problems` collects console errors and exceptions.
 * @param options  of the browser's context: viewport, deviceScaleFactor, hasTouch, colorScheme; and `init`, a
 *                 function that runs in the page first, `gallery: 'own'` for the site's gallery in place of scenes.mjs,
 *                 `visits: 0` for somebody who has never been there, `beside` a page in another tab of whose browser it is
 */
export async function openPage(stage, path = 'index.html', { init, gallery = 'made', markup = '', visits = 1, beside, ...options } = {}) {
  const context = beside?.context() ?? (await stage.browser.newContext({ viewport: { width: 800, height: 600 }, ...options }));
  const page = await context.newPage();
  const problems = [];
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  page.on('pageerror', (error) => problems.push(String(error)));
  page.setDefaultTimeout(kPatience);
  await page.addInitScript(watch);
  if (visits) await page.addInitScript(() => self.origin !== 'null' && localStorage.setItem('lucent.tour', 'seen'));
  if (init) await page.addInitScript(init);
  if (gallery === 'made') await page.route('**/gallery/*', fulfilMade);
  await page.route('**/made/*', fulfilMade);
  const headers = { 'Content-Security-Policy': kPolicy };
  await page.route('**/blank.html', (route) =>
    route.fulfill({ contentType: 'text/html', headers, body: kBlank + markup }),
  );
  await page.goto(new URL(path, stage.address).href);
  const violations = () => page.evaluate(() => window.seen.violations);
  return Object.assign(page, { problems, violations, leave: () => context.close() });
}

function fulfilMade(route) {
  const name = new URL(route.request().url()).pathname.split('/').pop();
  const headers = { 'Access-Control-Allow-Origin': '*' }; // as the server sends it
  return route.fulfill(kScenes[name] ? { headers, body: kScenes[name] } : { headers, status: 404 });
}

/** Opens an otherwise empty page with viewers of our own; the site's policy holds. */
export const openViewers = (stage, markup, options) => openPage(stage, 'blank.html', { ...options, markup });

/** Waits until a viewer shows a finished picture at the size it has now, and no further frame is wanted; of what plays, a
 * complete one. */
export async function complete(page, selector = 'lucent-viewer') {
    const isComplete = (one) => {
        const viewer = document.querySelector(one);
        const canvas = viewer?.shadowRoot?.querySelector('canvas');
        const wide = canvas ? canvas.clientWidth * Math.min(devicePixelRatio, 2) : 0;
        return viewer?.stats?.().complete && Math.abs(canvas.width - wide) <= 1;
    };
    await page.waitForFunction(isComplete, selector, { polling: 50 });
    // All samples of its pixels may take a software driver longer than its patience for a picture.
    await page.evaluate(async (one) => {
      const viewer = document.querySelector(one);
      const isDone = () => !viewer?.isConnected || viewer.stats().finished || !viewer.paused;
      while (!isDone()) await new Promise((done) => setTimeout(done, 50));
    }, selector);
    await quiet(page);
}

/** Waits until the page has asked for no animation frame for a while, and none is still to come: a busy machine may let
 * one wait longer than that. */
export async function quiet(page, rest = 200) {
  await page.evaluate(async (milliseconds) => {
    let before;
    do {
      before = window.seen.frames;
      await new Promise((done) => setTimeout(done, milliseconds));
    } while (window.seen.frames !== before || window.seen.wanted.size);
  }, rest);
}

/** Waits for an event of a viewer that fires while `act` runs or after it. @return its detail */
export async function eventOf(page, type, act, selector = 'lucent-viewer') {
  await page.evaluate(
    ([one, name]) => {
      window.awaited = new Promise((done) =>
        document.querySelector(one).addEventListener(name, ({ detail }) => done(detail ?? {}), { once: true }),
      );
    },
    [selector, type],
  );
  await act();
  return page.evaluate(() => window.awaited);
}

/** Clicks the first button of a viewer's bar once that says `text`, in the same task: a hand from outside the page may come
 * when all is done. */
export const clickOnce = (page, bar, text, selector = 'lucent-viewer') =>
  page.evaluate(
    ([one, part, source]) =>
      new Promise((done) => {
        const { shadowRoot } = document.querySelector(one);
        const look = () => {
          const element = shadowRoot.querySelector(part);
          if (!element || element.hidden || !new RegExp(source).test(element.textContent)) return;
          observer.disconnect();
          element.querySelector('button').click();
          done();
        };
        const observer = new MutationObserver(look);
        observer.observe(shadowRoot, { attributes: true, characterData: true, childList: true, subtree: true });
        look();
      }),
    [selector, bar, text.source],
  );

/**
 * The finished picture of a viewer without its panel.
 * @return {{width: number, height: number, pixels: Uint8Array}}  RGBA, row 0 at the top
 */
export async function pictureOf(page, selector = 'lucent-viewer') {
  const { width, height, base64 } = await page.evaluate(async (one) => {
    const viewer = document.querySelector(one);
    const bitmap = await createImageBitmap(await viewer.toBlob());
    return window.encode(bitmap);
  }, selector);
  return { width, height, pixels: new Uint8Array(Buffer.from(base64, 'base64')) };
}

/** What a viewer shows right now, panel included. */
export async function shownBy(page, selector = 'lucent-viewer') {
  const { width, height, base64 } = await page.evaluate(
    (one) => window.encode(document.querySelector(one).shadowRoot.querySelector('canvas')),
    selector,
  );
  return { width, height, pixels: new Uint8Array(Buffer.from(base64, 'base64')) };
}

/** A PNG file as pixels, decoded by the browser. */
export async function decodePng(page, bytes) {
  const { width, height, base64 } = await page.evaluate(async (text) => {
    const data = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return window.encode(await createImageBitmap(new Blob([data], { type: 'image/png' })));
  }, Buffer.from(bytes).toString('base64'));
  return { width, height, pixels: new Uint8Array(Buffer.from(base64, 'base64')) };
}

/** Mean of red, green and blue, [0, 255], over a part of a picture given as shares of its sides. */
export function brightness({ width, height, pixels }, [left, top, right, bottom] = [0, 0, 1, 1]) {
  let sum = 0;
  let count = 0;
  for (let y = Math.floor(top * height); y < Math.floor(bottom * height); ++y)
    for (let x = Math.floor(left * width); x < Math.floor(right * width); ++x, count += 3)
      for (let channel = 0; channel < 3; ++channel) sum += pixels[4 * (y * width + x) + channel];
  return sum / count;
}

/** Distance between the darkest and the brightest green of a picture, [0, 255]: an empty one has none. */
export function spread({ pixels }) {
  let low = 255;
  let high = 0;
  for (let at = 0; at < pixels.length; at += 4) {
    low = Math.min(low, pixels[at + 1]);
    high = Math.max(high, pixels[at + 1]);
  }
  return high - low;
}

/**
 * How far two pictures of the same size are apart in what reaches the eye: colours times their coverage, [0, 255].
 * @return {{max: number, mean: number, share: number}}  share of the pixels that differ by more than `limit`
 */
export function difference(a, b, limit = 1) {
  if (a.width !== b.width || a.height !== b.height)
    throw new Error(`sizes differ: ${a.width}x${a.height}, ${b.width}x${b.height}`);
  const covered = (pixels, at, channel) =>
    channel === 3 ? pixels[at + 3] : Math.round((pixels[at + channel] * pixels[at + 3]) / 255);
  let max = 0;
  let sum = 0;
  let over = 0;
  for (let at = 0; at < a.pixels.length; at += 4) {
    let worst = 0;
    for (let channel = 0; channel < 4; ++channel) {
      const distance = Math.abs(covered(a.pixels, at, channel) - covered(b.pixels, at, channel));
      worst = Math.max(worst, distance);
      sum += distance;
    }
    max = Math.max(max, worst);
    if (worst > limit) ++over;
  }
  return { max, mean: sum / a.pixels.length, share: (over * 4) / a.pixels.length };
}

/** How often a viewer has drawn since its start. */
export const drawsOf = (page, selector = 'lucent-viewer') =>
  page.evaluate((one) => document.querySelector(one).stats().frames, selector);

/** Place of a viewer's canvas on the page, CSS pixels. */
export const boxOf = (page, selector = 'lucent-viewer') => page.locator(`${selector} canvas`).first().boundingBox();

/** A parameter of a viewer. */
export const valueOf = (page, path, selector = 'lucent-viewer') =>
  page.evaluate(([one, name]) => document.querySelector(one).get(name), [selector, path]);
