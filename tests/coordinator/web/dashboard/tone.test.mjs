import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import {
  CURVES,
  heat,
  relativeError,
  srgbEncode,
  toneMap,
  TONE_GLSL,
} from '../../../../coordinator/web/dashboard/tone.js';

const near = (actual, wanted, by = 1e-3) =>
  actual.forEach((x, i) => assert.ok(Math.abs(x - wanted[i]) <= by, `${actual} instead of ${wanted}`));

test('sRGB meets its standard', () => {
  near([srgbEncode(0), srgbEncode(0.0031308), srgbEncode(0.18), srgbEncode(1)], [0, 0.04045, 0.46135, 1], 1e-4);
  near(toneMap([0.5, 2, -1], 'srgb'), [0.7354, 1, 0]);
});

test('every curve keeps to what a display has, and black black', () => {
  for (const curve of Object.keys(CURVES)) {
    near(toneMap([0, 0, 0], curve), [0, 0, 0], curve === 'agx' ? 0.01 : 1e-3);
    for (const light of [
      [1e9, 1e9, 1e9],
      [Infinity, 0, 1],
      [NaN, 1, -3],
      [1e-8, 0.2, 40],
    ]) {
      for (const x of toneMap(light, curve)) assert.ok(x >= 0 && x <= 1, `${curve} of ${light}: ${x}`);
    }
    const greys = [0.001, 0.01, 0.1, 0.3, 1, 3].map((x) => toneMap([x, x, x], curve)[1]);
    for (let i = 1; i < greys.length; ++i) assert.ok(greys[i] >= greys[i - 1], curve);
  }
});

test('a stop doubles', () => {
  for (const curve of Object.keys(CURVES))
    near(toneMap([0.1, 0.2, 0.05], curve, 1), toneMap([0.2, 0.4, 0.1], curve), 1e-9);
});

test('known values of the film-like curves', () => {
  // Narkowicz's formula at 1: 2.54 / 3.16; Hable's white (11.2) is 1 by its scale.
  near([toneMap([1, 1, 1], 'aces')[0]], [srgbEncode(2.54 / 3.16)], 1e-6);
  near(toneMap([5.6, 5.6, 5.6], 'filmic'), [1, 1, 1], 1e-6);
  // AgX puts middle grey near the middle of the display.
  const grey = toneMap([0.18, 0.18, 0.18], 'agx');
  assert.ok(grey[0] > 0.42 && grey[0] < 0.52, String(grey));
});

test('the curves are those of the renderer', () => {
  const source = readFileSync(new URL('../../../../core/image/tone_map.cpp', import.meta.url), 'utf8');
  const own = readFileSync(new URL('../../../../coordinator/web/dashboard/tone.js', import.meta.url), 'utf8');
  const numbers = (text) => text.match(/\d+\.\d{2,}/g).map(Number);
  const here = new Set(numbers(own));
  const agx = source.slice(source.indexOf('agx_contrast(float'), source.indexOf('/// NaN becomes'));
  for (const number of [...numbers(agx), 2.51, 2.43, 0.59, 0.14])
    assert.ok(here.has(number), `${number} is not in tone.js`);
  for (const name of Object.keys(CURVES)) assert.ok(source.includes(`"${name}"`), name);
});

test('the shader has the same numbers', () => {
  for (const number of ['15.5', '2.51', '0.00232', '1.055', '0.842479062253094'])
    assert.ok(TONE_GLSL.includes(number), number);
  for (const { index } of Object.values(CURVES)) assert.ok(index >= 0 && index <= 4);
});

test('noise is the error of the mean over the luminance', () => {
  // Grey 1 with a variance of 0.04 in all channels: 0.2 / (1 + floor).
  assert.ok(Math.abs(relativeError([1, 1, 1], [0.04, 0.04, 0.04]) - 0.2 / 1.01) < 1e-9);
  assert.ok(Number.isFinite(relativeError([0, 0, 0], [0.04, 0.04, 0.04])));
  assert.equal(relativeError([1, 1, 1], [-1, 0, 0]), 0);
});

test('heat grows lighter evenly', () => {
  const light = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
  let before = -1;
  for (let i = 0; i <= 70; ++i) {
    const now = light(heat(i / 70));
    assert.ok(now > before);
    before = now;
  }
  assert.deepEqual(heat(-1), heat(0));
  assert.deepEqual(heat(2), heat(1));
});
