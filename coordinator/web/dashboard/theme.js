// Light, dark, or as the system has it.
import { recall, remember } from './memory.js';

const ORDER = ['system', 'light', 'dark'];
const listeners = new Set();

/** The chosen theme: 'system', 'light' or 'dark'. */
export function theme() {
  const chosen = recall('theme', 'system');
  return ORDER.includes(chosen) ? chosen : 'system';
}

/** Takes the theme from now on, and in later visits. */
export function setTheme(name) {
  remember('theme', name);
  if (name === 'system') delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = name;
  for (const listener of listeners) listener();
}

/** The theme after this one, for a button that goes round. */
export const nextTheme = () => ORDER[(ORDER.indexOf(theme()) + 1) % ORDER.length];

/** Calls `listener` when colours change; returns what ends that. */
export function onTheme(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  for (const listener of listeners) listener();
});

/** A colour of the style sheet ('--blue') as canvases take it. */
export function color(variable) {
  const probe = document.createElement('i');
  probe.style.color = `var(${variable})`;
  document.body.append(probe);
  const value = getComputedStyle(probe).color;
  probe.remove();
  return value;
}

/** Whether the person asked for little motion. */
export const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;
