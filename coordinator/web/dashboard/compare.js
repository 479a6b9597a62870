// Another picture beside the one that is shown: of another frame, or of another job.
import { h, setAttribute, setText } from './dom.js';
import { FrameSource } from './frame_source.js';
import { watchJob } from './job_state.js';

const MODES = { off: 0, split: 1, difference: 2 };

/**
 * `view`: {job: its id, frame(): the frame shown, layer(): its layer, neighbour(): a frame to begin with, stage(): the element, got(main,
 * beside, layer), dropped() when what was got does not count any more, changed() when the
 * choice is another one, moved() when only the line between them is}.
 */
export class Compare {
  constructor(view) {
    this.view = view;
    this.mode = 'off';
    this.splitAt = 0.5;
    this.other = null;
    this.source = new FrameSource({
      got: (...all) => {
        setText(this.note, '');
        view.got(...all);
      },
      failed: (error) => setText(this.note, error.message),
    });
    this.button = h('button', { type: 'button', testid: 'compare', text: 'Compare', onclick: () => this.toggle() });
    this.makeFields();
    this.makeSplit();
    this.draw();
  }

  makeFields() {
    const field = (label, testid) =>
      h('input', { type: 'number', step: 1, 'aria-label': label, testid, onchange: () => this.read() });
    this.jobField = field('Job to compare with', 'compare-job');
    this.frameField = field('Frame to compare with', 'compare-frame');
    const pill = ([mode, text]) =>
      h('button', {
        type: 'button',
        'data-mode': mode,
        text,
        testid: `mode-${mode}`,
        onclick: () => this.setMode(mode),
      });
    const modes = [
      ['split', 'Side by side'],
      ['difference', 'Difference'],
    ];
    this.modes = h('div', { class: 'pills', role: 'group', 'aria-label': 'How to compare' }, modes.map(pill));
    this.note = h('span', { class: 'soft' });
    const words = [h('span', { text: 'with frame' }), h('span', { text: 'of job' })];
    this.box = h(
      'div',
      { class: 'compare-box' },
      words[0],
      this.frameField,
      words[1],
      this.jobField,
      this.modes,
      this.note,
    );
  }

  makeSplit() {
    this.handle = h(
      'div',
      {
        class: 'split',
        role: 'slider',
        tabindex: 0,
        'aria-label': 'Where the two pictures meet',
        'aria-valuemin': 0,
        'aria-valuemax': 100,
        'aria-valuenow': 50,
        testid: 'split',
        onkeydown: (event) => this.key(event),
        onpointerdown: (event) => this.drag(event),
      },
      h('i', {}),
    );
    this.tags = ['left', 'right'].map((side) => h('span', { class: `stage-tag ${side}` }));
    /** What lies on the stage. */
    this.marks = [this.handle, ...this.tags];
    this.drawMarks(false);
  }

  /** The number for the shader; 0 while there is nothing to compare with. */
  modeNumber(there) {
    return there ? MODES[this.mode] : 0;
  }

  get on() {
    return this.mode !== 'off';
  }

  /** What the page's address says of the comparison. */
  query() {
    if (!this.on || !this.other) return {};
    const { job, frame } = this.other;
    return { with: frame, job: job === this.view.job ? '' : job, mode: this.mode === 'difference' ? this.mode : '' };
  }

  toggle() {
    if (this.on) {
      this.setMode('off');
      return;
    }
    if (!this.other) this.choose(this.view.job, this.view.neighbour());
    this.setMode('split');
    this.frameField.focus();
  }

  setMode(mode) {
    this.mode = mode;
    this.draw();
    this.want();
    this.view.changed();
  }

  draw() {
    this.box.hidden = !this.on;
    setAttribute(this.button, 'aria-expanded', this.on);
    for (const pill of this.modes.children) setAttribute(pill, 'aria-pressed', pill.dataset.mode === this.mode);
  }

  read() {
    const frame = Number(this.frameField.value);
    if (this.frameField.value === '' || !Number.isInteger(frame)) return;
    this.choose(Number(this.jobField.value) || this.view.job, frame);
    this.view.changed();
  }

  /** Compares with this frame from now on. */
  choose(job, frame, mode = this.on ? this.mode : 'split') {
    this.jobField.value = job;
    this.frameField.value = frame;
    if (this.other?.job !== job) {
      this.leaveJob?.();
      const watched = watchJob(job, () => this.want());
      this.state = watched.state;
      this.leaveJob = watched.leave;
    }
    this.other = { job, frame };
    this.mode = mode;
    this.view.dropped();
    this.draw();
    this.want();
  }

  /** Asks for the other picture, as far as it is there and in the layer that is shown. */
  want() {
    if (!this.on || !this.other) return;
    const { state, other } = this;
    const frame = state.frames.get(other.frame);
    if (state.error && !state.job) setText(this.note, state.error.message);
    else if (frame && frame.samples_done > 0) this.source.want(other.job, frame, this.view.layer());
    else if (state.numbers.length > 0) setText(this.note, frame ? 'nothing of it yet' : 'there is no such frame');
    setText(this.tags[0], `Frame ${this.view.frame()}`);
    const where = other.job === this.view.job ? '' : ` of ${state.job?.name ?? `job ${other.job}`}`;
    setText(this.tags[1], `Frame ${other.frame}${where}`);
  }

  /** Shows or hides what lies on the stage. */
  drawMarks(there) {
    const split = there && this.mode === 'split';
    for (const mark of this.marks) mark.hidden = !split;
    this.handle.style.left = `${this.splitAt * 100}%`;
  }

  drag(event) {
    event.preventDefault();
    event.stopPropagation();
    this.handle.setPointerCapture(event.pointerId);
    this.handle.onpointermove = (next) => {
      const box = this.view.stage().getBoundingClientRect();
      this.setSplit((next.clientX - box.left) / box.width);
    };
    this.handle.onpointerup = this.handle.onpointercancel = () => {
      this.handle.onpointermove = null;
    };
  }

  key(event) {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    this.setSplit(this.splitAt + step);
  }

  setSplit(share) {
    this.splitAt = Math.min(1, Math.max(0, share));
    this.handle.setAttribute('aria-valuenow', Math.round(this.splitAt * 100));
    this.view.moved();
  }

  leave() {
    this.source.leave();
    this.leaveJob?.();
  }
}
