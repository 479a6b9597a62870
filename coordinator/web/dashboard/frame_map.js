// All frames of a job at a glance: a square each, as large as fits in a strip. The grid below tells screen readers the same.
import { color, onTheme } from './theme.js';
import { h, oncePerFrame } from './dom.js';
import { frameShare } from './job_state.js';

const LARGEST = 14;
/** The strip's height, pixels, as long as squares of 3 pixels fit in it; and beyond that. */
const STRIP = 84;
const TALLEST = 240;
const COLORS = {
  waiting: '--map-waiting',
  rendering: '--warm',
  finishing: '--teal',
  done: '--map-done',
  failed: '--red',
  doubtful: '--violet',
  unknown: '--map-waiting',
};

/** The map of `state` (job_state.js); `goTo(number)` when a frame is clicked. */
export class FrameMap {
  constructor(state, goTo) {
    this.state = state;
    this.goTo = goTo;
    this.node = h('canvas', {
      class: 'frame-map',
      'aria-hidden': 'true',
      title: 'All frames; click to go there',
      testid: 'frame-map',
      onclick: (event) => this.click(event),
    });
    this.draw = oncePerFrame(() => this.paint());
    addEventListener('resize', this.draw);
    this.leaveTheme = onTheme(() => {
      this.colors = null;
      this.draw();
    });
  }

  leave() {
    this.draw.cancel();
    removeEventListener('resize', this.draw);
    this.leaveTheme();
  }

  click(event) {
    const { columns, size, numbers } = this.shape;
    const box = this.node.getBoundingClientRect();
    const row = Math.floor((event.clientY - box.top) / size);
    const index = row * columns + Math.floor((event.clientX - box.left) / size);
    if (index < numbers.length) this.goTo(numbers[index]);
  }

  paint() {
    const { node } = this;
    if (node.hidden || !node.isConnected) return;
    const { frames, numbers } = this.state;
    const width = node.parentNode.clientWidth;
    let size = LARGEST;
    while (size > 3 && Math.ceil(numbers.length / Math.floor(width / size)) * size > STRIP) --size;
    const columns = Math.max(1, Math.floor(width / size));
    const height = Math.min(TALLEST, Math.ceil(numbers.length / columns) * size);
    const dense = devicePixelRatio;
    this.shape = { columns, size, numbers };
    if (node.width !== Math.round(width * dense) || node.height !== Math.round(height * dense)) {
      node.width = Math.round(width * dense);
      node.height = Math.round(height * dense);
      node.style.height = `${height}px`;
    }
    this.colors ??= Object.fromEntries(Object.entries(COLORS).map(([state, name]) => [state, color(name)]));
    const pen = node.getContext('2d');
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.clearRect(0, 0, width, height);
    const inner = size > 5 ? size - 1.5 : size - 0.75;
    numbers.forEach((number, i) => {
      const frame = frames.get(number);
      const x = (i % columns) * size;
      const y = Math.floor(i / columns) * size;
      pen.fillStyle = this.colors[frame.doubtful ? 'doubtful' : frame.state === 'rendering' ? 'waiting' : frame.state];
      pen.fillRect(x, y, inner, inner);
      if (frame.state !== 'rendering') return;
      const part = Math.max(0.2, frameShare(frame));
      pen.fillStyle = this.colors.rendering;
      pen.fillRect(x, y + inner * (1 - part), inner, inner * part);
    });
  }
}
