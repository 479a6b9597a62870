// The page: navigation, the view that the address asks for, what is true everywhere.
import { farm, onFarm, startFarm } from './farm_state.js';
import { clearToasts, h, setText } from './dom.js';
import { help, shortcuts } from './keys.js';
import { icon, mark } from './icons.js';
import { lost, onConnection } from './live.js';
import { nextTheme, setTheme, theme } from './theme.js';
import { parse, to } from './router.js';
import { onMe, whoAmI } from './me.js';
import { signOutButton, startSession } from './session.js';
import { closeDialogs } from './dialog.js';
import { counted } from './format.js';
import { enter, scrollBack } from './place.js';
import { farmView } from './farm.js';
import { jobsView } from './jobs.js';
import { jobView } from './job.js';
import { frameView } from './viewer.js';
import { flipbookView } from './flipbook.js';
import { workersView } from './workers.js';
import { submitView } from './submit.js';
import { offerDrop } from './drop.js';

/**
 * A view: a function of the route that gives {node, title, shown(), atPlace(), leave(), take(route), keys}.
 * `title` may be a function, for titles that change (call `retitle`). `take` answers true where it goes on with another
 * route by itself, `atPlace` where it has put the focus where the person was before.
 */
const VIEWS = {
  farm: farmView,
  jobs: jobsView,
  job: jobView,
  frame: frameView,
  play: flipbookView,
  workers: workersView,
  submit: submitView,
};
const PLACES = [
  ['farm', 'Farm', 'f'],
  ['jobs', 'Jobs', 'j'],
  ['workers', 'Workers', 'w'],
  ['submit', 'Submit', 's'],
];
const PLACE_OF = { job: 'jobs', frame: 'jobs', play: 'jobs' };

const main = document.getElementById('main');
let view = null;
let leaveKeys = () => {};

function lostView() {
  return {
    node: h(
      'section',
      { class: 'nothing' },
      h('h1', { text: 'There is no such page' }),
      h('p', {}, h('a', { href: to('farm'), text: 'To the farm' })),
    ),
    title: 'Not found',
  };
}

function retitle() {
  if (!view) return;
  const title = typeof view.title === 'function' ? view.title() : view.title;
  const text = title === 'Farm' ? 'Hyades' : `${title} · Hyades`;
  if (document.title !== text) document.title = text;
}

/** `anew`: the view is made again, whatever it holds. */
function show(first = false, anew = false) {
  const back = enter();
  const route = parse(location.hash);
  for (const link of document.querySelectorAll('[data-place]')) {
    const here = link.dataset.place === (PLACE_OF[route.view] ?? route.view);
    if (here) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  }
  if (!anew && view?.take?.(route)) {
    retitle();
    return;
  }
  view?.leave?.();
  leaveKeys();
  view = (VIEWS[route.view] ?? lostView)(route, { retitle });
  leaveKeys = view.keys ? shortcuts(view.keysTitle ?? 'Here', view.keys) : () => {};
  document.body.dataset.view = route.view;
  main.replaceChildren(view.node);
  view.shown?.();
  retitle();
  if (first) return;
  if (back) scrollBack();
  else scrollTo(0, 0);
  if (view.atPlace?.()) return;
  const heading = main.querySelector('h1');
  if (heading) {
    heading.tabIndex = -1;
    heading.focus({ preventScroll: true });
  }
}

function themeButton() {
  const button = h('button', {
    type: 'button',
    class: 'plain square',
    testid: 'theme',
    onclick: () => {
      setTheme(nextTheme());
      refresh();
    },
  });
  const refresh = () => {
    const label = `Colours: ${theme()}. Change to ${nextTheme()}`;
    button.title = label;
    button.setAttribute('aria-label', label);
    button.replaceChildren(icon(theme()));
  };
  refresh();
  return button;
}

function makeTop() {
  const workers = h('span', {});
  const threads = h('span', { class: 'wide' });
  const count = h('span', { class: 'top-count', testid: 'top-count' }, workers, threads);
  const who = h('span', { class: 'top-count', testid: 'who' });
  onMe(() => setText(who, whoAmI()));
  const refresh = () => {
    if (!farm.info) return;
    setText(workers, counted(farm.info.workers, 'worker'));
    setText(threads, ` · ${counted(farm.info.threads, 'thread')}`);
  };
  onFarm(refresh);
  document.getElementById('top').append(
    h(
      'a',
      { class: 'brand', href: to('farm'), 'aria-label': 'Hyades, the farm' },
      mark(),
      h('span', { text: 'Hyades' }),
    ),
    h(
      'nav',
      { 'aria-label': 'Main' },
      PLACES.map(([name, text]) =>
        h('a', { href: to(name), 'data-place': name, testid: `nav-${name}` }, icon(name), h('span', { text })),
      ),
    ),
    h(
      'div',
      { class: 'top-end' },
      count,
      who,
      signOutButton(),
      themeButton(),
      h(
        'button',
        {
          type: 'button',
          class: 'plain square',
          'aria-label': 'Keyboard shortcuts',
          title: 'Keyboard shortcuts (?)',
          testid: 'help-button',
          onclick: help,
        },
        icon('help'),
      ),
    ),
  );
}

function makeBanner() {
  const banner = document.getElementById('banner');
  let timer = 0;
  onConnection(() => {
    clearTimeout(timer);
    if (!lost()) {
      banner.replaceChildren();
      return;
    }
    // Short gaps are nobody's business.
    timer = setTimeout(
      () =>
        banner.replaceChildren(
          h(
            'p',
            { class: 'banner', testid: 'banner' },
            h('span', { class: 'spinner', 'aria-hidden': 'true' }),
            'The coordinator does not answer. What is shown is old; it goes on by itself.',
          ),
        ),
      1500,
    );
  });
}

history.scrollRestoration = 'manual';
shortcuts('Everywhere', [
  ...PLACES.map(([name, what, key]) => ({
    keys: `g ${key}`,
    what,
    run: () => {
      location.hash = to(name);
    },
  })),
  {
    keys: '/',
    what: 'Search',
    run: () => {
      const field = main.querySelector('input[type=search]');
      if (field) field.focus();
      else location.hash = to('jobs');
    },
  },
  { keys: 't', what: 'Light or dark', run: () => document.querySelector('[data-testid=theme]').click() },
  { keys: '?', what: 'This help', run: help },
]);
makeTop();
makeBanner();
startSession();
onMe(() => view && show(true)); // buttons depend on it
// What a view could not be told while nobody was signed in it asks for again; what is being submitted stays.
addEventListener('hyades-signed-in', () => {
  if (view && document.body.dataset.view !== 'submit') show(true, true);
});
startFarm();
offerDrop();
addEventListener('hashchange', () => {
  closeDialogs();
  clearToasts();
  show();
});
show(true);
