import assert from 'node:assert/strict';
import test from 'node:test';

Object.assign(globalThis, {
  document: { addEventListener: () => {}, visibilityState: 'visible' },
  addEventListener: () => {},
  localStorage: { getItem: () => null, setItem: () => {}, removeItem: () => {} },
});
const { doneOf, leftOf, lookOf, tookOf } = await import('../../../../coordinator/web/dashboard/job_state.js');
const { placeOf, skyMap, FIGURE } = await import('../../../../coordinator/web/dashboard/star_places.js');

const job = (more) => ({ state: 'running', leased: 2, samples: 100, samples_done: 40, seconds_left: 60, ...more });

test('a job that runs but has no worker is called waiting', () => {
  assert.equal(lookOf(job()), 'running');
  assert.equal(lookOf(job({ leased: 0, waiting: true })), 'waiting');
  assert.equal(lookOf(job({ leased: 0 })), 'running', 'its files are being written, or so: the coordinator knows');
  assert.equal(lookOf(job({ leased: 0, state: 'paused' })), 'paused');
});

test('the time left is told only where somebody renders, and never in years', () => {
  assert.equal(leftOf(job()), 60);
  assert.equal(leftOf(job({ seconds_left: -1 })), Infinity);
  assert.equal(leftOf(job({ leased: 0, waiting: true })), Infinity);
  assert.equal(leftOf(job({ seconds_left: 1e15 })), Infinity);
  assert.equal(leftOf(job({ state: 'paused' })), Infinity);
});

test('what a job took is what it was worked on', () => {
  const ended = { submitted_ms: 1000, begun_ms: 60000, ended_ms: 100000, frames: 4, frames_done: 4, samples_done: 9 };
  assert.equal(tookOf({ ...ended, busy_seconds: 7.5 }), 7.5);
  assert.equal(tookOf({ ...ended, busy_seconds: 0 }), 40, 'an older coordinator has ended it');
  assert.equal(doneOf({ ...ended, busy_seconds: 7.5 }), '4 frames in 8 s');
  assert.equal(doneOf({ ...ended, busy_seconds: 7.5, frames_done: 3 }), '3 of 4 frames in 8 s');
  const untouched = { submitted_ms: 1000, begun_ms: 0, ended_ms: 100000, frames: 1, frames_done: 0, samples_done: 0 };
  assert.ok(Number.isNaN(tookOf(untouched)));
  assert.equal(doneOf(untouched), '0 of 1 frame');
});

test('all stars lie on the map, east to the left and north above', () => {
  for (const [count, width, height] of [
    [0, 500, 250],
    [2, 340, 250],
    [300, 1200, 250],
  ]) {
    const put = skyMap(count, width, height);
    for (const place of [...FIGURE, ...Array.from({ length: count }, (_, i) => placeOf(i))]) {
      const [x, y] = put(place);
      assert.ok(x > 20 && x < width - 20 && y > 20 && y < height - 20, `${place} of ${count} at ${x}, ${y}`);
    }
    assert.ok(put([68, 16])[0] < put([67, 16])[0]);
    assert.ok(put([68, 17])[1] < put([68, 16])[1]);
  }
});
