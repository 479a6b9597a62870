import assert from 'node:assert/strict';
import test from 'node:test';

const { pieces, shownLines } = await import('../../../../coordinator/web/dashboard/yaml_text.js');

test('a line is cut into pieces that join to it', () => {
  const line = '  - "a: b": c  # d';
  const cut = pieces(line);
  assert.equal(cut.map(([, text]) => text).join(''), line);
  assert.deepEqual(
    cut.filter(([kind]) => kind).map(([kind]) => kind),
    ['text', 'remark'],
  );
});

test('a text of ordinary size is shown whole', () => {
  assert.deepEqual(shownLines('a: 1\r\nb: 2\n'), { lines: ['a: 1', 'b: 2'], more: false });
});

test('of a text without measure the beginning is shown', () => {
  const wide = shownLines('x'.repeat(5 << 20));
  assert.equal(wide.lines.length, 1);
  assert.equal(wide.lines[0].length, 1 << 20);
  assert.equal(wide.more, true);
  const tall = shownLines('\n'.repeat(1 << 19));
  assert.equal(tall.lines.length, 20000);
  assert.equal(tall.more, true);
});

test('a line without measure is not searched for quotes again and again', () => {
  const line = '"' + '\\"'.repeat(1 << 19);
  assert.deepEqual(pieces(line), [['', line]]);
});
