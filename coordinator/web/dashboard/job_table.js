// The table of jobs: its columns.
import { bar, chip } from './parts.js';
import { coreHours, counted, duration, moment, money, percent, rate, whole } from './format.js';
import { h, setText } from './dom.js';
import { askPriority } from './job_actions.js';
import { farm, isOpen } from './farm_state.js';
import { whyNotJob } from './me.js';
import { leftOf, lookOf, otherFrames, share, tookOf } from './job_state.js';
import { stamp } from './preview.js';
import { Table } from './table.js';
import { to } from './router.js';

const nameCell = (thumbs) => (td, job) => {
  if (!td.firstChild)
    td.append(
      h(
        'span',
        { class: 'pictured' },
        stamp(thumbs),
        h('span', { class: 'two' }, h('a', { class: 'row-link', testid: 'job-link' }), h('span', { class: 'sub' })),
      ),
    );
  const [picture, two] = td.firstChild.children;
  const [link, sub] = two.children;
  picture.refresh(job);
  setText(link, job.name);
  link.title = job.name;
  link.href = to('job', { job: job.id });
  setText(
    sub,
    job.reason ? `#${job.id} · ${job.reason}` : `#${job.id}${job.tags.length ? ` · ${job.tags.join(', ')}` : ''}`,
  );
  sub.title = job.reason;
  sub.classList.toggle('warn', Boolean(job.reason) && job.state !== 'done');
};

function progressCell(td, job) {
  if (!td.firstChild)
    td.append(h('span', { class: 'progress' }, bar('Progress'), h('span', { class: 'progress-text' })));
  const [gauge, text] = td.firstChild.children;
  gauge.set(share(job), { failed: job.frames > 0 ? job.frames_failed / job.frames : 0, state: job.state });
  setText(text, `${percent(share(job))} · ${whole(job.frames_done)}/${whole(job.frames)}`);
  td.title = `${counted(job.frames, 'frame')}, ${whole(job.frames_done)} done${otherFrames(job)}`;
}

const ORDER = { running: 0, waiting: 1, paused: 2, failed: 3, cancelled: 4, done: 5 };

function costCell(td, job) {
  if (!td.firstChild) td.append(h('span', { class: 'two' }, h('span', {}), h('span', { class: 'sub' })));
  const [time, price] = td.firstChild.children;
  setText(time, coreHours(job.core_seconds));
  const priced = farm.info?.price_per_core_hour > 0 && job.core_seconds > 0;
  setText(price, priced ? money(job.cost, farm.info.currency) : '');
}

const chooseCell = (choose) => (td, job, chosen) => {
  if (!td.firstChild) {
    td.append(
      h(
        'label',
        {},
        h('input', {
          type: 'checkbox',
          testid: 'choose',
          tabindex: -1,
          onclick: (event) => choose(td.job.id, event.shiftKey),
        }),
      ),
    );
  }
  td.job = job;
  const box = td.firstChild.firstChild;
  box.checked = chosen;
  box.setAttribute('aria-label', `Choose ${job.name}, job ${job.id}`);
};

function priorityCell(td, job) {
  if (!td.firstChild)
    td.append(
      h('button', {
        type: 'button',
        class: 'plain number',
        testid: 'priority',
        tabindex: -1,
        onclick: () => isOpen(td.job) && askPriority(td.job),
      }),
    );
  td.job = job;
  setText(td.firstChild, job.priority);
  td.firstChild.disabled = !isOpen(job) || Boolean(whyNotJob(job));
  td.firstChild.title = whyNotJob(job);
  td.firstChild.setAttribute('aria-label', `Priority ${job.priority}${isOpen(job) ? ', change' : ''}`);
}

const columnsWith = (thumbs) => [
  { key: 'name', label: 'Job', sort: (job) => job.name, up: true, cell: nameCell(thumbs) },
  {
    key: 'state',
    label: 'State',
    sort: (job) => ORDER[lookOf(job)] ?? 9,
    up: true,
    cell: (td, job) => (td.firstChild ? td.firstChild.set(lookOf(job)) : td.append(chip(lookOf(job)))),
  },
  { key: 'progress', label: 'Progress', sort: share, cell: progressCell },
  {
    key: 'left',
    label: 'Time left',
    kind: 'num',
    sort: leftOf,
    up: true,
    cell: (td, job) => setText(td, Number.isFinite(leftOf(job)) ? duration(leftOf(job)) : ''),
  },
  {
    key: 'speed',
    label: 'Speed',
    kind: 'num',
    drop: 2,
    sort: (job) => (isOpen(job) ? job.samples_per_second : 0),
    cell: (td, job) =>
      setText(td, lookOf(job) === 'running' && job.samples_per_second > 0 ? rate(job.samples_per_second) : ''),
  },
  {
    key: 'cost',
    label: 'Core-hours',
    kind: 'num',
    drop: 3,
    sort: (job) => job.core_seconds,
    cell: costCell,
  },
  {
    key: 'priority',
    label: 'Priority',
    kind: 'num',
    drop: 1,
    sort: (job) => job.priority,
    cell: priorityCell,
  },
  {
    key: 'owner',
    label: 'Owner',
    drop: 1,
    sort: (job) => job.owner,
    up: true,
    cell: (td, job) => setText(td, job.owner),
  },
  {
    key: 'took',
    label: 'Took',
    kind: 'num',
    drop: 3,
    always: true,
    sort: (job) => tookOf(job) || -1,
    cell: (td, job) => setText(td, duration(tookOf(job))),
  },
  {
    key: 'id',
    label: 'Submitted',
    kind: 'num',
    drop: 2,
    sort: (job) => job.id,
    cell: (td, job) => {
      setText(td, moment(job.submitted_ms));
      td.title = new Date(job.submitted_ms).toLocaleString();
    },
  },
];

/**
 * The table; `all`: the node for choosing all, `choose(id, range)`: one is chosen or not any more, `thumbs`: who loads pictures
 * (thumbs.js), others as for Table.
 */
export const jobTable = ({ all, choose, thumbs, ...options }) =>
  new Table({
    label: 'Jobs',
    testid: 'jobs-table',
    cards: true,
    rowKey: (job) => job.id,
    onChosen: choose,
    columns: [{ key: 'choose', label: '', header: () => all, cell: chooseCell(choose) }, ...columnsWith(thumbs)],
    onGone: (tr) => tr.querySelector('.row-picture')?.drop(),
    ...options,
  });
