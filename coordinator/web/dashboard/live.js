// Server-sent events that come back by themselves.
import { ApiError, address, info } from './api.js';

const LONGEST_WAIT = 15000;
/** A stream that says something all the time is dead after such a silence (a laptop slept, a proxy forgot). */
const SILENCE = 30000;
/** A page that nobody sees lets go of its streams after this time: browsers allow few, and the farm has better to do. */
const UNSEEN_FOR = 60000;

let lostSince = 0;
const watchers = new Set();

/** Since when the coordinator does not answer (milliseconds); 0: it does. */
export const lost = () => lostSince;

/** Calls `listener` when the connection is lost or found; returns what ends that. */
export function onConnection(listener) {
  watchers.add(listener);
  return () => watchers.delete(listener);
}

function setLost(is) {
  if (is === lostSince > 0) return;
  lostSince = is ? Date.now() : 0;
  for (const watcher of watchers) watcher();
}

/**
 * Listens to a stream until the returned function is called, or its event `end` or `gone` came. `handlers`: functions by the name of
 * the event, which get its data; `refused(error)` where the coordinator answers but not with a stream.
 * `lively`: silence means that the line is dead, and then those of the other streams are too.
 */
export function listen(path, handlers, { lively = false } = {}) {
  let source = null;
  let timer = 0;
  let wait = 1000;
  let closed = false;
  let watch = 0;

  const open = () => {
    hear();
    source = new EventSource(address(path));
    for (const [name, handler] of Object.entries(handlers)) {
      if (name === 'refused') continue;
      source.addEventListener(name, (event) => {
        wait = 1000;
        hear();
        setLost(false);
        handler(JSON.parse(event.data));
        if (name === 'end' || name === 'gone') close();
      });
    }
    source.onerror = () => {
      drop();
      if (!closed) diagnose();
    };
  };
  const hear = () => {
    clearTimeout(watch);
    if (lively) watch = setTimeout(() => source && dispatchEvent(new Event('hyades-reopen')), SILENCE);
  };
  const drop = () => {
    clearTimeout(watch);
    if (!source) return;
    source.close();
    source = null;
  };
  // An event source does not tell why it failed: an ordinary call does.
  const diagnose = async () => {
    try {
      await info();
      setLost(false);
      if (wait > 1000) handlers.refused?.(new ApiError('unknown', 'the stream was refused'));
    } catch (error) {
      if (error.code === 'unauthenticated') return;
      setLost(true);
    }
    if (closed) return;
    timer = setTimeout(open, wait * (0.75 + Math.random() / 2));
    wait = Math.min(LONGEST_WAIT, wait * 1.7);
  };
  const seen = () => {
    clearTimeout(timer);
    if (closed) return;
    if (document.hidden) timer = setTimeout(drop, UNSEEN_FOR);
    else if (!source) open();
  };
  const again = () => {
    clearTimeout(timer);
    if (!closed && !source) open();
  };
  const reopen = () => {
    if (!source) return;
    drop();
    open();
  };
  const close = () => {
    closed = true;
    clearTimeout(timer);
    drop();
    document.removeEventListener('visibilitychange', seen);
    removeEventListener('online', again);
    removeEventListener('hyades-signed-in', again);
    removeEventListener('hyades-reopen', reopen);
  };

  document.addEventListener('visibilitychange', seen);
  addEventListener('online', again);
  addEventListener('hyades-signed-in', again);
  addEventListener('hyades-reopen', reopen);
  open();
  return close;
}
