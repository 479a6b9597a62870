// How each layer of a picture is best looked at.
import { halfTable, quantile, sorted } from './half.js';
import { relativeError } from './tone.js';

/** Ways to show: what the shader and the plain canvas know. */
export const KINDS = { light: 0, grey: 1, heat: 2, signed: 3, noise: 4, places: 5, ids: 6 };

/** What the viewer calls the picture of noise: not a layer, but made of two. */
export const NOISE = 'noise';

const NAMES = {
  beauty: 'Beauty',
  alpha: 'Alpha',
  depth: 'Depth',
  position: 'Position',
  normal: 'Normal',
  albedo: 'Albedo',
  motion: 'Motion',
  variance: 'Variance',
  samples: 'Samples per pixel',
  noise: 'Noise',
  object_id: 'Object ids',
  material_id: 'Material ids',
  denoised: 'Denoised',
  emission: 'Emission',
  environment: 'Environment',
};

/** What people call a layer. */
export function nameOf(layer) {
  if (NAMES[layer]) return NAMES[layer];
  if (layer.startsWith('light_group:')) return `Light of ${layer.slice(12)}`;
  const words = layer.replaceAll('_', ' ');
  return words[0].toUpperCase() + words.slice(1);
}

/** The way to show a layer. */
export function kindOf(layer) {
  if (layer === NOISE) return 'noise';
  if (layer === 'samples') return 'heat';
  if (layer === 'depth' || layer === 'alpha') return 'grey';
  if (layer === 'normal' || layer === 'motion') return 'signed';
  if (layer === 'position') return 'places';
  if (/_id$/.test(layer) || layer.startsWith('crypto_')) return 'ids';
  return 'light';
}

/** [title, layers] groups for a menu, of what can be had. */
export function grouped(layers) {
  const data = [];
  const light = [];
  const sampling = [];
  for (const layer of layers) {
    if (layer === 'variance' || layer === 'samples') sampling.push(layer);
    else (kindOf(layer) === 'light' ? light : data).push(layer);
  }
  if (layers.includes('variance')) sampling.unshift(NOISE);
  return [
    ['Light', light],
    ['Sampling', sampling],
    ['Surfaces', data],
  ].filter(([, list]) => list.length > 0);
}

/** What is to be loaded for a layer: [the picture, one beside it or null]. */
export const sourcesOf = (layer) => (layer === NOISE ? ['beauty', 'variance'] : [layer, null]);

const niceAbove = (value) => {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 3, 5, 7.5, 10].find((step) => value <= step * power * 1.0001) * power;
};

/**
 * The range that a picture's scale covers: {low, high, middle}. Depth from its nearest to nearly its farthest, samples from the least to the
 * most, noise from nothing to what 98 % of pixels keep.
 */
export function rangeOf(layer, picture, beside) {
  const kind = kindOf(layer);
  if (kind === 'noise') {
    if (!beside || beside.width !== picture.width) return { low: 0, high: 1, middle: 0 };
    const count = beside.width * beside.height;
    const values16 = halfTable();
    const errors = sorted(picture, (values, i) => {
      const variance = beside.channels.map((_, c) => values16[beside.planes[c * count + i]]);
      // Where nothing is known of the noise yet, it does not count.
      return variance.some((v) => v > 0) ? relativeError(values, variance) : NaN;
    });
    return { low: 0, high: niceAbove(quantile(errors, 0.98)), middle: quantile(errors, 0.5) };
  }
  if (layer === 'alpha') return { low: 0, high: 1, middle: 0 };
  // Motion as in the PNG outputs: 32 pixels to either end.
  if (kind === 'signed') return { low: -1, high: layer === 'motion' ? 32 : 1, middle: 0 };
  const values = sorted(picture);
  const low = quantile(values, 0);
  const high = quantile(values, kind === 'heat' ? 1 : 0.99);
  return {
    low: kind === 'heat' ? 0 : low,
    high: high > low ? high : Math.max(high, low + 1),
    middle: quantile(values, 0.5),
  };
}
