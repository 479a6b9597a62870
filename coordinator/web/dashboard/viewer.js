// One frame at full size, on float data, also while it renders.
import { CURVES, heat, luminance, relativeError } from './tone.js';
import { grouped, kindOf, nameOf, NOISE, rangeOf } from './layers.js';
import { h, oncePerFrame, setAttribute, setText } from './dom.js';
import { nothing, chip } from './parts.js';
import { percent, short, value, whole } from './format.js';
import { replaceQuery, to } from './router.js';
import { address, documentOf } from './api.js';
import { color, onTheme } from './theme.js';
import { flatStage } from './flat_stage.js';
import { frameShare } from './frames.js';
import { FrameSource } from './frame_source.js';
import { glStage } from './gl_stage.js';
import { icon } from './icons.js';
import { pixel } from './half.js';
import { Viewport } from './viewport.js';
import { watchJob } from './job_state.js';

const MODES = { off: 0, split: 1, difference: 2 };

const rgbOf = (css) => (css.match(/[\d.]+/g) ?? [0, 0, 0]).slice(0, 3).map((x) => Number(x) / 255);

class FrameView {
  constructor(route, { retitle }) {
    this.id = route.job;
    this.frame = route.frame;
    this.retitle = retitle;
    const { layer, ev, tone, with: other, job, mode, flat } = route.query;
    this.layer = layer || 'beauty';
    this.exposure = Number.isFinite(Number(ev)) ? Number(ev ?? 0) : 0;
    this.curve = CURVES[tone] ? tone : 'srgb';
    this.own = { curve: 'srgb', exposure: 0 };
    if (!tone && ev === undefined) this.asTheJob();
    this.mode = other ? (mode === 'difference' ? 'difference' : 'split') : 'off';
    this.splitAt = 0.5;
    this.pictures = {};
    this.range = { low: 0, high: 1, middle: 0 };
    this.layers = [];
    const watched = watchJob(this.id, () => this.update());
    this.state = watched.state;
    this.leaveJob = watched.leave;
    this.makeControls();
    this.makeStage(flat !== undefined);
    this.node = h('div', { class: 'viewer' }, this.bar, this.stage, this.foot);
    this.sourceA = new FrameSource({ got: (...all) => this.got('A', ...all), failed: (error) => this.fail(error), busy: (is) => this.busy.classList.toggle('on', is) });
    this.sourceB = new FrameSource({ got: (...all) => this.got('B', ...all), failed: (error) => setText(this.compareNote, error.message) });
    this.sourceA.largest = this.sourceB.largest = this.gl.largest;
    if (other) this.compare(Number(job || this.id), Number(other));
    this.makeKeys();
    this.leaveTheme = onTheme(() => { this.ground = null; this.paint(); });
    this.update();
  }

  makeStage(flat) {
    this.canvas = h('canvas', { class: 'stage-canvas', role: 'img', 'aria-label': 'The picture', testid: 'stage' });
    this.handle = h('div', { class: 'split', role: 'slider', tabindex: 0, 'aria-label': 'Where the two pictures meet', 'aria-valuemin': 0, 'aria-valuemax': 100, 'aria-valuenow': 50, hidden: true, testid: 'split', onkeydown: (event) => this.splitKey(event), onpointerdown: (event) => this.splitDown(event) }, h('i', {}));
    this.tags = [h('span', { class: 'stage-tag left', hidden: true }), h('span', { class: 'stage-tag right', hidden: true })];
    this.message = h('div', { class: 'stage-message', hidden: true });
    this.legend = h('div', { class: 'legend', hidden: true, testid: 'legend' });
    this.stage = h('div', { class: 'stage', tabindex: 0, 'aria-label': 'Picture: arrows move it, plus and minus zoom', onpointermove: (event) => this.point(event), onpointerdown: (event) => this.point(event), onpointerleave: () => { this.pointer = null; this.tellPixel(); } },
      this.canvas, this.handle, this.tags, this.legend, this.message);
    this.gl = flat ? flatStage(this.canvas) : null;
    try {
      this.gl ??= glStage(this.canvas);
    } catch (error) {
      console.warn('WebGL is not used:', error.message);
    }
    if (!this.gl) {
      // A canvas that was asked for WebGL gives nothing else.
      const fresh = h('canvas', { class: 'stage-canvas', role: 'img', 'aria-label': 'The picture', testid: 'stage' });
      this.canvas.replaceWith(fresh);
      this.canvas = fresh;
      this.gl = flatStage(fresh);
    }
    this.canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    this.viewport = new Viewport(this.stage, () => this.paint());
    this.paint = oncePerFrame(() => this.draw());
    this.viewport.changed = this.paint;
    this.resized = new ResizeObserver(() => (this.viewport.fitted ? this.viewport.fit() : this.paint()));
    this.resized.observe(this.stage);
  }

  makeControls() {
    this.heading = h('h1', { testid: 'frame-title' });
    this.back = h('a', { class: 'viewer-back', href: to('job', { job: this.id }), testid: 'back' });
    this.chip = chip('unknown');
    this.busy = h('span', { class: 'busy', 'aria-hidden': 'true' });
    this.previous = h('a', { class: 'button square', 'aria-label': 'Frame before', title: 'Frame before (,)', testid: 'frame-before' }, icon('left'));
    this.next = h('a', { class: 'button square', 'aria-label': 'Next frame', title: 'Next frame (.)', testid: 'frame-next' }, icon('right'));
    this.layerField = h('select', { 'aria-label': 'Layer', testid: 'layer', onchange: () => this.setLayer(this.layerField.value) });
    this.slider = h('input', { type: 'range', min: -8, max: 8, step: 0.1, 'aria-label': 'Exposure, stops', testid: 'exposure', oninput: () => this.setExposure(Number(this.slider.value)) });
    this.stops = h('button', { type: 'button', class: 'plain small stops', title: 'Back to the job’s', testid: 'exposure-reset', onclick: () => this.setExposure(this.own.exposure) });
    this.toneField = h('select', { 'aria-label': 'Tone map', testid: 'tone', onchange: () => this.setCurve(this.toneField.value) }, Object.entries(CURVES).map(([name, { text }]) => h('option', { value: name, text })));
    this.zoomText = h('button', { type: 'button', class: 'plain small zoom', title: 'Fit (0) or one to one (1)', testid: 'zoom', onclick: () => (this.viewport.fitted ? this.viewport.zoomTo(1) : this.viewport.fit()) });
    this.compareButton = h('button', { type: 'button', 'aria-expanded': false, testid: 'compare', text: 'Compare', onclick: () => this.toggleCompare() });
    this.otherJob = h('input', { type: 'number', min: 1, step: 1, 'aria-label': 'Job to compare with', testid: 'compare-job', onchange: () => this.compareFields() });
    this.otherFrame = h('input', { type: 'number', step: 1, 'aria-label': 'Frame to compare with', testid: 'compare-frame', onchange: () => this.compareFields() });
    this.modeField = h('div', { class: 'pills', role: 'group', 'aria-label': 'How to compare' }, [['split', 'Side by side'], ['difference', 'Difference']].map(([name, text]) => h('button', { type: 'button', 'data-mode': name, text, testid: `mode-${name}`, onclick: () => this.setMode(name) })));
    this.compareNote = h('span', { class: 'soft' });
    this.compareBox = h('div', { class: 'compare-box', hidden: true }, h('span', { text: 'with frame' }), this.otherFrame, h('span', { text: 'of job' }), this.otherJob, this.modeField, this.compareNote);
    this.lightBox = h('div', { class: 'viewer-group light' }, h('label', { class: 'inline' }, 'Exposure', this.slider), this.stops, this.toneField);
    this.save = h('a', { class: 'button', title: 'The picture as PNG, as the job maps it', download: '', testid: 'save-png', 'aria-label': 'PNG' }, icon('download'), h('span', { class: 'text', text: 'PNG' }));
    this.bar = h('div', { class: 'viewer-bar', role: 'toolbar', 'aria-label': 'How the picture is shown' },
      h('div', { class: 'viewer-group' }, this.previous, this.next, h('span', { class: 'viewer-name' }, this.back, this.heading), this.chip, this.busy),
      h('div', { class: 'viewer-group grow' }, this.layerField, this.lightBox, this.compareButton, this.save,
        h('button', { type: 'button', class: 'square', 'aria-label': 'Fill the screen', title: 'Fill the screen (f)', testid: 'fullscreen', onclick: () => this.fill() }, icon('fit'))),
      this.compareBox);
    this.pixelText = h('output', { class: 'pixel mono', testid: 'pixel' });
    this.swatch = h('i', { class: 'swatch', 'aria-hidden': 'true' });
    this.sampleText = h('span', { class: 'soft', testid: 'frame-samples' });
    this.foot = h('div', { class: 'viewer-foot' }, this.swatch, this.pixelText, h('span', { class: 'spring' }), this.sampleText, this.zoomText);
    this.drawLayers();
    this.toneField.value = this.curve;
    this.setExposure(this.exposure);
  }

  makeKeys() {
    const zoom = (factor) => this.viewport.zoomTo(this.viewport.scale * factor);
    const pan = (x, y) => this.viewport.pan(x * this.stage.clientWidth * 0.1, y * this.stage.clientHeight * 0.1);
    this.keysTitle = 'This picture';
    this.keys = [
      { keys: '+|=', what: 'Closer', run: () => zoom(1.5) }, { keys: '-', what: 'Farther', run: () => zoom(1 / 1.5) },
      { keys: '0', what: 'The whole picture', run: () => this.viewport.fit() }, { keys: '1', what: 'One to one', run: () => this.viewport.zoomTo(1) },
      { keys: 'ArrowLeft', shown: 'Arrows', what: 'Move', run: () => pan(1, 0) }, { keys: 'ArrowRight', run: () => pan(-1, 0) }, { keys: 'ArrowUp', run: () => pan(0, 1) }, { keys: 'ArrowDown', run: () => pan(0, -1) },
      { keys: 'e', what: 'Brighter by half a stop', run: () => this.setExposure(this.exposure + 0.5) }, { keys: 'd', what: 'Darker', run: () => this.setExposure(this.exposure - 0.5) },
      { keys: 'm', what: 'Next tone map', run: () => this.setCurve(after(Object.keys(CURVES), this.curve)) },
      { keys: 'l', what: 'Next layer', run: () => this.setLayer(after(this.menu(), this.layer)) },
      { keys: 'n', what: 'Noise, and back', run: () => this.setLayer(this.layer === NOISE ? 'beauty' : NOISE) },
      { keys: 'c', what: 'Compare', run: () => this.toggleCompare() },
      { keys: ',|PageUp', what: 'Frame before', run: () => this.previous.href && this.previous.click() }, { keys: '.|PageDown', what: 'Next frame', run: () => this.next.href && this.next.click() },
      { keys: 'f', what: 'Fill the screen', run: () => this.fill() },
      { keys: 'Escape', what: 'Back to the job', run: () => { location.hash = to('job', { job: this.id }); } },
    ];
  }

  title() {
    return `Frame ${this.frame} · ${this.state.job?.name ?? `job ${this.id}`}`;
  }

  got(slot, main, beside, layer) {
    this.pictures[slot] = { main, beside, layer };
    this.gl.set(`pic${slot}`, main);
    if (beside) this.gl.set(`beside${slot}`, beside);
    if (slot === 'A') {
      this.message.hidden = true;
      if (main.width !== this.viewport.size[0] || main.height !== this.viewport.size[1]) this.viewport.resize([main.width, main.height]);
      const layers = main.layers.includes(main.layer) ? main.layers : [main.layer, ...main.layers];
      if (layers.join() !== this.layers.join()) {
        this.layers = layers;
        this.drawLayers();
      }
      this.range = rangeOf(layer, main, beside);
      this.drawLegend();
      this.tellSamples();
    } else {
      setText(this.compareNote, '');
    }
    this.tellPixel();
    this.paint();
  }

  take(route) {
    if (route.view !== 'frame' || route.job !== this.id) return false;
    if (route.frame !== this.frame) {
      this.frame = route.frame;
      this.update();
    }
    return true;
  }

  fail(error) {
    const waiting = error.code === 'not_found' && this.layer === 'beauty';
    this.message.hidden = false;
    this.message.replaceChildren(nothing(waiting ? 'Nothing of it yet' : 'It cannot be shown', h('p', { text: error.message }), waiting ? h('p', { class: 'soft', text: 'The picture appears as soon as the first samples are there.' }) : null));
    if (!waiting && this.layer !== 'beauty') this.setLayer('beauty');
  }

  update() {
    const { state } = this;
    if (state.error && !state.job) {
      this.message.hidden = false;
      this.message.replaceChildren(nothing('There is no such job', h('p', { text: state.error.message })));
      return;
    }
    const at = state.numbers.indexOf(this.frame);
    const frame = state.frames.get(this.frame);
    setText(this.heading, `Frame ${this.frame}`);
    setText(this.back, state.job?.name ?? `Job ${this.id}`);
    this.back.title = 'To the job (Escape)';
    this.retitle();
    for (const [link, number] of [[this.previous, state.numbers[at - 1]], [this.next, at >= 0 ? state.numbers[at + 1] : undefined]]) {
      link.hidden = state.numbers.length < 2;
      setAttribute(link, 'href', number === undefined ? null : to('frame', { job: this.id, frame: number, query: this.query() }));
      setAttribute(link, 'aria-disabled', number === undefined ? 'true' : null);
    }
    this.save.href = address(`api/v1/jobs/${this.id}/frames/${this.frame}/picture`, { layer: this.layer === NOISE || this.layer === 'beauty' ? '' : this.layer });
    this.save.download = `${state.job?.name ?? `job-${this.id}`}.${this.frame}.png`;
    if (!frame) {
      if (state.numbers.length > 0) this.fail({ code: 'unknown', message: `The job has no frame ${this.frame}.` });
      return;
    }
    this.chip.set(frame.doubtful ? 'doubtful' : frame.state);
    if (frame.samples_done === 0 && frame.state !== 'done') this.fail({ code: 'not_found', message: frame.reason || (frame.state === 'waiting' ? 'The frame waits for a worker.' : 'It has been begun.') });
    else this.sourceA.want(this.id, frame, this.layer, this.stage.clientWidth > 0 ? Math.max(320, Math.round(this.stage.clientWidth * 0.6)) : 640);
    this.tellSamples();
    this.wantOther();
  }

  tellSamples() {
    const frame = this.state.frames.get(this.frame);
    const main = this.pictures.A?.main;
    if (!frame) return;
    const pixels = main ? main.width * main.height : 0;
    const per = pixels > 0 && !(this.sourceA.preview > 0) ? `${whole(frame.samples_done / pixels)} of ${whole(frame.samples / pixels)} samples per pixel` : `${short(frame.samples_done)} samples`;
    setText(this.sampleText, [main && `${main.width} × ${main.height}`, per, frame.state === 'rendering' && percent(frameShare(frame)), main?.exact === false && 'from a finished file of 8 bits', frame.reason].filter(Boolean).join(' · '));
  }

  menu() {
    return grouped(this.layers).flatMap(([, list]) => list);
  }

  drawLayers() {
    const layers = this.layers.length > 0 ? this.layers : ['beauty'];
    this.layerField.replaceChildren(...grouped(layers).map(([title, list]) => h('optgroup', { label: title }, list.map((name) => h('option', { value: name, text: nameOf(name) })))));
    this.layerField.value = this.layer;
  }

  setLayer(layer) {
    if (!layer || (this.layer === layer && this.pictures.A)) return;
    this.layer = layer;
    this.layerField.value = layer;
    this.remember();
    this.update();
  }

  setExposure(stops) {
    this.exposure = Math.round(Math.min(24, Math.max(-24, stops)) * 10) / 10;
    this.slider.value = this.exposure;
    setText(this.stops, `${this.exposure > 0 ? '+' : ''}${this.exposure.toFixed(1)}`);
    this.stops.setAttribute('aria-label', `Exposure ${this.exposure} stops; back to the job’s`);
    this.remember();
    this.paint?.();
    this.tellPixel?.();
  }

  setCurve(curve) {
    this.curve = curve;
    this.toneField.value = curve;
    this.remember();
    this.paint();
  }

  // The job's first tone map and exposure are where to begin: what its PNGs look like.
  async asTheJob() {
    try {
      this.own = toneOf(await documentOf(this.id));
    } catch {
      return;
    }
    if (this.left) return;
    this.setCurve(this.own.curve);
    this.setExposure(this.own.exposure);
  }

  query() {
    return { layer: this.layer === 'beauty' ? '' : this.layer, ev: this.exposure === this.own.exposure ? '' : this.exposure, tone: this.curve === this.own.curve && this.exposure === this.own.exposure ? '' : this.curve, with: this.mode === 'off' ? '' : this.other?.frame, job: this.mode === 'off' || this.other?.job === this.id ? '' : this.other?.job, mode: this.mode === 'difference' ? 'difference' : '' };
  }

  remember() {
    if (this.node?.isConnected) replaceQuery(this.query());
  }

  toggleCompare() {
    if (this.mode !== 'off') {
      this.setMode('off');
      return;
    }
    if (!this.other) {
      const at = this.state.numbers.indexOf(this.frame);
      const number = this.state.numbers[at - 1] ?? this.state.numbers[at + 1] ?? this.frame;
      this.compare(this.id, number);
    }
    this.setMode('split');
    this.otherFrame.focus();
  }

  setMode(mode) {
    this.mode = mode;
    this.drawMode();
    this.remember();
    this.wantOther();
    this.paint();
  }

  drawMode() {
    this.compareBox.hidden = this.mode === 'off';
    setAttribute(this.compareButton, 'aria-expanded', this.mode !== 'off');
    for (const button of this.modeField.children) setAttribute(button, 'aria-pressed', button.dataset.mode === this.mode);
  }

  compareFields() {
    const job = Number(this.otherJob.value) || this.id;
    const frame = Number(this.otherFrame.value);
    if (Number.isInteger(frame)) this.compare(job, frame);
    this.remember();
  }

  compare(job, frame) {
    this.otherJob.value = job;
    this.otherFrame.value = frame;
    if (this.other?.job !== job) {
      this.leaveOther?.();
      const watched = watchJob(job, () => this.wantOther());
      this.otherState = watched.state;
      this.leaveOther = watched.leave;
    }
    this.other = { job, frame };
    delete this.pictures.B;
    if (this.mode === 'off') this.mode = 'split';
    this.drawMode();
    this.wantOther();
  }

  wantOther() {
    if (this.mode === 'off' || !this.other) return;
    const { state, other } = { state: this.otherState, other: this.other };
    const frame = state.frames.get(other.frame);
    if (state.error && !state.job) setText(this.compareNote, state.error.message);
    else if (frame && frame.samples_done > 0) this.sourceB.want(other.job, frame, this.layer);
    else if (state.numbers.length > 0) setText(this.compareNote, frame ? 'nothing of it yet' : 'there is no such frame');
    this.tags[0].textContent = `Frame ${this.frame}`;
    this.tags[1].textContent = `Frame ${other.frame}${other.job === this.id ? '' : ` of ${state.job?.name ?? `job ${other.job}`}`}`;
  }

  get comparing() {
    return this.mode !== 'off' && this.pictures.B?.layer === this.layer && this.pictures.A?.layer === this.layer;
  }

  splitDown(event) {
    event.preventDefault();
    event.stopPropagation();
    this.handle.setPointerCapture(event.pointerId);
    const move = (next) => {
      const box = this.stage.getBoundingClientRect();
      this.setSplit((next.clientX - box.left) / box.width);
    };
    this.handle.onpointermove = move;
    this.handle.onpointerup = () => { this.handle.onpointermove = null; };
  }

  splitKey(event) {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    this.setSplit(this.splitAt + step);
  }

  setSplit(share) {
    this.splitAt = Math.min(1, Math.max(0, share));
    this.handle.setAttribute('aria-valuenow', Math.round(this.splitAt * 100));
    this.paint();
  }

  fill() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.node.requestFullscreen?.();
  }

  point(event) {
    const box = this.stage.getBoundingClientRect();
    this.pointer = [event.clientX - box.left, event.clientY - box.top];
    this.tellPixel();
  }

  tellPixel() {
    if (!this.pixelText) return;
    const split = this.splitAt * this.stage?.clientWidth;
    const right = this.pointer && this.comparing && this.mode === 'split' && this.pointer[0] >= split;
    const shown = this.pictures[right ? 'B' : 'A'];
    if (!this.pointer || !shown) {
      setText(this.pixelText, '');
      this.swatch.hidden = true;
      return;
    }
    const [x, y] = this.viewport.pixelAt(this.pointer);
    const { main, beside, layer } = shown;
    const scaled = [Math.floor((x * main.width) / this.viewport.size[0]), Math.floor((y * main.height) / this.viewport.size[1])];
    const values = pixel(main, ...scaled);
    if (!values) {
      setText(this.pixelText, '');
      this.swatch.hidden = true;
      return;
    }
    const names = main.channels.map((name) => name.slice(name.lastIndexOf('.') + 1));
    const parts = [`${String(x).padStart(4)}, ${String(y).padEnd(4)}`];
    if (layer === NOISE) {
      const variance = beside && pixel(beside, ...scaled);
      if (variance) parts.push(`error ${(100 * relativeError(values, variance)).toFixed(2)} %`);
    }
    parts.push(...values.map((v, i) => `${names[i]} ${value(v)}`));
    if (values.length >= 3 && kindOf(layer) === 'light') parts.push(`luminance ${value(luminance(...values))}`);
    setText(this.pixelText, parts.join('   '));
    this.swatch.hidden = false;
    this.swatch.style.background = `rgb(${values.length >= 3 ? values.slice(0, 3).map((v) => Math.round(255 * Math.min(1, Math.max(0, v * 2 ** this.exposure)) ** (1 / 2.2))) : [90, 90, 90]})`;
  }

  drawLegend() {
    const kind = kindOf(this.layer);
    this.lightBox.hidden = kind !== 'light';
    this.legend.hidden = !['heat', 'noise', 'grey'].includes(kind) || this.layer === 'alpha';
    if (this.legend.hidden) return;
    const { low, high, middle } = this.range;
    const text = (v) => (kind === 'noise' ? `${value(v * 100)} %` : value(v));
    const scale = h('canvas', { width: 128, height: 1, 'aria-hidden': 'true' });
    const pen = scale.getContext('2d');
    for (let i = 0; i < 128; ++i) {
      const share = i / 127;
      pen.fillStyle = kind === 'grey' ? `hsl(0 0% ${100 - 100 * share}%)` : `rgb(${heat(share).map((c) => Math.round(c * 255))})`;
      pen.fillRect(i, 0, 1, 1);
    }
    const about = kind === 'noise' ? `standard error over luminance; median ${text(middle)}` : kind === 'grey' ? 'nearest to farthest' : `samples per pixel; median ${text(middle)}`;
    this.legend.replaceChildren(scale, h('span', { class: 'legend-line' }, h('span', { text: text(low) }), h('span', { class: 'soft', text: about }), h('span', { text: text(high) })));
  }

  draw() {
    if (!this.stage.isConnected) return;
    const dense = devicePixelRatio;
    const [width, height] = [Math.round(this.stage.clientWidth * dense), Math.round(this.stage.clientHeight * dense)];
    if (width === 0 || height === 0) return;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    setText(this.zoomText, !this.pictures.A ? '' : `${this.viewport.fitted ? 'Fit · ' : ''}${Math.round(this.viewport.scale * 100)} %`);
    const comparing = this.comparing;
    const split = comparing && this.mode === 'split';
    this.handle.hidden = !split;
    this.handle.style.left = `${this.splitAt * 100}%`;
    for (const tag of this.tags) tag.hidden = !split;
    this.canvas.hidden = !this.pictures.A;
    if (!this.pictures.A) return;
    this.ground ??= rgbOf(color('--stage'));
    this.gl.draw({
      logical: this.viewport.size, offset: this.viewport.offset, scale: this.viewport.scale, dense, exposure: this.exposure, curve: this.curve,
      kind: kindOf(this.pictures.A.layer), low: this.range.low, high: this.range.high, split: this.splitAt * this.stage.clientWidth, mode: comparing ? MODES[this.mode] : 0, ground: this.ground,
    });
  }

  shown() {
    this.viewport.fit();
    this.update();
  }

  leave() {
    this.left = true;
    this.paint.cancel();
    this.resized.disconnect();
    this.leaveTheme();
    this.sourceA.leave();
    this.sourceB.leave();
    this.gl.leave();
    this.leaveOther?.();
    this.leaveJob();
  }
}

/** The first tone map and exposure that a job's text says: {curve, exposure}. */
export function toneOf(text) {
  const outputs = text.slice(Math.max(0, text.search(/^outputs:/m)));
  const curve = /\btone_map:\s*["']?(\w+)/.exec(outputs)?.[1];
  const exposure = Number(/\bexposure:\s*(-?[\d.]+)/.exec(outputs)?.[1] ?? 0);
  return { curve: CURVES[curve] ? curve : 'srgb', exposure: Number.isFinite(exposure) ? exposure : 0 };
}

const after = (list, item) => list[(list.indexOf(item) + 1) % list.length];

/** The view. */
export const frameView = (route, page) => new FrameView(route, page);
