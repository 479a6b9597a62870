// The workers as stars of the Hyades: size by threads, light by speed, colour by state. Shows at a glance what the table says.
import { FIGURE, GIANT, placeOf, random, skyMap, unclaimed } from './star_places.js';
import { h, oncePerFrame, setText } from './dom.js';
import { calm } from './theme.js';
import { counted, rateInWords } from './format.js';

/** It is night on this map in light themes too. */
const PALETTE = {
  active: '#cfdcff',
  draining: '#ffb65c',
  quarantined: '#ff7d87',
  gone: '#7c88a2',
  line: '#33405f',
  dust: '#8f9dbd',
  giant: '#ffa94d',
  name: '#b6c2dc',
};
/** With more workers their names would be a thicket. */
const MOST_NAMED = 24;
const FLASH_MS = 900;

const disc = (pen, x, y, r) => {
  pen.beginPath();
  pen.arc(x, y, r, 0, 7);
};

function halo(pen, x, y, r, colour, strength) {
  const glow = pen.createRadialGradient(x, y, 0, x, y, r);
  glow.addColorStop(0, colour);
  glow.addColorStop(0.35, `${colour}66`);
  glow.addColorStop(1, `${colour}00`);
  pen.globalAlpha = strength;
  pen.fillStyle = glow;
  disc(pen, x, y, r);
  pen.fill();
  pen.globalAlpha = 1;
}

function drawDust(pen, width, height) {
  const next = random(5);
  pen.fillStyle = PALETTE.dust;
  for (let i = 0; i < (width * height) / 700; ++i) {
    pen.globalAlpha = 0.08 + 0.34 * next() ** 3;
    disc(pen, next() * width, next() * height, 0.3 + 0.6 * next());
    pen.fill();
  }
  pen.globalAlpha = 1;
}

function drawFigure(pen, put, count) {
  pen.strokeStyle = PALETTE.line;
  pen.lineWidth = 1.2;
  pen.beginPath();
  FIGURE.forEach((place, i) => pen[i === 0 ? 'moveTo' : 'lineTo'](...put(place)));
  pen.stroke();
  pen.fillStyle = PALETTE.dust;
  for (const place of unclaimed(count)) {
    disc(pen, ...put(place), 1.2);
    pen.fill();
  }
  const [x, y] = put(GIANT);
  halo(pen, x, y, 16, PALETTE.giant, 0.4);
  pen.fillStyle = PALETTE.giant;
  disc(pen, x, y, 3.4);
  pen.fill();
}

/** `light` 0..1, `flash` 1..0 after it has delivered. */
function drawStar(pen, { x, y, r, worker }, light, flash) {
  const colour = PALETTE[worker.state] ?? PALETTE.gone;
  if (worker.state === 'active' || worker.state === 'draining') {
    halo(pen, x, y, r * (4 + 2 * flash), colour, 0.35 + 0.4 * light + 0.25 * flash);
    pen.fillStyle = colour;
    pen.globalAlpha = 0.6 + 0.4 * light;
    disc(pen, x, y, r);
    pen.fill();
    pen.globalAlpha = 1;
    return;
  }
  pen.strokeStyle = colour;
  pen.lineWidth = 1.5;
  disc(pen, x, y, r);
  if (worker.state === 'quarantined') {
    pen.moveTo(x - r * 0.6, y - r * 0.6);
    pen.lineTo(x + r * 0.6, y + r * 0.6);
  }
  pen.stroke();
}

// Beside their stars, where there is room: a name that would lie over another one is left to the pointer.
function drawNames(pen, stars, width) {
  const taken = stars.map(({ x, y, r }) => [x - r, y - r, x + r, y + r]);
  const free = (box) =>
    taken.every((other) => box[0] > other[2] || box[2] < other[0] || box[1] > other[3] || box[3] < other[1]);
  pen.font = '12px system-ui, sans-serif';
  pen.fillStyle = PALETTE.name;
  pen.textBaseline = 'middle';
  for (const { x, y, r, worker } of stars) {
    const long = pen.measureText(worker.name).width;
    const left = [x + r + 7, x - r - 7 - long].find(
      (at) => at > 4 && at + long < width - 4 && free([at, y - 7, at + long, y + 7]),
    );
    if (left === undefined) continue;
    taken.push([left, y - 7, left + long, y + 7]);
    pen.fillText(worker.name, left, y);
  }
}

/** The map; `draw(workers, speedOf)`; `choose(worker)` when one is clicked. */
export function starMap(choose) {
  const canvas = h('canvas', { class: 'sky', role: 'img', testid: 'sky' });
  const tip = h('div', { class: 'sky-tip', hidden: true });
  const node = h('div', { class: 'sky-box' }, canvas, tip);
  let workers = [];
  let speedOf = () => 0;
  let stars = [];
  const lit = new Map();
  let timer = 0;

  const paint = oncePerFrame(() => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0) return;
    const dense = devicePixelRatio;
    Object.assign(canvas, { width: Math.round(width * dense), height: Math.round(height * dense) });
    const pen = canvas.getContext('2d');
    pen.scale(dense, dense);
    const put = skyMap(workers.length, width, height);
    drawDust(pen, width, height);
    drawFigure(pen, put, workers.length);
    const fastest = Math.max(1, ...workers.map(speedOf));
    const now = performance.now();
    const size = workers.length > 60 ? 0.7 : 1;
    stars = workers.map((worker, i) => {
      const [x, y] = put(placeOf(i));
      return { worker, x, y, r: size * (2.4 + 0.6 * Math.log2(1 + worker.threads)) };
    });
    let again = false;
    for (const star of stars) {
      // A star that has just delivered is brighter for a moment.
      const since = (now - (lit.get(star.worker.id)?.at ?? -1e9)) / FLASH_MS;
      const flash = since < 1 && !calm() ? 1 - since : 0;
      again ||= flash > 0;
      drawStar(pen, star, speedOf(star.worker) / fastest, flash);
    }
    if (workers.length <= MOST_NAMED) drawNames(pen, stars, width);
    clearTimeout(timer);
    if (again) timer = setTimeout(paint, 60);
  });

  const nearest = (event) => {
    const box = canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    let best = null;
    for (const star of stars) {
      const far = Math.hypot(star.x - x, star.y - y);
      if (far < Math.max(14, star.r * 2) && (!best || far < best.far)) best = { ...star, far };
    }
    return best;
  };
  canvas.addEventListener('pointermove', (event) => {
    const star = nearest(event);
    tip.hidden = !star;
    canvas.style.cursor = star ? 'pointer' : '';
    if (!star) return;
    const { worker } = star;
    const does = worker.state === 'active' ? rateInWords(speedOf(worker)) : worker.state;
    setText(tip, `${worker.name} · ${does} · ${counted(worker.threads, 'thread')}`);
    tip.style.left = `${Math.max(4, Math.min(star.x + 10, canvas.clientWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${star.y > 40 ? star.y - 34 : star.y + 12}px`;
  });
  canvas.addEventListener('pointerleave', () => {
    tip.hidden = true;
  });
  canvas.addEventListener('click', (event) => {
    const star = nearest(event);
    if (star) choose(star.worker);
  });
  const resized = new ResizeObserver(paint);
  resized.observe(canvas);

  return {
    node,
    draw(all, speed) {
      workers = [...all].sort((a, b) => a.joined_ms - b.joined_ms || a.id - b.id);
      speedOf = speed;
      const at = performance.now();
      for (const worker of workers) {
        const before = lit.get(worker.id);
        if (!before || before.done !== worker.units_done)
          lit.set(worker.id, { done: worker.units_done, at: before ? at : -1e9 });
      }
      canvas.setAttribute(
        'aria-label',
        `Workers as stars: ${workers.filter((w) => w.state === 'active').length} active of ${workers.length}. The table of workers says the same.`,
      );
      paint();
    },
    leave() {
      clearTimeout(timer);
      paint.cancel();
      resized.disconnect();
    },
  };
}
