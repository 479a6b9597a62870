// Which unit was rendered where and when: a chart by worker, a table that says the same, and time by tile.
import { counted, duration, percent, whole } from './format.js';
import { h, setText } from './dom.js';
import { byWorker } from './units.js';
import { Gantt } from './gantt.js';
import { isOpen } from './farm_state.js';
import { Table } from './table.js';
import { TileMap } from './tile_map.js';
import { Timed } from './timed.js';

const EVERY = 4000;
/** Many units take long to draw: for each so many milliseconds more between questions. */
const EACH = 0.5;

function workerCell(td, { worker }) {
  if (!td.firstChild) td.append(h('span', { class: 'row-link', tabindex: -1 }));
  setText(td.firstChild, worker);
}

const numbers = (key, label, of, text, more = {}) => ({
  key,
  label,
  kind: 'num',
  sort: of,
  cell: (td, row) => setText(td, text(of(row))),
  ...more,
});

/** `span()`: seconds from the first unit's begin to the last one's end. */
const workTable = (span) =>
  new Table({
    label: 'Time by worker',
    testid: 'timeline-table',
    rowKey: ({ worker }) => worker,
    sort: { key: 'work', down: true },
    columns: [
      { key: 'worker', label: 'Worker', up: true, sort: ({ worker }) => worker, cell: workerCell },
      numbers('count', 'Units', ({ count }) => count, whole),
      numbers('work', 'Time', ({ work }) => work, duration),
      numbers(
        'mean',
        'Per unit',
        ({ work, count }) => work / count,
        (mean) => `${mean.toFixed(mean < 10 ? 2 : 0)} s`,
      ),
      numbers(
        'busy',
        'Busy',
        ({ busy }) => busy,
        (busy) => percent(busy / span()),
        { drop: 1 },
      ),
    ],
  });

/** Why there is nothing to be seen of a job. */
export function noneWhy(job) {
  if (job.samples_done > 0)
    return 'What was rendered when is kept of the latest jobs, until the coordinator is started again: of this one nothing is known.';
  return isOpen(job) ? 'Nothing has been rendered yet.' : 'Nothing was rendered.';
}

class Timeline {
  constructor(state) {
    this.state = state;
    this.stop = new AbortController();
    this.timed = new Timed(state.id);
    this.gantt = new Gantt();
    this.tiles = new TileMap();
    this.table = workTable(() => this.span);
    this.summary = h('p', { class: 'soft', testid: 'timeline-summary' });
    const all = h('button', {
      type: 'button',
      text: 'All of it',
      testid: 'timeline-all',
      onclick: () => this.gantt.whole(),
    });
    this.none = h('p', { class: 'soft pad', testid: 'timeline-none', text: 'Asking…' });
    this.box = h(
      'div',
      { class: 'timeline', hidden: true },
      h('div', { class: 'filters pad' }, this.summary, h('span', { class: 'spring' }), all),
      this.gantt.node,
      h('div', { class: 'timeline-lower' }, this.table.node, this.tiles.node),
    );
    this.node = h('div', {}, this.none, this.box);
    this.ask();
  }

  async ask() {
    const open = !this.state.job || isOpen(this.state.job);
    if (!document.hidden && (open || !this.complete)) {
      try {
        const news = await this.timed.more(this.stop.signal);
        this.complete = !open;
        if (news) this.take(this.timed);
        else if (this.state.job) setText(this.none, noneWhy(this.state.job));
      } catch {
        // Asked again soon.
      }
    }
    if (!this.stop.signal.aborted)
      this.timer = setTimeout(() => this.ask(), Math.max(EVERY, this.timed.units.length * EACH));
  }

  take({ units, steps, dropped }) {
    this.none.hidden = units.length > 0;
    this.box.hidden = units.length === 0;
    if (units.length === 0) return;
    const rows = byWorker(units);
    const begin = units.reduce((least, { begun_ms: at }) => Math.min(least, at), Infinity);
    const end = units.reduce((most, { ended_ms: at }) => Math.max(most, at), 0);
    this.span = Math.max(0.001, (end - begin) / 1000);
    const work = rows.reduce((sum, row) => sum + row.work, 0);
    const by = `${counted(units.length, 'unit')} by ${counted(rows.length, 'worker')} in ${duration(this.span)}`;
    const lost = dropped > 0 ? `; ${counted(dropped, 'older unit')} not kept` : '';
    setText(this.summary, `${by}; ${duration(work)} of their time${lost}`);
    this.table.setRows(rows);
    this.gantt.take(
      [...rows, ...byWorker(steps)],
      begin,
      Math.max(end, ...steps.slice(-1).map((step) => step.ended_ms)),
    );
    this.tiles.take(units);
  }

  shown() {
    this.gantt.paint();
    this.tiles.draw();
  }

  leave() {
    this.stop.abort();
    clearTimeout(this.timer);
    this.gantt.leave();
    this.tiles.leave();
    this.table.leave();
  }
}

/** The tab. */
export const timelineTab = (state) => new Timeline(state);
