// Float pictures on the graphics card (WebGL 2): exposure, curve and zoom cost nothing there.
import { CURVES, TONE_GLSL } from './tone.js';
import { KINDS } from './layers.js';

const VERTEX = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

const FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DArray;
uniform sampler2DArray picA, besideA, picB, besideB;
uniform ivec3 sizeA, sizeB, sizeBesideA, sizeBesideB;
uniform vec2 logical, offset, screen;
uniform float scale, dense, gain, low, high, split;
uniform int kind, curve, mode;
uniform vec3 ground;
out vec4 result;
${TONE_GLSL}
bool bad(float x) { return isnan(x); }
// Where no sample is yet (half.js).
bool absent(float x) { return isinf(x) && x < 0.0; }
vec3 hatch() {
  float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / (12.0 * dense)));
  return mix(ground, vec3(0.5), 0.1 + 0.12 * stripe);
}
vec3 texel(sampler2DArray t, ivec3 size, ivec2 p) {
  p = clamp(p, ivec2(0), size.xy - 1);
  float r = texelFetch(t, ivec3(p, 0), 0).r;
  if (size.z < 2) return vec3(r);
  float g = texelFetch(t, ivec3(p, 1), 0).r;
  return vec3(r, g, size.z > 2 ? texelFetch(t, ivec3(p, 2), 0).r : 0.0);
}
// Larger than the screen: the mean of what a pixel of the screen covers, as far as eight by eight tell it.
vec3 area(sampler2DArray t, ivec3 size, vec2 at, float reach) {
  vec2 whole = vec2(size.xy);
  vec2 centre = at * whole;
  float span = reach * whole.x / logical.x;
  int n = clamp(int(ceil(span)), 1, 8);
  if (n == 1 || kind == ${KINDS.ids}) return texel(t, size, ivec2(floor(centre)));
  vec3 sum = vec3(0.0);
  float count = 0.0;
  bool seen = false;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      vec3 v = texel(t, size, ivec2(floor(centre + span * ((vec2(x, y) + 0.5) / float(n) - 0.5))));
      if (absent(v.r)) continue;
      seen = true;
      if (kind == ${KINDS.grey} && isinf(v.r)) continue;
      sum += v;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : vec3(seen ? 1.0 / 0.0 : -1.0 / 0.0);
}
vec3 hashed(float x) {
  vec3 p = fract(vec3(x * 12.9898, x * 78.233, x * 37.719) * 0.1031);
  p += dot(p, p.yzx + 33.33);
  return 0.25 + 0.75 * fract((p.xxy + p.yzz) * p.zyx);
}
vec3 show(vec3 v, vec3 beside) {
  if (absent(v.r)) return hatch();
  if (kind == ${KINDS.light} && (bad(v.r) || bad(v.g) || bad(v.b))) return vec3(1.0, 0.0, 1.0);
  if (kind == ${KINDS.light}) return toneMap(v * gain, curve);
  if (kind == ${KINDS.grey}) {
    if (isinf(v.r) || bad(v.r)) return ground;
    float share = (v.r - low) / (high - low);
    return vec3(srgbEncode(clamp(low == 0.0 && high == 1.0 ? share : 1.0 - share, 0.0, 1.0)));
  }
  if (kind == ${KINDS.heat}) return heat((v.r - low) / (high - low));
  if (kind == ${KINDS.signed}) return clamp(v * 0.5 * (high > 1.5 ? 1.0 / high : 1.0) + 0.5, 0.0, 1.0);
  if (kind == ${KINDS.places}) return fract(v / 10.0);
  if (kind == ${KINDS.ids}) return v.r == 0.0 ? vec3(0.0) : hashed(v.r);
  vec3 w = vec3(0.2126, 0.7152, 0.0722);
  return heat(dot(w, sqrt(max(beside, 0.0))) / (max(dot(w, v), 0.0) + 0.01) / high);
}
void main() {
  vec2 place = vec2(gl_FragCoord.x, screen.y - gl_FragCoord.y) / dense;
  vec2 at = (place - offset) / (scale * logical);
  float reach = 1.0 / (scale * dense);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(1.0)))) { result = vec4(ground, 1.0); return; }
  bool right = mode == 1 && place.x >= split;
  if (mode == 2) {
    vec3 a = area(picA, sizeA, at, reach);
    vec3 b = area(picB, sizeB, at, reach);
    vec3 gap = abs(a - b);
    if (absent(a.r) || absent(b.r)) result = vec4(hatch(), 1.0);
    else result = vec4(kind == ${KINDS.light} ? toneMap(gap * gain, curve) : heat(gap.r / (high - low)), 1.0);
  } else if (right) {
    result = vec4(show(area(picB, sizeB, at, reach), kind == ${KINDS.noise} ? area(besideB, sizeBesideB, at, reach) : vec3(0.0)), 1.0);
  } else {
    result = vec4(show(area(picA, sizeA, at, reach), kind == ${KINDS.noise} ? area(besideA, sizeBesideA, at, reach) : vec3(0.0)), 1.0);
  }
}`;

const SLOTS = ['picA', 'besideA', 'picB', 'besideB'];
const SIZES = ['sizeA', 'sizeBesideA', 'sizeB', 'sizeBesideB'];

/** A stage on `canvas`: {largest, set(slot, picture), draw(scene), leave()}; null where there is no WebGL 2. */
export function glStage(canvas) {
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, depth: false });
  if (!gl) return null;
  const compile = (kind, text) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, FRAGMENT));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  const places = new Map();
  const uniform = (name) => {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
    return places.get(name);
  };
  const textures = SLOTS.map((name, unit) => {
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, side, gl.NEAREST);
    gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, gl.R16F, 1, 1, 1, 0, gl.RED, gl.HALF_FLOAT, new Uint16Array(1));
    gl.uniform1i(uniform(name), unit);
    return texture;
  });
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
  const sizes = SLOTS.map(() => [1, 1, 1]);

  return {
    largest: gl.getParameter(gl.MAX_TEXTURE_SIZE),
    set(slot, picture) {
      const unit = SLOTS.indexOf(slot);
      const layers = Math.min(3, picture.channels.length);
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.texImage3D(
        gl.TEXTURE_2D_ARRAY,
        0,
        gl.R16F,
        picture.width,
        picture.height,
        layers,
        0,
        gl.RED,
        gl.HALF_FLOAT,
        picture.planes.subarray(0, picture.width * picture.height * layers),
      );
      sizes[unit] = [picture.width, picture.height, layers];
    },
    draw(scene) {
      gl.viewport(0, 0, canvas.width, canvas.height);
      SIZES.forEach((name, unit) => gl.uniform3iv(uniform(name), sizes[unit]));
      gl.uniform2fv(uniform('logical'), scene.logical);
      gl.uniform2fv(uniform('offset'), scene.offset);
      gl.uniform2f(uniform('screen'), canvas.width, canvas.height);
      gl.uniform1f(uniform('scale'), scene.scale);
      gl.uniform1f(uniform('dense'), scene.dense);
      gl.uniform1f(uniform('gain'), 2 ** scene.exposure);
      gl.uniform1f(uniform('low'), scene.low);
      gl.uniform1f(uniform('high'), scene.high);
      gl.uniform1f(uniform('split'), scene.split);
      gl.uniform1i(uniform('kind'), KINDS[scene.kind]);
      gl.uniform1i(uniform('curve'), CURVES[scene.curve].index);
      gl.uniform1i(uniform('mode'), scene.mode);
      gl.uniform3fv(uniform('ground'), scene.ground);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    },
    leave() {
      for (const texture of textures) gl.deleteTexture(texture);
      gl.getExtension('WEBGL_lose_context')?.loseContext();
    },
  };
}
