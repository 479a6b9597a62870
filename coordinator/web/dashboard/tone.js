// From light to what a display shows: the same curves as the renderer's (core/image/tone_map.cpp), here and for the graphics card.

/** name -> {text, index in the shader}. */
export const CURVES = {
  srgb: { text: 'sRGB, clipped', index: 0 },
  filmic: { text: 'Filmic', index: 1 },
  aces: { text: 'ACES', index: 2 },
  agx: { text: 'AgX', index: 3 },
  linear: { text: 'Linear numbers', index: 4 },
};

/** Beyond this every curve is white; keeps infinity out of fractions. */
const BRIGHTEST = 65504;
const DARKEST_STOP = -12.47393;
const STOPS = 4.026069 - DARKEST_STOP;
const INSET = [
  0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772, 0.0784336,
  0.0792237451477643, 0.0791661274605434, 0.879142973793104,
];
const OUTSET = [
  1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417,
  -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116,
];

const clamp01 = (x) => Math.min(1, Math.max(0, x));
const held = (x) => (x > 0 ? Math.min(x, BRIGHTEST) : 0);

/** IEC 61966-2-1. */
export const srgbEncode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/** J. Hable, "Filmic Tonemapping Operators" (2010), before it is scaled to white. */
const hable = (x) => (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
const filmic = (x) => hable(2 * x) / hable(11.2);

/** K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015). */
const aces = (x) => (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);

/** B. Wrensch, "Minimal AgX Implementation" (2023), of T. Sobotka's AgX (2022): a sigmoid over stops. */
const agxContrast = (x) =>
  -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
const by = (m, [r, g, b]) => [0, 1, 2].map((i) => m[i] * r + m[3 + i] * g + m[6 + i] * b);

function agx(color) {
  const mixed = by(INSET, color).map((x) =>
    agxContrast(clamp01((Math.log2(Math.max(x, 1e-10)) - DARKEST_STOP) / STOPS)),
  );
  return by(OUTSET, mixed).map(clamp01);
}

/** Display values 0..1 of linear Rec.709 light; `stops` of exposure come before. NaN becomes black. */
export function toneMap(color, curve, stops = 0) {
  const light = color.map((x) => held(x * 2 ** stops));
  if (curve === 'agx') return agx(light);
  if (curve === 'linear') return light.map((x) => Math.min(x, 1));
  const shape = { srgb: (x) => x, filmic, aces }[curve];
  return light.map((x) => clamp01(srgbEncode(clamp01(shape(x)))));
}

/** Rec.709's luminance. */
export const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** Added to luminance where noise is told relative to it: black is not infinitely noisy. */
export const NOISE_FLOOR = 0.01;

/**
 * Relative standard error of a pixel: the deviation of its luminance's mean over that luminance. Channels are taken to err together, which
 * they mostly do; where they do not it is less.
 */
export function relativeError([r, g, b], variance) {
  const [vr, vg, vb] = variance.length >= 3 ? variance : [variance[0], variance[0], variance[0]];
  const deviation = luminance(Math.sqrt(Math.max(0, vr)), Math.sqrt(Math.max(0, vg)), Math.sqrt(Math.max(0, vb)));
  return deviation / (Math.max(0, luminance(r, g, b)) + NOISE_FLOOR);
}

/** A scale of heat that goes up evenly in lightness: night, blue, rose, amber, white; display values. */
export const HEAT = [
  [0.03, 0.04, 0.09],
  [0.11, 0.13, 0.36],
  [0.33, 0.17, 0.55],
  [0.62, 0.21, 0.53],
  [0.87, 0.34, 0.38],
  [0.98, 0.57, 0.25],
  [1, 0.81, 0.42],
  [1, 0.98, 0.86],
];

/** The colour of 0..1 on it. */
export function heat(share) {
  const at = clamp01(share) * (HEAT.length - 1);
  const i = Math.min(HEAT.length - 2, Math.floor(at));
  return HEAT[i].map((x, c) => x + (HEAT[i + 1][c] - x) * (at - i));
}

const vec3 = (list) => `vec3(${list.map((x) => x.toFixed(4)).join(', ')})`;

/** Tone mapping and the colours of heat in GLSL ES 3: toneMap(light, curve) and heat(share). */
export const TONE_GLSL = `
float srgbEncode(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }
float hable(float x) { return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3; }
float curveOf(float x, int curve) {
  if (curve == 1) x = hable(2.0 * x) / hable(11.2);
  if (curve == 2) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  return srgbEncode(clamp(x, 0.0, 1.0));
}
float agxContrast(float x) { return -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5))))); }
vec3 toneMap(vec3 light, int curve) {
  light = vec3(light.r > 0.0 ? min(light.r, 65504.0) : 0.0, light.g > 0.0 ? min(light.g, 65504.0) : 0.0, light.b > 0.0 ? min(light.b, 65504.0) : 0.0);
  if (curve == 4) return min(light, 1.0);
  if (curve == 3) {
    vec3 x = clamp((log2(max(mat3(${INSET.join(', ')}) * light, 1e-10)) - (${DARKEST_STOP})) / ${STOPS.toFixed(6)}, 0.0, 1.0);
    return clamp(mat3(${OUTSET.join(', ')}) * vec3(agxContrast(x.r), agxContrast(x.g), agxContrast(x.b)), 0.0, 1.0);
  }
  return vec3(curveOf(light.r, curve), curveOf(light.g, curve), curveOf(light.b, curve));
}
vec3 heat(float share) {
  vec3 scale[${HEAT.length}] = vec3[](${HEAT.map(vec3).join(', ')});
  float at = clamp(share, 0.0, 1.0) * ${(HEAT.length - 1).toFixed(1)};
  int i = min(${HEAT.length - 2}, int(at));
  return mix(scale[i], scale[i + 1], at - float(i));
}`;
