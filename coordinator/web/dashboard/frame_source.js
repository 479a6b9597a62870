// The float pictures of one frame, layer by layer, asked for anew while there is more of it.
import { picture } from './api.js';
import { readHalf } from './half.js';
import { sourcesOf } from './layers.js';
import { madeAt, stampOf } from './thumbs.js';

const PAUSE = 2000;

/** `got(main, beside, layer)` with what came; `failed(error)`; `busy(is)` while something is on its way. */
export class FrameSource {
  constructor({ got, failed, busy = () => {} }) {
    Object.assign(this, { got, failed, tellBusy: busy });
    this.layer = 'beauty';
    this.largest = 16384;
    this.timer = 0;
    this.frame = null;
    this.shown = '';
    this.askedAt = 0;
    this.took = 0;
  }

  /** What is to be shown: job, frame (as in the API; null: not known yet), layer. `preview`: a width for a first quick look. */
  want(job, frame, layer, preview = 0) {
    const other = this.job !== job || this.frame?.id !== frame?.id || this.layer !== layer;
    Object.assign(this, { job, frame, layer, preview: other ? preview : this.preview });
    if (other) {
      this.abort?.abort();
      this.running = false;
      this.shown = '';
      this.askedAt = 0;
    }
    this.pump();
  }

  pump() {
    clearTimeout(this.timer);
    if (this.closed || this.running || !this.frame || document.hidden) {
      if (document.hidden && !this.closed) this.timer = setTimeout(() => this.pump(), PAUSE);
      return;
    }
    if (stampOf(this.frame) === this.shown) return;
    // Large pictures over slow lines: not more than a third of the time is spent on them.
    const wait = this.askedAt + Math.max(PAUSE, this.took * 3) - Date.now();
    if (wait > 0) this.timer = setTimeout(() => this.pump(), wait);
    else this.load();
  }

  async load() {
    const abort = new AbortController();
    const { job, frame, layer, preview } = this;
    const stamp = stampOf(frame);
    const begun = Date.now();
    this.abort = abort;
    this.running = true;
    this.tellBusy(true);
    let got = stamp;
    const ask = async (name, width) => {
      const response = await picture(job, frame.id, { format: 'half', layer: name, width, mask: true }, abort.signal);
      got = madeAt(response, stamp);
      return readHalf(await response.arrayBuffer());
    };
    try {
      const [main, beside] = sourcesOf(layer);
      if (preview > 0) {
        const [first, second] = [await ask(main, preview), beside && (await ask(beside, preview))];
        if (abort.signal.aborted) return;
        // A smaller picture than was asked for is the whole one.
        const whole = first.width < preview;
        this.preview = whole ? 0 : preview;
        this.got(first, second, layer);
        this.preview = 0;
        if (whole) {
          this.shown = got;
          return;
        }
      }
      const most = this.largest < 16384 ? this.largest : undefined;
      const [first, second] = [await ask(main, most), beside && (await ask(beside, most))];
      if (abort.signal.aborted) return;
      this.shown = got;
      this.got(first, second, layer);
    } catch (error) {
      if (abort.signal.aborted) return;
      this.shown = error.code === 'unreachable' ? '' : stamp;
      this.failed(error);
    } finally {
      if (this.abort === abort) {
        this.running = false;
        this.askedAt = Date.now();
        this.took = this.askedAt - begun;
        this.tellBusy(false);
        this.pump();
      }
    }
  }

  leave() {
    this.closed = true;
    clearTimeout(this.timer);
    this.abort?.abort();
  }
}
