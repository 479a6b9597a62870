// Workers as a table, and what can be done with them.
import { ago, brief, bytes, counted, moment, percent, rate, short, whole } from './format.js';
import { ask } from './dialog.js';
import { bar, chip } from './parts.js';
import { h, setText, toast } from './dom.js';
import { farm, learnWorker, speed } from './farm_state.js';
import { steerWorker } from './api.js';
import { Table } from './table.js';
import { to } from './router.js';
import { whyNotWorkers } from './me.js';

const ORDER = { quarantined: 0, draining: 1, active: 2, gone: 3, unknown: 4 };
const ACTIONS = {
  drain: { text: 'Drain', what: 'It gets no more units, delivers what it has, and leaves.', reason: false },
  quarantine: {
    text: 'Quarantine',
    what: 'It gets no more units until it is released; what it has in hand is given to others.',
    reason: true,
    danger: true,
  },
  release: { text: 'Release', what: 'It gets units again.', reason: false },
};

const fitting = (worker) =>
  ({ active: ['drain', 'quarantine'], draining: ['release', 'quarantine'], quarantined: ['release', 'drain'] })[
    worker.state
  ] ?? [];

async function steer(worker, name) {
  const action = ACTIONS[name];
  const field = h('input', { type: 'text', maxlength: 200, testid: 'reason', autofocus: true });
  await ask({
    title: `${action.text} ${worker.name}?`,
    testid: 'worker-dialog',
    body: [
      h('p', { text: action.what }),
      h('label', { class: 'field' }, action.reason ? 'Reason, for others to read' : 'Reason (optional)', field),
    ],
    buttons: [
      { value: '', text: 'Keep as it is' },
      { value: 'yes', text: action.text, kind: action.danger ? 'danger' : 'primary' },
    ],
    check: async () => {
      learnWorker(await steerWorker(worker.id, name, field.value.trim()));
      toast(`${worker.name}: ${name === 'release' ? 'released' : name === 'drain' ? 'draining' : 'quarantined'}`);
    },
  });
}

function nameCell(td, worker) {
  if (!td.firstChild) {
    td.append(h('span', { class: 'two' }, h('span', { class: 'row-link', tabindex: -1 }), h('span', { class: 'sub' })));
  }
  const [name, sub] = td.firstChild.children;
  setText(name, worker.name);
  setText(sub, worker.reason || [worker.host, ...worker.tags].join(' · '));
  sub.classList.toggle('warn', Boolean(worker.reason) && worker.state !== 'active');
  sub.title = worker.reason;
}

function actionsCell(td, worker) {
  const names = fitting(worker);
  if (td.dataset.names === names.join()) return;
  td.dataset.names = names.join();
  td.replaceChildren(
    h(
      'span',
      { class: 'row-actions' },
      names.map((name) =>
        h('button', {
          type: 'button',
          class: 'small',
          text: ACTIONS[name].text,
          'aria-label': `${ACTIONS[name].text} ${worker.name}`,
          testid: `worker-${name}`,
          disabled: Boolean(whyNotWorkers()),
          title: whyNotWorkers(),
          onclick: () => steer(td.worker, name),
        }),
      ),
    ),
  );
}

// So much of what there may be, with a bar; `full` says from where on that is much.
function fillCell(td, name, some, most, full) {
  if (!td.firstChild) td.append(h('span', { class: 'with-bar' }, h('span', {}), bar(name)));
  const [text, gauge] = td.firstChild.children;
  setText(text, some > 0 ? bytes(some) : '–');
  const share = most > 0 ? Math.min(1, some / most) : 0;
  gauge.hidden = share === 0;
  gauge.set(share, { state: share > full ? 'failed' : 'plain' });
  td.title = most > 0 ? `of ${bytes(most)}` : '';
}

const memoryCell = (td, worker) => fillCell(td, 'Memory', worker.memory_bytes, worker.memory_limit_bytes, 0.92);

function cacheCell(td, worker) {
  // A full cache is as it should be.
  fillCell(td, 'Cache', worker.cache_bytes, worker.cache_limit_bytes, 1);
  const files = worker.cache_hits + worker.cache_misses;
  if (files > 0) td.title += `\n${percent(worker.cache_hits / files)} of ${counted(files, 'file')} were there already`;
}

// How many units it has, and below of what: the frame with the most of them.
function workCell(td, worker) {
  if (!td.firstChild)
    td.append(h('span', { class: 'two' }, h('span', {}), h('span', { class: 'sub' }, h('a', {}), h('span', {}))));
  const [count, of] = td.firstChild.children;
  const [link, more] = of.children;
  setText(count, worker.leased > 0 ? counted(worker.leased, 'unit') : '–');
  const [first, ...others] = worker.work ?? [];
  link.hidden = !first;
  setText(more, others.length > 0 ? ` and ${whole(others.length)} more` : '');
  if (!first) return;
  const name = farm.jobs.get(first.job)?.name ?? `job ${first.job}`;
  setText(link, `${name} ${first.frame}`);
  link.href = to('frame', { job: first.job, frame: first.frame });
  td.title = worker.work
    .map(
      ({ job, frame, units }) =>
        `${counted(units, 'unit')} of frame ${frame}, ${farm.jobs.get(job)?.name ?? `job ${job}`}`,
    )
    .join('\n');
}

const columns = [
  { key: 'name', label: 'Worker', sort: (w) => w.name, up: true, cell: nameCell },
  {
    key: 'state',
    label: 'State',
    sort: (w) => ORDER[w.state] ?? 4,
    up: true,
    cell: (td, w) => (td.firstChild ? td.firstChild.set(w.state) : td.append(chip(w.state))),
  },
  {
    key: 'speed',
    label: 'Speed',
    kind: 'num',
    sort: (w) => speed(w),
    always: true,
    cell: (td, w) => setText(td, rate(speed(w))),
  },
  {
    key: 'leased',
    label: 'In hand',
    sort: (w) => w.leased,
    drop: 1,
    cell: workCell,
  },
  {
    key: 'threads',
    label: 'Threads',
    kind: 'num',
    sort: (w) => w.threads,
    drop: 1,
    cell: (td, w) => setText(td, w.threads),
  },
  {
    key: 'class',
    label: 'Class',
    sort: (w) => w.worker_class,
    up: true,
    drop: 3,
    cell: (td, w) => {
      setText(td, brief(w.worker_class));
      td.title = `${w.worker_class}\nportable: ${w.portable_class || 'none'}\n${w.build}`;
    },
  },
  {
    key: 'cache',
    label: 'Cache',
    kind: 'num',
    sort: (w) => w.cache_bytes,
    drop: 3,
    cell: cacheCell,
  },
  { key: 'memory', label: 'Memory', kind: 'num', sort: (w) => w.memory_bytes, drop: 2, cell: memoryCell },
  {
    key: 'done',
    label: 'Done',
    kind: 'num',
    sort: (w) => w.units_done,
    drop: 2,
    cell: (td, w) => {
      setText(td, short(w.units_done));
      td.title = counted(w.units_done, 'unit');
    },
  },
  {
    key: 'failed',
    label: 'Failures',
    kind: 'num',
    sort: (w) => w.units_failed,
    drop: 1,
    cell: (td, w) => {
      setText(td, whole(w.units_failed));
      td.classList.toggle('warn', w.units_failed > 0);
    },
  },
  {
    key: 'heard',
    label: 'Heard',
    kind: 'num',
    sort: (w) => w.heard_ms,
    drop: 3,
    always: true,
    cell: (td, w) => {
      setText(td, ago(w.heard_ms));
      td.title = `here since ${moment(w.joined_ms)}`;
    },
  },
  {
    key: 'actions',
    label: '',
    spoken: 'Actions',
    kind: 'end',
    cell: (td, w) => {
      td.worker = w;
      actionsCell(td, w);
    },
  },
];

/** The table; `empty()` makes what is shown where there are none. */
export const workerTable = (empty) =>
  new Table({
    columns,
    rowKey: (worker) => worker.id,
    label: 'Workers',
    testid: 'workers-table',
    cards: true,
    sort: { key: 'state', down: false },
    tie: (worker) => worker.name,
    empty,
  });
