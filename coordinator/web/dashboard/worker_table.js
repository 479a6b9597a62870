// Workers as a table, and what can be done with them.
import { ago, brief, bytes, counted, moment, rate, short, whole } from './format.js';
import { ask } from './dialog.js';
import { bar, chip } from './parts.js';
import { h, setText, toast } from './dom.js';
import { learnWorker, speed } from './farm_state.js';
import { steerWorker } from './api.js';
import { Table } from './table.js';

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
  sub.classList.toggle('warn', Boolean(worker.reason));
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
          onclick: () => steer(td.worker, name),
        }),
      ),
    ),
  );
}

function memoryCell(td, worker) {
  if (!td.firstChild) td.append(h('span', { class: 'with-bar' }, h('span', {}), bar('Memory')));
  const [text, gauge] = td.firstChild.children;
  setText(text, worker.memory_bytes > 0 ? bytes(worker.memory_bytes) : '–');
  const share = worker.memory_limit_bytes > 0 ? Math.min(1, worker.memory_bytes / worker.memory_limit_bytes) : 0;
  gauge.hidden = share === 0;
  gauge.set(share, { state: share > 0.92 ? 'failed' : 'plain' });
  td.title = worker.memory_limit_bytes > 0 ? `of ${bytes(worker.memory_limit_bytes)}` : '';
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
    label: 'Units',
    kind: 'num',
    sort: (w) => w.leased,
    drop: 1,
    cell: (td, w) => setText(td, w.leased),
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
      td.title = `${w.worker_class}\n${w.build}`;
    },
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
    empty,
  });
