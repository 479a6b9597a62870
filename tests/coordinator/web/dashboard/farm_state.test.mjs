import assert from 'node:assert/strict';
import test from 'node:test';

// A page that is empty, one stream, and a coordinator that knows two jobs.
const nobody = new Proxy(() => nobody, {
  get: (_, name) => (name === Symbol.toPrimitive ? () => '' : name === 'baseURI' ? 'http://farm.example/' : nobody),
  set: () => true,
});
const streams = [];
const asked = [];
const known = { 2: { id: 2, name: 'two', state: 'failed' } };
Object.assign(globalThis, {
  document: nobody,
  matchMedia: () => nobody,
  addEventListener: () => {},
  localStorage: { getItem: () => null, setItem: () => {}, removeItem: () => {} },
  EventSource: class {
    handlers = {};
    constructor() {
      streams.push(this);
    }
    addEventListener(name, handler) {
      this.handlers[name] = handler;
    }
    close() {}
  },
  fetch: async (url) => {
    const id = Number(/jobs\/(\d+)/.exec(url)[1]);
    asked.push(id);
    return known[id]
      ? Response.json({ job: known[id], frames: [], more: false })
      : Response.json({ error: { code: 'not_found', message: 'no' } }, { status: 404 });
  },
});
// The stream's own clock is not waited for at the end.
const timer = globalThis.setTimeout;
globalThis.setTimeout = (...what) => timer(...what).unref();
const { farm, startFarm } = await import('../../../../coordinator/web/dashboard/farm_state.js');

const running = (id) => ({ id, name: `job ${id}`, state: 'running' });
const snapshot = (...jobs) =>
  streams[0].handlers.snapshot({ data: JSON.stringify({ jobs, workers: [], info: {}, samples_per_second: [] }) });

test('jobs that ended while nobody listened are asked for, and those that are gone go', async () => {
  startFarm();
  snapshot(running(1), running(2), running(3));
  snapshot(running(1));
  for (let i = 0; i < 100 && (asked.length < 2 || farm.jobs.has(3)); ++i) await new Promise((done) => timer(done, 10));
  assert.deepEqual(asked.sort(), [2, 3]);
  assert.equal(farm.jobs.get(1).state, 'running');
  assert.equal(farm.jobs.get(2).state, 'failed');
  assert.ok(!farm.jobs.has(3));
});
