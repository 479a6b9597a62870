// Which unit was rendered where and when: a chart by worker, a table that says the same, and time by tile.
import { color, onTheme } from './theme.js';
import { clock, counted, duration, percent, whole } from './format.js';
import { h, oncePerFrame, setText } from './dom.js';
import { heat } from './tone.js';
import { isOpen } from './farm_state.js';
import { Table } from './table.js';
import { timeline } from './api.js';

const EVERY = 4000;
const LABELS = 130;
const ROW = 26;
const AXIS = 24;
const MOST_LANES = 8;

/**
 * Units by worker, those that overlap in lanes: [{worker, units: [{unit, lane}], lanes, busy (seconds in which it had a unit), work (seconds, summed
 * over units), count}], workers by name.
 */
export function byWorker(units) {
  const rows = new Map();
  for (const unit of [...units].sort((a, b) => a.begun_ms - b.begun_ms)) {
    let row = rows.get(unit.worker);
    if (!row) rows.set(unit.worker, (row = { worker: unit.worker, units: [], ends: [], busy: 0, work: 0, count: 0, until: 0 }));
    let lane = row.ends.findIndex((end) => end <= unit.begun_ms);
    if (lane < 0) lane = row.ends.length < MOST_LANES ? row.ends.length : row.ends.indexOf(Math.min(...row.ends));
    row.ends[lane] = unit.ended_ms;
    row.units.push({ unit, lane });
    row.busy += Math.max(0, unit.ended_ms - Math.max(unit.begun_ms, row.until)) / 1000;
    row.until = Math.max(row.until, unit.ended_ms);
    row.work += (unit.ended_ms - unit.begun_ms) / 1000;
    ++row.count;
  }
  return [...rows.values()].map(({ ends, until, ...row }) => ({ ...row, lanes: Math.max(1, ends.length) })).sort((a, b) => a.worker.localeCompare(b.worker, 'en', { numeric: true }));
}

/** Seconds that each tile took, over all batches: [{tile, seconds, batches}]. */
export function byTile(units) {
  const tiles = new Map();
  for (const { tile, batches, begun_ms: begun, ended_ms: ended } of units) {
    const key = tile.join();
    let entry = tiles.get(key);
    if (!entry) tiles.set(key, (entry = { tile, seconds: 0, batches: 0 }));
    entry.seconds += (ended - begun) / 1000;
    entry.batches += batches;
  }
  return [...tiles.values()];
}

/** Neighbouring frames in colours that differ. */
const colorOf = (frame, dark) => `hsl(${(frame * 137.508) % 360} ${dark ? '52% 62%' : '55% 48%'})`;

class Timeline {
  constructor(state) {
    this.state = state;
    this.rows = [];
    this.stop = new AbortController();
    this.canvas = h('canvas', { class: 'gantt', role: 'img', 'aria-label': 'Units over time, a row for each worker; the table below says the same', tabindex: 0, testid: 'gantt' });
    this.tip = h('div', { class: 'sky-tip', hidden: true });
    this.summary = h('p', { class: 'soft', testid: 'timeline-summary' });
    this.tiles = h('canvas', { class: 'tiles', role: 'img', 'aria-label': 'Time by tile of the picture', testid: 'tiles' });
    this.tileText = h('p', { class: 'soft' });
    this.frameField = h('select', { 'aria-label': 'Tiles of', testid: 'tile-frame', onchange: () => this.drawTiles() });
    this.table = new Table({
      label: 'Time by worker', testid: 'timeline-table', rowKey: ({ worker }) => worker, sort: { key: 'work', down: true },
      columns: [
        { key: 'worker', label: 'Worker', up: true, sort: ({ worker }) => worker, cell: (td, { worker }) => { if (!td.firstChild) td.append(h('span', { class: 'row-link', tabindex: -1 })); setText(td.firstChild, worker); } },
        { key: 'count', label: 'Units', kind: 'num', sort: ({ count }) => count, cell: (td, { count }) => setText(td, whole(count)) },
        { key: 'work', label: 'Time', kind: 'num', sort: ({ work }) => work, cell: (td, { work }) => setText(td, duration(work)) },
        { key: 'mean', label: 'Per unit', kind: 'num', sort: ({ work, count }) => work / count, cell: (td, { work, count }) => setText(td, `${(work / count).toFixed(work / count < 10 ? 2 : 0)} s`) },
        { key: 'busy', label: 'Busy', kind: 'num', drop: 1, sort: ({ busy }) => busy, cell: (td, { busy }) => setText(td, percent(busy / this.span)) },
      ],
    });
    this.none = h('p', { class: 'soft pad', text: 'Nothing has been rendered yet.' });
    this.box = h('div', { class: 'timeline', hidden: true },
      h('div', { class: 'filters pad' }, this.summary, h('span', { class: 'spring' }), h('button', { type: 'button', text: 'All of it', testid: 'timeline-all', onclick: () => { this.view = null; this.paint(); } })),
      h('div', { class: 'gantt-box panel-box' }, this.canvas, this.tip),
      h('div', { class: 'timeline-lower' }, this.table.node,
        h('section', { class: 'panel-box tile-box' }, h('div', { class: 'box-head' }, h('h2', { text: 'Time by tile' }), h('span', { class: 'spring' }), this.frameField), this.tiles, this.tileText)));
    this.node = h('div', {}, this.none, this.box);
    this.paint = oncePerFrame(() => this.draw());
    this.resized = new ResizeObserver(() => { this.paint(); this.drawTiles(); });
    this.resized.observe(this.box);
    this.leaveTheme = onTheme(() => this.paint());
    this.canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    this.canvas.addEventListener('pointerdown', (event) => { this.dragged = event.clientX; this.canvas.setPointerCapture(event.pointerId); });
    this.canvas.addEventListener('pointerup', () => { this.dragged = null; });
    this.canvas.addEventListener('pointermove', (event) => this.move(event));
    this.canvas.addEventListener('pointerleave', () => { this.tip.hidden = true; });
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    this.ask();
  }

  async ask() {
    clearTimeout(this.timer);
    const open = !this.state.job || isOpen(this.state.job);
    if (!document.hidden && (open || !this.complete)) {
      try {
        const { units, dropped } = await timeline(this.state.id, this.stop.signal);
        this.complete = !open;
        this.take(units, dropped);
      } catch {
        // Asked again soon.
      }
    }
    // Many units are many bytes: they are asked for less often.
    if (!this.stop.signal.aborted) this.timer = setTimeout(() => this.ask(), Math.max(EVERY, (this.units?.length ?? 0) * 1.5));
  }

  take(units, dropped) {
    this.none.hidden = units.length > 0;
    this.box.hidden = units.length === 0;
    if (units.length === 0) return;
    this.units = units;
    this.rows = byWorker(units);
    this.begin = units.reduce((least, { begun_ms: at }) => Math.min(least, at), Infinity);
    this.end = units.reduce((most, { ended_ms: at }) => Math.max(most, at), 0);
    this.span = Math.max(0.001, (this.end - this.begin) / 1000);
    const work = this.rows.reduce((sum, row) => sum + row.work, 0);
    setText(this.summary, `${counted(units.length, 'unit')} by ${counted(this.rows.length, 'worker')} in ${duration(this.span)}; ${duration(work)} of their time${dropped > 0 ? `; ${counted(dropped, 'older unit')} not kept` : ''}`);
    this.table.setRows(this.rows);
    const frames = [...new Set(units.map(({ frame }) => frame))].sort((a, b) => a - b);
    if (this.frames !== frames.join()) {
      this.frames = frames.join();
      const now = this.frameField.value;
      this.frameField.replaceChildren(h('option', { value: '', text: 'all frames' }), ...frames.slice(-500).map((frame) => h('option', { value: frame, text: `frame ${frame}` })));
      this.frameField.value = frames.includes(Number(now)) ? now : '';
    }
    this.paint();
    this.drawTiles();
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
    const run = { '+': () => this.zoom(0.6, (from + until) / 2), '-': () => this.zoom(1.6, (from + until) / 2), ArrowLeft: () => this.pan((from - until) * 0.15), ArrowRight: () => this.pan((until - from) * 0.15), 0: () => { this.view = null; this.paint(); } }[event.key];
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
    const hit = x > LABELS && row?.units.find(({ unit, lane: own }) => own === lane && unit.begun_ms <= at && unit.ended_ms >= at);
    this.tip.hidden = !hit;
    if (!hit) return;
    const { unit } = hit;
    setText(this.tip, `Frame ${unit.frame}, tile ${unit.tile[0]},${unit.tile[1]} to ${unit.tile[2]},${unit.tile[3]}, batches ${unit.first_batch}–${unit.first_batch + unit.batches - 1} · ${((unit.ended_ms - unit.begun_ms) / 1000).toFixed(2)} s from ${clock(unit.begun_ms)}`);
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
    const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 43200, 86400];
    const step = (steps.find((s) => ((until - from) / 1000 / s) * 84 < inner) ?? 86400) * 1000;
    pen.strokeStyle = line;
    pen.fillStyle = soft;
    pen.textAlign = 'center';
    for (let at = Math.ceil(from / step) * step; at <= until; at += step) {
      pen.beginPath();
      pen.moveTo(x(at), 0);
      pen.lineTo(x(at), height - AXIS);
      pen.stroke();
      if (x(at) > LABELS + 24 && x(at) < width - 28) pen.fillText(clock(at) + (step < 1000 ? `.${Math.floor((at % 1000) / 100)}` : ''), x(at), height - AXIS / 2);
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
        pen.fillRect(left, y + 3 + lane * tall, Math.max(0.7, wide > 4 ? wide - 1 : wide), Math.max(1, tall - (row.lanes > 1 ? 1 : 0)));
      }
    });
  }

  drawTiles() {
    if (!this.units) return;
    const frame = this.frameField.value;
    const tiles = byTile(frame === '' ? this.units : this.units.filter((unit) => unit.frame === Number(frame)));
    const room = this.tiles.parentNode.clientWidth - 28;
    if (room <= 0 || tiles.length === 0) return;
    const right = Math.max(...tiles.map(({ tile }) => tile[2]));
    const bottom = Math.max(...tiles.map(({ tile }) => tile[3]));
    const scale = Math.min(room / right, 300 / bottom);
    const dense = devicePixelRatio;
    this.tiles.style.width = `${right * scale}px`;
    this.tiles.style.height = `${bottom * scale}px`;
    this.tiles.width = Math.round(right * scale * dense);
    this.tiles.height = Math.round(bottom * scale * dense);
    const pen = this.tiles.getContext('2d');
    pen.scale(scale * dense, scale * dense);
    const perBatch = tiles.map(({ seconds, batches }) => seconds / Math.max(1, batches));
    const most = Math.max(...perBatch);
    tiles.forEach(({ tile: [x0, y0, x1, y1] }, i) => {
      pen.fillStyle = `rgb(${heat((0.9 * perBatch[i]) / most).map((c) => Math.round(c * 255))})`;
      pen.fillRect(x0, y0, x1 - x0 - 0.5 / scale, y1 - y0 - 0.5 / scale);
    });
    const mean = perBatch.reduce((a, b) => a + b, 0) / perBatch.length;
    setText(this.tileText, `${counted(tiles.length, 'tile')}; per batch ${mean.toFixed(2)} s on average, ${most.toFixed(2)} s at most`);
  }

  leave() {
    this.stop.abort();
    clearTimeout(this.timer);
    this.paint.cancel();
    this.resized.disconnect();
    this.leaveTheme();
    this.table.leave();
  }
}

/** The tab. */
export function timelineTab(state) {
  const view = new Timeline(state);
  return { node: view.node, shown: () => { view.paint(); view.drawTiles(); }, leave: () => view.leave() };
}
