// One job: how it stands, what can be done with it, and its tabs.
import { ACTIONS, act, askPriority } from './job_actions.js';
import { bar, chip, figure, nothing } from './parts.js';
import { archiveAddress, explain } from './api.js';
import {
  bytes,
  clock,
  coreHours,
  counted,
  duration,
  moment,
  money,
  noise,
  percent,
  rateInWords,
  short,
  whole,
} from './format.js';
import { h, keyed, say, setText } from './dom.js';
import { whyNotJob } from './me.js';
import { leftOf, lookOf, otherFrames, share, tookOf, watchJob } from './job_state.js';
import { TABS, to } from './router.js';
import { documentTab } from './document.js';
import { Frames } from './frames.js';
import { icon } from './icons.js';
import { farm, isOpen } from './farm_state.js';
import { logTab } from './log.js';
import { outputsTab } from './outputs.js';
import { timelineTab } from './timeline.js';

const LABELS = { frames: 'Frames', log: 'Log', outputs: 'Outputs', document: 'Document', timeline: 'Timeline' };
const EXPLAIN_EVERY = 8000;
const MOST_FAILURES = 3;

function framesTab(state) {
  const frames = new Frames(state);
  return {
    node: frames.node,
    update: (changed) => frames.update(changed),
    shown: () => frames.update(null),
    atPlace: () => frames.atPlace(),
    step: (by) => frames.step(by),
    leave: () => frames.leave(),
  };
}

const MAKERS = { frames: framesTab, log: logTab, outputs: outputsTab, document: documentTab, timeline: timelineTab };

class JobView {
  constructor(route, { retitle }) {
    this.id = route.job;
    this.retitle = retitle;
    this.tab = route.tab;
    const watched = watchJob(route.job, (changed) => this.update(changed));
    this.state = watched.state;
    this.leaveJob = watched.leave;
    this.makeHead();
    this.panel = h('div', { role: 'tabpanel', id: 'panel', class: 'panel', 'aria-labelledby': `tab-${this.tab}` });
    this.node = h('div', { class: 'view job' }, this.head, this.tabs, this.panel);
    this.keysTitle = 'This job';
    this.keys = [
      ...TABS.map((name, i) => ({
        keys: String(i + 1),
        what: LABELS[name],
        run: () => {
          location.hash = to('job', { job: this.id, tab: name });
        },
      })),
      { keys: 'j', what: 'Next frame or file', run: () => this.content.step?.(1) },
      { keys: 'k', what: 'The one before', run: () => this.content.step?.(-1) },
      {
        keys: 'p',
        what: 'Pause or resume',
        run: () => this.act(this.state.job?.state === 'paused' ? 'resume' : 'pause'),
      },
      {
        keys: 'b',
        what: 'Flip-book',
        run: () => {
          location.hash = to('play', { job: this.id });
        },
      },
      {
        keys: 'Escape',
        what: 'Back to the jobs',
        run: () => {
          location.hash = to('jobs');
        },
      },
    ];
    this.timer = setInterval(() => this.why(), EXPLAIN_EVERY);
    this.openTab();
    this.update(new Set());
  }

  makeHead() {
    this.name = h('h1', { text: `Job ${this.id}`, testid: 'job-name' });
    this.chip = chip('loading');
    this.chip.dataset.testid = 'job-state';
    this.meta = h('p', { class: 'job-meta' });
    this.buttons = h('div', { class: 'buttons', testid: 'job-actions' });
    this.gauge = bar('Progress');
    this.gauge.classList.add('big');
    this.gauge.hidden = true; // until something is known
    this.figures = {
      progress: figure('Progress', 'job-progress'),
      noise: figure('Noise', 'job-noise'),
      frames: figure('Frames', 'job-frames'),
      left: figure('Time left', 'job-left'),
      speed: figure('Speed', 'job-speed', 'Samples per second, lately'),
      leased: figure('Units out', 'job-leased', 'Units that are with workers'),
      took: figure('Took', 'job-took', 'Waiting does not count'),
      hours: figure('Core-hours', 'job-hours', 'What threads took for the results that counted'),
      cost: figure('Cost', 'job-cost'),
      priority: figure('Priority', 'job-priority'),
    };
    const priority = h(
      'button',
      {
        type: 'button',
        class: 'plain square',
        hidden: true,
        'aria-label': 'Change the priority',
        title: 'Change the priority',
        testid: 'change-priority',
        onclick: async () => {
          const job = await askPriority(this.state.job);
          if (job) this.state.learn(job);
        },
      },
      icon('edit'),
    );
    this.priorityButton = priority;
    for (const unusual of [this.figures.noise, this.figures.cost]) unusual.hidden = true;
    this.figures.priority.lastChild.append(priority);
    this.reasons = h('ul', { class: 'reasons' });
    this.whyBox = h(
      'details',
      { class: 'why', testid: 'why', hidden: true },
      h('summary', { text: 'Why is it waiting?' }),
      this.reasons,
    );
    this.trouble = h('p', { class: 'job-reason', testid: 'job-reason', hidden: true });
    this.failures = h('ul', { class: 'reasons failures', 'aria-label': 'Frames that failed', testid: 'failures' });
    this.head = h(
      'section',
      { class: 'job-head', 'aria-label': 'This job' },
      h(
        'div',
        { class: 'job-title' },
        h('div', {}, h('div', { class: 'job-name' }, this.name, this.chip), this.meta),
        this.buttons,
      ),
      this.gauge,
      h('dl', { class: 'figures' }, Object.values(this.figures)),
      this.trouble,
      this.failures,
      this.whyBox,
    );
    this.tabs = h(
      'div',
      { class: 'tabs', role: 'tablist', 'aria-label': 'Of this job', onkeydown: (event) => this.tabKey(event) },
      TABS.map((name) =>
        h('a', {
          role: 'tab',
          id: `tab-${name}`,
          'data-tab': name,
          href: to('job', { job: this.id, tab: name }),
          'aria-controls': 'panel',
          testid: `tab-${name}`,
          text: LABELS[name],
        }),
      ),
    );
  }

  tabKey(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const next = TABS[(TABS.indexOf(this.tab) + step + TABS.length) % TABS.length];
    location.hash = to('job', { job: this.id, tab: next });
    this.focusTab = true;
  }

  openTab() {
    this.content?.leave?.();
    this.content = MAKERS[this.tab](this.state);
    this.panel.replaceChildren(this.content.node);
    this.panel.setAttribute('aria-labelledby', `tab-${this.tab}`);
    for (const link of this.tabs.children) {
      const here = link.dataset.tab === this.tab;
      link.setAttribute('aria-selected', here);
      link.tabIndex = here ? 0 : -1;
      if (here && this.focusTab) link.focus();
    }
    this.focusTab = false;
    if (this.node?.isConnected) this.content.shown?.();
  }

  take(route) {
    if (route.view !== 'job' || route.job !== this.id) return false;
    if (route.tab !== this.tab) {
      this.tab = route.tab;
      this.openTab();
      this.retitle();
    }
    return true;
  }

  shown() {
    this.content.shown?.();
  }

  atPlace() {
    return this.content.atPlace?.() ?? false;
  }

  title() {
    const { job } = this.state;
    if (!job) return `Job ${this.id}`;
    return `${job.state === 'running' ? percent(share(job)) : job.state} · ${job.name}`;
  }

  async act(name) {
    const { job } = this.state;
    if (!job || !ACTIONS[name].fits(this.withDoubts(job))) return;
    if (whyNotJob(job)) {
      say(whyNotJob(job));
      return;
    }
    const results = await act(name, [this.withDoubts(job)]);
    if (!results) return;
    if (name === 'delete') {
      location.hash = to('jobs');
      return;
    }
    this.state.learn(results[0]);
    this.why();
  }

  withDoubts(job) {
    let doubtful = 0;
    for (const frame of this.state.frames.values()) if (frame.doubtful) ++doubtful;
    return { ...job, doubtful };
  }

  update(changed) {
    const { job, error } = this.state;
    if (error && !job) {
      this.node.replaceChildren(
        h(
          'section',
          {},
          h('h1', { text: `Job ${this.id}` }),
          nothing(
            error.code === 'not_found' ? 'There is no such job' : 'It cannot be shown',
            h('p', { text: error.message }),
            h('p', {}, h('a', { href: to('jobs'), text: 'To the jobs' })),
          ),
        ),
      );
      return;
    }
    if (job) this.drawHead(job);
    this.content.update?.(changed);
    this.retitle();
  }

  drawHead(job) {
    setText(this.name, job.name);
    if (this.was && this.was !== job.state) say(`The job is ${job.state}.`);
    this.chip.set(lookOf(job));
    const meta = [
      `#${job.id}`,
      job.owner && `by ${job.owner}`,
      `submitted ${moment(job.submitted_ms)}`,
      job.begun_ms && `begun ${moment(job.begun_ms)}`,
      job.ended_ms && `ended ${moment(job.ended_ms)}`,
      job.frame_order === 'progressive' && 'all frames a little at a time',
      job.tags.length > 0 && `tags ${job.tags.join(', ')}`,
      job.max_workers > 0 && `at most ${counted(job.max_workers, 'worker')}`,
      job.redundancy > 0 && `${job.redundancy} % rendered twice`,
      job.memory_bytes > 0 && `needs ${bytes(job.memory_bytes)}`,
    ];
    setText(this.meta, meta.filter(Boolean).join(' · '));
    const open = isOpen(job);
    const part = share(job);
    this.gauge.hidden = false;
    this.gauge.set(part, { failed: job.frames > 0 ? job.frames_failed / job.frames : 0, state: job.state });
    const { figures } = this;
    figures.progress.set(percent(part));
    figures.progress.title = `${short(job.samples_done)} of ${short(job.samples)} samples`;
    figures.noise.hidden = job.noise === undefined || job.noise === null;
    figures.noise.set(`${noise(job.noise)}${job.noise_aim > 0 ? ` (aim ${noise(job.noise_aim)})` : ''}`);
    figures.noise.title = 'How far pixels are off on average, in parts of white: 0.02 is 2 % where the picture is white';
    figures.frames.set(
      `${whole(job.frames_done)} / ${whole(job.frames)}${otherFrames(job)}`,
    );
    const left = leftOf(job);
    const told = Number.isFinite(left);
    figures.left.set(told ? duration(left) : '–');
    figures.left.title = told ? `until about ${clock(Date.now() + left * 1000)}` : '';
    const runs = lookOf(job) === 'running' && job.samples_per_second > 0;
    figures.speed.set(runs ? rateInWords(job.samples_per_second) : '–');
    figures.leased.set(open ? whole(job.leased) : '–');
    const fresh = open && !job.begun_ms;
    setText(figures.took.firstChild, fresh ? 'Since submit' : 'Took');
    figures.took.set(duration(fresh ? (Date.now() - job.submitted_ms) / 1000 : tookOf(job)));
    figures.hours.set(coreHours(job.core_seconds));
    const price = farm.info?.price_per_core_hour ?? 0;
    figures.cost.hidden = price <= 0;
    figures.cost.set(money(job.cost, farm.info?.currency));
    figures.cost.title = `${money(price, farm.info?.currency)} for a core-hour`;
    figures.priority.set(job.priority);
    this.priorityButton.hidden = !open || Boolean(whyNotJob(job));
    setText(this.trouble, job.reason);
    this.trouble.hidden = !job.reason;
    this.trouble.dataset.state = job.state;
    this.drawFailures(job);
    this.drawButtons(job);
    if (this.was !== job.state) this.why();
    this.was = job.state;
  }

  // The reasons of the first ones that failed: often all have the same.
  drawFailures(job) {
    this.failures.hidden = job.frames_failed === 0;
    if (job.frames_failed === 0) return;
    const failed = [];
    for (const number of this.state.numbers) {
      const frame = this.state.frames.get(number);
      if (frame.state === 'failed' && failed.push(frame) === MOST_FAILURES) break;
    }
    keyed(
      this.failures,
      failed,
      ({ id, reason }) => `${id} ${reason}`,
      ({ id, reason }) =>
        h(
          'li',
          {},
          h('a', { href: to('frame', { job: this.id, frame: id }), text: `Frame ${id}` }),
          `: ${reason || 'failed'}`,
        ),
    );
  }

  drawButtons(job) {
    const with_ = this.withDoubts(job);
    const names = Object.keys(ACTIONS).filter((name) => ACTIONS[name].fits(with_));
    const whyNot = whyNotJob(job);
    const key = `${names.join()} ${job.frames_done > 0} ${job.frames > 1} ${whyNot}`;
    if (this.buttons.key === key) return;
    this.buttons.key = key;
    this.buttons.replaceChildren(
      ...(job.frames > 1
        ? [
            h(
              'a',
              { class: 'button', href: to('play', { job: this.id }), testid: 'open-flipbook' },
              icon('video'),
              'Flip-book',
            ),
          ]
        : []),
      ...(job.frames_done > 0
        ? [
            h(
              'a',
              { class: 'button', href: archiveAddress(this.id), download: '', testid: 'archive' },
              icon('download'),
              'Download all',
            ),
          ]
        : []),
      ...names.map((name) =>
        h(
          'button',
          {
            type: 'button',
            class: ACTIONS[name].danger ? 'danger' : '',
            testid: `job-${name}`,
            disabled: Boolean(whyNot),
            title: whyNot,
            onclick: () => this.act(name),
          },
          icon(ACTIONS[name].icon),
          ACTIONS[name].text,
        ),
      ),
    );
  }

  // Moving along well needs no reasons: they wait behind a line.
  async why() {
    const { job } = this.state;
    if (!job || document.hidden) return;
    const stuck = isOpen(job) && lookOf(job) !== 'running';
    if (this.stuck !== stuck) this.whyBox.open = stuck;
    this.stuck = stuck;
    setText(
      this.whyBox.firstChild,
      !isOpen(job) ? 'How did it end?' : stuck ? 'Why is it waiting?' : 'What is it doing?',
    );
    try {
      // What is told above is not told again.
      const reasons = (await explain(this.id)).reasons.filter((text) => text !== this.state.job.reason);
      this.whyBox.hidden = reasons.length === 0;
      keyed(
        this.reasons,
        reasons.map((text, i) => ({ text, key: `${i} ${text}` })),
        ({ key }) => key,
        ({ text }) => h('li', { text }),
      );
    } catch {
      // The next time, or the job is gone: then the stream says so.
    }
  }

  leave() {
    clearInterval(this.timer);
    this.content.leave?.();
    this.leaveJob();
  }
}

/** The view. */
export const jobView = (route, page) => new JobView(route, page);
