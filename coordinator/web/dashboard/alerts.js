// What needs a person, with the worst first.
import { farm, isOpen } from './farm_state.js';
import { h, keyed, setText } from './dom.js';
import { recall, remember } from './memory.js';
import { counted } from './format.js';
import { icon } from './icons.js';
import { me } from './me.js';
import { lookOf } from './job_state.js';
import { to } from './router.js';

const MOST = 4;
const MOST_HUSHED = 100;
/** Jobs that failed so lately are told. */
const FRESH = 12 * 3600e3;

/** What needs a person: [{key, text, bad, href, what}], the worst first. */
export function alertsOf({ info, jobs, workers, me }, now = Date.now()) {
  const list = [];
  if (me?.expiring)
    list.push({ key: `expiring ${me.token_id}`, text: `Your token ${me.expiring}: ask an admin for another.` });
  if (info?.unguarded) list.push({ key: `unguarded ${info.unguarded}`, bad: true, text: info.unguarded });
  if (info?.trouble) list.push({ key: `trouble ${info.trouble}`, bad: true, text: info.trouble });
  for (const worker of workers.values()) {
    if (worker.state === 'quarantined')
      list.push({
        key: `w${worker.id}q`,
        bad: true,
        href: to('workers'),
        what: worker.name,
        text: `is quarantined${worker.reason ? `: ${worker.reason}` : ''}`,
      });
    if (worker.state === 'gone')
      list.push({
        key: `w${worker.id}g${worker.heard_ms}`,
        href: to('workers'),
        what: worker.name,
        text: `is gone${worker.reason ? `: ${worker.reason}` : ''}; what it had in hand goes to others`,
      });
  }
  for (const job of jobs.values()) {
    const href = to('job', { job: job.id });
    if (job.state === 'failed' && job.ended_ms > now - FRESH)
      list.push({
        key: `j${job.id}f${job.ended_ms}`,
        bad: true,
        href,
        what: job.name,
        text: `has failed${job.reason ? `: ${job.reason}` : ''}`,
      });
    // That nobody is there is told once, where the workers are.
    else if (isOpen(job) && job.reason && !(lookOf(job) === 'waiting' && info?.workers === 0))
      list.push({
        key: `j${job.id}r${job.reason}`,
        href,
        what: job.name,
        text: lookOf(job) === 'waiting' ? `waits: ${job.reason}` : job.reason,
      });
    else if (isOpen(job) && job.frames_failed > 0)
      list.push({
        key: `j${job.id}n${job.frames_failed}`,
        href,
        what: job.name,
        text: `${counted(job.frames_failed, 'frame')} failed so far`,
      });
  }
  return list.sort((a, b) => Boolean(b.bad) - Boolean(a.bad));
}

/** The list on the page; a person can hide what is known. `draw()` after changes of the farm. */
export class Alerts {
  constructor() {
    this.hushed = new Set(recall('hushed', '').split('\n').filter(Boolean));
    this.node = h('ul', { class: 'alerts', 'aria-label': 'What needs attention', testid: 'alerts' });
    this.all = false;
  }

  draw() {
    const list = alertsOf({ ...farm, me }).filter(({ key }) => !this.hushed.has(key));
    this.node.hidden = list.length === 0;
    // For one that is left out, the line that says so is as long.
    const shown = this.all || list.length <= MOST + 1 ? [...list] : list.slice(0, MOST);
    if (shown.length < list.length) shown.push({ key: 'more', more: list.length - shown.length });
    keyed(
      this.node,
      shown,
      ({ key }) => key,
      (alert) => (alert.more ? this.rest() : this.item(alert)),
    );
  }

  item({ key, text, bad, href, what }) {
    const hide = h('button', {
      type: 'button',
      class: 'plain small',
      text: 'Hide',
      'aria-label': `Hide: ${what ?? ''} ${text}`,
      onclick: () => this.hush(key),
    });
    const words = h('p', {}, href ? [h('a', { href, text: what }), ' '] : null, text);
    return h('li', { class: `alert ${bad ? 'bad' : ''}` }, icon('warning'), words, hide);
  }

  rest() {
    const show = () => {
      this.all = true;
      this.draw();
    };
    const button = h('button', { type: 'button', class: 'plain', testid: 'more-alerts', onclick: show });
    const node = h('li', {}, button);
    node.refresh = ({ more }) => setText(button, `${more} more`);
    return node;
  }

  hush(key) {
    this.hushed.add(key);
    remember('hushed', [...this.hushed].slice(-MOST_HUSHED).join('\n'));
    this.draw();
  }
}
