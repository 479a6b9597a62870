// Float pictures on a plain canvas, where there is no WebGL 2: the same pictures, pixel by pixel.
import { heat, relativeError, toneMap } from './tone.js';
import { halfTable } from './half.js';

/** More pixels than these are drawn at half the resolution. */
const MOST_PIXELS = 2e6;

/** A stage on `canvas`, used like glStage() (gl_stage.js): {largest, set(slot, picture), draw(scene), leave()}. */
export function flatStage(canvas) {
  const pen = canvas.getContext('2d', { alpha: false });
  const values = halfTable();
  const pictures = {};
  const look = (picture, u, v) => {
    const { width, height, planes, channels } = picture;
    const i = Math.min(height - 1, Math.floor(v * height)) * width + Math.min(width - 1, Math.floor(u * width));
    const r = values[planes[i]];
    if (channels.length < 2) return [r, r, r];
    const plane = width * height;
    return [r, values[planes[plane + i]], channels.length > 2 ? values[planes[2 * plane + i]] : 0];
  };
  const colorOf = (scene, value, beside) => {
    const part = (value[0] - scene.low) / (scene.high - scene.low);
    switch (scene.kind) {
      case 'light':
        return value.some(Number.isNaN) ? [1, 0, 1] : toneMap(value, scene.curve, scene.exposure);
      case 'grey': {
        if (!Number.isFinite(value[0])) return scene.ground;
        const share = scene.low === 0 && scene.high === 1 ? part : 1 - part;
        return toneMap([share, share, share], 'srgb');
      }
      case 'heat':
        return heat(part);
      case 'signed':
        return value.map((x) => Math.min(1, Math.max(0, (x / (scene.high > 1.5 ? scene.high : 1)) * 0.5 + 0.5)));
      case 'places':
        return value.map((x) => x / 10 - Math.floor(x / 10));
      case 'ids':
        return value[0] === 0
          ? [0, 0, 0]
          : [0.37, 0.73, 0.51].map((k) => 0.25 + 0.75 * Math.abs((value[0] * k * 7.31) % 1));
      default:
        return heat(relativeError(value, beside) / scene.high);
    }
  };

  const gapColor = (scene, a, b) => {
    const gap = a.map((x, i) => Math.abs(x - b[i]));
    if (scene.kind === 'light') return toneMap(gap, scene.curve, scene.exposure);
    return heat(gap[0] / (scene.high - scene.low));
  };

  return {
    largest: 16384,
    set(slot, picture) {
      pictures[slot] = picture;
    },
    draw(scene) {
      const coarse = canvas.width * canvas.height > MOST_PIXELS ? 2 : 1;
      const width = Math.ceil(canvas.width / coarse);
      const height = Math.ceil(canvas.height / coarse);
      const image = new ImageData(width, height);
      const out = new Uint32Array(image.data.buffer);
      const pack = ([r, g, b]) =>
        0xff000000 | (Math.round(b * 255) << 16) | (Math.round(g * 255) << 8) | Math.round(r * 255);
      const ground = pack(scene.ground);
      // Where no sample is yet (half.js).
      const hatch = [0.1, 0.22].map((share) => pack(scene.ground.map((c) => c + (0.5 - c) * share)));
      for (let y = 0; y < height; ++y) {
        const v = (((y + 0.5) * coarse) / scene.dense - scene.offset[1]) / (scene.scale * scene.logical[1]);
        for (let x = 0; x < width; ++x) {
          const place = ((x + 0.5) * coarse) / scene.dense;
          const u = (place - scene.offset[0]) / (scene.scale * scene.logical[0]);
          if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) {
            out[y * width + x] = ground;
            continue;
          }
          const side = scene.mode === 1 && place >= scene.split ? 'B' : 'A';
          const value = look(pictures[`pic${side}`], u, v);
          const beside = scene.kind === 'noise' ? look(pictures[`beside${side}`], u, v) : null;
          const other = scene.mode === 2 ? look(pictures.picB, u, v) : null;
          if (value[0] === -Infinity || other?.[0] === -Infinity) {
            out[y * width + x] = hatch[Math.floor((x + height - y) / 6) % 2];
            continue;
          }
          const color = other ? gapColor(scene, value, other) : colorOf(scene, value, beside);
          out[y * width + x] = pack(color);
        }
      }
      if (coarse === 1) {
        pen.putImageData(image, 0, 0);
        return;
      }
      const small = new OffscreenCanvas(width, height);
      small.getContext('2d').putImageData(image, 0, 0);
      pen.imageSmoothingEnabled = false;
      pen.drawImage(small, 0, 0, canvas.width, canvas.height);
    },
    leave() {},
  };
}
