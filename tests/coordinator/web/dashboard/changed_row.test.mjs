import assert from 'node:assert/strict';
import test from 'node:test';
import { changedRow } from '../../../../coordinator/web/dashboard/changed_row.js';

test('what has changed of a row is put into it, and nothing else', () => {
  const row = { id: 3, state: 'running', samples_done: 10, preview_frame: 7 };
  assert.deepEqual(changedRow(row, { id: 3, samples_done: 20 }), { id: 3, state: 'running', samples_done: 20, preview_frame: 7 });
  assert.equal(row.samples_done, 10, 'views may hold the row as it was');
});

test('a field that is gone is not there', () => {
  assert.ok(!('preview_frame' in changedRow({ id: 3, state: 'running', preview_frame: 7 }, { id: 3, preview_frame: null })));
});

test('a new row comes whole; a part of one that nobody knows is none', () => {
  assert.deepEqual(changedRow(undefined, { id: 4, state: 'paused' }), { id: 4, state: 'paused' });
  assert.equal(changedRow(undefined, { id: 4, samples_done: 5 }), undefined);
});
