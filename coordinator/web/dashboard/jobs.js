// All jobs: open ones live, ended ones brought in page by page.
import * as api from './api.js';
import { ACTIONS, act } from './job_actions.js';
import { noJobs } from './welcome.js';
import { asking, nothing } from './parts.js';
import { counted, whole } from './format.js';
import { farm, isOpen, learnJobs, onFarm } from './farm_state.js';
import { h, oncePerFrame, setText, toast } from './dom.js';
import { parse, replaceQuery, to } from './router.js';
import { icon } from './icons.js';
import { lookOf } from './job_state.js';
import { Thumbs } from './thumbs.js';
import { jobTable } from './job_table.js';
import { whyNotJob } from './me.js';

const PAGE = 500;
const STATES = [
  ['open', 'Open'],
  ['', 'All'],
  ['running', 'Running'],
  ['waiting', 'Waiting'],
  ['paused', 'Paused'],
  ['done', 'Done'],
  ['failed', 'Failed'],
  ['cancelled', 'Cancelled'],
];
/** Of jobs that have not ended: all of these are known. */
const OPEN_STATES = ['open', 'running', 'waiting', 'paused'];

// How far back the ended ones are known; kept between visits of the view.
const past = { before: null, whole: false };

class JobsView {
  constructor(route) {
    const { q = '', state = 'open', owner = '', sort = 'id', up } = route.query;
    this.query = { q, state: STATES.some(([value]) => value === state) || state === 'all' ? state : 'open', owner };
    if (this.query.state === 'all') this.query.state = '';
    this.chosen = new Set();
    this.lastChosen = null;
    this.search = h('input', {
      type: 'search',
      value: q,
      placeholder: 'Name, id, owner or tag',
      'aria-label': 'Search jobs',
      testid: 'job-search',
      oninput: () => this.filter(),
    });
    this.states = h(
      'div',
      { class: 'pills', role: 'group', 'aria-label': 'State' },
      STATES.map(([value, text]) =>
        h(
          'button',
          {
            type: 'button',
            'data-state': value,
            testid: `state-${value || 'all'}`,
            onclick: () => {
              this.query.state = value;
              this.filter();
            },
          },
          h('span', { text }),
          h('span', { class: 'pill-count' }),
        ),
      ),
    );
    this.owners = h('select', { 'aria-label': 'Owner', testid: 'owner', onchange: () => this.filter() });
    this.all = h('input', {
      type: 'checkbox',
      'aria-label': 'Choose all that are listed',
      testid: 'choose-all',
      onchange: () => this.chooseAll(this.all.checked),
    });
    this.thumbs = new Thumbs();
    this.table = jobTable({
      thumbs: this.thumbs,
      all: this.all,
      sort: { key: sort, down: up === undefined },
      chosen: this.chosen,
      choose: (id, range) => this.choose(id, range),
      onSort: () => this.remember(),
      empty: () => this.emptiness(),
    });
    this.more = h('div', { class: 'more' });
    this.actions = h('div', { class: 'selection', role: 'region', 'aria-label': 'Chosen jobs', testid: 'selection' });
    this.node = h(
      'div',
      { class: 'view' },
      h(
        'div',
        { class: 'view-head' },
        h('h1', { text: 'Jobs' }),
        h('a', { class: 'button primary', href: to('submit') }, icon('submit'), 'Submit'),
      ),
      h('div', { class: 'filters' }, this.search, this.states, this.owners),
      this.table.node,
      this.more,
      this.actions,
    );
    const drawSoon = oncePerFrame(() => this.draw());
    this.leaveFarm = onFarm((what) => what.has('jobs') && drawSoon());
    this.timer = setInterval(() => this.table.refresh(), 10000);
    this.onScroll = () => this.nearEnd();
    addEventListener('scroll', this.onScroll, { passive: true });
    this.title = 'Jobs';
    this.keysTitle = 'Jobs';
    this.keys = [
      { keys: 'j', what: 'Next job', run: () => this.table.step(1) },
      { keys: 'k', what: 'Job before', run: () => this.table.step(-1) },
      { keys: 'x', what: 'Choose the job', run: () => this.table.active !== null && this.choose(this.table.active) },
      { keys: 'Escape', what: 'Choose none', run: () => this.chooseNone() },
    ];
    this.draw();
  }

  emptiness() {
    if (!farm.info) return asking();
    if (this.loading) return h('p', { class: 'soft', text: 'Looking for ended jobs…' });
    if (this.query.q || this.query.owner) return h('p', { class: 'soft', text: 'No job is like that.' });
    if (this.query.state === 'open')
      return farm.jobs.size === 0 ? noJobs() : nothing('Nothing to do', h('p', { text: 'All jobs have ended.' }));
    return this.query.state === '' ? noJobs() : h('p', { class: 'soft', text: 'No job is in this state.' });
  }

  remember() {
    const { key, down } = this.table.sort;
    replaceQuery({
      q: this.query.q,
      state: this.query.state === 'open' ? '' : this.query.state || 'all',
      owner: this.query.owner,
      sort: key === 'id' && down ? '' : key,
      up: down ? '' : 1,
    });
  }

  filter() {
    this.query.q = this.search.value;
    this.query.owner = this.owners.value;
    this.remember();
    this.draw();
  }

  get wantsEnded() {
    return !OPEN_STATES.includes(this.query.state);
  }

  fits(job) {
    const { state, owner } = this.query;
    return (
      (state === '' || (state === 'open' ? isOpen(job) : lookOf(job) === state)) &&
      (owner === '' || job.owner === owner) &&
      this.hasWords(job)
    );
  }

  hasWords(job) {
    return this.words.every(
      (word) =>
        job.name.toLowerCase().includes(word) ||
        `#${job.id}`.includes(word) ||
        job.owner.toLowerCase().includes(word) ||
        job.tags.some((tag) => tag.toLowerCase().includes(word)),
    );
  }

  draw() {
    if (this.left) return;
    this.words = this.query.q.toLowerCase().split(/\s+/).filter(Boolean);
    const all = [...farm.jobs.values()];
    for (const id of this.chosen) if (!farm.jobs.has(id)) this.chosen.delete(id);
    this.table.setRows(all.filter((job) => this.fits(job)));
    const counts = { open: 0, '': all.length };
    for (const job of all) {
      const look = lookOf(job);
      counts[look] = (counts[look] ?? 0) + 1;
      if (isOpen(job)) ++counts.open;
    }
    for (const pill of this.states.children) {
      const { state } = pill.dataset;
      pill.setAttribute('aria-pressed', state === this.query.state);
      const known = farm.info && (OPEN_STATES.includes(state) || past.whole);
      setText(pill.lastChild, known ? whole(counts[state] ?? 0) : '');
    }
    const owners = [...new Set(all.map((job) => job.owner).filter(Boolean))].sort();
    if (this.ownerList !== owners.join('\n')) {
      this.ownerList = owners.join('\n');
      const now = this.query.owner;
      if (now && !owners.includes(now)) owners.push(now);
      this.owners.replaceChildren(
        h('option', { value: '', text: 'All owners' }),
        ...owners.map((text) => h('option', { value: text, text })),
      );
      this.owners.value = now;
    }
    this.drawChosen();
    this.drawMore();
    if (this.wantsEnded && past.before === null && farm.info) this.loadMore();
  }

  drawMore() {
    this.more.hidden = !this.wantsEnded;
    if (!this.wantsEnded) return;
    if (past.whole)
      this.more.replaceChildren(
        h('p', {
          class: 'soft',
          text: this.table.rows.length > 0 ? `${counted(this.table.rows.length, 'job')}. No older ones.` : '',
        }),
      );
    else
      this.more.replaceChildren(
        h('button', {
          type: 'button',
          text: this.loading ? 'Loading…' : 'Older jobs',
          disabled: Boolean(this.loading),
          testid: 'older',
          onclick: () => this.loadMore(),
        }),
      );
    this.nearEnd();
  }

  nearEnd() {
    if (!this.wantsEnded || past.whole || this.loading || past.before === null) return;
    if (this.more.getBoundingClientRect().top < innerHeight + 600) this.loadMore();
  }

  async loadMore() {
    if (this.loading || past.whole) return;
    this.loading = true;
    try {
      const page = await api.jobs({ ended: true, limit: PAGE, before: past.before ?? undefined });
      past.before = page.next_before;
      past.whole = page.next_before === 0;
      this.loading = false;
      learnJobs(page.jobs);
    } catch (error) {
      past.before ??= undefined;
      toast(error.message, 'bad');
      // Not at once again: 'Older jobs' asks.
      setTimeout(() => {
        this.loading = false;
      }, 5000);
    }
  }

  choose(id, range = false) {
    const ids = this.table.rows.map((job) => job.id);
    const on = !this.chosen.has(id);
    let list = [id];
    if (range && this.lastChosen !== null) {
      const [a, b] = [ids.indexOf(this.lastChosen), ids.indexOf(id)].sort((x, y) => x - y);
      if (a >= 0) list = ids.slice(a, b + 1);
    }
    for (const one of list) {
      if (on) this.chosen.add(one);
      else this.chosen.delete(one);
    }
    this.lastChosen = id;
    this.drawChosen();
    this.table.refresh();
  }

  chooseAll(on) {
    this.chosen.clear();
    if (on) for (const job of this.table.rows) this.chosen.add(job.id);
    this.drawChosen();
    this.table.refresh();
  }

  chooseNone() {
    this.chooseAll(false);
  }

  drawChosen() {
    const jobs = [...this.chosen].map((id) => farm.jobs.get(id)).filter(Boolean);
    this.all.checked = jobs.length > 0 && jobs.length === this.table.rows.length;
    this.all.indeterminate = jobs.length > 0 && jobs.length < this.table.rows.length;
    this.actions.hidden = jobs.length === 0;
    if (jobs.length === 0) {
      this.actions.replaceChildren();
      return;
    }
    const key = jobs.map((job) => `${job.id}${job.state}${job.frames_failed > 0}`).join();
    if (this.actions.key === key && this.actions.firstChild) return;
    this.actions.key = key;
    const buttons = Object.entries(ACTIONS).map(([name, action]) => {
      const count = jobs.filter((job) => action.fits(job) && !whyNotJob(job)).length;
      const whyNot = count === 0 ? (jobs.filter(action.fits).map(whyNotJob)[0] ?? '') : '';
      const text = count === 0 || count === jobs.length ? action.text : `${action.text} ${count}`;
      return h(
        'button',
        {
          type: 'button',
          class: action.danger ? 'danger' : '',
          disabled: count === 0,
          title: whyNot,
          testid: `chosen-${name}`,
          onclick: () => this.actOn(name),
        },
        icon(action.icon),
        text,
      );
    });
    this.actions.replaceChildren(
      h('b', { text: `${counted(jobs.length, 'job')} chosen` }),
      h('span', { class: 'buttons' }, buttons),
      h('button', {
        type: 'button',
        class: 'plain',
        text: 'Choose none',
        testid: 'choose-none',
        onclick: () => this.chooseNone(),
      }),
    );
  }

  async actOn(name) {
    const jobs = [...this.chosen].map((id) => farm.jobs.get(id)).filter(Boolean);
    if (await act(name, jobs)) this.chooseNone();
  }

  take(route) {
    return (
      route.view === 'jobs' &&
      parse(location.hash).query.q === this.query.q &&
      (route.query.state ?? 'open') === (this.query.state || 'all')
    );
  }

  shown() {
    this.draw();
  }

  leave() {
    this.left = true;
    this.leaveFarm();
    clearInterval(this.timer);
    removeEventListener('scroll', this.onScroll);
    this.table.leave();
    this.thumbs.leave();
  }
}

/** The view. */
export const jobsView = (route) => new JobsView(route);
