import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import test from 'node:test';
import { Sha256, digestOf } from '../../../../coordinator/web/dashboard/sha256.js';

const bytes = (count) => Uint8Array.from({ length: count }, (_, i) => (i * 197 + (i >> 3)) & 255);
const expected = (data) => createHash('sha256').update(data).digest('hex');

test('the digests that FIPS 180 tells', () => {
  const ascii = (text) => new TextEncoder().encode(text);
  assert.equal(new Sha256().hex(), 'e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855');
  assert.equal(
    new Sha256().update(ascii('abc')).hex(),
    'ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad',
  );
  assert.equal(
    new Sha256().update(ascii('abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq')).hex(),
    '248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1',
  );
});

test('all lengths around a block, and a large one', () => {
  for (let count = 0; count <= 200; ++count)
    assert.equal(new Sha256().update(bytes(count)).hex(), expected(bytes(count)), String(count));
  assert.equal(new Sha256().update(bytes(3_000_001)).hex(), expected(bytes(3_000_001)));
});

test('pieces of any length give the same', () => {
  const data = bytes(1000);
  for (const piece of [1, 7, 63, 64, 65, 130, 999]) {
    const sum = new Sha256();
    for (let at = 0; at < data.length; at += piece) sum.update(data.subarray(at, at + piece));
    assert.equal(sum.hex(), expected(data), String(piece));
  }
});

test('files are read in slices where the browser has no digest of its own', async () => {
  const data = bytes(9 * 1024 * 1024 + 5);
  const told = [];
  const own = Object.getOwnPropertyDescriptor(globalThis, 'crypto');
  Object.defineProperty(globalThis, 'crypto', { value: {}, configurable: true });
  try {
    assert.equal(await digestOf(new Blob([data]), (count) => told.push(count)), expected(data));
  } finally {
    Object.defineProperty(globalThis, 'crypto', own);
  }
  assert.equal(told.at(-1), data.length);
  assert.ok(told.length > 1);
  assert.equal(await digestOf(new Blob([data])), expected(data));
});
