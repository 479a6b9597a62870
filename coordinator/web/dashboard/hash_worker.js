// Digests of files, away from the page's own thread: {id, file} -> {id, told} ..., {id, sha256} or {id, error}.
import { digestOf } from './sha256.js';

onmessage = async ({ data: { id, file } }) => {
  try {
    postMessage({ id, sha256: await digestOf(file, (told) => postMessage({ id, told })) });
  } catch (error) {
    postMessage({ id, error: error.message });
  }
};
