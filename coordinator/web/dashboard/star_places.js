// Where the stars of the Hyades stand, and which part of the sky is shown.

/** Right ascension and declination of the brightest members, degrees (J2000; theta, gamma, epsilon, delta Tauri and so on). */
const MEMBERS = [
  [67.166, 15.871],
  [64.948, 15.628],
  [67.154, 19.18],
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

/** Aldebaran, which is no member and only stands before them. */
export const GIANT = [68.98, 16.509];

/** The V as it is drawn in atlases: epsilon, delta 3, delta 1, gamma, theta, Aldebaran. */
export const FIGURE = [MEMBERS[2], MEMBERS[4], MEMBERS[3], MEMBERS[1], MEMBERS[0], GIANT];

/** Degrees of declination are that much longer on the map than those of right ascension would be. */
const STRETCH = 1.35;
const CENTRE = [67, 16.9];

/** Numbers 0..1 that are the same for the same seed. */
export function random(seed) {
  let state = (seed * 2654435761) >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Where the star of worker `index` stands, degrees; those after the members scatter around the cluster's centre. */
export function placeOf(index) {
  if (index < MEMBERS.length) return MEMBERS[index];
  const next = random(index + 7);
  const far = 1.1 + 3.6 * Math.sqrt(-Math.log(1 - 0.95 * next()));
  const angle = next() * 2 * Math.PI;
  return [CENTRE[0] + far * Math.cos(angle) * 1.15, CENTRE[1] + far * Math.sin(angle) * 0.55];
}

/** Members that no worker has taken, of `count` workers. */
export const unclaimed = (count) => MEMBERS.slice(count);

/** Pixels that stay free around the stars: above for a title, at the sides for names. */
const MARGIN = { top: 52, bottom: 24, side: 72 };

/**
 * How the sky of `count` workers lies on a map of width x height: the V and all workers' stars fill it, but for the margins. Returns
 * put([ra, dec]) -> [x, y]; east is left, as in the sky.
 */
export function skyMap(count, width, height) {
  const shown = [...FIGURE];
  for (let i = 0; i < count; ++i) shown.push(placeOf(i));
  const span = (k) => {
    const all = shown.map((place) => place[k]);
    return [Math.min(...all), Math.max(...all)];
  };
  const [east, north] = [span(0), span(1)];
  const wide = (east[1] - east[0]) * STRETCH;
  const high = north[1] - north[0];
  const room = [width - 2 * MARGIN.side, height - MARGIN.top - MARGIN.bottom];
  const scale = Math.max(1, Math.min(room[0] / wide, room[1] / high));
  const centre = [width / 2, MARGIN.top + room[1] / 2];
  const middle = [(east[0] + east[1]) / 2, (north[0] + north[1]) / 2];
  return ([ra, dec]) => [centre[0] - (ra - middle[0]) * STRETCH * scale, centre[1] - (dec - middle[1]) * scale];
}
