// What the viewer says in words: the pixel under the pointer, the scale of heat, how far the frame is.
import { h, setText } from './dom.js';
import { heat, luminance, relativeError } from './tone.js';
import { kindOf, NOISE } from './layers.js';
import { noise, percent, short, value, whole } from './format.js';
import { frameShare } from './job_state.js';
import { pixel } from './half.js';

/** The line below the picture; `zoom`: a node for its end. */
export class Readout {
  constructor(zoom) {
    this.pixel = h('output', { class: 'pixel mono', testid: 'pixel' });
    this.swatch = h('i', { class: 'swatch', 'aria-hidden': 'true', hidden: true });
    this.samples = h('span', { class: 'soft', testid: 'frame-samples' });
    const spring = h('span', { class: 'spring' });
    this.node = h('div', { class: 'viewer-foot' }, this.swatch, this.pixel, spring, this.samples, zoom);
  }

  /**
   * Tells the pixel at `place` of a picture that is `size` large in the viewer's eyes (a preview has fewer pixels). `shown`: {main,
   * beside, layer}; null, or a place outside: tells nothing.
   */
  tell(shown, place, size, exposure) {
    const main = shown?.main;
    const at = main &&
      place && [Math.floor((place[0] * main.width) / size[0]), Math.floor((place[1] * main.height) / size[1])];
    const values = at && pixel(main, ...at);
    this.swatch.hidden = !values;
    if (!values) {
      setText(this.pixel, '');
      return;
    }
    if (values[0] === -Infinity) {
      this.swatch.hidden = true;
      setText(this.pixel, `${String(place[0]).padStart(4)}, ${String(place[1]).padEnd(4)}   no samples yet`);
      return;
    }
    const names = main.channels.map((name) => name.slice(name.lastIndexOf('.') + 1));
    const parts = [`${String(place[0]).padStart(4)}, ${String(place[1]).padEnd(4)}`];
    const variance = shown.layer === NOISE && shown.beside && pixel(shown.beside, ...at);
    if (variance) parts.push(`error ${(100 * relativeError(values, variance)).toFixed(2)} %`);
    parts.push(...values.map((v, i) => `${names[i]} ${value(v)}`));
    const light = values.length >= 3;
    if (light && kindOf(shown.layer) === 'light') parts.push(`luminance ${value(luminance(...values))}`);
    setText(this.pixel, parts.join('   '));
    const byte = (v) => Math.round(255 * Math.min(1, Math.max(0, v * 2 ** exposure)) ** (1 / 2.2));
    this.swatch.style.background = `rgb(${light ? values.slice(0, 3).map(byte) : [90, 90, 90]})`;
  }

  /** Tells how far a frame is; `main`: its picture, null yet; `whole`: it has all of the frame's pixels. */
  tellFrame(frame, main, complete) {
    const pixels = main && complete ? main.width * main.height : 0;
    const each = (samples) => whole(Math.floor(samples / pixels));
    const parts = [
      main && `${main.width} × ${main.height}`,
      pixels > 0
        ? `${each(frame.samples_done)} of ${each(frame.samples)} samples per pixel`
        : `${short(frame.samples_done)} samples`,
      frame.state === 'rendering' && percent(frameShare(frame)),
      frame.noise !== undefined && frame.noise !== null && `noise ${noise(frame.noise)}`,
      main?.exact === false && 'from a finished file of 8 bits',
      frame.reason,
    ];
    setText(this.samples, parts.filter(Boolean).join(' · '));
  }
}

const ABOUT = {
  noise: (middle) => `relative error; median ${middle}`,
  grey: () => 'nearest to farthest',
  heat: (middle) => `samples per pixel; median ${middle}`,
};

/** Fills `box` with the scale of a layer and its range (layers.js), or hides it where colours need none. */
export function drawLegend(box, layer, { low, high, middle }) {
  const kind = kindOf(layer);
  box.hidden = !ABOUT[kind] || layer === 'alpha';
  if (box.hidden) return;
  const text = (v) => (kind === 'noise' ? `${noise(v * 100)} %` : value(v));
  const scale = h('canvas', { width: 128, height: 1, 'aria-hidden': 'true' });
  const pen = scale.getContext('2d');
  for (let i = 0; i < 128; ++i) {
    const share = i / 127;
    const grey = `hsl(0 0% ${100 - 100 * share}%)`;
    pen.fillStyle = kind === 'grey' ? grey : `rgb(${heat(share).map((c) => Math.round(c * 255))})`;
    pen.fillRect(i, 0, 1, 1);
  }
  const about = h('span', { class: 'soft', text: ABOUT[kind](text(middle)) });
  box.replaceChildren(
    scale,
    h('span', { class: 'legend-line' }, h('span', { text: text(low) }), about, h('span', { text: text(high) })),
  );
}
