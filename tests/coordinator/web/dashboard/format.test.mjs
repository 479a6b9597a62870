import assert from 'node:assert/strict';
import test from 'node:test';
import {
  ago,
  brief,
  bytes,
  coreHours,
  counted,
  duration,
  listed,
  moment,
  money,
  noise,
  percent,
  rate,
  rateInWords,
  short,
  value,
} from '../../../../coordinator/web/dashboard/format.js';
import { roundUp } from '../../../../coordinator/web/dashboard/chart.js';

const all = (f, pairs) => pairs.forEach(([input, text]) => assert.equal(f(input), text, `${input}`));

test('numbers have three digits and a unit', () => {
  all(short, [
    [0, '0'],
    [999, '999'],
    [1000, '1.00 k'],
    [12345678, '12.3 M'],
    [999500, '1.00 M'],
    [1e15, '1.00 P'],
    [-4200, '-4.20 k'],
    [NaN, '–'],
    [0.5, '0.50'],
  ]);
  all(rate, [
    [0, '–'],
    [25e6, '25.0 Msamples/s'],
    [640, '640 samples/s'],
    [-1, '–'],
  ]);
  all(rateInWords, [
    [25e6, '25.0 Msamples/s'],
    [12, '12 samples/s'],
    [0, '0 samples/s'],
  ]);
  all(bytes, [
    [0, '0 B'],
    [1023, '1023 B'],
    [1024, '1.00 KiB'],
    [12345678, '11.8 MiB'],
    [2 ** 50, '1.00 PiB'],
    [-1, '–'],
  ]);
});

test('a job is at 100 % only when it is done', () => {
  all(percent, [
    [0, '0 %'],
    [0.0001, '< 1 %'],
    [0.424, '42 %'],
    [0.9999, '99 %'],
    [1, '100 %'],
    [NaN, '0 %'],
  ]);
});

test('times say what matters', () => {
  all(duration, [
    [0, '0 s'],
    [59.4, '59 s'],
    [60, '1 min 00 s'],
    [200, '3 min 20 s'],
    [7500, '2 h 05 min'],
    [86400 * 3 + 4 * 3600, '3 d 4 h'],
    [-1, '–'],
    [Infinity, '–'],
  ]);
  const now = new Date(2026, 10, 22, 14, 3, 9).getTime();
  assert.equal(moment(now - 60000, now), '14:02');
  assert.equal(moment(new Date(2026, 10, 3, 9, 5).getTime(), now), '3 Nov 09:05');
  assert.equal(moment(new Date(2025, 0, 3, 9, 5).getTime(), now), '3 Jan 2025');
  assert.equal(moment(0, now), '–');
  assert.equal(ago(now - 500, now), 'now');
  assert.equal(ago(now - 45000, now), '45 s ago');
  assert.equal(ago(now + 9000, now), 'now');
});

test('pixel values', () => {
  all(value, [
    [0, '0'],
    [1, '1'],
    [0.5, '0.5'],
    [0.33333, '0.3333'],
    [12345, '1.23e+4'],
    [1e-6, '1.00e-6'],
    [NaN, 'NaN'],
    [Infinity, '∞'],
    [100, '100'],
    [1234, '1234'],
  ]);
});

test('noise is never in powers of ten', () => {
  all(noise, [
    [0.0158, '0.016'],
    [0.5, '0.5'],
    [0.999, '1.0'],
    [160.4, '160'],
    [2.1e-5, '0.000021'],
    [1e-9, '< 0.000001'],
    [0, '0'],
    [NaN, '–'],
  ]);
});

test('words', () => {
  assert.equal(brief('cd95d7e72e22abfda802f5525a970004ad8d22c3871dabc62f98340c994bc992'), 'cd95d7e7');
  assert.equal(brief('x86-64-v3'), 'x86-64-v3');
  assert.equal(counted(1, 'frame'), '1 frame');
  assert.equal(counted(10000, 'frame'), '10,000 frames');
  assert.equal(listed(['a', 'b', 'c']), 'a, b and c');
  assert.equal(listed(['a']), 'a');
});

test('scales end at round numbers', () => {
  all(roundUp, [
    [0, 1],
    [1, 1],
    [1.01, 1.5],
    [25.6e6, 3e7],
    [7, 8],
    [9.5, 10],
    [99, 100],
  ]);
});

test('core-hours and money are short', () => {
  assert.equal(coreHours(0), '–');
  assert.equal(coreHours(undefined), '–');
  assert.equal(coreHours(20), '< 0.01');
  assert.equal(coreHours(3600), '1.00');
  assert.equal(coreHours(45000), '12.5');
  assert.equal(coreHours(36e6), '10,000');
  assert.equal(money(12.3, 'EUR'), '12.30 EUR');
  assert.equal(money(0.001, 'EUR'), '< 0.01 EUR');
  assert.equal(money(1234.5, ''), '1,234.50');
});
