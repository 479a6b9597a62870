// The picture of a job: that of the frame which best stands for it, as the coordinator says.
import { h, setText } from './dom.js';
import { share } from './job_state.js';

/** So often the picture of a card is looked at again while there is more of the job. */
const LOOK_EVERY = 4000;
/** Small pictures in lists are asked for anew at most so often until the job ends. */
const STEPS = 40;

const shows = (image) => (url) => {
  image.hidden = url === null;
  if (url) image.src = url;
};

/** What `Thumbs` asks for (thumbs.js); how far the frame itself is only its job tells: `done` stands for that. */
const wish = (job, width, done, image) => ({
  job: job.id,
  width,
  show: shows(image),
  frame: { id: job.preview_frame, state: 'rendering', samples_done: done, restarts: 0 },
});

/** A large picture for `thumbs`; `refresh(job)` after changes. */
export function preview(thumbs) {
  const image = h('img', { alt: '', hidden: true });
  const label = h('span', { class: 'now-frame' });
  const node = h('span', { class: 'now-picture' }, image, label);
  let shown = null;
  let lookedAt = 0;
  const refresh = (job) => {
    if (job.preview_frame === undefined) return;
    const now = Date.now();
    if (shown === job.preview_frame && now - lookedAt < LOOK_EVERY) return;
    shown = job.preview_frame;
    lookedAt = now;
    setText(label, job.frames > 1 ? `Frame ${shown}` : '');
    thumbs.want(node, wish(job, 480, job.samples_done, image));
  };
  return { node, refresh };
}

/** A small one for a row of a list; `refresh(job)` after changes, `drop()` when it is not to be seen any more. */
export function stamp(thumbs) {
  const image = h('img', { alt: '', hidden: true });
  const node = h('span', { class: 'row-picture', 'aria-hidden': 'true' }, image);
  node.refresh = (job) => {
    if (job.preview_frame === undefined) return;
    thumbs.want(node, wish(job, 120, 1 + Math.floor(STEPS * share(job)), image));
  };
  node.drop = () => thumbs.drop(node);
  return node;
}
