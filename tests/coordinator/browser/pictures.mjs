// What a person sees of pictures: exposure, pixel values, two frames beside each other, the flip-book. Frames of one colour each, so that
// every pixel on the screen is known.
import assert from 'node:assert/strict';
import { at, colours, finish, jobNow, page, step, submit, until, url } from './page.mjs';

const FRAMES = 6;
const document = `hyades: 1
name: steps-of-colour
frames: {range: 1-${FRAMES}}
film: {size: [48, 32]}
sampling: {samples: 16}
camera: {look_from: [0, 0, 5], look_at: [0, 0, 0], fov: 35}
environment: {color: [0.05, 0.1, 0.02], strength: "= frame"}
outputs: [{file: grey.####.exr, layers: [beauty, variance, samples]}, {file: grey.####.png}]
`;

/** IEC 61966-2-1, as bytes. */
const shown = (light) =>
  light.map((x) => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(1, x) ** (1 / 2.4) - 0.055)));
const lightOf = (frame, stops = 0) => [0.05, 0.1, 0.02].map((x) => x * frame * 2 ** stops);
const alike = (a, b, slack = 2) => a.every((x, i) => Math.abs(x - b[i]) <= slack);
const words = (colour) => colour.join();

const id = await submit('steps', document);
const stage = at('stage');
const centre = [[0.5, 0.5]];
const shows = async (what, light, places = centre) => {
  let now = [];
  const right = async () => {
    now = await colours(stage, places);
    return now.every((colour) => alike(colour, shown(light)));
  };
  await until(`${what}: ${words(shown(light))}`, right).catch((error) => {
    throw new Error(`${error.message}, but there is ${now.map(words).join(' and ')}`);
  });
};

await step('the job is done', () => until('done', async () => (await jobNow(id)).state === 'done'));

for (const painter of ['the graphics card', 'a plain canvas']) {
  const flat = painter === 'a plain canvas' ? '?flat=1' : '';

  await step(`${painter} shows light as it is, brighter and darker`, async () => {
    await page.goto(`${url}/#/jobs`);
    await at('jobs-table').waitFor({ state: 'attached' });
    await page.goto(`${url}/#/jobs/${id}/frames/2${flat}`);
    await shows('frame 2', lightOf(2));
    await page.keyboard.press('e');
    await page.keyboard.press('e');
    await shows('a stop brighter', lightOf(2, 1));
    for (let i = 0; i < 4; ++i) await page.keyboard.press('d');
    await shows('a stop darker', lightOf(2, -1));
    assert.match(page.url(), /ev=-1/);
    await at('exposure-reset').click();
    await shows('as the job has it', lightOf(2));
    await at('exposure').fill('2');
    await shows('by the slider', lightOf(2, 2));
    await at('exposure-reset').click();
  });

  await step(`${painter} shows two frames beside each other, and the line between them moves`, async () => {
    await at('compare').click();
    await at('compare-frame').fill('5');
    await at('compare-frame').press('Enter');
    await shows('frame 2 to the left', lightOf(2), [[0.4, 0.5]]);
    await shows('frame 5 to the right', lightOf(5), [[0.6, 0.5]]);
    const box = await stage.boundingBox();
    const y = box.y + box.height / 2;
    await page.mouse.move(box.x + box.width / 2, y);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.7, y, { steps: 5 });
    await page.mouse.up();
    await shows('frame 2 up to the line', lightOf(2), [
      [0.4, 0.5],
      [0.6, 0.5],
      [0.68, 0.5],
    ]);
    await shows('frame 5 after it', lightOf(5), [[0.72, 0.5]]);
    await at('split').focus();
    await page.keyboard.press('Home');
    await shows('frame 5 alone', lightOf(5), [
      [0.4, 0.5],
      [0.6, 0.5],
    ]);
    await at('mode-difference').click();
    await shows('what differs', lightOf(3), [
      [0.4, 0.5],
      [0.6, 0.5],
    ]);
    await at('compare').click();
    await shows('frame 2 again', lightOf(2));
    await page.goto(`${url}/#/jobs/${id}/frames/2?with=5${flat.replace('?', '&')}`);
    await shows('the comparison that a link asks for', lightOf(5), [[0.6, 0.5]]);
  });
}

await step('the pixel under the pointer is told in numbers', async () => {
  await page.goto(`${url}/#/jobs/${id}/frames/2`);
  await shows('frame 2 alone', lightOf(2), [[0.6, 0.5]]);
  const box = await stage.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  let text = '';
  await until('values', async () => /luminance/.test((text = await at('pixel').textContent())));
  const number = (name) => Number(new RegExp(`${name} ([\\d.]+)`).exec(text)[1]);
  const told = ['R', 'G', 'B', 'luminance'].map(number);
  const right = [0.1, 0.2, 0.04, 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.04];
  assert.ok(
    right.every((x, i) => Math.abs(told[i] / x - 1) < 0.001),
    text,
  );
});

await step('noise and samples have their scales', async () => {
  await at('layer').selectOption('samples');
  await until('samples', async () => /samples per pixel; median 16/.test(await at('legend').textContent()));
  await at('layer').selectOption('noise');
  await until('noise', async () => /relative error/.test(await at('legend').textContent()));
});

const video = at('video-stage');
const frameNow = async () => Number(/\d+/.exec(await at('video-frame').textContent())?.[0]);

await step('the flip-book shows each frame, forth and back', async () => {
  await page.goto(`${url}/#/jobs/${id}/play`);
  await at('video-frame').waitFor();
  // Both the number and the picture follow a key with the next drawing, not at once.
  const isAt = (frame) =>
    until(`frame ${frame}`, async () => {
      const [colour] = await colours(video, centre);
      return (await frameNow()) === frame && alike(colour, shown(lightOf(frame)));
    });
  await page.keyboard.press('Home');
  await isAt(1);
  for (const [key, frame] of [
    ['ArrowRight', 2],
    ['ArrowRight', 3],
    ['End', FRAMES],
    ['ArrowLeft', FRAMES - 1],
    ['Home', 1],
  ]) {
    await page.keyboard.press(key);
    await isAt(frame);
  }
});

await step('the flip-book plays, round and round, until it is stopped', async () => {
  await at('play').click();
  const seen = new Set();
  await until('every frame was shown', async () => {
    const [colour] = await colours(video, centre);
    for (let frame = 1; frame <= FRAMES; ++frame) if (alike(colour, shown(lightOf(frame)))) seen.add(frame);
    return seen.size === FRAMES;
  });
  await at('play').click();
  await page.waitForTimeout(200);
  const frame = await frameNow();
  await page.waitForTimeout(400);
  assert.equal(await frameNow(), frame);
  assert.ok(
    alike((await colours(video, centre))[0], shown(lightOf(frame))),
    'the frame that it names is the one that it shows',
  );
});

await finish();
