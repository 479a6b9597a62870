// What has happened with a job, as it happens.
import { clock } from './format.js';
import { h } from './dom.js';
import { logs } from './api.js';

const EVERY = 2000;
/** More lines than these make a page slow; older ones leave. */
const MOST = 5000;

/** The tab. */
export function logTab(state) {
  const list = h('ol', { class: 'log', 'aria-label': 'Log', tabindex: 0, testid: 'log' });
  const follow = h('input', { type: 'checkbox', checked: true, testid: 'follow' });
  const search = h('input', {
    type: 'search',
    placeholder: 'Text, frame or worker',
    'aria-label': 'Search the log',
    testid: 'log-search',
    oninput: () => filter(),
  });
  const levels = h(
    'select',
    { 'aria-label': 'Level', testid: 'log-level', onchange: () => filter() },
    [
      ['', 'All lines'],
      ['warning', 'Warnings and errors'],
      ['error', 'Errors'],
    ].map(([value, text]) => h('option', { value, text })),
  );
  const none = h('p', { class: 'soft pad', text: 'No lines yet.' });
  const node = h(
    'div',
    {},
    h(
      'div',
      { class: 'filters pad' },
      search,
      levels,
      h('span', { class: 'spring' }),
      h('label', { class: 'check' }, follow, 'Follow'),
    ),
    none,
    list,
  );
  const stop = new AbortController();
  let after = 0;
  let timer = 0;
  let busy = false;

  const fits = (line) => {
    if (levels.value === 'error' && line.level !== 'error') return false;
    if (levels.value === 'warning' && !['warning', 'error'].includes(line.level)) return false;
    const word = search.value.toLowerCase();
    return (
      word === '' ||
      line.text.toLowerCase().includes(word) ||
      line.worker.toLowerCase().includes(word) ||
      (line.frame !== undefined && `frame ${line.frame}`.includes(word))
    );
  };
  const filter = () => {
    for (const item of list.children) item.hidden = !fits(item.line);
  };
  const row = (line) => {
    const time = new Date(line.time_ms);
    const item = h(
      'li',
      { 'data-level': line.level },
      h('time', { datetime: time.toISOString(), title: time.toLocaleString(), text: clock(line.time_ms) }),
      h('span', { class: 'from', text: line.frame === undefined ? '' : `frame ${line.frame}` }),
      h('span', { class: 'from', text: line.worker, title: line.worker }),
      h(
        'span',
        { class: 'said' },
        ['warning', 'error'].includes(line.level) ? h('span', { class: 'unseen', text: `${line.level}: ` }) : null,
        line.text,
      ),
    );
    item.line = line;
    item.hidden = !fits(line);
    return item;
  };
  const ask = async () => {
    if (busy || document.hidden || stop.signal.aborted) return;
    busy = true;
    let more = true;
    try {
      while (more) {
        const page = await logs(state.id, after, stop.signal);
        more = page.more && page.lines.length > 0;
        if (page.lines.length === 0) break;
        after = page.lines[page.lines.length - 1].id;
        const atEnd = scrollY + innerHeight > document.documentElement.scrollHeight - 80;
        list.append(...page.lines.map(row));
        while (list.children.length > MOST) list.firstChild.remove();
        if (follow.checked && (atEnd || !list.seen)) scrollTo(0, document.documentElement.scrollHeight);
      }
      list.seen = true;
    } catch {
      // Asked again soon.
    }
    none.hidden = list.children.length > 0;
    busy = false;
  };
  timer = setInterval(ask, EVERY);
  ask();
  return {
    node,
    leave: () => {
      stop.abort();
      clearInterval(timer);
    },
  };
}
