// The picture of a job: that of the frame that is being rendered.
import { h, setText } from './dom.js';
import { job as askJob } from './api.js';

/** So often a job's frames are asked for another one to show. */
const CHOOSE_EVERY = 15000;
/** So often the picture is looked at again while there is more of the job. */
const LOOK_EVERY = 4000;

/** The frame to show: the one with the most of those that are rendered, else the last finished one; null: none. */
export function choose(frames) {
  let best = null;
  const rank = (frame) =>
    frame.state === 'rendering'
      ? 2 + (frame.samples > 0 ? frame.samples_done / frame.samples : 0)
      : frame.state === 'finishing'
        ? 1.5
        : frame.state === 'done'
          ? 1
          : 0;
  for (const frame of frames) {
    if (rank(frame) === 0 || frame.samples_done === 0) continue;
    if (!best || rank(frame) > rank(best) || (rank(frame) === rank(best) && frame.id > best.id)) best = frame;
  }
  return best;
}

/** A picture for `thumbs` (thumbs.js); `refresh(job)` after changes. */
export function preview(thumbs, id) {
  const image = h('img', { alt: '', hidden: true });
  const label = h('span', { class: 'now-frame' });
  const node = h('span', { class: 'now-picture' }, image, label);
  let frame = null;
  let askedAt = 0;
  let lookedAt = 0;
  let first = null;
  const show = (url) => {
    image.hidden = url === null;
    if (url) image.src = url;
  };
  const look = (job) => {
    if (!frame) return;
    const now = Date.now();
    if (now - lookedAt < LOOK_EVERY) return;
    lookedAt = now;
    setText(label, job.frames > 1 ? `Frame ${frame.id}` : '');
    // How far this frame is, only its job tells: its picture is asked for by what the job has.
    thumbs.want(node, {
      job: id,
      width: 480,
      show,
      frame: { id: frame.id, state: 'rendering', samples_done: job.samples_done, restarts: 0 },
    });
  };
  const refresh = async (job) => {
    const now = Date.now();
    if (now - askedAt > CHOOSE_EVERY) {
      askedAt = now;
      try {
        // In order of their numbers, those that are rendered come after those that are done.
        const after =
          first !== null && job.frame_order === 'sequential' ? first + Math.max(0, job.frames_done - 40) : undefined;
        const page = await askJob(id, { after });
        if (first === null && page.frames.length > 0) {
          first = page.frames[0].id;
          // Only now it is known where to look for those in work.
          if (page.more && job.frame_order === 'sequential') askedAt = 0;
        }
        const next = choose(page.frames);
        if (next && next.id !== frame?.id) {
          frame = next;
          lookedAt = 0;
        }
      } catch {
        // Another time.
      }
    }
    look(job);
  };
  return { node, refresh };
}
