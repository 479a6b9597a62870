// Small pictures of frames: few at a time, each asked for again when there is more of it, at most every two seconds.
import { picture } from './api.js';

const AT_ONCE = 3;
const PAUSE = 2000;
/** What only flies past while one scrolls is not asked for. */
const SETTLE = 120;
const KEPT = 400;

// What was loaded lately, by job, frame and width: {url, stamp}. The oldest first.
const kept = new Map();

function keep(key, entry) {
  const old = kept.get(key);
  if (old) {
    kept.delete(key);
    if (old.url) setTimeout(() => URL.revokeObjectURL(old.url), 1000);
  }
  kept.set(key, entry);
  for (const [oldest, { url }] of kept) {
    if (kept.size <= KEPT) break;
    kept.delete(oldest);
    if (url) setTimeout(() => URL.revokeObjectURL(url), 1000);
  }
}

/** The stamp of the frame when a picture was made, which may be a little before it was asked for. */
export const madeAt = (response, asked) => response.headers.get('hyades-stamp') ?? asked;

/** What a picture of a frame depends on: while it stays, so does the picture. */
export const stampOf = (frame) => `${frame.samples_done}:${frame.state === 'done'}:${frame.restarts}`;

/** Loads the pictures of what is shown. */
export class Thumbs {
  constructor() {
    this.shown = new Map();
    this.busy = new Set();
    this.timer = 0;
    this.closed = false;
    this.onSeen = () => this.pump();
    document.addEventListener('visibilitychange', this.onSeen);
  }

  /** A picture that is to be there: `show(url, image)` is called with what there is, url null for nothing yet. */
  want(id, { job, frame, width, show }) {
    const key = `${job}/${frame.id}/${width}`;
    const stamp = stampOf(frame);
    const entry = this.shown.get(id);
    if (entry && entry.key === key) {
      entry.stamp = stamp;
      entry.frame = frame;
    } else {
      const had = kept.get(key);
      this.shown.set(id, {
        key,
        job,
        frame,
        width,
        show,
        stamp,
        has: had?.stamp ?? null,
        asked: Date.now() - PAUSE + SETTLE,
      });
      if (had) {
        kept.delete(key);
        kept.set(key, had);
        show(had.url, had);
      } else {
        show(null);
      }
    }
    if (!this.soon) {
      this.soon = true;
      queueMicrotask(() => {
        this.soon = false;
        this.pump();
      });
    }
  }

  /** It has left the screen. */
  drop(id) {
    const entry = this.shown.get(id);
    if (!entry) return;
    entry.abort?.abort();
    this.shown.delete(id);
  }

  leave() {
    this.closed = true;
    clearTimeout(this.timer);
    document.removeEventListener('visibilitychange', this.onSeen);
    for (const id of [...this.shown.keys()]) this.drop(id);
  }

  pump() {
    clearTimeout(this.timer);
    if (this.closed || document.hidden) return;
    const now = Date.now();
    let next = Infinity;
    const ready = [];
    for (const [id, entry] of this.shown) {
      if (this.busy.has(entry) || entry.has === entry.stamp) continue;
      // Nothing of it has been rendered: there is no picture to ask for.
      if (entry.frame.samples_done === 0 && entry.frame.state !== 'done') continue;
      const at = entry.asked + PAUSE;
      if (at <= now) ready.push([entry.has === null ? 0 : entry.asked, entry, id]);
      else next = Math.min(next, at);
    }
    ready.sort(([a], [b]) => a - b);
    for (const [, entry] of ready.slice(0, Math.max(0, AT_ONCE - this.busy.size))) this.load(entry);
    if (ready.length === 0 && next < Infinity) this.timer = setTimeout(() => this.pump(), next - now + 10);
  }

  async load(entry) {
    this.busy.add(entry);
    entry.asked = Date.now();
    entry.abort = new AbortController();
    const { stamp } = entry;
    try {
      const response = await picture(entry.job, entry.frame.id, { width: entry.width }, entry.abort.signal);
      const got = madeAt(response, stamp);
      const url = URL.createObjectURL(await response.blob());
      const image = new Image();
      image.src = url;
      await image.decode();
      const made = { url, stamp: got, width: image.naturalWidth, height: image.naturalHeight };
      keep(entry.key, made);
      entry.has = got;
      if (this.shown.has(this.idOf(entry))) entry.show(url, made);
    } catch (error) {
      // Nothing there yet, or not any more; another stamp asks again.
      if (error.code === 'not_found' || error.code === 'failed_precondition') entry.has = stamp;
    } finally {
      this.busy.delete(entry);
      entry.asked = Date.now();
      this.pump();
    }
  }

  idOf(entry) {
    for (const [id, other] of this.shown) if (other === entry) return id;
    return undefined;
  }
}
