// Tables of thousands of rows: those on the screen exist, the others are room above and below.
import { h, oncePerFrame, setAttribute } from './dom.js';

const MARGIN_ROWS = 8;
const letters = new Intl.Collator('en', { numeric: true, sensitivity: 'base' });

/** The rows in order of `by(row)`, `down` or up; what is alike as Table's `tie` and `rowKey` say. Digits in texts are numbers. */
export function sorted(rows, { by, down, tie, rowKey }) {
  const sign = down ? -1 : 1;
  const keyed = rows.map((row) => [by(row), row]);
  keyed.sort(([a, x], [b, y]) => {
    const order = typeof a === 'string' ? letters.compare(a, b) : a - b;
    return order * sign || (tie ? letters.compare(tie(x), tie(y)) : 0) || (rowKey(y) > rowKey(x) ? 1 : -1);
  });
  return keyed.map(([, row]) => row);
}

/**
 * columns: [{key, label, sort(row), up, cell(td, row), narrow}]: `sort` gives what to sort by (absent: not by this one), `up` that
 * it begins with the smallest, `cell` fills a cell (called again when the row is another object), `drop` 1..3: left out on narrow screens,
 * 3 first, `spoken` a label for those who cannot see that none is needed. rowKey(row).
 * `tie(row)`: a text by which rows are sorted that are alike otherwise; without it those with the greater key come first.
 * `onGone(tr)` is called when a row leaves the screen. `cards`: on phones rows are cards, which the style lays out. The height of rows is the style's `--row`.
 */
export class Table {
  constructor({ columns, rowKey, label, sort, tie, testid, onSort, chosen, onChosen, onGone, empty, cards = false }) {
    Object.assign(this, { columns, rowKey, tie, chosen, onChosen, onSort, onGone, empty });
    this.sort = sort;
    this.rows = [];
    this.shown = new Map();
    this.active = null;
    this.top = h('tr', { class: 'room', 'aria-hidden': 'true' }, h('td', { colspan: columns.length }));
    this.bottom = h('tr', { class: 'room', 'aria-hidden': 'true' }, h('td', { colspan: columns.length }));
    this.body = h(
      'tbody',
      { role: 'rowgroup', onkeydown: (event) => this.key(event), onclick: (event) => this.click(event) },
      this.top,
      this.bottom,
    );
    this.heads = columns.map((column) => this.head(column));
    this.nothing = h('div', { class: 'table-empty' }, h('p', { class: 'soft', text: 'Loading…' }));
    this.table = h(
      'table',
      { role: 'table', 'aria-label': label, testid, class: cards ? 'cards' : null },
      h('thead', { role: 'rowgroup' }, h('tr', { role: 'row', 'aria-rowindex': 1 }, this.heads)),
      this.body,
    );
    this.table.hidden = true;
    this.node = h('div', { class: 'table' }, this.table, this.nothing);
    this.draw = oncePerFrame(() => this.layout());
    addEventListener('scroll', this.draw, { passive: true });
    addEventListener('resize', this.draw);
    // What is above may grow and shrink: then others are on the screen.
    this.moved = new ResizeObserver(this.draw);
    this.moved.observe(document.body);
    this.tellSort();
  }

  leave() {
    this.draw.cancel();
    this.moved.disconnect();
    removeEventListener('scroll', this.draw);
    removeEventListener('resize', this.draw);
  }

  head(column) {
    const classes = `${column.kind ?? ''} ${column.drop ? `drop${column.drop}` : ''} c-${column.key}`;
    if (column.header) return h('th', { role: 'columnheader', scope: 'col', class: classes }, column.header());
    if (!column.sort)
      return h(
        'th',
        { role: 'columnheader', scope: 'col', class: classes },
        column.spoken ? h('span', { class: 'unseen', text: column.spoken }) : column.label,
      );
    return h(
      'th',
      { role: 'columnheader', scope: 'col', class: classes },
      h('button', {
        type: 'button',
        class: 'sorter',
        text: column.label,
        testid: `sort-${column.key}`,
        onclick: () => this.sortBy(column),
      }),
    );
  }

  sortBy(column) {
    const down = this.sort.key === column.key ? !this.sort.down : !column.up;
    this.sort = { key: column.key, down };
    this.tellSort();
    this.onSort?.(this.sort);
    this.setRows(this.rows);
  }

  tellSort() {
    this.columns.forEach((column, i) => {
      const here = column.key === this.sort.key;
      setAttribute(this.heads[i], 'aria-sort', here ? (this.sort.down ? 'descending' : 'ascending') : null);
    });
  }

  /** Shows these rows, sorted. */
  setRows(rows) {
    const by = this.columns.find(({ key }) => key === this.sort.key)?.sort;
    if (by) {
      rows = sorted(rows, { by, down: this.sort.down, tie: this.tie, rowKey: this.rowKey });
    }
    this.rows = rows;
    setAttribute(this.table, 'aria-rowcount', rows.length + 1);
    if (rows.length === 0 && this.empty) this.nothing.replaceChildren(this.empty());
    else this.nothing.replaceChildren();
    this.table.hidden = rows.length === 0 && Boolean(this.empty);
    this.draw();
  }

  layout() {
    if (!this.node.isConnected) return;
    const height = parseFloat(getComputedStyle(this.table).getPropertyValue('--row')) || 40;
    const box = this.body.getBoundingClientRect();
    const count = this.rows.length;
    const from = Math.max(0, Math.min(count, Math.floor(-box.top / height) - MARGIN_ROWS));
    const until = Math.min(count, Math.max(from, Math.ceil((innerHeight - box.top) / height) + MARGIN_ROWS));
    const wanted = new Set();
    let after = this.top;
    if (this.active === null || !this.rows.some((row) => this.rowKey(row) === this.active))
      this.active = count > 0 ? this.rowKey(this.rows[0]) : null;
    for (let i = from; i < until; ++i) {
      const row = this.rows[i];
      const id = this.rowKey(row);
      wanted.add(id);
      let shown = this.shown.get(id);
      if (!shown) this.shown.set(id, (shown = this.make(id)));
      if (after.nextSibling !== shown.tr) after.after(shown.tr);
      after = shown.tr;
      setAttribute(shown.tr, 'aria-rowindex', i + 2);
      this.fill(shown, row);
    }
    for (const [id, { tr }] of this.shown) {
      if (wanted.has(id)) continue;
      // What has the focus stays, out of sight at the end, or the keyboard would lose its place.
      if (tr.contains(document.activeElement) && this.rows.some((row) => this.rowKey(row) === id)) {
        this.bottom.after(tr);
        continue;
      }
      this.onGone?.(tr);
      tr.remove();
      this.shown.delete(id);
    }
    this.top.firstChild.style.height = `${from * height}px`;
    this.bottom.firstChild.style.height = `${(count - until) * height}px`;
  }

  make(id) {
    const cells = this.columns.map((column) =>
      h('td', {
        role: 'cell',
        class: `${column.kind ?? ''} ${column.drop ? `drop${column.drop}` : ''} c-${column.key}`,
        'data-label': column.label,
      }),
    );
    const tr = h('tr', { role: 'row', 'data-key': id, testid: 'row' }, cells);
    return { tr, cells, row: null, chosen: null };
  }

  fill(shown, row) {
    const chosen = this.chosen?.has(this.rowKey(row)) ?? false;
    if (shown.row !== row || shown.chosen !== chosen || this.columns.some(({ always }) => always)) {
      this.columns.forEach((column, i) => {
        if (shown.row !== row || shown.chosen !== chosen || column.always) column.cell(shown.cells[i], row, chosen);
      });
      shown.row = row;
      shown.chosen = chosen;
      shown.tr.classList.toggle('chosen', chosen);
      if (this.chosen) setAttribute(shown.tr, 'aria-selected', chosen);
    }
    const link = shown.tr.querySelector('.row-link');
    if (link) link.tabIndex = this.rowKey(row) === this.active ? 0 : -1;
  }

  /** Asks for cells anew whose values change by themselves (times). */
  refresh() {
    this.draw();
  }

  click(event) {
    const tr = event.target.closest('tr[data-key]');
    if (!tr || event.target.closest('a, button, input, select, label') || getSelection().toString()) return;
    tr.querySelector('.row-link')?.click();
  }

  key(event) {
    const tr = event.target.closest('tr[data-key]');
    if (!tr || event.target.matches('input:not([type=checkbox]), select')) return;
    const at = this.rows.findIndex((row) => String(this.rowKey(row)) === tr.dataset.key);
    const page = Math.max(1, Math.floor(innerHeight / 60));
    const step = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -at,
      End: this.rows.length - 1 - at,
    }[event.key];
    if (step !== undefined) {
      event.preventDefault();
      this.focusRow(Math.min(this.rows.length - 1, Math.max(0, at + step)));
    } else if ((event.key === ' ' || event.key === 'x') && this.onChosen) {
      event.preventDefault();
      this.onChosen(this.rowKey(this.rows[at]), event.shiftKey);
    }
  }

  /** Moves the focus by so many rows; into the table where it is elsewhere. */
  step(by) {
    const at = this.rows.findIndex((row) => this.rowKey(row) === this.active);
    const inside = this.body.contains(document.activeElement);
    this.focusRow(inside ? Math.min(this.rows.length - 1, Math.max(0, at + by)) : Math.max(0, at));
  }

  focusRow(index) {
    const row = this.rows[index];
    if (!row) return;
    const height = parseFloat(getComputedStyle(this.table).getPropertyValue('--row')) || 40;
    const y = this.body.getBoundingClientRect().top + index * height;
    const upper = 110;
    if (y < upper) scrollBy(0, y - upper);
    else if (y + height > innerHeight - 70) scrollBy(0, y + height - innerHeight + 70);
    this.active = this.rowKey(row);
    this.layout();
    this.shown.get(this.active)?.tr.querySelector('.row-link')?.focus({ preventScroll: true });
  }
}
