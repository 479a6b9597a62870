// One job as it is now: shared by the views that look at it.
import * as api from './api.js';
import { farm, isOpen, onFarm } from './farm_state.js';
import { counted, duration, whole } from './format.js';
import { listen } from './live.js';

/** A job that no view looks at is kept for so long: going from the grid to a frame and back costs nothing. */
const KEPT_FOR = 8000;

const open = new Map();

class WatchedJob {
  constructor(id) {
    this.id = id;
    /** As in the API; null until known. */
    this.job = null;
    /** Frames by number. */
    this.frames = new Map();
    /** Their numbers, ascending. */
    this.numbers = [];
    /** Why there is nothing: an ApiError. */
    this.error = null;
    this.listeners = new Set();
    this.users = 0;
    this.listenOn();
    this.leaveFarm = onFarm((what) => {
      if (!what.has('jobs')) return;
      const now = farm.jobs.get(id);
      if (this.ended && now && isOpen(now)) this.listenOn();
    });
  }

  listenOn() {
    this.stop?.();
    this.ended = false;
    this.stop = listen(`api/v1/jobs/${this.id}/events`, {
      snapshot: (change) => {
        this.frames.clear();
        this.take(change);
        // Nothing more comes of a job that has ended.
        if (!isOpen(change.job)) {
          this.ended = true;
          this.stop();
        }
      },
      change: (change) => this.take(change),
      end: (change) => {
        this.ended = true;
        this.take(change);
      },
      gone: () => this.ask(),
      refused: () => this.ask(),
    });
    this.ask();
  }

  // The stream does not say why it was refused; and a first answer comes sooner than a large snapshot.
  async ask() {
    try {
      const { job } = await api.job(this.id, { after: 2147483646 });
      this.error = null;
      this.take({ job, frames: [] });
    } catch (error) {
      if (error.code === 'unreachable' || error.code === 'unauthenticated') return;
      this.error = error;
      this.stop();
      this.tell(new Set());
    }
  }

  take({ job, frames }) {
    this.job = job;
    const changed = new Set();
    let added = false;
    for (const frame of frames) {
      added ||= !this.frames.has(frame.id);
      this.frames.set(frame.id, frame);
      changed.add(frame.id);
    }
    if (added) this.numbers = [...this.frames.keys()].sort((a, b) => a - b);
    this.tell(changed);
  }

  /** Takes in what an action answered. */
  learn(job) {
    this.job = job;
    this.tell(new Set());
    if (this.ended && isOpen(job)) this.listenOn();
  }

  tell(changed) {
    for (const listener of this.listeners) listener(changed);
  }
}

/**
 * Looks at a job. `listener(changed)` is called after each change, with the numbers of the frames that changed. Returns
 * {state, leave()}.
 */
export function watchJob(id, listener) {
  let state = open.get(id);
  if (!state) open.set(id, (state = new WatchedJob(id)));
  clearTimeout(state.timer);
  ++state.users;
  state.listeners.add(listener);
  return {
    state,
    leave() {
      state.listeners.delete(listener);
      if (--state.users > 0) return;
      state.timer = setTimeout(
        () => {
          state.stop();
          state.leaveFarm();
          open.delete(id);
        },
        state.error ? 0 : KEPT_FOR,
      );
    },
  };
}

/** How much of a job is rendered, 0..1. */
export const share = (job) => (job.samples > 0 ? Math.min(1, job.samples_done / job.samples) : 0);

/** Of its frames those that are being finished, and that failed, for a line that begins with the done ones. */
export const otherFrames = (job) =>
  (job.frames_finishing ? `, ${whole(job.frames_finishing)} finishing` : '') +
  (job.frames_failed ? `, ${whole(job.frames_failed)} failed` : '');

/** What people call its state: that of one that runs, and waits, is 'waiting'. */
export const lookOf = (job) => (job.waiting ? 'waiting' : job.state);

/**
 * Seconds in which somebody worked on it (of one that an older coordinator ended: from its beginning to its end); NaN of one that
 * nobody has begun.
 */
export function tookOf(job, now = Date.now()) {
  if (job.busy_seconds > 0) return job.busy_seconds;
  if (!job.begun_ms && !job.samples_done && !job.frames_done) return NaN;
  return ((job.ended_ms || now) - (job.begun_ms || job.submitted_ms)) / 1000;
}

/** What was done of one that has ended: '24 frames in 12 min 03 s', '3 of 24 frames in 2 min 10 s', '0 of 1 frame'. */
export function doneOf(job) {
  const all = job.frames_done === job.frames;
  const frames = all ? counted(job.frames, 'frame') : `${whole(job.frames_done)} of ${counted(job.frames, 'frame')}`;
  const took = tookOf(job);
  return Number.isFinite(took) ? `${frames} in ${duration(took)}` : frames;
}

/** Longer is not told: it only says that next to nothing was rendered lately. */
const LONGEST_LEFT = 400 * 86400;

/** Seconds to its end; Infinity where nobody can tell. */
export const leftOf = (job) =>
  lookOf(job) === 'running' && job.seconds_left >= 0 && job.seconds_left < LONGEST_LEFT ? job.seconds_left : Infinity;

/** How much of a frame is rendered, 0..1. */
export const frameShare = (frame) =>
  frame.state === 'done' ? 1 : frame.samples > 0 ? Math.min(1, frame.samples_done / frame.samples) : 0;
