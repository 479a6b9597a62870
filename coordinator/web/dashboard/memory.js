// What the page remembers between visits, where the browser lets it.

/** What was kept under `name`, or `otherwise`. */
export function recall(name, otherwise) {
  try {
    return localStorage.getItem(`hyades.${name}`) ?? otherwise;
  } catch {
    return otherwise;
  }
}

/** Keeps a text; an empty one is forgotten. */
export function remember(name, text) {
  try {
    if (text === '') localStorage.removeItem(`hyades.${name}`);
    else localStorage.setItem(`hyades.${name}`, text);
  } catch {
    // Storage is full or forbidden: the page works without.
  }
}
