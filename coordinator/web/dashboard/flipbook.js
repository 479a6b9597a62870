// The job's frames as a video, while they render: pictures are loaded ahead, and looked at again when there is more of them.
import { h, oncePerFrame, setAttribute, setText } from './dom.js';
import { icon } from './icons.js';
import { nothing } from './parts.js';
import { leavePlace } from './place.js';
import { picture } from './api.js';
import { recall, remember } from './memory.js';
import { replaceQuery, to } from './router.js';
import { madeAt, stampOf } from './thumbs.js';
import { watchJob } from './job_state.js';
import { whole } from './format.js';

const AT_ONCE = 3;
const AGAIN_AFTER = 3000;
/** Pictures ready to be shown take memory: this much of it. */
const MOST_BYTES = 300e6;
const SPEEDS = [1, 2, 4, 6, 8, 12, 15, 24, 25, 30, 48, 60];
/** Of a job that says nothing. */
const USUAL_FPS = 24;

/** The frames per second to choose from, with those of the job and those that are shown. */
export const speedsWith = (...more) => [...new Set([...SPEEDS, ...more.filter((fps) => fps > 0)])].sort((a, b) => a - b);

class Flipbook {
  constructor(route, { retitle }) {
    this.id = route.job;
    this.retitle = retitle;
    /** What the person has chosen; else it is the job's. */
    this.chosen = Number(route.query.fps) > 0 ? Number(route.query.fps) : null;
    this.fps = this.chosen ?? USUAL_FPS;
    this.at = 0;
    this.wanted = Number(route.query.frame);
    this.playing = false;
    this.numbers = [];
    this.bitmaps = new Map();
    this.busy = new Set();
    this.room = MOST_BYTES;
    const watched = watchJob(this.id, () => this.update());
    this.state = watched.state;
    this.leaveJob = watched.leave;
    this.make();
    this.update();
  }

  make() {
    this.canvas = h('canvas', { class: 'stage-canvas', role: 'img', 'aria-label': 'The video', testid: 'video-stage' });
    this.message = h(
      'div',
      { class: 'stage-message' },
      nothing(
        'Nothing to play yet',
        h('p', { class: 'soft', text: 'Frames appear here as soon as their first samples are there.' }),
      ),
    );
    this.stage = h('div', { class: 'stage plain-stage', onclick: () => this.toggle() }, this.canvas, this.message);
    this.playButton = h(
      'button',
      {
        type: 'button',
        class: 'square primary',
        'aria-label': 'Play',
        title: 'Play (space)',
        testid: 'play',
        onclick: () => this.toggle(),
      },
      icon('play'),
    );
    const step = (by, name, text) =>
      h(
        'button',
        {
          type: 'button',
          class: 'square',
          'aria-label': text,
          title: text,
          testid: `step-${name}`,
          onclick: () => this.step(by),
        },
        icon(name),
      );
    this.scrub = h('input', {
      type: 'range',
      class: 'scrub',
      min: 0,
      max: 0,
      step: 1,
      value: 0,
      'aria-label': 'Frame',
      testid: 'scrub',
      oninput: () => {
        this.pause();
        this.go(Number(this.scrub.value));
      },
    });
    this.loaded = h('canvas', { class: 'loaded', 'aria-hidden': 'true' });
    this.label = h('output', { class: 'mono', testid: 'video-frame' });
    this.speed = h(
      'select',
      { 'aria-label': 'Frames per second', testid: 'fps', onchange: () => this.setFps(Number(this.speed.value)) },
    );
    this.drawSpeeds();
    this.loop = h('input', { type: 'checkbox', checked: true, testid: 'loop' });
    this.size = h(
      'select',
      { 'aria-label': 'Size of pictures', testid: 'video-size', onchange: () => this.resize() },
      [
        [480, 'Small'],
        [960, 'Medium'],
        [1920, 'Large'],
      ].map(([value, text]) => h('option', { value, text })),
    );
    this.size.value = recall('film-size', innerWidth > 900 ? '960' : '480');
    if (!this.size.value) this.size.value = '960';
    this.heading = h('h1', { text: 'Flip-book' });
    this.back = h('a', { class: 'viewer-back', href: to('job', { job: this.id }), testid: 'back' });
    this.open = h('a', { class: 'button', text: 'Look at this frame', testid: 'open-frame' });
    this.note = h('span', { class: 'soft', testid: 'video-note' });
    this.node = h(
      'div',
      { class: 'viewer' },
      h(
        'div',
        { class: 'viewer-bar' },
        h('div', { class: 'viewer-group' }, h('span', { class: 'viewer-name' }, this.back, this.heading)),
        h('div', { class: 'viewer-group grow' }, this.note, this.size, this.open),
      ),
      this.stage,
      h(
        'div',
        { class: 'video-bar' },
        step(-1, 'left', 'Frame before'),
        this.playButton,
        step(1, 'right', 'Next frame'),
        h('div', { class: 'scrub-box' }, this.loaded, this.scrub),
        this.label,
        this.speed,
        h('label', { class: 'check' }, this.loop, 'Loop'),
      ),
    );
    this.paint = oncePerFrame(() => this.draw());
    this.resized = new ResizeObserver(this.paint);
    this.resized.observe(this.stage);
    this.keysTitle = 'Flip-book';
    this.keys = [
      { keys: 'Space', what: 'Play or stop', run: () => this.toggle() },
      { keys: 'ArrowRight|.', shown: '→', what: 'Next frame', run: () => this.step(1) },
      { keys: 'ArrowLeft|,', shown: '←', what: 'Frame before', run: () => this.step(-1) },
      { keys: 'Home', what: 'First frame', run: () => this.go(0) },
      { keys: 'End', what: 'Last frame', run: () => this.go(this.numbers.length - 1) },
      {
        keys: '+|=',
        what: 'Faster',
        run: () => this.setFps(this.speeds[Math.min(this.speeds.length - 1, this.speeds.indexOf(this.fps) + 1)]),
      },
      {
        keys: '-',
        what: 'Slower',
        run: () => this.setFps(this.speeds[Math.max(0, this.speeds.indexOf(this.fps) - 1)]),
      },
      { keys: 'Enter', what: 'Look at this frame', run: () => this.open.click() },
      {
        keys: 'Escape',
        what: 'Back to the job',
        run: () => {
          location.hash = to('job', { job: this.id });
        },
      },
    ];
  }

  title() {
    return `Flip-book · ${this.state.job?.name ?? `job ${this.id}`}`;
  }

  update() {
    const { state } = this;
    if (state.error && !state.job) {
      this.message.replaceChildren(nothing('There is no such job', h('p', { text: state.error.message })));
      return;
    }
    setText(this.back, state.job?.name ?? `Job ${this.id}`);
    this.retitle();
    this.drawSpeeds();
    const now = this.numbers[this.at];
    this.numbers = state.numbers.filter(
      (number) => state.frames.get(number).samples_done > 0 || state.frames.get(number).state === 'done',
    );
    if (Number.isInteger(this.wanted) && this.numbers.includes(this.wanted)) {
      this.at = this.numbers.indexOf(this.wanted);
      this.wanted = null;
    } else if (now !== undefined) {
      this.at = Math.max(0, this.numbers.indexOf(now));
    }
    this.message.hidden = this.numbers.length > 0;
    setAttribute(this.scrub, 'max', Math.max(0, this.numbers.length - 1));
    setText(
      this.note,
      state.job ? `${whole(this.numbers.length)} of ${whole(state.job.frames)} frames have a picture` : '',
    );
    this.load();
    this.paint();
  }

  resize() {
    remember('film-size', this.size.value);
    for (const entry of this.bitmaps.values()) entry.bitmap.close();
    this.bitmaps.clear();
    this.load();
  }

  setFps(fps) {
    this.chosen = fps;
    this.drawSpeeds();
    replaceQuery({ fps: fps === this.usual ? '' : fps });
  }

  // The job's own speed is known when the job is.
  drawSpeeds() {
    this.usual = Math.round((this.state.job?.frame_rate || USUAL_FPS) * 1000) / 1000;
    this.fps = this.chosen ?? this.usual;
    const speeds = speedsWith(this.usual, this.fps);
    if (this.speeds?.join() !== speeds.join()) {
      this.speeds = speeds;
      this.speed.replaceChildren(...speeds.map((fps) => h('option', { value: fps, text: `${fps} fps` })));
    }
    this.speed.value = this.fps;
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.numbers.length < 2) return;
    if (this.at >= this.numbers.length - 1) this.at = 0;
    this.playing = true;
    this.due = performance.now();
    this.drawButton();
    this.tick();
  }

  pause() {
    this.playing = false;
    cancelAnimationFrame(this.ticking);
    this.drawButton();
  }

  drawButton() {
    this.playButton.replaceChildren(icon(this.playing ? 'pause' : 'play'));
    this.playButton.setAttribute('aria-label', this.playing ? 'Stop' : 'Play');
  }

  tick() {
    this.ticking = requestAnimationFrame((now) => {
      if (!this.playing) return;
      const span = 1000 / this.fps;
      if (now >= this.due + span) {
        // After a hitch it goes on from there: no frames are run through in a burst.
        this.due = now - this.due > 4 * span ? now : this.due + span;
        const next = this.at + 1;
        if (next < this.numbers.length) this.go(next);
        else if (this.loop.checked) this.go(0);
        else this.pause();
      }
      this.tick();
    });
  }

  step(by) {
    this.pause();
    const count = this.numbers.length;
    if (count > 0) this.go((this.at + by + count) % count);
  }

  go(index) {
    this.at = Math.min(Math.max(0, this.numbers.length - 1), Math.max(0, index));
    this.load();
    this.paint();
  }

  // What will be shown next comes first; then what has got better since.
  load() {
    clearTimeout(this.timer);
    if (this.left || document.hidden || this.numbers.length === 0) return;
    const width = Number(this.size.value);
    const each = width * width * 0.6 * 4;
    const ahead = Math.min(this.numbers.length, Math.max(8, Math.floor(this.room / each)));
    const now = Date.now();
    const wanted = new Set();
    for (let i = 0; i < ahead; ++i) {
      const number = this.numbers[(this.at + i) % this.numbers.length];
      wanted.add(number);
      if (this.busy.size >= AT_ONCE) continue;
      const frame = this.state.frames.get(number);
      const has = this.bitmaps.get(number);
      if (this.busy.has(number) || (has && (has.stamp === stampOf(frame) || now - has.at < AGAIN_AFTER))) continue;
      this.fetch(frame, width);
    }
    for (const [number, { bitmap }] of this.bitmaps) {
      if (wanted.has(number)) continue;
      bitmap.close();
      this.bitmaps.delete(number);
    }
    this.timer = setTimeout(() => this.load(), AGAIN_AFTER);
    this.drawLoaded();
  }

  async fetch(frame, width) {
    this.busy.add(frame.id);
    const stamp = stampOf(frame);
    try {
      const response = await picture(this.id, frame.id, { width });
      const bitmap = await createImageBitmap(await response.blob());
      if (this.left || width !== Number(this.size.value)) {
        bitmap.close();
        return;
      }
      this.bitmaps.get(frame.id)?.bitmap.close();
      this.bitmaps.set(frame.id, { bitmap, stamp: madeAt(response, stamp), at: Date.now() });
      if (this.numbers[this.at] === frame.id) this.paint();
    } catch {
      // Asked again with the others.
    } finally {
      this.busy.delete(frame.id);
      if (!this.left) this.load();
    }
  }

  draw() {
    const number = this.numbers[this.at];
    if (number === undefined || !this.stage.isConnected) return;
    const dense = devicePixelRatio;
    const [width, height] = [Math.round(this.stage.clientWidth * dense), Math.round(this.stage.clientHeight * dense)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    setText(this.label, `Frame ${number}`);
    this.scrub.value = this.at;
    this.scrub.setAttribute('aria-valuetext', `Frame ${number}`);
    this.open.href = to('frame', { job: this.id, frame: number });
    const entry = this.bitmaps.get(number);
    // Not there yet: the one before stays.
    if (!entry) return;
    const { bitmap } = entry;
    const scale = Math.min(width / bitmap.width, height / bitmap.height);
    const pen = this.canvas.getContext('2d');
    pen.clearRect(0, 0, width, height);
    pen.imageSmoothingQuality = 'high';
    pen.drawImage(
      bitmap,
      (width - bitmap.width * scale) / 2,
      (height - bitmap.height * scale) / 2,
      bitmap.width * scale,
      bitmap.height * scale,
    );
  }

  drawLoaded() {
    const count = this.numbers.length;
    const { canvas } = { canvas: this.loaded };
    canvas.width = 400;
    canvas.height = 1;
    const pen = canvas.getContext('2d');
    pen.fillStyle = getComputedStyle(canvas).color;
    this.numbers.forEach((number, i) => {
      if (this.bitmaps.has(number)) pen.fillRect((i * 400) / count, 0, Math.max(1, 400 / count), 1);
    });
  }

  take(route) {
    return route.view === 'play' && route.job === this.id;
  }

  shown() {
    this.paint();
  }

  leave() {
    this.left = true;
    if (this.numbers.length > 0) leavePlace(this.id, this.numbers[this.at]);
    this.pause();
    clearTimeout(this.timer);
    this.paint.cancel();
    this.resized.disconnect();
    for (const { bitmap } of this.bitmaps.values()) bitmap.close();
    this.leaveJob();
  }
}

/** The view. */
export const flipbookView = (route, page) => new Flipbook(route, page);
