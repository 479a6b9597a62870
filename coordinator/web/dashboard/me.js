// Who is signed in, and what their role lets them do. The coordinator decides; buttons that it would refuse say so before.
import * as api from './api.js';

/** Who is signed in, as GET api/v1/session has it. Until that is known everything may be tried. */
export const me = { guarded: false, role: 'admin', name: '', token_id: '', expiring: '' };

const RANKS = { viewer: 1, submitter: 2, operator: 3, admin: 4 };
const listeners = new Set();
const rank = () => RANKS[me.role] ?? 0;

/** Calls `listener` when somebody else is signed in. */
export function onMe(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Asks who is signed in. Where nobody is, the page is told to sign in by its other calls. */
export async function learnMe() {
  const before = `${me.role} ${me.name} ${me.guarded}`;
  try {
    Object.assign(me, await api.session());
  } catch {
    return;
  }
  if (before === `${me.role} ${me.name} ${me.guarded}`) return;
  for (const listener of listeners) listener();
}

/** Why the person who is signed in may not submit jobs; empty: they may. */
export const whyNotSubmit = () => (rank() >= RANKS.submitter ? '' : `Needs the role submitter: yours is ${me.role}.`);

/** Why the person who is signed in may not steer workers; empty: they may. */
export const whyNotWorkers = () => (rank() >= RANKS.operator ? '' : `Needs the role operator: yours is ${me.role}.`);

/** Why the person who is signed in may not steer this job; empty: they may. */
export function whyNotJob(job) {
  if (rank() >= RANKS.operator) return '';
  if (rank() < RANKS.submitter) return whyNotSubmit();
  if (job.owner === me.name && !job.owner_proven)
    return `It was submitted in the name of ${job.owner} without a token that proves it: operators may.`;
  return job.owner === me.name ? '' : `It belongs to ${job.owner || 'nobody in particular'}: its owner and operators may.`;
}

/** "alice, submitter"; empty where the farm asks for no token. */
export const whoAmI = () => (me.guarded ? [me.name, me.role].filter(Boolean).join(', ') : '');
