import assert from 'node:assert/strict';
import test from 'node:test';
import { parse, TABS, to } from '../../../../coordinator/web/dashboard/router.js';

test('every view has an address that leads back to it', () => {
  const routes = [
    { view: 'farm' },
    { view: 'jobs' },
    { view: 'workers' },
    { view: 'submit' },
    { view: 'play', job: 12 },
    { view: 'frame', job: 12, frame: 0 },
    { view: 'frame', job: 3, frame: 120 },
    ...TABS.map((tab) => ({ view: 'job', job: 7, tab })),
  ];
  for (const route of routes) {
    assert.deepEqual(parse(to(route.view, route)), { query: {}, ...route });
    const query = { q: 'a b&c', state: 'done', 'odd=': '#/ü' };
    assert.deepEqual(parse(to(route.view, { ...route, query })), { ...route, query });
  }
});

test('what is empty is not in addresses', () => {
  assert.equal(to('jobs', { query: { q: '', owner: undefined, sort: null } }), '#/jobs');
  assert.equal(to('job', { job: 5, tab: 'frames' }), '#/jobs/5');
});

test('other addresses are lost, not errors', () => {
  for (const hash of [
    '#/nowhere',
    '#/jobs/abc',
    '#/jobs/0',
    '#/jobs/1/nonsense',
    '#/jobs/1/frames/x',
    '#/jobs/1/frames/2/3',
    '#/workers/1',
    '#/jobs/1/log/2',
  ])
    assert.equal(parse(hash).view, 'lost', hash);
  for (const hash of ['', '#', '#/', '#?']) assert.equal(parse(hash).view, 'farm', hash);
});
