import assert from 'node:assert/strict';
import test from 'node:test';

// Modules that look at the page when they are loaded find one that is empty.
const nobody = new Proxy(() => nobody, {
  get: (_, name) => (name === Symbol.toPrimitive ? () => '' : nobody),
  set: () => true,
});
Object.assign(globalThis, {
  document: nobody,
  matchMedia: () => nobody,
  addEventListener: () => {},
  localStorage: { getItem: () => null, setItem: () => {}, removeItem: () => {} },
});
const { alertsOf } = await import('../../../../coordinator/web/dashboard/alerts.js');
const { inOrder, noneKind } = await import('../../../../coordinator/web/dashboard/farm.js');
const { noneWhy } = await import('../../../../coordinator/web/dashboard/timeline.js');
const { sorted } = await import('../../../../coordinator/web/dashboard/table.js');
const { speedsWith } = await import('../../../../coordinator/web/dashboard/flipbook.js');
const { byTile, byWorker } = await import('../../../../coordinator/web/dashboard/units.js');
const { grouped, kindOf, nameOf, rangeOf, sourcesOf } = await import('../../../../coordinator/web/dashboard/layers.js');
const { toneOf } = await import('../../../../coordinator/web/dashboard/viewer.js');
const { me, whyNotJob } = await import('../../../../coordinator/web/dashboard/me.js');
const { placeOf } = await import('../../../../coordinator/web/dashboard/star_places.js');

const job = (id, more) => ({
  id,
  name: `job ${id}`,
  state: 'running',
  priority: 0,
  reason: '',
  ended_ms: 0,
  frames_failed: 0,
  ...more,
});
const worker = (id, more) => ({ id, name: `w${id}`, state: 'active', reason: '', heard_ms: 0, ...more });

test('what needs a person comes with the worst first', () => {
  const now = 1e12;
  const list = alertsOf(
    {
      info: { trouble: 'the disk is full' },
      workers: new Map([
        [1, worker(1)],
        [2, worker(2, { state: 'gone', reason: 'not heard of' })],
        [3, worker(3, { state: 'quarantined', reason: 'odd bits' })],
      ]),
      jobs: new Map([
        [1, job(1)],
        [2, job(2, { state: 'failed', ended_ms: now - 1000, reason: '1 frame failed' })],
        [3, job(3, { state: 'failed', ended_ms: now - 1e8 })],
        [4, job(4, { reason: 'no worker has the tag gpu' })],
        [5, job(5, { frames_failed: 2 })],
      ]),
      me: { token_id: '9f3a01c2', expiring: 'expires on 2026-03-01 12:00 UTC, in 3 days' },
    },
    now,
  );
  assert.deepEqual(
    list.map(({ what }) => what),
    [undefined, 'w3', 'job 2', undefined, 'w2', 'job 4', 'job 5'],
  );
  assert.equal(list[0].text, 'the disk is full');
  assert.match(list[3].text, /^Your token expires on .* in 3 days/);
  assert.match(list[6].text, /2 frames failed/);
});

test('that nobody is there is not told of each job that waits', () => {
  const waits = job(1, { reason: 'no worker is there that could take units', waiting: true, leased: 0, samples: 9 });
  const told = (info) => alertsOf({ info, workers: new Map(), jobs: new Map([[1, waits]]), me: {} }).length;
  assert.equal(told({ workers: 0 }), 0);
  assert.equal(told({ workers: 1 }), 1);
});

test('a farm whose jobs have ended has had some', () => {
  assert.equal(noneKind({ running: 1, open: 1, jobs: 1 }, 1), null);
  assert.equal(noneKind({ running: 0, open: 1, jobs: 1 }, 1), 'held');
  assert.equal(noneKind({ running: 0, open: 1, jobs: 1 }, 0), 'alone');
  assert.equal(noneKind({ running: 0, open: 0, jobs: 1 }, 1), 'ended');
  assert.equal(noneKind({ running: 0, open: 0, jobs: 0 }, 1), 'empty');
});

test('a timeline that is lost is not one of nothing', () => {
  assert.match(noneWhy(job(1, { state: 'done', samples_done: 5 })), /until the coordinator is started again/);
  assert.match(noneWhy(job(1, { samples_done: 0 })), /yet/);
  assert.equal(noneWhy(job(1, { state: 'cancelled', samples_done: 0 })), 'Nothing was rendered.');
});

test('workers that do the same are in order of their names', () => {
  const rows = [worker(1, { name: 'w10' }), worker(2, { name: 'w2' }), worker(3, { name: 'w1' })];
  const names = (more) =>
    sorted(rows, { by: () => 1, rowKey: ({ id }) => id, ...more }).map(({ name }) => name);
  assert.deepEqual(names({ tie: ({ name }) => name }), ['w1', 'w2', 'w10']);
  assert.deepEqual(names({}), ['w1', 'w2', 'w10'], 'the greater key');
});

test("a flip-book has the job's speed among others", () => {
  assert.ok(speedsWith(6).includes(6));
  assert.deepEqual(speedsWith(12.5, 12.5).slice(4, 7), [8, 12, 12.5]);
});

test('a name that no token has proven steers no job', () => {
  Object.assign(me, { guarded: true, role: 'submitter', name: 'anna' });
  assert.equal(whyNotJob(job(1, { owner: 'anna', owner_proven: true })), '');
  assert.match(whyNotJob(job(2, { owner: 'anna', owner_proven: false })), /without a token that proves it/);
  assert.match(whyNotJob(job(3, { owner: 'bob', owner_proven: true })), /belongs to bob/);
  me.role = 'operator';
  assert.equal(whyNotJob(job(2, { owner: 'anna', owner_proven: false })), '');
  Object.assign(me, { guarded: false, role: 'admin', name: '' });
});

test('the queue is in the order in which units go out', () => {
  const jobs = [
    job(1),
    job(2, { priority: 5 }),
    job(3, { state: 'paused', priority: 90 }),
    job(4, { state: 'done' }),
    job(5, { priority: 5 }),
  ];
  assert.deepEqual(
    inOrder(jobs).map(({ id }) => id),
    [2, 5, 1, 3],
  );
});

test('units that overlap lie in lanes, and time is not counted twice', () => {
  const unit = (name, begun, ended) => ({
    worker: name,
    frame: 1,
    tile: [0, 0, 8, 8],
    batches: 2,
    begun_ms: begun,
    ended_ms: ended,
  });
  const [a, b] = byWorker([
    unit('w10', 0, 1000),
    unit('w9', 0, 1000),
    unit('w9', 500, 2000),
    unit('w9', 1000, 1500),
    unit('w9', 4000, 5000),
  ]);
  assert.equal(a.worker, 'w9');
  assert.equal(b.worker, 'w10');
  assert.deepEqual(
    a.units.map(({ lane }) => lane),
    [0, 1, 0, 0],
  );
  assert.equal(a.lanes, 2);
  assert.equal(a.busy, 3);
  assert.equal(a.work, 4);
  assert.deepEqual(byTile([unit('a', 0, 1000), unit('b', 0, 500)]), [{ tile: [0, 0, 8, 8], seconds: 1.5, batches: 4 }]);
});

test('layers are shown as what they are', () => {
  assert.deepEqual(
    ['beauty', 'diffuse_direct', 'light_group:key', 'normal', 'depth', 'samples', 'object_id', 'noise', 'position'].map(
      kindOf,
    ),
    ['light', 'light', 'light', 'signed', 'grey', 'heat', 'ids', 'noise', 'places'],
  );
  assert.deepEqual(grouped(['beauty', 'variance', 'samples', 'normal']), [
    ['Light', ['beauty']],
    ['Sampling', ['noise', 'variance', 'samples']],
    ['Surfaces', ['normal']],
  ]);
  assert.deepEqual(grouped(['beauty']), [['Light', ['beauty']]]);
  assert.equal(nameOf('light_group:key'), 'Light of key');
  assert.equal(nameOf('volume_indirect'), 'Volume indirect');
  assert.deepEqual(sourcesOf('noise'), ['beauty', 'variance']);
});

test('the scale of noise covers what most pixels have', () => {
  const one = 0x3c00;
  const picture = { width: 2, height: 2, channels: ['R', 'G', 'B'], planes: new Uint16Array(12).fill(one) };
  // A variance of 0.01 (0x211f) in all channels: a tenth.
  const variance = { width: 2, height: 2, channels: ['R', 'G', 'B'], planes: new Uint16Array(12).fill(0x211f) };
  const range = rangeOf('noise', picture, variance);
  assert.ok(Math.abs(range.middle - 0.1 / 1.01) < 1e-3, String(range.middle));
  assert.ok(Math.abs(range.high - 0.1) < 1e-9);
  const depth = { width: 2, height: 1, channels: ['Z'], planes: Uint16Array.from([0x7c00, 0x4000]) };
  assert.deepEqual(rangeOf('depth', depth, null), { low: 2, high: 3, middle: 2 });
});

test('the viewer begins with the tone map of the job', () => {
  assert.deepEqual(
    toneOf(
      'materials: {a: {exposure: 9}}\noutputs:\n  - {file: a.exr}\n  - {file: a.png, tone_map: filmic, exposure: -0.5}\n  - {file: b.png, tone_map: aces}\n',
    ),
    { curve: 'filmic', exposure: -0.5 },
  );
  assert.deepEqual(toneOf('hyades: 1\n'), { curve: 'srgb', exposure: 0 });
  assert.deepEqual(toneOf('outputs: [{file: a.png, tone_map: odd}]'), { curve: 'srgb', exposure: 0 });
});

test('every worker has a star of its own', () => {
  const places = Array.from({ length: 300 }, (_, i) => placeOf(i));
  assert.equal(new Set(places.map(String)).size, 300);
  assert.deepEqual(placeOf(200), placeOf(200));
  for (const [ra, dec] of places) assert.ok(ra > 50 && ra < 90 && dec > 5 && dec < 30);
});
