// Where a picture lies on its stage: zoom and pan by wheel, fingers, mouse and keys.

const LARGEST = 64;
const SMALLEST = 1 / 64;

/** `changed()` after each move. `size`: the picture's, in its own pixels; lengths of the stage in CSS pixels. */
export class Viewport {
  constructor(stage, changed) {
    this.stage = stage;
    this.changed = changed;
    this.size = [1, 1];
    this.scale = 1;
    this.offset = [0, 0];
    this.fitted = true;
    this.fingers = new Map();
    stage.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    stage.addEventListener('pointerdown', (event) => this.down(event));
    stage.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel']) stage.addEventListener(name, (event) => this.up(event));
    stage.addEventListener('dblclick', (event) => (this.fitted ? this.zoomTo(1, this.at(event)) : this.fit()));
  }

  at(event) {
    const box = this.stage.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** The picture's size has become another one: what is seen stays. */
  resize(size) {
    const ratio = this.size[0] / size[0];
    this.size = size;
    if (this.fitted) this.fit();
    else this.scale *= ratio;
    this.changed();
  }

  /** The whole picture, as large as fits. */
  fit() {
    const [width, height] = [this.stage.clientWidth, this.stage.clientHeight];
    this.scale = Math.min(LARGEST, width / this.size[0], height / this.size[1]) || 1;
    this.offset = [(width - this.size[0] * this.scale) / 2, (height - this.size[1] * this.scale) / 2];
    this.fitted = true;
    this.changed();
  }

  /** Zooms so that the point of the picture at `place` stays there (without: the middle). */
  zoomTo(scale, place = [this.stage.clientWidth / 2, this.stage.clientHeight / 2]) {
    const next = Math.min(LARGEST, Math.max(SMALLEST, scale));
    this.offset = this.offset.map((o, i) => place[i] - ((place[i] - o) * next) / this.scale);
    this.scale = next;
    this.fitted = false;
    this.hold();
    this.changed();
  }

  /** Moves the picture, but never out of sight. */
  pan(x, y) {
    this.offset = [this.offset[0] + x, this.offset[1] + y];
    this.fitted = false;
    this.hold();
    this.changed();
  }

  hold() {
    const room = [this.stage.clientWidth, this.stage.clientHeight];
    this.offset = this.offset.map((o, i) => Math.min(room[i] - 40, Math.max(40 - this.size[i] * this.scale, o)));
  }

  /** The picture's pixel at a place of the stage: [x, y], may lie outside. */
  pixelAt(place) {
    return place.map((p, i) => Math.floor((p - this.offset[i]) / this.scale));
  }

  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 18 : 1;
    this.zoomTo(this.scale * Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0016)), this.at(event));
  }

  down(event) {
    if (event.button > 1 || event.target.closest('button, [role=slider]')) return;
    this.stage.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, this.at(event));
  }

  move(event) {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const now = this.at(event);
    const others = [...this.fingers].filter(([id]) => id !== event.pointerId);
    this.fingers.set(event.pointerId, now);
    if (others.length === 0) {
      this.pan(now[0] - before[0], now[1] - before[1]);
      return;
    }
    const [, other] = others[0];
    const far = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    const middle = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const [was, is] = [middle(before, other), middle(now, other)];
    this.pan(is[0] - was[0], is[1] - was[1]);
    this.zoomTo((this.scale * far(now, other)) / Math.max(1, far(before, other)), is);
  }

  up(event) {
    this.fingers.delete(event.pointerId);
  }
}
