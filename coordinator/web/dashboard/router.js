// Addresses of views, after the '#': deep links work behind any proxy, and the server knows one page only.

/** The tabs of a job, the first one without a name in the address. */
export const TABS = ['frames', 'log', 'outputs', 'document', 'timeline'];

const number = (text) => (/^-?\d+$/.test(text ?? '') ? Number(text) : null);

/**
 * '#/jobs/12/frames/7?layer=normal' -> {view, job, frame, tab, query}. Views: farm, jobs, job, frame, play, workers, submit,
 * lost (there is no such address).
 */
export function parse(hash) {
  const [path, search = ''] = hash.replace(/^#/, '').split('?');
  const query = Object.fromEntries(new URLSearchParams(search));
  const parts = path.split('/').filter((part) => part !== '');
  const route = (view, more = {}) => ({ view, query, ...more });
  if (parts.length === 0) return route('farm');
  const [room, id, what, which, ...rest] = parts;
  if (rest.length > 0) return route('lost');
  if (room === 'workers' && parts.length === 1) return route('workers');
  if (room === 'submit' && parts.length === 1) return route('submit');
  if (room !== 'jobs') return route('lost');
  if (id === undefined) return route('jobs');
  const job = number(id);
  if (job === null || job < 1) return route('lost');
  if (what === undefined) return route('job', { job, tab: TABS[0] });
  if (what === 'frames' && which !== undefined) {
    const frame = number(which);
    return frame === null ? route('lost') : route('frame', { job, frame });
  }
  if (which !== undefined) return route('lost');
  if (what === 'play') return route('play', { job });
  return TABS.includes(what) ? route('job', { job, tab: what }) : route('lost');
}

/** The address of a view; what `parse` reads. */
export function to(view, { job, frame, tab, query } = {}) {
  let path = '#/';
  if (view === 'job') path = `#/jobs/${job}${tab && tab !== TABS[0] ? `/${tab}` : ''}`;
  else if (view === 'frame') path = `#/jobs/${job}/frames/${frame}`;
  else if (view === 'play') path = `#/jobs/${job}/play`;
  else if (view !== 'farm') path = `#/${view}`;
  const filled = Object.entries(query ?? {}).filter(
    ([, value]) => value !== undefined && value !== null && value !== '',
  );
  return filled.length > 0 ? `${path}?${new URLSearchParams(filled)}` : path;
}

/** Changes the query of the address in place: no new entry of the history, no new view. */
export function replaceQuery(query) {
  const route = parse(location.hash);
  history.replaceState(history.state, '', to(route.view, { ...route, query }));
}
