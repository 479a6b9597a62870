// How long each tile of the picture took: where the light is hard.
import { h, setText } from './dom.js';
import { byTile } from './units.js';
import { counted } from './format.js';
import { heat } from './tone.js';

const TALLEST = 300;
const MOST_FRAMES = 500;

/** `take(units)`: as the API gives them. */
export class TileMap {
  constructor() {
    this.units = [];
    this.canvas = h('canvas', { role: 'img', 'aria-label': 'Time by tile of the picture', testid: 'tiles' });
    this.text = h('p', { class: 'soft' });
    this.frame = h('select', { 'aria-label': 'Tiles of', testid: 'tile-frame', onchange: () => this.draw() });
    const head = [h('h2', { text: 'Time by tile' }), h('span', { class: 'spring' }), this.frame];
    const box = h('div', { class: 'box-head' }, head);
    this.node = h('section', { class: 'panel-box tile-box' }, box, this.canvas, this.text);
    this.resized = new ResizeObserver(() => this.draw());
    this.resized.observe(this.node);
  }

  take(units) {
    this.units = units;
    const frames = [...new Set(units.map(({ frame }) => frame))].sort((a, b) => a - b);
    if (this.frames !== frames.join()) {
      this.frames = frames.join();
      const now = this.frame.value;
      const option = (frame) => h('option', { value: frame, text: `frame ${frame}` });
      const all = h('option', { value: '', text: 'all frames' });
      this.frame.replaceChildren(all, ...frames.slice(-MOST_FRAMES).map(option));
      this.frame.value = now !== '' && frames.includes(Number(now)) ? now : '';
    }
    this.draw();
  }

  draw() {
    const frame = this.frame.value;
    const tiles = byTile(frame === '' ? this.units : this.units.filter((unit) => unit.frame === Number(frame)));
    const room = this.node.clientWidth - 30;
    if (room <= 0 || tiles.length === 0) return;
    const right = Math.max(...tiles.map(({ tile }) => tile[2]));
    const bottom = Math.max(...tiles.map(({ tile }) => tile[3]));
    const scale = Math.min(room / right, TALLEST / bottom);
    const dense = devicePixelRatio;
    Object.assign(this.canvas.style, { width: `${right * scale}px`, height: `${bottom * scale}px` });
    this.canvas.width = Math.round(right * scale * dense);
    this.canvas.height = Math.round(bottom * scale * dense);
    const pen = this.canvas.getContext('2d');
    pen.scale(scale * dense, scale * dense);
    const times = tiles.map(({ seconds, batches }) => seconds / Math.max(1, batches));
    const most = Math.max(...times);
    tiles.forEach(({ tile: [x0, y0, x1, y1] }, i) => {
      pen.fillStyle = `rgb(${heat((0.9 * times[i]) / most).map((c) => Math.round(c * 255))})`;
      pen.fillRect(x0, y0, x1 - x0 - 0.5 / scale, y1 - y0 - 0.5 / scale);
    });
    const mean = times.reduce((a, b) => a + b, 0) / times.length;
    const text = `per batch ${mean.toFixed(2)} s on average, ${most.toFixed(2)} s at most`;
    setText(this.text, `${counted(tiles.length, 'tile')}; ${text}`);
  }

  leave() {
    this.resized.disconnect();
  }
}
