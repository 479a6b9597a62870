// Calls to the coordinator (api/openapi.yaml says them all).

/** What the coordinator said instead of an answer; `code` 'unreachable' where nobody answered. */
export class ApiError extends Error {
  constructor(code, message, { status = 0, retryAfterMs = 0, missing = [] } = {}) {
    super(message);
    this.code = code;
    this.status = status;
    this.retryAfterMs = retryAfterMs;
    this.missing = missing;
  }
}

let whenSignedOut = () => {};

/** Calls `listener` with the coordinator's words whenever it wants a token. */
export function onSignedOut(listener) {
  whenSignedOut = listener;
}

/** The address of `path` below the coordinator's root, wherever a proxy has put that. */
export function address(path, query = {}) {
  const url = new URL(path, document.baseURI);
  url.hash = '';
  url.search = '';
  for (const [name, value] of Object.entries(query)) {
    if (value !== undefined && value !== null && value !== '') url.searchParams.set(name, value);
  }
  return url.href;
}

async function refusal(response) {
  let error = {};
  try {
    error = (await response.json()).error ?? {};
  } catch {
    // A proxy's page, say: the status is all that is known.
  }
  const told = error.message || `the coordinator answered ${response.status} ${response.statusText}`.trim();
  return new ApiError(error.code ?? (response.status === 401 ? 'unauthenticated' : 'unknown'), told, {
    status: response.status,
    retryAfterMs: error.retry_after_ms ?? 0,
    missing: error.missing ?? [],
  });
}

/**
 * One call; the Response. `body`: an object is sent as JSON, a Blob or array as it is. Throws ApiError, or AbortError by
 * `signal`.
 */
export async function call(method, path, { query, body, signal, cache } = {}) {
  const plain = body instanceof Blob || body instanceof Uint8Array || body === undefined;
  let response;
  try {
    response = await fetch(address(path, query), {
      method,
      signal,
      cache: cache ?? 'default',
      credentials: 'same-origin',
      headers: plain
        ? body
          ? { 'content-type': 'application/octet-stream' }
          : {}
        : { 'content-type': 'application/json' },
      body: plain ? body : JSON.stringify(body),
    });
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new ApiError('unreachable', 'the coordinator does not answer');
  }
  if (response.ok) return response;
  const error = await refusal(response);
  if (error.code === 'unauthenticated' && path !== 'api/v1/session') whenSignedOut(error.message);
  throw error;
}

const json = async (method, path, options) => (await call(method, path, options)).json();

export const info = () => json('GET', 'api/v1/info');
export const signIn = (token) => call('POST', 'api/v1/session', { body: { token } });
/** Who is signed in. */
export const session = () => json('GET', 'api/v1/session');
export const signOut = () => call('DELETE', 'api/v1/session');
export const jobs = (query) => json('GET', 'api/v1/jobs', { query });
export const submit = (submission) => json('POST', 'api/v1/jobs', { body: submission });
export const job = (id, query, signal) => json('GET', `api/v1/jobs/${id}`, { query, signal });
export const forget = (id) => call('DELETE', `api/v1/jobs/${id}`);
export const steer = (id, action) => json('POST', `api/v1/jobs/${id}/${action}`);
export const setPriority = (id, priority) => json('PUT', `api/v1/jobs/${id}/priority`, { body: { priority } });
export const explain = (id, signal) => json('GET', `api/v1/jobs/${id}/explain`, { signal });
export const documentOf = async (id, signal) => (await call('GET', `api/v1/jobs/${id}/document`, { signal })).text();
export const logs = (id, after, signal) => json('GET', `api/v1/jobs/${id}/logs`, { query: { after }, signal });
/** All finished files, page by page. */
export async function outputs(id, signal) {
  const all = [];
  for (let page = { after: 0, more: true }; page.more; ) {
    page = await json('GET', `api/v1/jobs/${id}/outputs`, { query: { after: page.after }, signal });
    all.push(...page.outputs);
  }
  return { outputs: all };
}
/** Videos that somebody has asked for, and how far they are. */
export const videos = (id, signal) => json('GET', `api/v1/jobs/${id}/videos`, { signal });
export const askForVideo = (id, wish) => json('POST', `api/v1/jobs/${id}/videos`, { body: wish });
export const timeline = (id, after, signal) => json('GET', `api/v1/jobs/${id}/timeline`, { query: { after }, signal });
export const missing = (files, signal) => json('POST', 'api/v1/assets/missing', { body: { files }, signal });
export const putPiece = (sha256, size, offset, piece, signal) =>
  json('PUT', `api/v1/assets/${sha256}`, { query: { size, offset }, body: piece, signal });
export const steerWorker = (id, action, reason) =>
  json('POST', `api/v1/workers/${id}/${action}`, { body: reason ? { reason } : {} });

/** A frame's picture as it is now. `query`: format, width, layer. The browser's cache asks again by ETag. */
export const picture = (id, frame, query, signal) =>
  call('GET', `api/v1/jobs/${id}/frames/${frame}/picture`, { query, signal, cache: 'no-cache' });

/** Where a finished file is. */
export const outputAddress = (id, path, download) =>
  address(`api/v1/jobs/${id}/outputs/${path.split('/').map(encodeURIComponent).join('/')}`, {
    download: download ? 'true' : '',
  });

/** Where all finished files are in one. */
export const archiveAddress = (id) => address(`api/v1/jobs/${id}/archive.zip`);
