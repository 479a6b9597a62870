// The workers as stars of the Hyades: size by threads, light by speed, colour by state. Shows at a glance what the table says.
import { calm, color, onTheme } from './theme.js';
import { h, oncePerFrame, setText } from './dom.js';
import { rateInWords } from './format.js';

/** Right ascension and declination of the brightest members, degrees (J2000; epsilon, theta, delta, gamma Tauri and so on). */
const MEMBERS = [
  [67.154, 19.18],
  [67.166, 15.871],
  [64.948, 15.628],
  [65.734, 17.543],
  [66.372, 17.928],
  [68.462, 14.844],
  [69.788, 15.8],
  [67.209, 13.048],
  [66.587, 15.618],
  [67.965, 15.852],
  [65.151, 15.096],
  [65.514, 14.077],
  [65.855, 16.777],
  [66.024, 17.444],
  [67.11, 16.36],
  [67.535, 15.638],
  [67.656, 15.692],
  [67.655, 13.724],
  [64.99, 14.035],
  [69.539, 12.511],
  [67.144, 15.962],
  [69.819, 15.918],
];
/** The V as it is drawn in atlases: epsilon, delta 3, delta 1, gamma, theta, Aldebaran. */
const FIGURE = [
  [67.154, 19.18],
  [66.372, 17.928],
  [65.734, 17.543],
  [64.948, 15.628],
  [67.15, 15.9],
  [68.98, 16.509],
];
const CENTRE = [67, 16.9];

function random(seed) {
  let state = (seed * 2654435761) >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// The same colour, seen through: canvases mix 'transparent' as black.
const clear = (css) => (css.startsWith('#') ? `${css.slice(0, 7)}00` : css.replace(/rgba?\(([^)]+)\)/, 'rgba($1, 0)'));

/** Where the star of worker `index` stands, degrees; those after the members scatter around the cluster's centre. */
export function placeOf(index) {
  if (index < MEMBERS.length) return MEMBERS[index];
  const next = random(index + 7);
  const far = 1.1 + 3.6 * Math.sqrt(-Math.log(1 - 0.95 * next()));
  const angle = next() * 2 * Math.PI;
  return [CENTRE[0] + far * Math.cos(angle) * 1.15, CENTRE[1] + far * Math.sin(angle) * 0.55];
}

/** The map; `draw(workers, speedOf)`; `choose(worker)` when one is clicked. */
export function starMap(choose) {
  const canvas = h('canvas', { class: 'sky', role: 'img', testid: 'sky' });
  const tip = h('div', { class: 'sky-tip', hidden: true });
  const node = h('div', { class: 'sky-box' }, canvas, tip);
  let workers = [];
  let speedOf = () => 0;
  let stars = [];
  let palette = null;
  const lit = new Map();
  let timer = 0;

  const paint = oncePerFrame(() => {
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (width === 0) return;
    const dense = devicePixelRatio;
    canvas.width = Math.round(width * dense);
    canvas.height = Math.round(height * dense);
    const pen = canvas.getContext('2d');
    pen.scale(dense, dense);
    palette ??= {
      active: color('--star'),
      draining: color('--warm'),
      quarantined: color('--red'),
      gone: color('--faint'),
      line: color('--line'),
      dust: color('--line-strong'),
    };
    const scale = Math.min(width / 7.5, height / 7.4);
    // East is left, as in the sky.
    const put = ([ra, dec]) => [
      width / 2 - (ra - CENTRE[0]) * scale * 1.5,
      height / 2 - (dec - CENTRE[1] + 0.75) * scale,
    ];
    const next = random(5);
    pen.fillStyle = palette.dust;
    for (let i = 0; i < width / 6; ++i) {
      pen.globalAlpha = 0.1 + 0.3 * next();
      const r = 0.4 + 0.5 * next();
      pen.fillRect(next() * width, next() * height, r, r);
    }
    // Members that no worker has taken yet.
    for (const member of MEMBERS.slice(workers.length)) {
      pen.globalAlpha = 0.5;
      pen.beginPath();
      pen.arc(...put(member), 1.1, 0, 7);
      pen.fill();
    }
    pen.globalAlpha = 1;
    pen.strokeStyle = palette.line;
    pen.lineWidth = 1.2;
    pen.beginPath();
    FIGURE.forEach((point, i) => pen[i === 0 ? 'moveTo' : 'lineTo'](...put(point)));
    pen.stroke();
    const fastest = Math.max(1, ...workers.map(speedOf));
    const now = performance.now();
    let again = false;
    stars = workers.map((worker, i) => {
      const [x, y] = put(placeOf(i));
      const working = worker.state === 'active' || worker.state === 'draining';
      const r = 1.8 + 0.55 * Math.log2(1 + worker.threads);
      pen.fillStyle = pen.strokeStyle = palette[worker.state] ?? palette.gone;
      if (working) {
        // A star that has just delivered is brighter for a moment.
        const since = (now - (lit.get(worker.id)?.at ?? -1e9)) / 900;
        const flash = since < 1 && !calm() ? 1 - since : 0;
        again ||= flash > 0;
        const light = 0.25 + 0.75 * (speedOf(worker) / fastest);
        const glow = pen.createRadialGradient(x, y, 0, x, y, r * (3 + 1.4 * flash));
        glow.addColorStop(0, pen.fillStyle);
        glow.addColorStop(1, clear(pen.fillStyle));
        pen.globalAlpha = 0.34 * light + 0.25 * flash;
        pen.fillStyle = glow;
        pen.beginPath();
        pen.arc(x, y, r * (3 + 1.4 * flash), 0, 7);
        pen.fill();
        pen.globalAlpha = 0.45 + 0.55 * light;
        pen.fillStyle = palette[worker.state];
        pen.beginPath();
        pen.arc(x, y, r, 0, 7);
        pen.fill();
      } else {
        pen.lineWidth = 1.5;
        pen.beginPath();
        pen.arc(x, y, r, 0, 7);
        if (worker.state === 'quarantined') {
          pen.moveTo(x - r * 0.6, y - r * 0.6);
          pen.lineTo(x + r * 0.6, y + r * 0.6);
        }
        pen.stroke();
      }
      pen.globalAlpha = 1;
      return { worker, x, y, r };
    });
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
    setText(
      tip,
      `${worker.name} · ${worker.state === 'active' ? rateInWords(speedOf(worker)) : worker.state} · ${worker.threads} threads`,
    );
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
  const leaveTheme = onTheme(() => {
    palette = null;
    paint();
  });

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
      leaveTheme();
    },
  };
}
