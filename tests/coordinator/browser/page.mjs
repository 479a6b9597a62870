// What the tests in the browser share: the page, steps that say what they expect, pixels as they are shown.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';

const { HYADES_URL, HYADES_CHROMIUM: chromium, HYADES_MODULES: modules, HYADES_SHOTS: shots } = process.env;
const playwright = createRequire(`${modules}/playwright-core/package.json`)('playwright-core');

/** Where the dashboard is. */
export const url = HYADES_URL;

const browser = await playwright.chromium.launch({
  executablePath: chromium,
  args: ['--no-sandbox', '--disable-dev-shm-usage', '--disable-gpu'],
});
const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true });
context.setDefaultTimeout(60_000);
export const page = await context.newPage();

const wrong = [];
let forgiven = /status of (404|503|400|409)/;
/** What the console may say, besides. */
export const forgive = (also) => {
  forgiven = new RegExp(`${forgiven.source}|${also.source}`);
};
page.on('pageerror', (error) => wrong.push(`error in the page: ${error.message}`));
page.on('console', (message) => {
  if (message.type() === 'error' && !forgiven.test(message.text()))
    wrong.push(`console: ${message.text()}`);
});
page.on('request', (request) => {
  if (!request.url().startsWith(url) && !/^(blob|data):/.test(request.url()))
    wrong.push(`the page asked for ${request.url()}`);
});

export const at = (id) => page.getByTestId(id);

/** Pictures of the page as it is now, light and dark, where a folder was given for them. */
export async function shot(name) {
  if (!shots) return;
  mkdirSync(shots, { recursive: true });
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await page.waitForTimeout(150);
    await page.screenshot({ path: `${shots}/${name}-${scheme}.png` });
  }
}

/** Does something; the first step that fails ends the test. */
export async function step(what, does) {
  const begun = Date.now();
  try {
    await does();
  } catch (error) {
    console.error(`FAILED: ${what}\n${error.stack}\n${wrong.join('\n')}`);
    if (shots) await page.screenshot({ path: `${shots}/failed.png` });
    await browser.close();
    process.exit(1);
  }
  console.log(`${what}: ${((Date.now() - begun) / 1000).toFixed(1)} s`);
}

export async function until(what, holds) {
  for (let i = 0; i < 600; ++i) {
    if (await holds()) return;
    await page.waitForTimeout(100);
  }
  assert.fail(what);
}

/** Ends the browser, and the test where the page complained of anything. */
export async function finish() {
  await browser.close();
  if (wrong.length === 0) return;
  console.error(wrong.join('\n'));
  process.exit(1);
}

/** Chooses files on the page of submissions: [[name, text]]. */
export const give = (files) =>
  at('pick-files').setInputFiles(
    files.map(([name, text]) => ({ name, mimeType: 'text/yaml', buffer: Buffer.from(text) })),
  );

const read = async (path) => (await fetch(`${url}/api/v1/${path}`)).json();

/** A job as the API tells it now. */
export const jobNow = async (id) => (await read(`jobs/${id}`)).job;

/** Submits a document by the API alone; gives the job's id. */
export async function submit(name, text) {
  const sha256 = createHash('sha256').update(text).digest('hex');
  const size = Buffer.byteLength(text);
  const send = async (method, path, body) => {
    const answer = await fetch(`${url}/api/v1/${path}`, { method, body });
    assert.ok(answer.ok, `${method} ${path}: ${answer.status}`);
    return answer.json();
  };
  await send('PUT', `assets/${sha256}?size=${size}`, text);
  const files = [{ path: `${name}.yaml`, sha256, size }];
  return (await send('POST', 'jobs', JSON.stringify({ name, document: `${name}.yaml`, files }))).job.id;
}

/**
 * The colours that the screen shows of an element, at places given as shares of its width and height: [[r, g, b]], 0..255 each.
 */
export async function colours(element, places) {
  const png = (await element.screenshot()).toString('base64');
  return page.evaluate(
    async ([text, wanted]) => {
      const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      const pen = canvas.getContext('2d');
      pen.drawImage(bitmap, 0, 0);
      return wanted.map(([x, y]) =>
        Array.from(pen.getImageData(Math.floor(x * bitmap.width), Math.floor(y * bitmap.height), 1, 1).data).slice(
          0,
          3,
        ),
      );
    },
    [png, places],
  );
}

/** A number that stands for the pixels of an <img>; null while it shows nothing. */
export const pixelsOf = (image) =>
  image.evaluate((node) => {
    if (!node.complete || node.naturalWidth === 0) return null;
    const canvas = new OffscreenCanvas(node.naturalWidth, node.naturalHeight);
    const pen = canvas.getContext('2d');
    pen.drawImage(node, 0, 0);
    const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
    let hash = 2166136261;
    for (const byte of data) hash = Math.imul(hash ^ byte, 16777619);
    return hash;
  });
