// Throughput over time: one curve, its scale, and the value under the pointer.
import { s, setText } from './dom.js';
import { clock, duration, rate, rateInWords } from './format.js';

const HEIGHT = 210;
const LEFT = 118;
const RIGHT = 14;
const TOP = 12;
const BOTTOM = 24;
const STEP_SECONDS = 5;

/** The next round number above, whose half is round too. */
export function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  for (const step of [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8]) if (value <= step * power * 1.0000001) return step * power;
  return 10 * power;
}

/** A chart; `draw(values, end)`: values every 5 s, the last one at `end` (milliseconds). */
export function flowChart() {
  const svg = s('svg', { class: 'flow', role: 'img', 'aria-label': 'Samples per second over time', height: HEIGHT });
  const grid = s('g');
  const area = s('path', { class: 'area' });
  const curve = s('path', { class: 'curve' });
  const cursor = s('line', { class: 'cursor', y1: TOP, y2: HEIGHT - BOTTOM, visibility: 'hidden' });
  const spot = s('circle', { class: 'spot', r: 4, visibility: 'hidden' });
  const label = s('text', { y: TOP + 10, visibility: 'hidden' });
  svg.append(grid, area, curve, cursor, spot, label);
  let shape = null;
  let last = null;

  const draw = (values, end) => {
    last = [values, end];
    const width = svg.clientWidth;
    if (width === 0) return;
    const inner = width - LEFT - RIGHT;
    const count = Math.max(60, values.length);
    const top = roundUp(Math.max(...values, 1) * 1.02);
    const x = (i) => LEFT + (inner * (i + count - values.length)) / (count - 1);
    const y = (value) => TOP + (HEIGHT - TOP - BOTTOM) * (1 - value / top);
    shape = { x, y, values, end, count, inner, width };
    const points = values.map((value, i) => `${x(i).toFixed(1)},${y(value).toFixed(1)}`);
    curve.setAttribute('d', points.length > 1 ? `M${points.join('L')}` : '');
    area.setAttribute(
      'd',
      points.length > 1 ? `M${x(0)},${y(0)}L${points.join('L')}L${x(values.length - 1)},${y(0)}Z` : '',
    );
    const lines = [];
    for (let i = 0; i <= (values.some((value) => value > 0) ? 2 : 0); ++i) {
      const value = (top * i) / 2;
      lines.push(
        s('line', { class: 'grid', x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) }),
        s('text', { x: LEFT - 8, y: y(value) + 4, 'text-anchor': 'end' }, value === 0 ? '0' : rate(value)),
      );
    }
    const minutes = (count * STEP_SECONDS) / 60;
    const step = [1, 2, 5, 10, 15, 20].find((m) => minutes / m <= Math.max(2, inner / 110)) ?? 30;
    for (let m = 0; m <= minutes; m += step) {
      const at = width - RIGHT - (inner * m * 60) / STEP_SECONDS / (count - 1);
      if (at < LEFT) break;
      lines.push(
        s('text', { x: at, y: HEIGHT - 6, 'text-anchor': m === 0 ? 'end' : 'middle' }, m === 0 ? 'now' : `${m} min`),
      );
    }
    grid.replaceChildren(...lines);
    svg.setAttribute(
      'aria-label',
      values.length > 0
        ? `Samples per second over the last ${duration(values.length * STEP_SECONDS)}: now ${rateInWords(values[values.length - 1])}, highest ${rateInWords(Math.max(...values))}`
        : 'Samples per second: nothing yet',
    );
  };
  const point = (event) => {
    if (!shape || shape.values.length < 2) return;
    const { values, x, y, count, inner, end, width } = shape;
    const at = event.clientX - svg.getBoundingClientRect().left;
    const i = Math.round(((at - LEFT) / inner) * (count - 1)) - (count - values.length);
    const on = i >= 0 && i < values.length;
    for (const node of [cursor, spot, label]) node.setAttribute('visibility', on ? 'visible' : 'hidden');
    if (!on) return;
    cursor.setAttribute('x1', x(i));
    cursor.setAttribute('x2', x(i));
    spot.setAttribute('cx', x(i));
    spot.setAttribute('cy', y(values[i]));
    const right = x(i) > width / 2;
    label.setAttribute('x', x(i) + (right ? -8 : 8));
    label.setAttribute('text-anchor', right ? 'end' : 'start');
    setText(label, `${rate(values[i])} at ${clock(end - (values.length - 1 - i) * STEP_SECONDS * 1000)}`);
  };
  svg.addEventListener('pointermove', point);
  svg.addEventListener('pointerleave', () =>
    [cursor, spot, label].forEach((node) => node.setAttribute('visibility', 'hidden')),
  );
  const resized = new ResizeObserver(() => last && draw(...last));
  resized.observe(svg);
  return { node: svg, draw, leave: () => resized.disconnect() };
}
