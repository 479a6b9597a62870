// The options of a submission.
import { recall, remember } from './memory.js';
import { framesOf } from './gather.js';
import { h } from './dom.js';

/** `choose(path)`: another document is the job; `submit()`: the form was sent. */
export class Options {
  constructor({ choose, submit }) {
    const field = (label, input, hint) =>
      h('label', { class: 'field' }, label, input, hint ? h('span', { class: 'hint', text: hint }) : null);
    const number = (testid, placeholder, min = 0) => h('input', { type: 'number', step: 1, min, placeholder, testid });
    this.fields = {
      document: h('select', { testid: 'document-choice', onchange: () => choose(this.fields.document.value) }),
      owner: h('input', {
        type: 'text',
        maxlength: 100,
        value: recall('owner', ''),
        autocomplete: 'username',
        testid: 'owner-field',
      }),
      priority: h('input', { type: 'number', step: 1, value: 0, testid: 'priority-option' }),
      frames: h('input', { type: 'text', placeholder: 'all', testid: 'frames-option' }),
      samples: number('samples-option', 'as in the job', 1),
      tags: h('input', { type: 'text', placeholder: 'any worker', testid: 'tags-option' }),
      workers: number('workers-option', 'no limit', 1),
      memory: h('input', { type: 'number', step: 'any', min: 0, placeholder: 'any', testid: 'memory-option' }),
      attempts: number('attempts-option', '3', 1),
      redundancy: number('redundancy-option', '0', 0),
      order: h(
        'select',
        { testid: 'order-option' },
        h('option', { value: 'sequential', text: 'One frame after the other' }),
        h('option', { value: 'progressive', text: 'All frames a little at a time' }),
      ),
    };
    const f = this.fields;
    this.asks = h('p', { class: 'asks', hidden: true, text: 'Several files could be the job. Which one is it?' });
    this.form = h(
      'form',
      {
        id: 'options',
        class: 'panel-box options',
        'aria-label': 'Options',
        onsubmit: (event) => {
          event.preventDefault();
          submit();
        },
      },
      h(
        'div',
        { class: 'option-grid' },
        h('div', { class: 'wide' }, this.asks, field('Job document', f.document)),
        field('Owner', f.owner),
        field('Priority', f.priority, 'higher goes first'),
        field('Frames', f.frames, 'of the job: 3, 5-8 or 1-9x2'),
        field('Samples per pixel', f.samples),
      ),
      h(
        'details',
        { class: 'option-more' },
        h('summary', { text: 'Where and in which order' }),
        h(
          'div',
          { class: 'option-grid' },
          h('div', { class: 'wide' }, field('Order', f.order, 'the second shows the whole video early')),
          field('Tags', f.tags, 'workers need all of them'),
          field('Workers at once', f.workers),
          field('Memory, GiB', f.memory, 'a worker needs at least'),
          field('Attempts', f.attempts, 'failures of a unit that stop its frame'),
          field('Redundancy, %', f.redundancy, 'units rendered twice and compared'),
        ),
      ),
    );
  }

  /** Which documents could be the job (paths), and which one is; null: the person is asked. */
  setJobs(paths, job) {
    const option = (path) => h('option', { value: path, text: path });
    const none = job === null ? [h('option', { value: '', text: 'Choose…' })] : [];
    this.fields.document.replaceChildren(...none, ...paths.map(option));
    this.fields.document.value = job ?? '';
    this.asks.hidden = job !== null;
  }

  /** Which document it is, is known now. */
  settled() {
    this.asks.hidden = true;
  }

  /** What the fields say, as the API's Submission. Throws an Error that says what cannot be read. */
  read() {
    const { fields: f } = this;
    const number = (field) => (field.value === '' ? undefined : Number(field.value));
    const ranges = framesOf(f.frames.value);
    const tags = f.tags.value.split(/[,\s]+/).filter(Boolean);
    const owner = f.owner.value.trim();
    remember('owner', owner);
    // What is undefined is not sent.
    return {
      owner: owner || undefined,
      priority: number(f.priority) ?? 0,
      frames: ranges.length > 0 ? ranges : undefined,
      samples: number(f.samples),
      tags: tags.length > 0 ? tags : undefined,
      max_workers: number(f.workers),
      max_attempts: number(f.attempts),
      redundancy: number(f.redundancy),
      memory_bytes: f.memory.value === '' ? undefined : Math.round(Number(f.memory.value) * 2 ** 30),
      frame_order: f.order.value,
    };
  }
}
