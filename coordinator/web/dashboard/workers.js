// All workers.
import { counted, rateInWords } from './format.js';
import { farm, onFarm, speed } from './farm_state.js';
import { h, setText } from './dom.js';
import { noWorkers } from './welcome.js';
import { workerTable } from './worker_table.js';

/** The view. */
export function workersView() {
  const search = h('input', {
    type: 'search',
    placeholder: 'Name, host, class or tag',
    'aria-label': 'Search workers',
    testid: 'worker-search',
    oninput: () => draw(),
  });
  const summary = h('p', { class: 'summary', 'aria-live': 'off' });
  const states = h(
    'select',
    { 'aria-label': 'State', testid: 'worker-state', onchange: () => draw() },
    [
      ['', 'All states'],
      ['active', 'Active'],
      ['draining', 'Draining'],
      ['quarantined', 'Quarantined'],
      ['gone', 'Gone'],
    ].map(([value, text]) => h('option', { value, text })),
  );
  const table = workerTable(() =>
    farm.workers.size === 0 ? noWorkers() : h('p', { class: 'soft', text: 'None of them is like that.' }),
  );
  const draw = () => {
    if (!farm.info) return;
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const all = [...farm.workers.values()];
    table.setRows(
      all.filter(
        (worker) =>
          (!states.value || worker.state === states.value) &&
          words.every((word) =>
            [
              worker.name,
              worker.host,
              worker.worker_class,
              worker.portable_class,
              worker.build,
              worker.reason,
              ...worker.tags,
            ].some((text) => text.toLowerCase().includes(word)),
          ),
      ),
    );
    const here = all.filter(({ state }) => state !== 'gone');
    setText(
      summary,
      all.length === 0
        ? ''
        : `${counted(here.length, 'worker')}, ${counted(here.reduce((sum, { threads }) => sum + threads, 0), 'thread')}, ${rateInWords(all.reduce((sum, worker) => sum + speed(worker), 0))}`,
    );
  };
  const leave = onFarm((what) => what.has('workers') && draw());
  const timer = setInterval(() => table.refresh(), 5000);
  const node = h(
    'div',
    { class: 'view' },
    h('div', { class: 'view-head' }, h('h1', { text: 'Workers' }), summary),
    h('div', { class: 'filters' }, search, states),
    table.node,
  );
  draw();
  return {
    node,
    title: 'Workers',
    keysTitle: 'Workers',
    keys: [
      { keys: 'j', what: 'Next worker', run: () => table.step(1) },
      { keys: 'k', what: 'Worker before', run: () => table.step(-1) },
    ],
    shown: draw,
    leave: () => {
      leave();
      clearInterval(timer);
      table.leave();
    },
  };
}
