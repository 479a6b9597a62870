// The viewer's controls: frame before and after, layer, exposure, tone map.
import { grouped, kindOf, nameOf } from './layers.js';
import { h, setAttribute, setText } from './dom.js';
import { chip } from './parts.js';
import { CURVES } from './tone.js';
import { icon } from './icons.js';
import { to } from './router.js';

/** `view`: {setLayer(name), setExposure(stops), resetExposure(), setCurve(name), fill()}; `compare`: compare.js. */
export class ViewerBar {
  constructor(job, view, compare) {
    this.job = job;
    this.view = view;
    this.heading = h('h1', { testid: 'frame-title' });
    this.back = h('a', {
      class: 'viewer-back',
      href: to('job', { job }),
      title: 'To the job (Escape)',
      testid: 'back',
    });
    this.chip = chip('unknown');
    this.busy = h('span', { class: 'busy', 'aria-hidden': 'true' });
    const step = (name, label, key, testid) =>
      h('a', { class: 'button square', 'aria-label': label, title: `${label} (${key})`, testid }, icon(name));
    this.previous = step('left', 'Frame before', ',', 'frame-before');
    this.next = step('right', 'Next frame', '.', 'frame-next');
    this.makeLook();
    this.save = h(
      'a',
      { class: 'button', title: 'The picture as PNG, as the job maps it', testid: 'save-png', 'aria-label': 'PNG' },
      icon('download'),
      h('span', { class: 'text', text: 'PNG' }),
    );
    const fill = h(
      'button',
      {
        type: 'button',
        class: 'square',
        'aria-label': 'Fill the screen',
        title: 'Fill the screen (f)',
        testid: 'fullscreen',
        onclick: () => view.fill(),
      },
      icon('fit'),
    );
    const name = h('span', { class: 'viewer-name' }, this.back, this.heading);
    this.node = h(
      'div',
      { class: 'viewer-bar', role: 'toolbar', 'aria-label': 'How the picture is shown' },
      h('div', { class: 'viewer-group' }, this.previous, this.next, name, this.chip, this.busy),
      h('div', { class: 'viewer-group grow' }, this.layer, this.light, compare.button, this.save, fill),
      compare.box,
    );
  }

  makeLook() {
    const { view } = this;
    this.layer = h('select', {
      'aria-label': 'Layer',
      testid: 'layer',
      onchange: () => view.setLayer(this.layer.value),
    });
    this.slider = h('input', {
      type: 'range',
      min: -8,
      max: 8,
      step: 0.1,
      'aria-label': 'Exposure, stops',
      testid: 'exposure',
      oninput: () => view.setExposure(Number(this.slider.value)),
    });
    this.stops = h('button', {
      type: 'button',
      class: 'plain small stops',
      title: 'Back to the job’s',
      testid: 'exposure-reset',
      onclick: () => view.resetExposure(),
    });
    this.curve = h(
      'select',
      { 'aria-label': 'Tone map', testid: 'tone', onchange: () => view.setCurve(this.curve.value) },
      Object.entries(CURVES).map(([name, { text }]) => h('option', { value: name, text })),
    );
    const slider = h('label', { class: 'inline' }, 'Exposure', this.slider);
    this.light = h('div', { class: 'viewer-group light' }, slider, this.stops, this.curve);
  }

  /** Which layers there are, and which of them is shown. */
  setLayers(layers, chosen) {
    const option = (name) => h('option', { value: name, text: nameOf(name) });
    this.layer.replaceChildren(...grouped(layers).map(([label, list]) => h('optgroup', { label }, list.map(option))));
    this.setLayer(chosen);
  }

  setLayer(layer) {
    this.layer.value = layer;
    this.light.hidden = kindOf(layer) !== 'light';
  }

  setLook(curve, exposure) {
    this.curve.value = curve;
    this.slider.value = exposure;
    setText(this.stops, `${exposure > 0 ? '+' : ''}${exposure.toFixed(1)}`);
    this.stops.setAttribute('aria-label', `Exposure ${exposure} stops; back to the job’s`);
  }

  /** The frame that is shown, of the job's `numbers`; `query`: what the neighbours' addresses take along. */
  setFrame(frame, numbers, name, query) {
    setText(this.heading, `Frame ${frame}`);
    setText(this.back, name);
    const at = numbers.indexOf(frame);
    const neighbours = [
      [this.previous, numbers[at - 1]],
      [this.next, at >= 0 ? numbers[at + 1] : undefined],
    ];
    for (const [link, number] of neighbours) {
      const there = number !== undefined;
      link.hidden = numbers.length < 2;
      setAttribute(link, 'href', there ? to('frame', { job: this.job, frame: number, query }) : null);
      setAttribute(link, 'aria-disabled', there ? null : 'true');
    }
  }
}
