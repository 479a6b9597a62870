// Where a person was: the way back leads there.

let place = null;

/** The frame that is looked at; the grid of its job shows it when it comes next. */
export function leavePlace(job, frame) {
  place = { job, frame };
}

/** The frame of `job` to come back to, once; null: none. */
export function takePlace(job) {
  const frame = place?.job === job ? place.frame : null;
  place = null;
  return frame;
}

const scrolled = new Map();
let current = null;
let count = 0;

/** A new address is shown: keeps how far the old one was scrolled. True where this one was shown before (back, forward). */
export function enter() {
  if (current !== null) scrolled.set(current, scrollY);
  const known = history.state?.place;
  const back = known !== undefined && scrolled.has(known);
  current = known ?? `${Date.now()} ${++count}`;
  if (known === undefined) history.replaceState({ place: current }, '');
  return back;
}

/** Scrolls to where this address was left; rows and pictures may come a moment later. */
export function scrollBack() {
  const y = scrolled.get(current) ?? 0;
  let tries = 0;
  const go = () => {
    scrollTo(0, y);
    if (Math.abs(scrollY - y) > 2 && ++tries < 20) requestAnimationFrame(go);
  };
  go();
}
