// What a job's timeline has told so far: asked for piece by piece, kept up to a limit.
import { timeline } from './api.js';

/** More is not kept: the oldest goes first. */
const MOST_KEPT = 50000;

/** What a coordinator's own work is called where workers' names stand. */
export const COORDINATOR = 'coordinator';

/** Units and steps of job `id`; `more(signal)` brings in what has come since. */
export class Timed {
  constructor(id, ask = timeline) {
    this.id = id;
    this.ask = ask;
    this.after = 0;
    /** Rendered units, as the API gives them. */
    this.units = [];
    /** What the coordinator did, its `worker` COORDINATOR. */
    this.steps = [];
    /** Older ones that are not there any more. */
    this.dropped = 0;
  }

  /** True where something was new. */
  async more(signal) {
    let found = false;
    for (;;) {
      const { units, steps, after, more, dropped } = await this.ask(this.id, this.after || undefined, signal);
      found ||= units.length > 0 || steps.length > 0;
      this.units.push(...units);
      for (const step of steps) this.steps.push({ ...step, worker: COORDINATOR });
      if (this.after === 0) this.dropped = dropped;
      this.after = Math.max(this.after, after);
      if (!more) break;
    }
    this.forget();
    return found;
  }

  forget() {
    const over = this.units.length - MOST_KEPT;
    if (over > 0) {
      this.units.splice(0, over);
      this.dropped += over;
    }
    this.steps.splice(0, this.steps.length - MOST_KEPT);
  }
}
