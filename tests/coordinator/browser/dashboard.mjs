// What a person does at the dashboard (run starts the farm). Each step says what it expects; the first one that does not happen ends the test.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { at, finish, give, jobNow, page, pixelsOf, shot, step, until, url } from './page.mjs';

const { HYADES_VICTIM: victim, HYADES_RENDER: render, HYADES_SCRATCH: scratch } = process.env;

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

const state = async () => (await at('job-state').textContent()).trim();

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
  const data = await page.evaluateHandle(
    (text) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([text], 'endless.yaml', { type: 'text/yaml' }));
      return transfer;
    },
    job('endless', 500, 65536),
  );
  for (const type of ['dragenter', 'dragover', 'drop']) await page.dispatchEvent('body', type, { dataTransfer: data });
  await until('the dropped file is listed', async () => (await at('file-list').textContent()).includes('endless.yaml'));
  await shot('submit');
  await at('send').click();
  await page.waitForURL(/#\/jobs\/\d+$/);
  first = Number(/jobs\/(\d+)/.exec(page.url())[1]);
  await until('its name is shown', async () => (await at('job-name').textContent()).trim() === 'endless');
});

await step('a whole folder is dropped: what is in it is found, and what systems leave there is not', async () => {
  const folder = `${scratch}/dropped`;
  mkdirSync(`${folder}/parts/deep`, { recursive: true });
  writeFileSync(
    `${folder}/job.yaml`,
    job('foldered', 1, 16)
      .replace('camera:', 'include: parts/light.yaml\ncamera:')
      .replace(/^environment.*\n/m, ''),
  );
  writeFileSync(`${folder}/parts/light.yaml`, 'environment: {color: [0.2, 0.3, 0.4]}\n');
  writeFileSync(`${folder}/parts/deep/notes.txt`, 'nothing that a job needs');
  writeFileSync(`${folder}/.DS_Store`, 'left by a file manager');
  await at('nav-submit').click();
  await at('pick').waitFor();
  const driver = await page.context().newCDPSession(page);
  const { x, y, width, height } = await at('pick').boundingBox();
  const data = { items: [], files: [folder], dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop'])
    await driver.send('Input.dispatchDragEvent', { type, x: x + width / 2, y: y + height / 2, data });
  await until('the folder is read', async () =>
    (
      await at('file-list')
        .textContent()
        .catch(() => '')
    ).includes('light.yaml'),
  );
  const listed = await at('file-list').textContent();
  assert.ok(!listed.includes('.DS_Store'), listed);
  await at('send').click();
  await page.waitForURL((address) => /#\/jobs\/\d+$/.test(address.href) && !address.href.endsWith(`/${first}`));
  await until('its name is shown', async () => (await at('job-name').textContent()).trim() === 'foldered');
  await page.goto(`${url}/#/jobs/${first}`);
});

await step('the picture refines', async () => {
  const image = page.locator('[data-testid=frame] img').first();
  await image.waitFor();
  const pictures = new Set();
  await until('a frame shows three pictures whose pixels differ', async () => {
    const pixels = await pixelsOf(image);
    if (pixels !== null) pictures.add(pixels);
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
  assert.equal(
    readFileSync(await archive.path())
      .subarray(0, 2)
      .toString(),
    'PK',
  );
  // The farm's bits are those of one machine, whoever died.
  writeFileSync(`${scratch}/balls.yaml`, job('balls', 6, 64));
  execFileSync(render, ['render', `${scratch}/balls.yaml`, '--frames', '1', '--quiet', '--output', `${scratch}/truth`]);
  assert.ok(bytes.equals(readFileSync(`${scratch}/truth/balls.0001.exr`)), 'the download is what render writes');
});

await step('a video is made of a job that has none', async () => {
  await at('make-video').click();
  const dialog = at('video-dialog');
  await dialog.waitFor();
  await at('video-file').fill('balls.avi');
  await at('dialog-make').click();
  await until('a file that is no video is refused', async () => /\.mp4/.test(await dialog.getByRole('alert').textContent()));
  await at('video-file').fill('cut.mp4');
  await at('video-rate').fill('12');
  await at('dialog-make').click();
  await at('video').waitFor();
  await until('the video plays', async () => (await at('video').evaluate((video) => video.videoWidth)) === 96);
  await shot('video');
  const { videos } = await (await fetch(`${url}/api/v1/jobs/${second}/videos`)).json();
  assert.deepEqual(
    videos.map(({ file, frames, rate, state: now }) => [file, frames, rate, now]),
    [['cut.mp4', 6, 12, 'done']],
  );
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

await step('an address that is none is told of on the page', async () => {
  await page.goto(`${url}/job/1`);
  await page.getByText('There is no such page').waitFor();
});

await step('while answers are slow nothing is told that is not known', async () => {
  await page.route('**/api/v1/**', async (route) => {
    await new Promise((go) => setTimeout(go, 4000));
    await route.continue().catch(() => {}); // the page may be left
  });
  const open = async (view) => {
    await page.goto('about:blank');
    await page.goto(`${url}/#/${view}`);
    await page.locator('h1').first().waitFor({ state: 'attached' });
  };
  await open('jobs');
  assert.equal(await at('state-open').textContent(), 'Open');
  assert.equal(await at('state-waiting').textContent(), 'Waiting');
  await shot('slow-jobs');
  await open(`jobs/${second}`);
  assert.equal(await state(), 'loading…');
  assert.ok(await at('why').isHidden());
  assert.ok(await page.getByRole('progressbar', { name: 'Progress' }).isHidden());
  await shot('slow-job');
  await open('');
  assert.equal(await page.getByText('Asking the coordinator…').count(), 4);
  await shot('slow-farm');
  await page.unroute('**/api/v1/**');
  await page.getByText('maia').first().waitFor();
  assert.equal(await page.getByText('Asking the coordinator…').filter({ visible: true }).count(), 0);
});

await finish();
