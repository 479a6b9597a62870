// Brings files to the coordinator: digests, what is missing, pieces, and on after a break.
import * as api from './api.js';
import { digestOf } from './sha256.js';

const LARGEST_PIECE = 8 * 1024 * 1024;
const SMALLEST_PIECE = 256 * 1024;
const FILES_AT_ONCE = 2;
const LONGEST_WAIT = 15000;

// Digests of this visit: who mends a line and sends again need not wait for gigabytes.
const digests = new WeakMap();

/** Digests of all files. `told(bytes)`: so many are read. Sets `sha256` of each. */
export async function hashAll(files, told, signal) {
  let before = 0;
  let worker = null;
  try {
    worker = new Worker(new URL('./hash_worker.js', import.meta.url), { type: 'module' });
  } catch {
    // Where workers are refused the page's own thread does it.
  }
  try {
    for (const entry of files) {
      if (signal.aborted) throw new DOMException('stopped', 'AbortError');
      let digest = digests.get(entry.file);
      if (!digest) {
        const tell = (bytes) => told(before + bytes);
        digest = worker ? await askWorker(worker, entry.file, tell, signal) : await digestOf(entry.file, tell);
        digests.set(entry.file, digest);
      }
      entry.sha256 = digest;
      before += entry.file.size;
      told(before);
    }
  } finally {
    worker?.terminate();
  }
}

function askWorker(worker, file, told, signal) {
  return new Promise((resolve, reject) => {
    const stop = () => reject(new DOMException('stopped', 'AbortError'));
    signal.addEventListener('abort', stop, { once: true });
    worker.onmessage = ({ data }) => {
      if (data.told !== undefined) told(data.told);
      else if (data.sha256) resolve(data.sha256);
      else reject(new Error(`${file.name} cannot be read: ${data.error}`));
    };
    worker.onerror = () => reject(new Error('the files cannot be read here'));
    worker.postMessage({ id: 0, file });
  });
}

/** Waits so many milliseconds, or until `signal`: then it throws AbortError. */
export const rest = (ms, signal) =>
  new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, ms);
    signal.addEventListener(
      'abort',
      () => {
        clearTimeout(timer);
        reject(new DOMException('stopped', 'AbortError'));
      },
      { once: true },
    );
  });

const passes = (error) =>
  error.code === 'unreachable' ||
  error.code === 'unavailable' ||
  error.code === 'unauthenticated' ||
  error.code === 'deadline_exceeded' ||
  error.retryAfterMs > 0;

async function sendFile(entry, offset, told, signal) {
  let piece = 1024 * 1024;
  const { file, sha256 } = entry;
  do {
    const begun = performance.now();
    const end = Math.min(file.size, offset + piece);
    let answer;
    try {
      answer = await api.putPiece(sha256, file.size, offset, file.slice(offset, end), signal);
    } catch (error) {
      if (error.name === 'NotReadableError' || error.name === 'NotFoundError')
        throw new Error(`${entry.path} has changed or is gone: choose the files again.`);
      throw error;
    }
    offset = answer.offset;
    told(offset);
    if (answer.complete) return;
    // Pieces of about a second: progress is seen, and a break costs little.
    const took = performance.now() - begun;
    piece = Math.max(SMALLEST_PIECE, Math.min(LARGEST_PIECE, took < 500 ? piece * 2 : took > 2000 ? piece / 2 : piece));
  } while (!signal.aborted);
}

/**
 * Uploads what the coordinator lacks of `files` ([{path, file, sha256}]). `told({sent, total, files, path, waiting})`: bytes that are there of
 * those that were missing. Goes on by itself after breaks, until `signal`.
 */
export async function uploadAll(files, told, signal) {
  const bySum = new Map(files.map((entry) => [entry.sha256, entry]));
  const state = { sent: 0, total: 0, files: 0, path: '', waiting: '' };
  const there = new Map();
  const tell = (sum, bytes, path) => {
    there.set(sum, bytes);
    state.sent = [...there.values()].reduce((a, b) => a + b, 0);
    state.path = path;
    state.waiting = '';
    told({ ...state });
  };
  let wait = 1000;
  for (;;) {
    try {
      const { missing } = await api.missing(
        [...bySum].map(([sha256, { file }]) => ({ sha256, size: file.size })),
        signal,
      );
      for (const { sha256, offset } of missing) there.set(sha256, offset);
      for (const sum of there.keys())
        if (!missing.some(({ sha256 }) => sha256 === sum)) there.set(sum, bySum.get(sum).file.size);
      state.total = [...there.keys()].reduce((sum, digest) => sum + bySum.get(digest).file.size, 0);
      state.files = there.size;
      if (missing.length === 0) return;
      const queue = [...missing];
      const lane = async () => {
        for (let next = queue.shift(); next; next = queue.shift()) {
          const entry = bySum.get(next.sha256);
          await sendFile(
            entry,
            next.offset,
            (bytes) => {
              wait = 1000;
              tell(next.sha256, bytes, entry.path);
            },
            signal,
          );
        }
      };
      const lanes = await Promise.allSettled(Array.from({ length: FILES_AT_ONCE }, lane));
      const failed = lanes.find(({ status }) => status === 'rejected');
      if (failed) throw failed.reason;
      return;
    } catch (error) {
      if (error.name === 'AbortError' || signal.aborted) throw error;
      // Another piece came in between, or the coordinator has gone: it says where to go on.
      if (!passes(error) && error.code !== 'out_of_range' && error.code !== 'aborted') throw error;
      state.waiting = error.message;
      told({ ...state });
      await rest(error.retryAfterMs || wait, signal);
      wait = Math.min(LONGEST_WAIT, wait * 1.7);
    }
  }
}
