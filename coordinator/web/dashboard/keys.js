// Keyboard shortcuts: those of the page and those of the view that is shown, told by '?'.
import { h } from './dom.js';
import { ask } from './dialog.js';

const layers = [];
let first = '';
let firstAt = 0;

const typing = (target) =>
  target.isContentEditable ||
  (['INPUT', 'TEXTAREA', 'SELECT'].includes(target.tagName) &&
    !['checkbox', 'radio', 'range', 'button'].includes(target.type));

/**
 * Adds shortcuts: [{keys: 'g j', what: 'Jobs', run(event), shown}]. `keys`: KeyboardEvent.key, two of them with a space one after the
 * other; several with '|'. `shown`: how the help calls them. Later layers win. Returns what takes them away.
 */
export function shortcuts(title, list) {
  const layer = { title, list };
  layers.push(layer);
  return () => layers.splice(layers.indexOf(layer), 1);
}

function find(pressed) {
  for (let i = layers.length - 1; i >= 0; --i) {
    const hit = layers[i].list.find(({ keys }) => keys.split('|').includes(pressed));
    if (hit) return hit;
  }
  return null;
}

addEventListener('keydown', (event) => {
  if (
    event.defaultPrevented ||
    event.ctrlKey ||
    event.metaKey ||
    event.altKey ||
    document.querySelector('dialog[open]')
  )
    return;
  if (typing(event.target)) {
    if (event.key === 'Escape') event.target.blur();
    return;
  }
  const name = event.key === ' ' ? 'Space' : event.key;
  // A button or link that has the focus answers these itself.
  if ((name === 'Space' || name === 'Enter') && event.target.closest('button, a, summary, [role=slider]')) return;
  if (event.target.type === 'range' && name.startsWith('Arrow')) return;
  const pair = Date.now() - firstAt < 1200 ? find(`${first} ${name}`) : null;
  first = name;
  firstAt = Date.now();
  const hit = pair ?? find(name);
  if (!hit) return;
  event.preventDefault();
  hit.run(event);
});

/** The dialog with all shortcuts that work now. */
export function help() {
  const key = (text) => h('kbd', { text });
  const body = layers.map(({ title, list }) =>
    h(
      'section',
      { class: 'help-part' },
      h('h3', { text: title }),
      h(
        'dl',
        { class: 'keys' },
        list
          .filter(({ what }) => what)
          .map(({ keys, shown, what }) => [
            h('dt', {}, (shown ?? keys.split('|')[0]).split(' ').map(key)),
            h('dd', { text: what }),
          ]),
      ),
    ),
  );
  return ask({
    title: 'Keyboard',
    body: [h('div', { class: 'help' }, body)],
    buttons: [{ value: '', text: 'Close' }],
    testid: 'help',
  });
}
