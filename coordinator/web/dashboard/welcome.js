// What a farm says that has just been set up: two steps, nothing else.
import { command, nothing } from './parts.js';
import { farm } from './farm_state.js';
import { h } from './dom.js';
import { joining } from './joining.js';
import { me } from './me.js';
import { to } from './router.js';

const join = () =>
  joining(
    farm.info?.grpc_address,
    { hostname: location.hostname, secure: location.protocol === 'https:' },
    me.guarded,
  );

/** The command that starts a worker of this farm. */
export const workerCommand = () => join().command;

/** What is shown where nobody renders. */
export const noWorkers = () =>
  nothing(
    'No workers yet',
    h('p', { text: join().where }),
    command(workerCommand()),
    h('p', { class: 'soft', text: 'Workers may come and go at any time, in mid-frame too.' }),
  );

/** What is shown where there has never been a job. */
export const noJobs = () =>
  nothing(
    'No jobs yet',
    h('p', { text: 'Drop a job with its files anywhere on this page.' }),
    h('p', {}, h('a', { class: 'button primary', href: to('submit'), text: 'Submit a job', testid: 'empty-submit' })),
    h('p', { class: 'soft' }, 'From a terminal: ', h('code', { text: 'hyades submit job.yaml --watch' })),
  );

/** The page of an empty farm. */
export function welcome() {
  const step = (number, title, ...body) =>
    h(
      'li',
      { class: 'panel-box welcome-step' },
      h('h2', {}, h('span', { class: 'welcome-number', 'aria-hidden': 'true', text: number }), title),
      ...body,
    );
  return h(
    'section',
    { class: 'welcome', testid: 'welcome' },
    nothing('A new farm', h('p', { class: 'soft', text: 'Two steps to the first picture, in any order.' })),
    h(
      'ol',
      { class: 'welcome-steps' },
      step(
        '1',
        'Start a worker',
        h('p', { text: join().where }),
        command(workerCommand()),
        h('p', { class: 'soft', text: 'Workers may come and go at any time, in mid-frame too.' }),
      ),
      step(
        '2',
        'Submit a job',
        h('p', { text: 'Drop a job with its files anywhere on this page, or choose it:' }),
        h(
          'p',
          {},
          h('a', { class: 'button primary', href: to('submit'), text: 'Submit a job', testid: 'empty-submit' }),
        ),
        h('p', { class: 'soft' }, 'From a terminal: ', h('code', { text: 'hyades submit job.yaml --watch' })),
      ),
    ),
  );
}
