// A job's frames as pictures that refine. Of ten thousand only those on the screen exist.
import { h, oncePerFrame, setAttribute, setText } from './dom.js';
import { chip } from './parts.js';
import { brief, counted, percent, whole } from './format.js';
import { recall, remember } from './memory.js';
import { FrameMap } from './frame_map.js';
import { frameShare } from './job_state.js';
import { takePlace } from './place.js';
import { Thumbs } from './thumbs.js';
import { to } from './router.js';

const SIZES = { small: 120, medium: 200, large: 340 };
const CAPTION = 26;
const GAP = 8;
const FILTERS = [
  ['', 'All'],
  ['rendering', 'Rendering'],
  ['finishing', 'Finishing'],
  ['waiting', 'Waiting'],
  ['done', 'Done'],
  ['failed', 'Failed'],
  ['doubtful', 'In doubt'],
];
/** What stands where there is no picture yet, while there are no more frames than FEW. */
const EMPTY = { waiting: 'waits for a worker', rendering: 'begun', finishing: 'begun', failed: 'failed' };
const FEW = 4;
/** Browsers do not know elements that are much taller (Firefox: 17.9 million); beyond it, scrolling is geared. */
const TALLEST = 8e6;

const fits = (frame, filter) =>
  filter === '' || (filter === 'doubtful' ? frame.doubtful : frame.state === filter);

/** The grid of frames of `state` (job_state.js), with its filters and the map of all frames. */
export class Frames {
  constructor(state) {
    this.state = state;
    this.filter = '';
    this.list = [];
    this.cells = new Map();
    this.spare = [];
    this.active = null;
    this.aspect = 9 / 16;
    this.thumbs = new Thumbs();
    this.size = recall('thumbs', 'medium');
    if (!SIZES[this.size]) this.size = 'medium';
    this.pills = h(
      'div',
      { class: 'pills', role: 'group', 'aria-label': 'Frames' },
      FILTERS.map(([value, text]) =>
        h(
          'button',
          {
            type: 'button',
            'data-filter': value,
            testid: `frames-${value || 'all'}`,
            onclick: () => {
              this.filter = value;
              this.refilter();
              this.draw();
            },
          },
          h('span', { text }),
          h('span', { class: 'pill-count' }),
        ),
      ),
    );
    this.sizes = h(
      'div',
      { class: 'pills', role: 'group', 'aria-label': 'Size of pictures' },
      Object.keys(SIZES).map((name) =>
        h('button', {
          type: 'button',
          'aria-label': `${name} pictures`,
          title: `${name} pictures`,
          'data-size': name,
          testid: `size-${name}`,
          text: name[0].toUpperCase(),
          onclick: () => this.resize(name),
        }),
      ),
    );
    this.jump = h('input', {
      type: 'number',
      class: 'jump',
      placeholder: 'Frame',
      'aria-label': 'Go to frame',
      testid: 'jump',
      onchange: () => this.goTo(Number(this.jump.value)),
    });
    this.map = new FrameMap(state, (number) => this.goTo(number));
    this.grid = h('div', {
      class: 'frames',
      role: 'list',
      'aria-label': 'Frames',
      testid: 'frames',
      onkeydown: (event) => this.key(event),
    });
    this.nothing = h('p', { class: 'soft pad' });
    this.tools = h('div', { class: 'filters' }, this.pills, h('span', { class: 'spring' }), this.jump, this.sizes);
    this.node = h('div', { class: 'frames-tab' }, this.tools, this.map.node, this.grid, this.nothing);
    this.draw = oncePerFrame(() => this.layout());
    addEventListener('scroll', this.draw, { passive: true });
    addEventListener('resize', this.draw);
    // What is above may grow and shrink: then others are on the screen.
    this.moved = new ResizeObserver(this.draw);
    this.moved.observe(document.body);
    this.update(null);
  }

  /** Shows the frame that was looked at last, with the focus; false where none was. */
  atPlace() {
    const frame = takePlace(this.state.id);
    const index = frame === null ? -1 : this.list.indexOf(frame);
    if (index < 0 || this.list.length < 2) return false;
    this.focusOn(index);
    return true;
  }

  leave() {
    this.draw.cancel();
    this.moved.disconnect();
    this.map.leave();
    removeEventListener('scroll', this.draw);
    removeEventListener('resize', this.draw);
    this.thumbs.leave();
  }

  resize(name) {
    this.size = name;
    remember('thumbs', name);
    for (const cell of this.cells.values()) this.thumbs.drop(cell);
    this.draw();
  }

  /** Frames have changed: `changed` their numbers, null for all. */
  update(changed) {
    if (changed === null || this.filter !== '' || this.list.length !== this.state.numbers.length) this.refilter();
    this.count();
    this.draw();
    this.map.draw();
  }

  refilter() {
    const { frames, numbers } = this.state;
    this.list = this.filter === '' ? numbers : numbers.filter((number) => fits(frames.get(number), this.filter));
  }

  count() {
    const counts = { '': 0, doubtful: 0, rendering: 0, finishing: 0, waiting: 0, done: 0, failed: 0 };
    for (const frame of this.state.frames.values()) {
      ++counts[''];
      if (frame.doubtful) ++counts.doubtful;
      counts[frame.state] += 1;
    }
    for (const pill of this.pills.children) {
      const { filter } = pill.dataset;
      pill.hidden = filter !== '' && filter !== this.filter && counts[filter] === 0;
      setText(pill.lastChild, whole(counts[filter]));
      setAttribute(pill, 'aria-pressed', filter === this.filter);
    }
    for (const pill of this.sizes.children) setAttribute(pill, 'aria-pressed', pill.dataset.size === this.size);
    const one = this.state.numbers.length <= 1;
    this.tools.hidden = one;
    this.map.node.hidden = this.state.numbers.length < 40;
    this.jump.hidden = this.state.numbers.length < 40;
    setText(
      this.nothing,
      this.list.length > 0
        ? ''
        : this.state.numbers.length > 0
          ? 'No frame is like that.'
          : this.state.job
            ? ''
            : 'Asking the coordinator…',
    );
  }

  measure() {
    const width = this.grid.clientWidth;
    const many = this.list.length;
    // Few frames have much room each.
    const wish =
      many === 1
        ? Math.min(width, 960, (innerHeight * 0.62) / this.aspect)
        : many <= FEW && this.size === 'medium'
          ? 340
          : Math.min(SIZES[this.size], Math.max(96, (width - GAP) / 2 - GAP));
    const columns = many === 1 ? 1 : Math.max(1, Math.floor((width + GAP) / (wish + GAP)));
    const cellWidth =
      many === 1 ? wish : Math.min((width - GAP * (columns - 1)) / columns, many <= columns ? wish * 1.25 : Infinity);
    const rowHeight = Math.round(cellWidth * this.aspect) + CAPTION + GAP;
    return { columns, cellWidth, rowHeight, rows: Math.ceil(many / columns) };
  }

  layout() {
    if (!this.grid.isConnected || this.grid.clientWidth === 0) return;
    const shape = this.measure();
    this.shape = shape;
    const full = shape.rows * shape.rowHeight;
    const height = Math.min(full, TALLEST);
    this.grid.style.height = `${height}px`;
    const above = Math.max(0, -this.grid.getBoundingClientRect().top);
    // Where the grid is taller than browsers know, the place in it is a fraction of the way.
    const gear = full > height ? (full - innerHeight) / Math.max(1, height - innerHeight) : 1;
    const shift = above * gear - above;
    const top = above + shift;
    const from = Math.max(0, Math.floor((top - shape.rowHeight) / shape.rowHeight)) * shape.columns;
    const until = Math.min(
      this.list.length,
      Math.ceil((top + innerHeight + shape.rowHeight) / shape.rowHeight) * shape.columns,
    );
    const wanted = new Set(this.list.slice(from, until));
    if (this.active === null || !this.state.frames.has(this.active)) this.active = this.list[0] ?? null;
    for (const [number, cell] of this.cells) {
      if (wanted.has(number) || cell.link === document.activeElement) continue;
      this.thumbs.drop(cell);
      cell.node.remove();
      this.cells.delete(number);
      this.spare.push(cell);
    }
    const width = [240, 480, 960, 1920].find((w) => w >= shape.cellWidth * Math.min(2, devicePixelRatio) * 0.8) ?? 1920;
    for (let i = from; i < until; ++i) {
      const number = this.list[i];
      let cell = this.cells.get(number);
      if (!cell) {
        cell = this.spare.pop() ?? this.make();
        this.cells.set(number, cell);
        this.grid.append(cell.node);
      }
      const x = (i % shape.columns) * (shape.cellWidth + GAP);
      const y = Math.floor(i / shape.columns) * shape.rowHeight - shift;
      cell.node.style.transform = `translate(${x}px, ${y}px)`;
      cell.node.style.width = `${shape.cellWidth}px`;
      cell.node.style.height = `${shape.rowHeight - GAP}px`;
      this.fill(cell, this.state.frames.get(number), i, width);
    }
    if (this.spare.length > 300) this.spare.length = 300;
  }

  make() {
    const image = h('img', { alt: '', decoding: 'async', draggable: 'false' });
    const name = h('span', {});
    const spoken = h('span', { class: 'frame-name' }, h('span', { class: 'unseen', text: 'Frame ' }), name);
    const note = h('span', { class: 'frame-note' });
    const mark = chip('waiting');
    const line = h('i', { class: 'frame-line' });
    const empty = h('span', { class: 'frame-empty', 'aria-hidden': 'true' });
    const link = h(
      'a',
      {
        class: 'frame',
        testid: 'frame',
        onfocus: () => {
          this.active = cell.number;
          this.roving();
        },
      },
      h('span', { class: 'frame-picture' }, image, empty, line),
      h('span', { class: 'frame-caption' }, spoken, mark, note),
    );
    const node = h('div', { class: 'frame-cell', role: 'listitem' }, link);
    const cell = { node, link, image, name, note, mark, line, empty, frame: null };
    return cell;
  }

  fill(cell, frame, index, width) {
    setAttribute(cell.link, 'tabindex', frame.id === this.active ? 0 : -1);
    setAttribute(cell.node, 'aria-posinset', index + 1);
    setAttribute(cell.node, 'aria-setsize', this.list.length);
    if (cell.frame !== frame || cell.width !== width) {
      if (cell.number !== frame.id) {
        cell.number = frame.id;
        cell.link.href = to('frame', { job: this.state.id, frame: frame.id });
        cell.link.dataset.frame = frame.id;
        setText(cell.name, frame.id);
      }
      cell.frame = frame;
      cell.width = width;
      const part = frameShare(frame);
      cell.link.dataset.state = frame.state;
      cell.mark.set(frame.doubtful ? 'doubtful' : frame.state);
      setText(
        cell.note,
        frame.state === 'rendering'
          ? percent(part)
          : frame.doubtful
            ? 'in doubt'
            : frame.state === 'finishing'
              ? 'finishing'
              : frame.state === 'failed'
                ? 'failed'
                : frame.black
                  ? 'black'
                  : '',
      );
      cell.line.style.transform = `scaleX(${part})`;
      // Of few frames, each is told; of many, the mark says it.
      setAttribute(cell.empty, 'data-text', this.list.length <= FEW ? (EMPTY[frame.state] ?? '') : '');
      cell.link.title =
        frame.reason ||
        (frame.black ? 'black all over: no light reaches what the camera sees' : '') ||
        (frame.worker_class
          ? `${frame.state}, class ${brief(frame.worker_class)}${frame.restarts ? `, begun anew ${counted(frame.restarts, 'time')}` : ''}`
          : '');
    }
    this.thumbs.want(cell, { job: this.state.id, frame, width, show: (url, picture) => this.show(cell, url, picture) });
  }

  show(cell, url, picture) {
    if (url === null) {
      cell.image.removeAttribute('src');
      return;
    }
    cell.image.src = url;
    const aspect = picture.height / picture.width;
    if (Math.abs(aspect - this.aspect) > 0.01 && aspect > 0.1 && aspect < 4) {
      this.aspect = aspect;
      this.draw();
    }
  }

  roving() {
    for (const cell of this.cells.values()) setAttribute(cell.link, 'tabindex', cell.number === this.active ? 0 : -1);
  }

  key(event) {
    const at = this.list.indexOf(this.active);
    const { columns, rowHeight } = this.shape;
    const page = columns * Math.max(1, Math.floor(innerHeight / rowHeight) - 1);
    const step = {
      ArrowRight: 1,
      ArrowLeft: -1,
      ArrowDown: columns,
      ArrowUp: -columns,
      PageDown: page,
      PageUp: -page,
      Home: -at,
      End: this.list.length - 1 - at,
    }[event.key];
    if (step === undefined || at < 0) return;
    event.preventDefault();
    const next = at + step;
    if (next < 0 || next >= this.list.length) return;
    this.focusOn(next);
  }

  /** Moves the focus by so many frames; into the grid where it is elsewhere. */
  step(by) {
    const at = Math.max(0, this.list.indexOf(this.active));
    const inside = this.grid.contains(document.activeElement);
    const next = inside ? Math.min(this.list.length - 1, Math.max(0, at + by)) : at;
    if (next < this.list.length) this.focusOn(next);
  }

  focusOn(index) {
    this.layout();
    this.reveal(index);
    this.active = this.list[index];
    this.layout();
    this.cells.get(this.active)?.link.focus({ preventScroll: true });
  }

  reveal(index) {
    const { columns, rowHeight, rows } = this.shape ?? this.measure();
    const full = rows * rowHeight;
    const box = this.grid.getBoundingClientRect();
    const gear = full > TALLEST ? (TALLEST - innerHeight) / (full - innerHeight) : 1;
    const y = box.top + Math.floor(index / columns) * rowHeight * gear;
    if (y < 110) scrollBy(0, y - 110);
    else if (y + rowHeight > innerHeight - 60) scrollBy(0, y + rowHeight - innerHeight + 60);
  }

  /** Shows a frame by its number, or the next one that there is. */
  goTo(number) {
    if (!Number.isFinite(number) || this.list.length === 0) return;
    let index = this.list.findIndex((other) => other >= number);
    if (index < 0) index = this.list.length - 1;
    this.focusOn(index);
  }
}
