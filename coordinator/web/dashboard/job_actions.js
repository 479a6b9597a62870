// What can be done with jobs, and what is asked before.
import * as api from './api.js';
import { ask, confirm } from './dialog.js';
import { counted, listed, whole } from './format.js';
import { dropJob, isOpen, learnJobs } from './farm_state.js';
import { h, say, toast } from './dom.js';
import { whyNotJob } from './me.js';

/** name -> {text, icon, fits(job), done, what(jobs): what will happen, danger}. */
export const ACTIONS = {
  pause: {
    text: 'Pause',
    icon: 'pause',
    fits: (job) => job.state === 'running',
    done: 'paused',
    what: () => 'No more units go out. What is out is delivered and kept.',
  },
  resume: {
    text: 'Resume',
    icon: 'play',
    fits: (job) => job.state === 'paused',
    done: 'resumed',
    what: () => 'Units go out again.',
  },
  cancel: {
    text: 'Cancel',
    icon: 'cancel',
    fits: isOpen,
    done: 'cancelled',
    danger: true,
    what: () => 'Rendering ends. Finished frames stay; what unfinished frames have is kept for a retry.',
  },
  retry: {
    text: 'Retry',
    icon: 'retry',
    fits: (job) => job.state === 'failed' || job.state === 'cancelled' || job.frames_failed > 0 || job.doubtful > 0,
    done: 'retried',
    what: () => 'Failed frames, frames in doubt and what was cancelled are rendered again. Finished frames stay.',
  },
  delete: {
    text: 'Delete',
    icon: 'trash',
    fits: (job) => !isOpen(job),
    done: 'deleted',
    danger: true,
    what: (jobs) =>
      `${whole(jobs.reduce((sum, job) => sum + job.frames_done, 0))} finished frames, with films, pictures and logs, are deleted from the coordinator. This cannot be undone.`,
  },
};

const MOST_NAMED = 8;

function question(name, jobs) {
  const action = ACTIONS[name];
  const named = jobs
    .slice(0, MOST_NAMED)
    .map((job) => h('li', {}, h('b', { text: job.name }), h('span', { class: 'soft', text: ` #${job.id}` })));
  if (jobs.length > MOST_NAMED)
    named.push(h('li', { class: 'soft', text: `and ${counted(jobs.length - MOST_NAMED, 'more job')}` }));
  return confirm({
    title: jobs.length === 1 ? `${action.text} this job?` : `${action.text} ${jobs.length} jobs?`,
    body: [h('ul', { class: 'named' }, named), h('p', { text: action.what(jobs) })],
    action: jobs.length === 1 ? `${action.text} job` : `${action.text} ${jobs.length} jobs`,
    danger: action.danger,
  });
}

/**
 * Does `name` with those of `jobs` that it fits, after asking where much depends on it. Resolves with the jobs as they are
 * then, null where it was not to be.
 */
export async function act(name, jobs) {
  const action = ACTIONS[name];
  const fitting = jobs.filter((job) => action.fits(job) && !whyNotJob(job));
  if (fitting.length === 0) return null;
  if ((action.danger || fitting.length > 1) && !(await question(name, fitting))) return null;
  const results = [];
  const failures = [];
  for (const job of fitting) {
    try {
      if (name === 'delete') {
        await api.forget(job.id);
        dropJob(job.id);
      } else {
        const now = await api.steer(job.id, name);
        results.push(now);
        learnJobs([now]);
      }
    } catch (error) {
      failures.push(`${job.name} #${job.id}: ${error.message}`);
    }
  }
  const good = fitting.length - failures.length;
  if (good > 0)
    toast(fitting.length === 1 ? `${fitting[0].name} ${action.done}` : `${counted(good, 'job')} ${action.done}`);
  if (failures.length > 0) toast(failures.slice(0, 5).join('\n'), 'bad');
  return failures.length < fitting.length ? results : null;
}

/** Asks for a job's priority and sets it. */
export async function askPriority(job) {
  const field = h('input', {
    type: 'number',
    step: 1,
    value: job.priority,
    required: true,
    autofocus: true,
    testid: 'priority-field',
  });
  let changed = null;
  await ask({
    title: 'Priority',
    testid: 'priority-dialog',
    body: [
      h('p', {}, h('b', { text: job.name }), ' · higher goes first; equal ones share the farm.'),
      h('label', { class: 'field' }, 'Priority', field),
    ],
    buttons: [
      { value: '', text: 'Keep as it is' },
      { value: 'set', text: 'Set', kind: 'primary' },
    ],
    check: async () => {
      const priority = Number(field.value);
      if (!Number.isInteger(priority)) throw new Error('A whole number is needed.');
      changed = await api.setPriority(job.id, priority);
      learnJobs([changed]);
      say(`Priority of ${job.name} is ${priority}.`);
    },
  });
  return changed;
}

/** "3 of 24 frames, 1 failed". */
export function framesText(job) {
  const parts = [`${whole(job.frames_done)} of ${counted(job.frames, 'frame')}`];
  if (job.frames_failed > 0) parts.push(`${whole(job.frames_failed)} failed`);
  return listed(parts);
}
