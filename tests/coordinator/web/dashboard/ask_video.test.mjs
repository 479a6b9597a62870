import assert from 'node:assert/strict';
import test from 'node:test';

Object.assign(globalThis, {
  document: { addEventListener: () => {}, visibilityState: 'visible' },
  addEventListener: () => {},
  localStorage: { getItem: () => null, setItem: () => {}, removeItem: () => {} },
});
const { videoRequest, howFar } = await import('../../../../coordinator/web/dashboard/ask_video.js');

test('fields that are empty are left to the coordinator', () => {
  assert.deepEqual(videoRequest(' ', ''), {});
  assert.deepEqual(videoRequest(' cut.mp4 ', ' 12 '), { file: 'cut.mp4', rate: 12 });
});

test('a speed that is none is told before anything is asked', () => {
  for (const rate of ['fast', '-1', '0']) assert.throws(() => videoRequest('', rate), /above 0/);
});

test('how far a video is, in words', () => {
  const video = { file: 'cut.mp4', frames: 1, reason: '' };
  assert.equal(howFar({ ...video, state: 'making' }), 'cut.mp4: is being made of 1 frame');
  assert.equal(howFar({ ...video, state: 'failed', reason: 'no room' }), 'cut.mp4: could not be made: no room');
});
