import assert from 'node:assert/strict';
import test from 'node:test';
import {
  halfTable,
  halfToFloat,
  pixel,
  quantile,
  readHalf,
  sorted,
  UNSAMPLED,
} from '../../../../coordinator/web/dashboard/half.js';

/** An answer as the coordinator gives it. */
function answer(head, planes) {
  const text = new TextEncoder().encode(`${JSON.stringify(head)}\n`);
  const bytes = new Uint8Array(text.length + planes.length * 2);
  bytes.set(text);
  const view = new DataView(bytes.buffer);
  planes.forEach((bits, i) => view.setUint16(text.length + 2 * i, bits, true));
  return bytes.buffer;
}

test('half floats have the values that IEEE 754 says', () => {
  const known = [
    [0x0000, 0],
    [0x3c00, 1],
    [0xbc00, -1],
    [0x4000, 2],
    [0x3555, 0.333251953125],
    [0x7bff, 65504],
    [0x0001, 2 ** -24],
    [0x03ff, 1023 * 2 ** -24],
    [0x0400, 2 ** -14],
    [0x7c00, Infinity],
    [0xfc00, -Infinity],
  ];
  for (const [bits, value] of known) assert.equal(halfToFloat(bits), value, bits.toString(16));
  assert.ok(Object.is(halfToFloat(0x8000), -0));
  assert.ok(Number.isNaN(halfToFloat(0x7e00)));
  assert.ok(Number.isNaN(halfToFloat(0xfc01)));
});

test('half floats grow with their bits, and the table holds them all', () => {
  const table = halfTable();
  assert.equal(table.length, 65536);
  for (let bits = 1; bits < 0x7c00; ++bits) assert.ok(table[bits] > table[bits - 1]);
  assert.equal(table[0x7bff], 65504);
});

test('a picture is read plane by plane, row by row, wherever its header ends', () => {
  for (const layer of ['n', 'nn']) {
    const picture = readHalf(
      answer(
        { width: 2, height: 2, channels: ['R', 'G', 'B'], layer, layers: ['beauty'], samples: 4, exact: true },
        [0x3c00, 0x4000, 0x4200, 0x4400, 0, 0, 0, 0x3800, 0, 0, 0, 0x7c00],
      ),
    );
    assert.equal(picture.layer, layer);
    assert.deepEqual(pixel(picture, 0, 0), [1, 0, 0]);
    assert.deepEqual(pixel(picture, 1, 0), [2, 0, 0]);
    assert.deepEqual(pixel(picture, 1, 1), [4, 0.5, Infinity]);
    assert.equal(pixel(picture, 2, 0), null);
    assert.equal(pixel(picture, 0, -1), null);
  }
});

test('what is not a picture is refused', () => {
  const head = { width: 2, height: 2, channels: ['Y'], layer: 'depth', layers: [] };
  assert.throws(() => readHalf(answer(head, [0, 0, 0])), /6 bytes instead of 8/);
  assert.throws(() => readHalf(answer({ ...head, width: 0 }, [])), /empty/);
  assert.throws(() => readHalf(new Uint8Array([1, 2, 3]).buffer), /no header/);
});

test('sorted values leave out what is no number', () => {
  const picture = readHalf(
    answer({ width: 4, height: 1, channels: ['Z'], layer: 'depth', layers: [] }, [0x7c00, 0x4000, 0x3c00, 0x7e00]),
  );
  const values = sorted(picture);
  assert.deepEqual([...values], [1, 2]);
  assert.equal(quantile(values, 0), 1);
  assert.equal(quantile(values, 1), 2);
  assert.equal(quantile([], 0.5), 0);
});

test('pixels that the mask leaves out have no value in any channel', () => {
  const one = 0x3c00;
  const head = { width: 3, height: 1, channels: ['R', 'G'], layer: 'beauty', mask: true };
  const plain = new Uint8Array(answer(head, [one, one, one, one, one, one]));
  const masked = new Uint8Array(plain.length + 3);
  masked.set(plain);
  masked.set([255, 0, 1], plain.length);
  const picture = readHalf(masked.buffer);
  assert.deepEqual([...picture.planes], [one, UNSAMPLED, one, one, UNSAMPLED, one]);
  assert.deepEqual(pixel(picture, 1, 0), [-Infinity, -Infinity]);
  assert.deepEqual([...sorted(picture)], [1, 1], 'they do not count for the scale');
  assert.throws(() => readHalf(plain.buffer), /instead of/, 'a mask that was promised and did not come');
});
