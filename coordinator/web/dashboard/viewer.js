// One frame at full size, on float data, also while it renders.
import { address, documentOf } from './api.js';
import { color, onTheme } from './theme.js';
import { drawLegend, Readout } from './readout.js';
import { grouped, kindOf, NOISE, rangeOf } from './layers.js';
import { h, oncePerFrame, setText } from './dom.js';
import { replaceQuery, to } from './router.js';
import { Compare } from './compare.js';
import { CURVES } from './tone.js';
import { FrameSource } from './frame_source.js';
import { leavePlace } from './place.js';
import { nothing } from './parts.js';
import { openStage } from './stage.js';
import { ViewerBar } from './viewer_bar.js';
import { Viewport } from './viewport.js';
import { watchJob } from './job_state.js';

const after = (list, item) => list[(list.indexOf(item) + 1) % list.length];
const rgbOf = (css) => (css.match(/[\d.]+/g) ?? [0, 0, 0]).slice(0, 3).map((x) => Number(x) / 255);

/** The first tone map and exposure that a job's text says: {curve, exposure}. */
export function toneOf(text) {
  const outputs = text.slice(Math.max(0, text.search(/^outputs:/m)));
  const curve = /\btone_map:\s*["']?(\w+)/.exec(outputs)?.[1];
  const exposure = Number(/\bexposure:\s*(-?[\d.]+)/.exec(outputs)?.[1] ?? 0);
  return { curve: CURVES[curve] ? curve : 'srgb', exposure: Number.isFinite(exposure) ? exposure : 0 };
}

class FrameView {
  constructor(route, { retitle }) {
    const { layer, ev, tone, with: other, job, mode, flat } = route.query;
    this.id = route.job;
    this.frame = route.frame;
    this.retitle = retitle;
    this.layer = layer || 'beauty';
    this.layers = ['beauty'];
    this.exposure = Number.isFinite(Number(ev)) ? Number(ev ?? 0) : 0;
    this.curve = CURVES[tone] ? tone : 'srgb';
    /** What the job's own pictures are made with. */
    this.own = { curve: 'srgb', exposure: 0 };
    this.pictures = {};
    this.range = { low: 0, high: 1, middle: 0 };
    this.paint = oncePerFrame(() => this.draw());
    const watched = watchJob(this.id, () => this.update());
    this.state = watched.state;
    this.leaveJob = watched.leave;
    this.compare = new Compare({
      job: this.id,
      frame: () => this.frame,
      layer: () => this.layer,
      stage: () => this.stage,
      neighbour: () => this.neighbour(),
      got: (...all) => this.got('B', ...all),
      dropped: () => delete this.pictures.B,
      changed: () => this.remember(),
      moved: () => this.paint(),
    });
    this.bar = new ViewerBar(this.id, this, this.compare);
    this.makeStage(flat !== undefined);
    this.readout = new Readout(this.zoomText);
    this.node = h('div', { class: 'viewer' }, this.bar.node, this.stage, this.readout.node);
    this.source = new FrameSource({
      got: (...all) => this.got('A', ...all),
      failed: (error) => this.fail(error),
      busy: (is) => this.bar.busy.classList.toggle('on', is),
    });
    this.source.largest = this.compare.source.largest = this.painter.largest;
    this.bar.setLayers(this.layers, this.layer);
    this.bar.setLook(this.curve, this.exposure);
    if (!tone && ev === undefined) this.asTheJob();
    const compared = mode === 'difference' ? 'difference' : 'split';
    if (/^-?\d+$/.test(other ?? '')) this.compare.choose(Number(job || this.id), Number(other), compared);
    this.makeKeys();
    this.leaveTheme = onTheme(() => {
      this.ground = null;
      this.paint();
    });
    this.update();
  }

  makeStage(flat) {
    Object.assign(this, openStage(flat));
    this.message = h('div', { class: 'stage-message', hidden: true });
    this.legend = h('div', { class: 'legend', hidden: true, testid: 'legend' });
    const point = (event) => {
      const box = this.stage.getBoundingClientRect();
      this.pointer = [event.clientX - box.left, event.clientY - box.top];
      this.tellPixel();
    };
    const gone = () => {
      this.pointer = null;
      this.tellPixel();
    };
    this.stage = h(
      'div',
      {
        class: 'stage',
        tabindex: 0,
        'aria-label': 'Picture: arrows move it, plus and minus zoom',
        onpointermove: point,
        onpointerdown: point,
        onpointerleave: gone,
      },
      this.canvas,
      this.compare.marks,
      this.legend,
      this.message,
    );
    this.viewport = new Viewport(this.stage, this.paint);
    this.zoomText = h('button', {
      type: 'button',
      class: 'plain small zoom',
      title: 'Fit (0) or one to one (1)',
      testid: 'zoom',
      onclick: () => (this.viewport.fitted ? this.viewport.zoomTo(1) : this.viewport.fit()),
    });
    this.resized = new ResizeObserver(() => (this.viewport.fitted ? this.viewport.fit() : this.paint()));
    this.resized.observe(this.stage);
  }

  makeKeys() {
    const { bar, viewport } = this;
    const zoom = (factor) => viewport.zoomTo(viewport.scale * factor);
    const pan = (x, y) => viewport.pan(x * this.stage.clientWidth * 0.1, y * this.stage.clientHeight * 0.1);
    const follow = (link) => link.href && link.click();
    const menu = () => grouped(this.layers).flatMap(([, list]) => list);
    const back = () => {
      location.hash = to('job', { job: this.id });
    };
    this.keysTitle = 'This picture';
    this.keys = [
      { keys: '+|=', what: 'Closer', run: () => zoom(1.5) },
      { keys: '-', what: 'Farther', run: () => zoom(1 / 1.5) },
      { keys: '0', what: 'The whole picture', run: () => viewport.fit() },
      { keys: '1', what: 'One to one', run: () => viewport.zoomTo(1) },
      { keys: 'ArrowLeft', shown: 'Arrows', what: 'Move', run: () => pan(1, 0) },
      { keys: 'ArrowRight', run: () => pan(-1, 0) },
      { keys: 'ArrowUp', run: () => pan(0, 1) },
      { keys: 'ArrowDown', run: () => pan(0, -1) },
      { keys: 'e', what: 'Brighter by half a stop', run: () => this.setExposure(this.exposure + 0.5) },
      { keys: 'd', what: 'Darker', run: () => this.setExposure(this.exposure - 0.5) },
      { keys: 'm', what: 'Next tone map', run: () => this.setCurve(after(Object.keys(CURVES), this.curve)) },
      { keys: 'l', what: 'Next layer', run: () => this.setLayer(after(menu(), this.layer)) },
      { keys: 'n', what: 'Noise, and back', run: () => this.setLayer(this.layer === NOISE ? 'beauty' : NOISE) },
      { keys: 'c', what: 'Compare', run: () => this.compare.toggle() },
      { keys: ',|k|PageUp', what: 'Frame before', run: () => follow(bar.previous) },
      { keys: '.|j|PageDown', what: 'Next frame', run: () => follow(bar.next) },
      { keys: 'f', what: 'Fill the screen', run: () => this.fill() },
      { keys: 'Escape', what: 'Back to the job', run: back },
    ];
  }

  title() {
    return `Frame ${this.frame} · ${this.state.job?.name ?? `job ${this.id}`}`;
  }

  neighbour() {
    const { numbers } = this.state;
    const at = numbers.indexOf(this.frame);
    return numbers[at - 1] ?? numbers[at + 1] ?? this.frame;
  }

  got(slot, main, beside, layer) {
    this.pictures[slot] = { main, beside, layer };
    this.painter.set(`pic${slot}`, main);
    if (beside) this.painter.set(`beside${slot}`, beside);
    if (slot === 'A') this.gotShown(main, beside, layer);
    this.tellPixel();
    this.paint();
  }

  gotShown(main, beside, layer) {
    this.message.hidden = true;
    const [width, height] = this.viewport.size;
    if (main.width !== width || main.height !== height) this.viewport.resize([main.width, main.height]);
    const layers = main.layers.includes(main.layer) ? main.layers : [main.layer, ...main.layers];
    if (layers.join() !== this.layers.join()) {
      this.layers = layers;
      this.bar.setLayers(layers, this.layer);
    }
    this.range = rangeOf(layer, main, beside);
    drawLegend(this.legend, layer, this.range);
    this.tellFrame();
  }

  take(route) {
    if (route.view !== 'frame' || route.job !== this.id) return false;
    // A link that asks for something else of this frame (another look, a comparison) is a view of its own.
    if (route.frame === this.frame) return false;
    this.frame = route.frame;
    this.update();
    return true;
  }

  tellInstead(title, ...body) {
    this.message.hidden = false;
    this.message.replaceChildren(nothing(title, ...body));
  }

  fail(error) {
    const text = h('p', { text: error.message });
    if (error.code === 'not_found' && this.layer === 'beauty') {
      const hope = h('p', { class: 'soft', text: 'The picture appears as soon as the first samples are there.' });
      this.tellInstead('Nothing of it yet', text, hope);
      return;
    }
    this.tellInstead('It cannot be shown', text);
    if (this.layer !== 'beauty') this.setLayer('beauty');
  }

  update() {
    const { state } = this;
    if (state.error && !state.job) {
      this.tellInstead('There is no such job', h('p', { text: state.error.message }));
      return;
    }
    const name = state.job?.name ?? `job ${this.id}`;
    this.bar.setFrame(this.frame, state.numbers, name, this.query());
    this.bar.save.href = address(`api/v1/jobs/${this.id}/frames/${this.frame}/picture`, {});
    this.bar.save.download = `${name}.${this.frame}.png`;
    this.retitle();
    const frame = state.frames.get(this.frame);
    if (frame) this.want(frame);
    else if (state.numbers.length > 0) this.fail({ message: `The job has no frame ${this.frame}.` });
  }

  want(frame) {
    this.bar.chip.set(frame.doubtful ? 'doubtful' : frame.state);
    if (frame.samples_done === 0 && frame.state !== 'done') {
      const why = frame.state === 'waiting' ? 'The frame waits for a worker.' : 'It has been begun.';
      this.fail({ code: 'not_found', message: frame.reason || why });
    } else {
      const quick = this.stage.clientWidth > 0 ? Math.max(320, Math.round(this.stage.clientWidth * 0.6)) : 640;
      this.source.want(this.id, frame, this.layer, quick);
    }
    this.tellFrame();
    this.compare.want();
  }

  tellFrame() {
    const frame = this.state.frames.get(this.frame);
    if (frame) this.readout.tellFrame(frame, this.pictures.A?.main, !(this.source.preview > 0));
  }

  setLayer(layer) {
    if (!layer || this.layer === layer) return;
    this.layer = layer;
    this.bar.setLayer(layer);
    this.remember();
    this.update();
  }

  setExposure(stops) {
    this.exposure = Math.round(Math.min(24, Math.max(-24, stops)) * 10) / 10;
    this.lookChanged();
  }

  resetExposure() {
    this.setExposure(this.own.exposure);
  }

  setCurve(curve) {
    this.curve = curve;
    this.lookChanged();
  }

  lookChanged() {
    this.bar.setLook(this.curve, this.exposure);
    this.remember();
    this.tellPixel();
  }

  // The job's first tone map and exposure are where to begin: what its PNGs look like.
  async asTheJob() {
    try {
      this.own = toneOf(await documentOf(this.id));
    } catch {
      return;
    }
    if (this.left) return;
    Object.assign(this, this.own);
    this.lookChanged();
  }

  query() {
    const ownLook = this.curve === this.own.curve && this.exposure === this.own.exposure;
    return {
      layer: this.layer === 'beauty' ? '' : this.layer,
      ev: ownLook ? '' : this.exposure,
      tone: ownLook ? '' : this.curve,
      ...this.compare.query(),
    };
  }

  remember() {
    if (this.node?.isConnected) replaceQuery(this.query());
    this.paint();
  }

  fill() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.node.requestFullscreen?.();
  }

  /** Whether the other picture is there, in the layer that is shown. */
  get comparing() {
    const { A, B } = this.pictures;
    return this.compare.on && A?.layer === this.layer && B?.layer === this.layer;
  }

  tellPixel() {
    const split = this.compare.splitAt * this.stage.clientWidth;
    const right = this.pointer && this.comparing && this.compare.mode === 'split' && this.pointer[0] >= split;
    const place = this.pointer && this.viewport.pixelAt(this.pointer);
    this.readout.tell(this.pictures[right ? 'B' : 'A'], place, this.viewport.size, this.exposure);
  }

  draw() {
    if (!this.stage.isConnected) return;
    const dense = devicePixelRatio;
    const [width, height] = [this.stage.clientWidth, this.stage.clientHeight].map((x) => Math.round(x * dense));
    if (width === 0 || height === 0) return;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    const { comparing, viewport } = this;
    const { A } = this.pictures;
    this.compare.drawMarks(comparing);
    this.canvas.hidden = !A;
    setText(this.zoomText, A ? `${viewport.fitted ? 'Fit · ' : ''}${Math.round(viewport.scale * 100)} %` : '');
    if (!A) return;
    this.ground ??= rgbOf(color('--stage'));
    this.painter.draw({
      logical: viewport.size,
      offset: viewport.offset,
      scale: viewport.scale,
      dense,
      exposure: this.exposure,
      curve: this.curve,
      kind: kindOf(A.layer),
      low: this.range.low,
      high: this.range.high,
      split: this.compare.splitAt * this.stage.clientWidth,
      mode: this.compare.modeNumber(comparing),
      ground: this.ground,
    });
  }

  shown() {
    this.viewport.fit();
    this.update();
  }

  leave() {
    this.left = true;
    leavePlace(this.id, this.frame);
    this.paint.cancel();
    this.resized.disconnect();
    this.leaveTheme();
    this.source.leave();
    this.painter.leave();
    this.compare.leave();
    this.leaveJob();
  }
}

/** The view. */
export const frameView = (route, page) => new FrameView(route, page);
