// The pictures of docs/dashboard.md: each view of a farm that is at work, light and dark, as small files. `screenshots` starts that farm.
import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { at, finish, page, step, until, url } from './page.mjs';

const { HYADES_PICTURES: folder } = process.env;
const WIDTH = 1200;
const HEIGHT = 750;
/** Bytes of a file at most; the quality goes down until it fits. */
const MOST_BYTES = 29_000;

const { jobs } = await (await fetch(`${url}/api/v1/jobs?ended=true`)).json();
const idOf = (name) => {
  const job = jobs.find((one) => one.name === name);
  assert.ok(job, `there is no job ${name}`);
  return job.id;
};

/** The picture of the page as WebP: what is small and what every browser shows. */
async function small() {
  const png = (await page.screenshot()).toString('base64');
  for (let quality = 0.86; ; quality -= 0.06) {
    const text = await page.evaluate(
      async ([data, wish]) => {
        const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
        canvas.getContext('2d').drawImage(bitmap, 0, 0);
        const made = await canvas.convertToBlob({ type: 'image/webp', quality: wish });
        return String.fromCharCode(...new Uint8Array(await made.arrayBuffer()));
      },
      [png, quality],
    );
    const bytes = Buffer.from(text, 'latin1');
    if (bytes.length <= MOST_BYTES || quality < 0.4) return bytes;
  }
}

async function take(name) {
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await page.waitForTimeout(700);
    writeFileSync(`${folder}/${name}-${scheme}.webp`, await small());
  }
}

const show = async (hash, node) => {
  // By way of another view: a view that is shown already would go on as it is.
  await page.goto(`${url}/#/nowhere`);
  await page.goto(`${url}/#/${hash}`);
  await node.first().waitFor();
  await page.mouse.move(0, 0);
  await page.waitForTimeout(2000);
};
const sequence = idOf('perlin-sphere');
const running = idOf('lamplighter');

mkdirSync(folder, { recursive: true });
await page.setViewportSize({ width: WIDTH, height: HEIGHT });

await step('the farm', async () => {
  await show('', page.locator('.now-picture img:not([hidden])'));
  await take('farm');
});
await step('jobs', async () => {
  await show('jobs?state=all', at('job-link'));
  await take('jobs');
});
await step('a job', async () => {
  await show(`jobs/${running}`, page.locator('[data-testid=frame] img[src]'));
  await take('job');
});
await step('a frame', async () => {
  await show(`jobs/${sequence}/frames/12`, at('zoom'));
  await until('its picture', async () => /%/.test(await at('zoom').textContent()));
  await page.mouse.move(WIDTH * 0.55, HEIGHT * 0.45);
  await take('frame');
});
await step('two frames', async () => {
  await show(`jobs/${sequence}/frames/12?with=24`, at('split'));
  await take('compare');
});
await step('the flip-book', async () => {
  await show(`jobs/${sequence}/play?frame=8`, at('video-stage'));
  await take('flip-book');
});
await step('the timeline', async () => {
  await show(`jobs/${running}/timeline`, at('timeline-table'));
  await take('timeline');
});
await step('workers', async () => {
  await show('workers', page.locator('[data-testid=workers-table] tr[data-key]'));
  await take('workers');
});
await step('a job to be sent', async () => {
  await show('submit', at('pick'));
  await at('example').click();
  await at('file-list').waitFor();
  await take('submit');
});
await finish();
