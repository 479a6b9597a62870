import assert from 'node:assert/strict';
import test from 'node:test';

Object.assign(globalThis, {
  document: { addEventListener: () => {}, visibilityState: 'visible' },
  addEventListener: () => {},
  localStorage: { getItem: () => null, setItem: () => {}, removeItem: () => {} },
});
const { leftOf, lookOf } = await import('../../../../coordinator/web/dashboard/job_state.js');
const { placeOf, skyMap, FIGURE } = await import('../../../../coordinator/web/dashboard/star_places.js');

const job = (more) => ({ state: 'running', leased: 2, samples: 100, samples_done: 40, seconds_left: 60, ...more });

test('a job that runs but has no worker is called waiting', () => {
  assert.equal(lookOf(job()), 'running');
  assert.equal(lookOf(job({ leased: 0 })), 'waiting');
  assert.equal(lookOf(job({ leased: 0, samples_done: 100 })), 'running', 'its files are being written');
  assert.equal(lookOf(job({ leased: 0, state: 'paused' })), 'paused');
  assert.equal(lookOf(job({ leased: 0, state: 'failed' })), 'failed');
});

test('the time left is told only where somebody renders, and never in years', () => {
  assert.equal(leftOf(job()), 60);
  assert.equal(leftOf(job({ seconds_left: -1 })), Infinity);
  assert.equal(leftOf(job({ leased: 0 })), Infinity);
  assert.equal(leftOf(job({ seconds_left: 1e15 })), Infinity);
  assert.equal(leftOf(job({ state: 'paused' })), Infinity);
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
