// What a person does at the dashboard (run starts the farm). Each step says what it expects; the first one that does not happen ends the test.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const { HYADES_URL: url, HYADES_CHROMIUM: chromium, HYADES_MODULES: modules, HYADES_VICTIM: victim, HYADES_RENDER: render, HYADES_SCRATCH: scratch, HYADES_SHOTS: shots } = process.env;
const playwright = createRequire(`${modules}/playwright-core/package.json`)('playwright-core');

const job = (name, frames, samples) => `hyades: 1
name: ${name}
frames: {range: 1-${frames}}
film: {size: [96, 64]}
sampling: {samples: ${samples}}
camera: {look_from: [0, 1.2, 5], look_at: [0, 0.8, 0], fov: 35}
environment: {color: [0.6, 0.7, 0.9]}
materials:
  clay: {type: lambert, color: [0.8, 0.4, 0.3]}
  floor: {type: lambert, color: 0.5}
objects:
  ground: {shape: rectangle, size: [20, 20], material: floor}
  ball: {shape: sphere, radius: 0.8, at: ["= 0.2 * frame - 0.5", 0.8, 0], material: clay}
outputs: [{file: ${name}.####.exr, layers: [beauty, normal, variance, samples]}, {file: ${name}.####.png, tone_map: filmic}]
`;

const browser = await playwright.chromium.launch({ executablePath: chromium, args: ['--no-sandbox', '--disable-dev-shm-usage', '--disable-gpu'] });
const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true });
context.setDefaultTimeout(60_000);
const page = await context.newPage();
const wrong = [];
page.on('pageerror', (error) => wrong.push(`error in the page: ${error.message}`));
page.on('console', (message) => {
  if (message.type() === 'error' && !/status of (404|503|400|409)/.test(message.text())) wrong.push(`console: ${message.text()}`);
});
page.on('request', (request) => {
  if (!request.url().startsWith(url) && !/^(blob|data):/.test(request.url())) wrong.push(`the page asked for ${request.url()}`);
});

const at = (id) => page.getByTestId(id);
const shot = async (name) => {
  if (!shots) return;
  mkdirSync(shots, { recursive: true });
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme: scheme });
    await page.waitForTimeout(150);
    await page.screenshot({ path: `${shots}/${name}-${scheme}.png` });
  }
};
const step = async (what, does) => {
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
};
const until = async (what, holds) => {
  for (let i = 0; i < 600; ++i) {
    if (await holds()) return;
    await page.waitForTimeout(100);
  }
  assert.fail(what);
};
const give = (files) => at('pick-files').setInputFiles(files.map(([name, text]) => ({ name, mimeType: 'text/yaml', buffer: Buffer.from(text) })));
const state = async () => (await at('job-state').textContent()).trim();
const jobNow = async (id) => (await (await fetch(`${url}/api/v1/jobs/${id}`)).json()).job;

let first = 0;
let second = 0;

await step('the page opens and shows both workers', async () => {
  await page.goto(`${url}/`);
  await page.getByText('alcyone').first().waitFor();
  await page.getByText('maia').first().waitFor();
});

await step('a job with a mistake is refused with its line', async () => {
  await at('nav-submit').click();
  await give([['wrong.yaml', job('wrong', 2, 16).replace('radius: 0.8', 'radios: 0.8')]]);
  await at('send').click();
  const problems = at('problems');
  await problems.waitFor();
  assert.match(await problems.textContent(), /wrong\.yaml:13/);
  assert.match(await problems.textContent(), /radios/);
  await shot('complaint');
});

await step('a job is dropped on the page and taken', async () => {
  const data = await page.evaluateHandle((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], 'endless.yaml', { type: 'text/yaml' }));
    return transfer;
  }, job('endless', 500, 65536));
  for (const type of ['dragenter', 'dragover', 'drop']) await page.dispatchEvent('body', type, { dataTransfer: data });
  await until('the dropped file is listed', async () => (await at('file-list').textContent()).includes('endless.yaml'));
  await shot('submit');
  await at('send').click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  first = Number(/jobs\/(\d+)/.exec(page.url())[1]);
  await until('its name is shown', async () => (await at('job-name').textContent()).trim() === 'endless');
});

await step('the picture refines', async () => {
  const pictures = new Set();
  await until('a frame shows three pictures', async () => {
    const source = await page.locator('[data-testid=frame] img').first().getAttribute('src').catch(() => null);
    if (source) pictures.add(source);
    return pictures.size >= 3;
  });
  await shot('job');
});

await step('one frame is looked at in full size', async () => {
  await at('frame').first().click();
  await page.waitForURL(/frames\/1/);
  const counts = new Set();
  await until('its samples grow', async () => {
    const text = (await at('frame-samples').textContent()).trim();
    if (/samples/.test(text)) counts.add(text);
    return counts.size >= 2;
  });
  const size = page.viewportSize();
  await page.mouse.move(size.width / 2, size.height / 2);
  await until('the pixel under the pointer has values', async () => /\d/.test(await at('pixel').textContent()));
  await shot('frame');
});

await step('the job is paused and goes on', async () => {
  await page.goto(`${url}/#/jobs/${first}`);
  await at('job-pause').click();
  await until('paused', async () => (await state()) === 'paused');
  assert.equal((await jobNow(first)).state, 'paused');
  await at('job-resume').click();
  await until('running', async () => (await state()) === 'running');
});

await step('a worker dies, is seen to be gone, and the job goes on', async () => {
  await at('nav-workers').click();
  await page.getByText('maia').first().waitFor();
  process.kill(Number(victim), 'SIGKILL');
  const row = page.locator('[data-testid=workers-table] tr', { hasText: 'maia' });
  await until('maia is gone', async () => /gone/.test(await row.textContent()));
  await shot('workers');
  const before = (await jobNow(first)).samples_done;
  await until('samples still come', async () => (await jobNow(first)).samples_done > before);
});

await step('the job is cancelled, after a question', async () => {
  await page.goto(`${url}/#/jobs/${first}`);
  await at('job-cancel').click();
  const question = at('confirm');
  await question.waitFor();
  assert.match(await question.textContent(), /endless|cancel/i);
  await shot('question');
  await question.locator('button[type=submit]').click();
  await until('cancelled', async () => (await state()) === 'cancelled');
});

await step('a second job ends and its files are downloaded whole', async () => {
  await at('nav-submit').click();
  await give([['balls.yaml', job('balls', 6, 64)]]);
  await at('send').click();
  await page.waitForURL((address) => /#\/jobs\/\d+$/.test(address.href) && !address.href.endsWith(`/${first}`));
  second = Number(/jobs\/(\d+)/.exec(page.url())[1]);
  await until('done', async () => (await state()) === 'done');
  await page.goto(`${url}/#/jobs/${second}/outputs`);
  await at('outputs-table').waitFor();
  await shot('outputs');
  const told = await (await fetch(`${url}/api/v1/jobs/${second}/outputs`)).json();
  assert.equal(told.outputs.length, 12);
  const row = page.locator('[data-testid=outputs-table] tr', { hasText: 'balls.0001.exr' });
  const [download] = await Promise.all([page.waitForEvent('download'), row.getByTestId('download').click()]);
  const bytes = readFileSync(await download.path());
  const digest = createHash('sha256').update(bytes).digest('hex');
  assert.equal(digest, told.outputs.find(({ id }) => id === 'balls.0001.exr').sha256);
  const [archive] = await Promise.all([page.waitForEvent('download'), at('outputs-archive').click()]);
  assert.equal(readFileSync(await archive.path()).subarray(0, 2).toString(), 'PK');
  // The farm's bits are those of one machine, whoever died.
  writeFileSync(`${scratch}/balls.yaml`, job('balls', 6, 64));
  execFileSync(render, ['render', `${scratch}/balls.yaml`, '--frames', '1', '--quiet', '--output', `${scratch}/truth`]);
  assert.ok(bytes.equals(readFileSync(`${scratch}/truth/balls.0001.exr`)), 'the download is what render writes');
});

await step('the other views are there', async () => {
  for (const tab of ['log', 'document', 'timeline']) {
    await page.goto(`${url}/#/jobs/${second}/${tab}`);
    await page.waitForTimeout(500);
    await shot(tab);
  }
  await at('nav-jobs').click();
  await page.getByRole('button', { name: /^All/ }).click();
  await page.getByText('endless').first().waitFor();
  await shot('jobs');
  await at('nav-farm').click();
  await page.waitForTimeout(500);
  await shot('farm');
});

await browser.close();
if (wrong.length > 0) {
  console.error(wrong.join('\n'));
  process.exit(1);
}
