// Building nodes. Whatever comes from the farm becomes text, never markup.

const SVG = 'http://www.w3.org/2000/svg';

function fill(node, props, children) {
  for (const [name, value] of Object.entries(props ?? {})) {
    if (value == null || value === false) continue;
    if (name === 'class') node.setAttribute('class', value);
    else if (name === 'text') node.textContent = value;
    else if (name === 'testid') node.dataset.testid = value;
    else if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (name === 'value' || name === 'checked' || name === 'disabled') node[name] = value;
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.flat(9).filter((child) => child != null && child !== false));
  return node;
}

/**
 * An element. Props: `class`, `text`, `testid`, `onEVENT` listeners, else attributes (null and false: none).
 * Children: nodes, texts, lists of them; null and false are left out.
 */
export const h = (name, props, ...children) => fill(document.createElement(name), props, children);

/** An element of SVG, with props and children as those of h(). */
export const s = (name, props, ...children) => fill(document.createElementNS(SVG, name), props, children);

/** Sets a text where it is another one: layout stays where nothing changed. */
export function setText(node, text) {
  const now = String(text);
  if (node.textContent !== now) node.textContent = now;
}

/** Sets or takes away an attribute where that changes something. */
export function setAttribute(node, name, value) {
  if (value == null || value === false) {
    if (node.hasAttribute(name)) node.removeAttribute(name);
  } else if (node.getAttribute(name) !== String(value)) {
    node.setAttribute(name, value);
  }
}

/**
 * Makes the children of `parent` those of `items`, in order, keeping nodes by key. `make(item)` gives a node with, where
 * it wants, a function `refresh(item)`.
 */
export function keyed(parent, items, key, make) {
  const nodes = (parent.keyedNodes ??= new Map());
  const seen = new Set();
  let at = parent.firstChild;
  for (const item of items) {
    const id = key(item);
    seen.add(id);
    let node = nodes.get(id);
    if (node === undefined) {
      node = make(item);
      nodes.set(id, node);
    }
    node.refresh?.(item);
    if (node === at) at = at.nextSibling;
    else parent.insertBefore(node, at);
  }
  for (const [id, node] of nodes) {
    if (seen.has(id)) continue;
    node.remove();
    nodes.delete(id);
  }
}

/** Calls `work` at most once a frame of the screen, however often it is asked. */
export function oncePerFrame(work) {
  let asked = 0;
  const ask = () => {
    asked ||= requestAnimationFrame(() => {
      asked = 0;
      work();
    });
  };
  ask.cancel = () => cancelAnimationFrame(asked);
  return ask;
}

/** Tells screen readers. */
export function say(text) {
  const speech = document.getElementById('speech');
  speech.append(h('p', { text }));
  while (speech.children.length > 20) speech.firstChild.remove();
}

/** A toast that is younger tells of what has led to another page. */
const TOAST_STAYS = 1000;

/** Takes away what was said of the page before. */
export function clearToasts(now = Date.now()) {
  for (const node of [...document.getElementById('toasts').children]) {
    if (now - node.shownAt > TOAST_STAYS) node.remove();
  }
}

/** Shows a short message for some seconds. Kinds: 'good', 'bad'. */
export function toast(text, kind = 'good') {
  const node = h(
    'div',
    { class: `toast ${kind}`, testid: 'toast' },
    h('p', { text }),
    h('button', { class: 'plain', type: 'button', 'aria-label': 'Dismiss', text: '×', onclick: () => node.remove() }),
  );
  node.shownAt = Date.now();
  document.getElementById('toasts').append(node);
  setTimeout(() => node.remove(), kind === 'bad' ? 12000 : 5000);
}
