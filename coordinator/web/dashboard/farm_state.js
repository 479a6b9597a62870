// The farm as it is now, kept by one stream for all views.
import * as api from './api.js';
import { changedRow } from './changed_row.js';
import { listen } from './live.js';
import { say } from './dom.js';

/** Over so many milliseconds the speed of a worker is told: units come in lumps. */
const SPEED_WINDOW = 45000;
/** The rows of throughput: a value each 5 seconds, an hour of them. */
const LONGEST_SERIES = 720;

/** info: null until the first snapshot. jobs: all that are known, open or not. series: samples/s, each 5 s, the latest last. */
export const farm = { info: null, jobs: new Map(), workers: new Map(), series: [], seriesEnd: 0 };

const listeners = new Set();
const histories = new Map();

/** Whether a job has not ended. */
export const isOpen = (job) => job.state === 'running' || job.state === 'paused';

/** Calls `listener(what)` after changes, `what` a set of 'info', 'jobs', 'workers', 'series'; returns what ends that. */
export function onFarm(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

const tell = (...what) => {
  const set = new Set(what);
  for (const listener of listeners) listener(set);
};

/** Takes in jobs that a call brought (older pages, a job after an action). */
export function learnJobs(jobs) {
  for (const job of jobs) farm.jobs.set(job.id, job);
  tell('jobs');
}

/** A job was deleted. */
export function dropJob(id) {
  farm.jobs.delete(id);
  tell('jobs');
}

/** Takes in a worker that an action brought. */
export function learnWorker(worker) {
  farm.workers.set(worker.id, worker);
  tell('workers');
}

function note(worker, now) {
  let history = histories.get(worker.id);
  if (!history) histories.set(worker.id, (history = []));
  const last = history[history.length - 1];
  if (last && worker.samples_done < last.samples) history.length = 0;
  history.push({ at: now, samples: worker.samples_done });
  while (history.length > 2 && history[1].at < now - SPEED_WINDOW) history.shift();
}

/** Samples per second of a worker lately; 0 where nothing is known yet. */
export function speed(worker, now = Date.now()) {
  if (worker.samples_per_second !== undefined) return worker.state === 'gone' ? 0 : worker.samples_per_second;
  const history = histories.get(worker.id);
  if (!history || history.length < 2 || worker.state === 'gone') return 0;
  const first = history[0];
  const last = history[history.length - 1];
  const span = Math.max(last.at - first.at, now - first.at - 5000);
  return span > 0 ? ((last.samples - first.samples) / span) * 1000 : 0;
}

const ENDS = { done: 'is done', failed: 'has failed', cancelled: 'was cancelled' };

function takeJob(change) {
  const before = farm.jobs.get(change.id);
  const job = changedRow(before, change);
  if (!job) return;
  if (before && isOpen(before) && ENDS[job.state]) say(`Job ${job.name} ${ENDS[job.state]}.`);
  farm.jobs.set(job.id, job);
}

function takeWorker(change, now) {
  const before = farm.workers.get(change.id);
  const worker = changedRow(before, change);
  if (!worker) return;
  if (before && before.state !== worker.state && worker.state !== 'active') {
    say(`Worker ${worker.name} is ${worker.state}${worker.reason ? `: ${worker.reason}` : ''}.`);
  }
  farm.workers.set(worker.id, worker);
  note(worker, now);
}

/** A job that was open and is so no more, while nobody listened here. */
async function askForEnd(id) {
  try {
    // Only the job itself: there are no frames above.
    const { job } = await api.job(id, { after: 2147483646 });
    takeJob(job);
  } catch (error) {
    if (error.status === 404) farm.jobs.delete(id);
  }
  tell('jobs');
}

/** Begins to listen; once, by main.js. */
export function startFarm() {
  listen(
    'api/v1/events',
    {
      snapshot(all) {
        const now = Date.now();
        const open = new Set(all.jobs.map(({ id }) => id));
        for (const [id, job] of farm.jobs) if (isOpen(job) && !open.has(id)) askForEnd(id);
        for (const job of all.jobs) farm.jobs.set(job.id, job);
        farm.workers = new Map();
        for (const worker of all.workers) takeWorker(worker, now);
        farm.info = all.info;
        farm.series = all.samples_per_second;
        farm.seriesEnd = now;
        tell('snapshot', 'info', 'jobs', 'workers', 'series');
      },
      change(change) {
        const now = Date.now();
        const what = [];
        if (change.info) {
          farm.info = change.info;
          what.push('info');
        }
        for (const job of change.jobs ?? []) takeJob(job);
        for (const id of change.removed_jobs ?? []) farm.jobs.delete(id);
        if (change.jobs?.length || change.removed_jobs?.length) what.push('jobs');
        for (const worker of change.workers ?? []) takeWorker(worker, now);
        for (const id of change.removed_workers ?? []) {
          farm.workers.delete(id);
          histories.delete(id);
        }
        if (change.workers?.length || change.removed_workers?.length) what.push('workers');
        if (change.samples_per_second !== undefined) {
          farm.series.push(change.samples_per_second);
          if (farm.series.length > LONGEST_SERIES) farm.series.shift();
          farm.seriesEnd = now;
          what.push('series');
        }
        if (what.length > 0) tell(...what);
      },
    },
    { lively: true },
  );
}
