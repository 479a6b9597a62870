// Before the first paint, so that a chosen theme does not flash; theme.js does the rest.
(() => {
  try {
    const chosen = localStorage.getItem('hyades.theme');
    if (chosen === 'light' || chosen === 'dark') document.documentElement.dataset.theme = chosen;
  } catch {
    // No storage (a strict browser): the system's scheme is used.
  }
})();
