import assert from 'node:assert/strict';
import test from 'node:test';

Object.assign(globalThis, { document: {}, addEventListener: () => {}, location: { href: 'http://127.0.0.1/' } });
const { COORDINATOR, Timed } = await import('../../../../coordinator/web/dashboard/timed.js');

const unit = (id) => ({ id, kind: 'render', worker: 'maia', begun_ms: id, ended_ms: id + 1 });
const step = (id) => ({ id, kind: 'merge', worker: '', begun_ms: id, ended_ms: id + 1 });

test('the timeline is asked for piece by piece, each piece once', async () => {
  const asked = [];
  const answers = [
    { units: [unit(1), unit(3)], steps: [step(2)], after: 3, more: true, dropped: 7 },
    { units: [unit(4)], steps: [], after: 4, more: false, dropped: 7 },
    { units: [], steps: [], after: 4, more: false, dropped: 9 },
  ];
  const timed = new Timed(12, async (job, after) => {
    asked.push([job, after]);
    return answers.shift();
  });
  assert.equal(await timed.more(), true);
  assert.equal(await timed.more(), false);
  assert.deepEqual(asked, [
    [12, undefined],
    [12, 3],
    [12, 4],
  ]);
  assert.deepEqual(
    timed.units.map(({ id }) => id),
    [1, 3, 4],
  );
  assert.deepEqual(
    timed.steps.map(({ worker }) => worker),
    [COORDINATOR],
  );
  assert.equal(timed.dropped, 7, 'what was lost before the first question is all that is missing here');
});

test('of very long jobs the oldest units go first', async () => {
  let next = 0;
  const timed = new Timed(1, async () => ({
    units: Array.from({ length: 30000 }, () => unit(++next)),
    steps: [],
    after: next,
    more: next < 90000,
    dropped: 0,
  }));
  await timed.more();
  assert.equal(timed.units.length, 50000);
  assert.equal(timed.units[0].id, 40001);
  assert.equal(timed.dropped, 40000);
});
