// The farm at a glance: what is wrong, who is there, how fast, what runs, what waits.
import * as api from './api.js';
import { asking, bar, chip, command, nothing } from './parts.js';
import { counted, duration, moment, percent, rate, rateInWords, whole } from './format.js';
import { farm, isOpen, learnJobs, onFarm, speed } from './farm_state.js';
import { h, keyed, setText } from './dom.js';
import { flowChart } from './chart.js';
import { Alerts } from './alerts.js';
import { noJobs, noWorkers, welcome, workerCommand } from './welcome.js';
import { preview } from './preview.js';
import { doneOf, leftOf, lookOf, share } from './job_state.js';
import { starMap } from './stars.js';
import { Thumbs } from './thumbs.js';
import { to } from './router.js';
import { workerTable } from './worker_table.js';

const MOST_NOW = 6;
const MOST_QUEUED = 12;
const MOST_ENDED = 6;

/** Open jobs in the order in which they get units: running before paused, higher priority first, older first. */
export const inOrder = (jobs) =>
  [...jobs]
    .filter(isOpen)
    .sort((a, b) => (a.state === 'paused') - (b.state === 'paused') || b.priority - a.priority || a.id - b.id);

/** What is said where nothing is rendered, of so many jobs: null (something is), 'held', 'alone', 'ended', 'empty'. */
export function noneKind({ running, open, jobs }, workers) {
  if (running > 0) return null;
  if (open > 0) return workers > 0 ? 'held' : 'alone';
  return jobs > 0 ? 'ended' : 'empty';
}

class FarmView {
  constructor() {
    this.title = 'Farm';
    this.alerts = new Alerts();
    this.thumbs = new Thumbs();
    this.sky = starMap((worker) => this.goToWorker(worker));
    this.chart = flowChart();
    this.speedNow = h('span', { class: 'soft', testid: 'farm-speed', text: 'Asking the coordinator…' });
    this.skyNow = h('span', { class: 'soft', text: 'Asking the coordinator…' });
    this.now = h('div', { class: 'now-list', testid: 'now' });
    this.queue = h('ul', { class: 'queue-list', testid: 'queue' });
    this.queueCount = h('span', { class: 'soft' });
    this.queueNone = h('p', { class: 'soft box-head', text: 'Asking the coordinator…' });
    this.ended = h('ul', { class: 'queue-list', testid: 'ended' });
    this.endedBox = h(
      'div',
      {},
      h(
        'div',
        { class: 'box-head' },
        h('h2', { text: 'Ended lately' }),
        h('a', { href: to('jobs', { query: { state: 'all' } }), text: 'All of them' }),
      ),
      this.ended,
    );
    this.endedBox.hidden = true;
    this.nowNone = h('div', {}, asking('box-head'));
    this.table = workerTable(noWorkers);
    this.tableCount = h('span', { class: 'soft' });
    const box = (kind, title, more, ...body) =>
      h(
        'section',
        { class: `panel-box ${kind}` },
        h('div', { class: 'box-head' }, h('h2', { text: title }), more),
        ...body,
      );
    this.skyBox = box('farm-sky', 'Cluster', this.skyNow, this.sky.node);
    this.flowBox = box('farm-flow', 'Throughput', this.speedNow, this.chart.node);
    this.nowBox = box('farm-now', 'Rendering now', null, this.now, this.nowNone);
    this.queueBox = box(
      'farm-queue',
      'Queue',
      [this.queueCount, h('a', { href: to('jobs'), text: 'All jobs' })],
      this.queue,
      this.queueNone,
      this.endedBox,
    );
    this.workersBox = box(
      'farm-workers',
      'Workers',
      [this.tableCount, h('a', { href: to('workers'), text: 'All workers' })],
      this.table.node,
    );
    this.grid = h(
      'div',
      { class: 'farm-grid' },
      this.skyBox,
      this.flowBox,
      this.nowBox,
      this.queueBox,
      this.workersBox,
    );
    this.fresh = h('div', { hidden: true });
    this.node = h(
      'div',
      { class: 'view' },
      h('h1', { class: 'unseen', text: 'Farm' }),
      this.alerts.node,
      this.fresh,
      this.grid,
    );
    this.leaveFarm = onFarm((what) => this.draw(what));
    // Those that have ended lately: what failed at night is seen in the morning.
    api
      .jobs({ ended: true, limit: 60 })
      .then(({ jobs }) => {
        this.asked = true;
        learnJobs(jobs);
      })
      .catch(() => {});
    this.timer = setInterval(() => this.draw(new Set(['workers', 'tick'])), 5000);
    this.draw(null);
  }

  goToWorker(worker) {
    const row = this.table.rows.findIndex((other) => other.id === worker.id);
    if (row >= 0) this.table.focusRow(row);
  }

  shown() {
    this.draw(null);
  }

  draw(what) {
    if (!farm.info) return;
    // A farm that has just been set up: what to do first, and nothing else.
    const fresh = this.asked === true && farm.workers.size === 0 && farm.jobs.size === 0;
    if (fresh && !this.fresh.firstChild) this.fresh.append(welcome());
    this.fresh.hidden = !fresh;
    this.grid.hidden = fresh;
    if (fresh) return;
    const is = (name) => what === null || what.has(name);
    if (is('info') || is('jobs') || is('workers')) this.alerts.draw();
    if (is('series')) {
      this.chart.draw(farm.series, farm.seriesEnd);
      setText(this.speedNow, rateInWords(farm.series[farm.series.length - 1] ?? 0));
    }
    if (is('workers')) this.drawWorkers();
    if (is('jobs')) this.drawJobs();
  }

  drawWorkers() {
    const all = [...farm.workers.values()];
    const here = all.filter(({ state }) => state !== 'gone');
    this.sky.draw(all, (worker) => speed(worker));
    setText(
      this.skyNow,
      here.length === 0
        ? ''
        : `${counted(here.length, 'worker')}, ${counted(here.reduce((sum, { threads }) => sum + threads, 0), 'thread')}`,
    );
    this.table.setRows(all);
    setText(this.tableCount, counted(here.length, 'worker'));
  }

  drawJobs() {
    const open = inOrder(farm.jobs.values());
    const running = open.filter((job) => lookOf(job) === 'running').slice(0, MOST_NOW);
    const rest = open.filter((job) => !running.includes(job));
    this.now.dataset.count = running.length;
    keyed(
      this.now,
      running,
      (job) => job.id,
      (job) => this.card(job),
    );
    const none = noneKind({ running: running.length, open: open.length, jobs: farm.jobs.size }, farm.info.workers);
    if (this.noneKind !== none) {
      this.noneKind = none;
      this.nowNone.replaceChildren(
        ...(none === null
          ? []
          : [
              none === 'empty'
                ? noJobs()
                : none === 'ended'
                  ? nothing(
                      'Nothing to do',
                      h('p', { class: 'soft', text: 'All jobs have ended.' }),
                      h('a', { class: 'button primary', href: to('submit'), text: 'Submit a job' }),
                    )
                  : nothing(
                    'Nothing is being rendered',
                    h('p', {
                      class: 'soft',
                      text: none === 'alone' ? 'Jobs wait for a worker:' : 'The jobs in the queue wait; each says why.',
                    }),
                    none === 'alone' && command(workerCommand()),
                  ),
            ]),
      );
    }
    keyed(
      this.queue,
      rest.slice(0, MOST_QUEUED),
      (job) => job.id,
      () => {
        const name = h('span', { class: 'name' });
        const end = h('span', { class: 'soft num' });
        const sub = h('span', { class: 'sub' });
        const link = h('a', { testid: 'queued' }, name, end, sub);
        const node = h('li', {}, link);
        node.refresh = (job) => {
          link.href = to('job', { job: job.id });
          setText(name, job.name);
          setText(end, job.state === 'paused' ? 'paused' : percent(share(job)));
          setText(
            sub,
            job.reason ||
              [
                `#${job.id}`,
                job.owner,
                counted(job.frames, 'frame'),
                job.priority !== 0 && `priority ${job.priority}`,
                `since ${moment(job.submitted_ms)}`,
              ]
                .filter(Boolean)
                .join(' · '),
          );
        };
        return node;
      },
    );
    setText(
      this.queueCount,
      rest.length > MOST_QUEUED
        ? `${whole(rest.length)}, the next ${MOST_QUEUED}`
        : rest.length > 0
          ? whole(rest.length)
          : '',
    );
    setText(this.queueNone, 'Nothing waits.');
    this.queueNone.hidden = rest.length > 0;
    const over = [...farm.jobs.values()]
      .filter((job) => !isOpen(job))
      .sort((a, b) => b.ended_ms - a.ended_ms)
      .slice(0, MOST_ENDED);
    this.endedBox.hidden = over.length === 0;
    keyed(
      this.ended,
      over,
      (job) => job.id,
      (job) => {
        const name = h('span', { class: 'name' });
        const end = chip(job.state);
        const sub = h('span', { class: 'sub' });
        const node = h('li', {}, h('a', { href: to('job', { job: job.id }) }, name, end, sub));
        node.refresh = (now) => {
          setText(name, now.name);
          end.set(now.state);
          setText(
            sub,
            now.reason && now.state === 'failed'
              ? now.reason
              : `${moment(now.ended_ms)} · ${doneOf(now)}`,
          );
        };
        return node;
      },
    );
  }

  card(job) {
    const picture = preview(this.thumbs);
    const name = h('span', { class: 'now-name' });
    const left = h('span', { class: 'sub' });
    const gauge = bar('Progress');
    const sub = h('span', { class: 'sub' });
    const speedText = h('span', { class: 'sub' });
    const node = h(
      'a',
      { class: 'now', href: to('job', { job: job.id }), testid: 'now-job' },
      picture.node,
      h(
        'span',
        { class: 'now-text' },
        h('span', { class: 'now-line' }, name, left),
        gauge,
        h('span', { class: 'now-line' }, sub, speedText),
      ),
    );
    node.refresh = (now) => {
      setText(name, now.name);
      setText(left, Number.isFinite(leftOf(now)) ? `${duration(leftOf(now))} left` : '');
      gauge.set(share(now), { failed: now.frames > 0 ? now.frames_failed / now.frames : 0, state: now.state });
      setText(sub, `${percent(share(now))} · ${whole(now.frames_done)} of ${counted(now.frames, 'frame')}`);
      setText(speedText, rate(now.samples_per_second));
      picture.refresh(now);
    };
    return node;
  }

  leave() {
    this.leaveFarm();
    clearInterval(this.timer);
    this.thumbs.leave();
    this.sky.leave();
    this.chart.leave();
    this.table.leave();
  }
}

/** The view. */
export const farmView = () => new FarmView();
