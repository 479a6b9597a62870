// Small pieces that several views show.
import { h, s, setAttribute, setText } from './dom.js';
import { percent } from './format.js';

const STATE_WORDS = { unknown: 'unknown state', loading: 'loading…' };

/** The state of a job, frame or worker, with a mark that does without colour. */
export function chip(state) {
  const node = h('span', { class: 'chip' }, h('i', { 'aria-hidden': 'true' }), h('span', {}));
  node.set = (now) => {
    if (node.dataset.state === now) return;
    node.dataset.state = now;
    setText(node.lastChild, STATE_WORDS[now] ?? now);
  };
  node.set(state);
  return node;
}

/** A bar of how much is done. `set(share, {failed, state})`: shares 0..1. */
export function bar(label) {
  const done = h('i', { class: 'bar-done' });
  const failed = h('i', { class: 'bar-failed' });
  const node = h(
    'span',
    { class: 'bar', role: 'progressbar', 'aria-label': label, 'aria-valuemin': 0, 'aria-valuemax': 100 },
    done,
    failed,
  );
  node.set = (share, { failed: bad = 0, state = 'running' } = {}) => {
    done.style.transform = `scaleX(${share})`;
    failed.style.transform = `scaleX(${bad})`;
    node.dataset.state = state;
    setAttribute(node, 'aria-valuenow', Math.floor(share * 100));
    setAttribute(node, 'aria-valuetext', percent(share));
  };
  return node;
}

/** A number with its name below; `set(text)`. The last child may take a button. */
export function figure(name, testid, title) {
  const number = h('span', { text: '–', testid });
  const node = h('div', { class: 'figure', title }, h('dt', { text: name }), h('dd', {}, number));
  node.set = (text) => setText(number, text);
  return node;
}

/** What stands where the coordinator's answer is waited for; `kind` 'box-head' in a box. */
export const asking = (kind = 'pad') => h('p', { class: `soft ${kind}`, text: 'Asking the coordinator…' });

/** A message for where there is no data: a title, then nodes. */
export const nothing = (title, ...body) =>
  h(
    'div',
    { class: 'nothing' },
    s(
      'svg',
      { viewBox: '0 0 120 60', 'aria-hidden': 'true', class: 'nothing-sky' },
      s('path', { d: 'M18 8 40 22 52 34 72 52 82 36 106 12' }),
      ...[
        [18, 8, 2],
        [40, 22, 1.4],
        [52, 34, 1.7],
        [72, 52, 2],
        [82, 36, 1.7],
      ].map(([cx, cy, r]) => s('circle', { cx, cy, r })),
      s('circle', { class: 'giant', cx: 106, cy: 12, r: 3 }),
    ),
    h('h2', { text: title }),
    ...body,
  );

/** A command to copy. */
export function command(text) {
  const button = h('button', { type: 'button', class: 'small', text: 'Copy', 'aria-label': `Copy: ${text}` });
  button.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(text);
      setText(button, 'Copied');
    } catch {
      // Not a secure page: the text is selected instead.
      getSelection().selectAllChildren(node.firstChild);
      setText(button, 'Press Ctrl C');
    }
    setTimeout(() => setText(button, 'Copy'), 2000);
  });
  const node = h('span', { class: 'command' }, h('code', { text }), button);
  return node;
}
