// The canvas that a float picture is shown on, by the graphics card where that can be.
import { flatStage } from './flat_stage.js';
import { glStage } from './gl_stage.js';
import { h } from './dom.js';

const makeCanvas = () =>
  h('canvas', { class: 'stage-canvas', role: 'img', 'aria-label': 'The picture', testid: 'stage' });

/** {canvas, painter}: painter as glStage (gl_stage.js) tells; `flat`: without the graphics card. */
export function openStage(flat = false) {
  const canvas = makeCanvas();
  if (!flat) {
    try {
      const painter = glStage(canvas);
      if (painter) {
        canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
        return { canvas, painter };
      }
    } catch (error) {
      console.warn('WebGL is not used:', error.message);
    }
  }
  // A canvas that was asked for WebGL gives nothing else: a fresh one.
  const plain = makeCanvas();
  return { canvas: plain, painter: flatStage(plain) };
}
