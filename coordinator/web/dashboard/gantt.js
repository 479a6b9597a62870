// Units over time: a row for each worker, to be zoomed and moved.
import { color, onTheme } from './theme.js';
import { h, oncePerFrame, setText } from './dom.js';
import { clock } from './format.js';

const LABELS = 130;
const ROW = 26;
const AXIS = 24;
/** Between the lines of the axis at least so many pixels. */
const APART = 84;
const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 43200, 86400];

/** Neighbouring frames in colours that differ. */
const colorOf = (frame, dark) => `hsl(${(frame * 137.508) % 360} ${dark ? '52% 62%' : '55% 48%'})`;

const STEP_WORDS = { merge: 'merged', finish: 'finished', video: 'video written' };

/** What a unit or step of the coordinator was. */
function nameOf({ kind, frame, tile, first_batch: first, batches }) {
  const parts = [
    frame !== undefined && `frame ${frame}`,
    tile && `tile ${tile[0]},${tile[1]} to ${tile[2]},${tile[3]}`,
    batches > 0 && (batches > 1 ? `batches ${first}–${first + batches - 1}` : `batch ${first}`),
    STEP_WORDS[kind],
  ];
  const text = parts.filter(Boolean).join(', ');
  return text[0].toUpperCase() + text.slice(1);
}

/** `take(rows, begin, end)`: rows as byWorker (units.js) gives them, times in milliseconds. */
export class Gantt {
  constructor() {
    this.rows = [];
    this.canvas = h('canvas', {
      class: 'gantt',
      role: 'img',
      'aria-label': 'Units over time, a row for each worker; the table below says the same',
      tabindex: 0,
      testid: 'gantt',
    });
    this.tip = h('div', { class: 'sky-tip', hidden: true });
    this.node = h('div', { class: 'gantt-box panel-box' }, this.canvas, this.tip);
    this.paint = oncePerFrame(() => this.draw());
    this.resized = new ResizeObserver(this.paint);
    this.resized.observe(this.canvas);
    this.leaveTheme = onTheme(this.paint);
    const on = (name, work, options) => this.canvas.addEventListener(name, work, options);
    on('wheel', (event) => this.wheel(event), { passive: false });
    on('pointerdown', (event) => this.down(event));
    on('pointerup', () => (this.dragged = null));
    on('pointermove', (event) => this.move(event));
    on('pointerleave', () => (this.tip.hidden = true));
    on('keydown', (event) => this.key(event));
  }

  take(rows, begin, end) {
    Object.assign(this, { rows, begin, end });
    this.paint();
  }

  /** Shows all of it. */
  whole() {
    this.view = null;
    this.paint();
  }

  down(event) {
    this.dragged = event.clientX;
    this.canvas.setPointerCapture(event.pointerId);
  }

  get window() {
    return this.view ?? [this.begin, this.end];
  }

  zoom(factor, at) {
    const [from, until] = this.window;
    const span = Math.min(this.end - this.begin, Math.max(50, (until - from) * factor));
    let start = at - ((at - from) / (until - from)) * span;
    start = Math.min(this.end - span, Math.max(this.begin, start));
    this.view = span >= this.end - this.begin ? null : [start, start + span];
    this.paint();
  }

  pan(ms) {
    if (!this.view) return;
    const span = this.view[1] - this.view[0];
    const start = Math.min(this.end - span, Math.max(this.begin, this.view[0] + ms));
    this.view = [start, start + span];
    this.paint();
  }

  timeAt(x) {
    const [from, until] = this.window;
    return from + ((x - LABELS) / Math.max(1, this.canvas.clientWidth - LABELS)) * (until - from);
  }

  wheel(event) {
    // The page scrolls as ever; with a key, or sideways, the chart moves.
    if (!event.ctrlKey && !event.shiftKey && Math.abs(event.deltaX) <= Math.abs(event.deltaY)) return;
    event.preventDefault();
    const x = event.clientX - this.canvas.getBoundingClientRect().left;
    if (event.ctrlKey) this.zoom(Math.exp(event.deltaY * 0.005), this.timeAt(x));
    else this.pan(((event.deltaX || event.deltaY) / this.canvas.clientWidth) * (this.window[1] - this.window[0]));
  }

  key(event) {
    const [from, until] = this.window;
    const run = {
      '+': () => this.zoom(0.6, (from + until) / 2),
      '-': () => this.zoom(1.6, (from + until) / 2),
      ArrowLeft: () => this.pan((from - until) * 0.15),
      ArrowRight: () => this.pan((until - from) * 0.15),
      0: () => this.whole(),
    }[event.key];
    if (!run) return;
    event.preventDefault();
    event.stopPropagation();
    run();
  }

  move(event) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    if (this.dragged != null) {
      const [from, until] = this.window;
      this.pan(((this.dragged - event.clientX) / (box.width - LABELS)) * (until - from));
      this.dragged = event.clientX;
    }
    const row = this.rows[Math.floor(y / ROW)];
    const at = this.timeAt(x);
    const lane = row ? Math.floor(((y % ROW) - 3) / ((ROW - 6) / row.lanes)) : 0;
    const hit =
      x > LABELS &&
      row?.units.find(({ unit, lane: own }) => own === lane && unit.begun_ms <= at && unit.ended_ms >= at);
    this.tip.hidden = !hit;
    if (!hit) return;
    const { begun_ms: begun, ended_ms: ended } = hit.unit;
    setText(this.tip, `${nameOf(hit.unit)} · ${((ended - begun) / 1000).toFixed(2)} s from ${clock(begun)}`);
    this.tip.style.left = `${Math.max(4, Math.min(x + 12, box.width - this.tip.offsetWidth - 4))}px`;
    this.tip.style.top = `${y + 16}px`;
  }

  draw() {
    const width = this.canvas.clientWidth;
    if (width === 0 || this.rows.length === 0) return;
    const height = this.rows.length * ROW + AXIS;
    const dense = devicePixelRatio;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(width * dense);
    this.canvas.height = Math.round(height * dense);
    const pen = this.canvas.getContext('2d');
    pen.scale(dense, dense);
    const [text, soft, line, panel, many] = ['--text', '--soft', '--line', '--panel', '--map-done'].map(color);
    const dark = Number(panel.match(/\d+/)[0]) < 128;
    pen.font = '12px system-ui, sans-serif';
    pen.textBaseline = 'middle';
    const [from, until] = this.window;
    const inner = width - LABELS - 4;
    const x = (ms) => LABELS + ((ms - from) / (until - from)) * inner;
    const step = (STEPS.find((s) => ((until - from) / 1000 / s) * APART < inner) ?? 86400) * 1000;
    pen.strokeStyle = line;
    pen.fillStyle = soft;
    pen.textAlign = 'center';
    for (let at = Math.ceil(from / step) * step; at <= until; at += step) {
      pen.beginPath();
      pen.moveTo(x(at), 0);
      pen.lineTo(x(at), height - AXIS);
      pen.stroke();
      if (x(at) > LABELS + 24 && x(at) < width - 28)
        pen.fillText(clock(at) + (step < 1000 ? `.${Math.floor((at % 1000) / 100)}` : ''), x(at), height - AXIS / 2);
    }
    pen.textAlign = 'left';
    this.rows.forEach((row, i) => {
      const y = i * ROW;
      pen.fillStyle = text;
      pen.fillText(row.worker, 12, y + ROW / 2, LABELS - 20);
      const tall = (ROW - 6) / row.lanes;
      // Units narrower than the eye sees would be confetti: then all have one colour.
      const mean = ((row.work / row.count) * 1000 * inner) / (until - from);
      for (const { unit, lane } of row.units) {
        if (unit.ended_ms < from || unit.begun_ms > until) continue;
        const left = Math.max(LABELS, x(unit.begun_ms));
        pen.fillStyle = mean > 3 ? colorOf(unit.frame, dark) : many;
        const wide = x(unit.ended_ms) - left;
        pen.fillRect(
          left,
          y + 3 + lane * tall,
          Math.max(0.7, wide > 4 ? wide - 1 : wide),
          Math.max(1, tall - (row.lanes > 1 ? 1 : 0)),
        );
      }
    });
  }

  leave() {
    this.paint.cancel();
    this.resized.disconnect();
    this.leaveTheme();
  }
}
