// A submission before it is sent: its text with complaints, and the files that go along.
import { bytes, whole } from './format.js';
import { h } from './dom.js';
import { icon } from './icons.js';
import { isYaml } from './gather.js';
import { yamlLines } from './yaml_text.js';

const MOST_LISTED = 400;

/** Shows `bundle` (bundle.js). `chosen()`: other files are to be sent; `reset()`: all are to be removed. */
export class Review {
  constructor(bundle, { chosen, reset }) {
    Object.assign(this, { bundle, chosen, reset });
    this.node = h('div', { class: 'submit-main' });
    this.clear();
  }

  /** Forgets what was open and edited. */
  clear() {
    this.open = null;
    this.editing = null;
  }

  draw() {
    const open = this.open ?? this.bundle.job ?? this.bundle.documents[0].path;
    const boxes = [this.problemBox(), this.documentBox(open), this.filesBox()];
    this.node.replaceChildren(...boxes.filter(Boolean));
  }

  problemBox() {
    const { found } = this.bundle;
    if (found.length === 0) return null;
    const list = h(
      'ul',
      { class: 'problem-list' },
      found.map((complaint) =>
        h(
          'li',
          {},
          complaint.line > 0
            ? [
                h('button', {
                  type: 'button',
                  class: 'link mono',
                  text: `${complaint.file}:${complaint.line}`,
                  onclick: () => this.goTo(complaint),
                }),
                ' ',
              ]
            : null,
          complaint.text,
        ),
      ),
    );
    return h(
      'section',
      { class: 'problem-box', role: 'alert', testid: 'problems' },
      h('h2', {
        text: found.length === 1 ? 'The job was not taken' : `The job was not taken: ${found.length} complaints`,
      }),
      list,
    );
  }

  goTo(complaint) {
    this.open = this.bundle.documentOf(complaint);
    this.draw();
    const line = this.node.querySelector(`#line-${complaint.line}`);
    line?.scrollIntoView({ block: 'center' });
  }

  documentBox(open) {
    const { documents, found } = this.bundle;
    const text = this.bundle.textOf(open);
    const about = found.filter((complaint) => complaint.line > 0 && this.bundle.documentOf(complaint) === open);
    const tabs =
      documents.length > 1
        ? h(
            'select',
            {
              'aria-label': 'Shown document',
              testid: 'shown-document',
              onchange: (event) => {
                this.open = event.target.value;
                this.draw();
              },
            },
            documents.map(({ path }) => h('option', { value: path, text: path })),
          )
        : h('span', { class: 'mono', text: open });
    if (documents.length > 1) tabs.value = open;
    const edit = h(
      'button',
      { type: 'button', class: 'small', testid: 'edit', onclick: () => this.edit(open) },
      icon('edit'),
      'Edit',
    );
    const body =
      this.editing === open ? this.editor(open, text) : h('div', { class: 'document-text' }, yamlLines(text, about));
    return h(
      'section',
      { class: 'panel-box', 'aria-label': 'Document' },
      h(
        'div',
        { class: 'box-head' },
        h('h2', { text: 'Document' }),
        tabs,
        h('span', { class: 'spring' }),
        this.editing === open ? null : edit,
      ),
      body,
    );
  }

  edit(path) {
    this.editing = path;
    this.draw();
    this.node.querySelector('textarea').focus();
  }

  editor(path, text) {
    const area = h('textarea', {
      class: 'mono editor',
      spellcheck: 'false',
      'aria-label': `Text of ${path}`,
      testid: 'editor',
      value: text,
      rows: Math.min(40, text.split('\n').length + 2),
    });
    const done = (keep) => {
      if (keep) this.bundle.replace(path, area.value);
      this.editing = null;
      this.draw();
    };
    return h(
      'div',
      { class: 'editor-box' },
      area,
      h(
        'div',
        { class: 'buttons' },
        h('button', {
          type: 'button',
          class: 'primary',
          text: 'Keep for this submission',
          testid: 'edit-keep',
          onclick: () => done(true),
        }),
        h('button', { type: 'button', text: 'Discard', onclick: () => done(false) }),
        h('span', { class: 'soft', text: 'Your file stays as it is.' }),
      ),
    );
  }

  filesBox() {
    const { files, job } = this.bundle;
    const row = (entry) => {
      const isJob = entry.path === job;
      const note = isJob ? 'the job' : this.bundle.isNamed(entry) ? '' : 'not named in the YAML';
      const box = h('input', {
        type: 'checkbox',
        checked: entry.on || isJob,
        disabled: isJob,
        testid: 'file-on',
        onchange: () => {
          entry.on = box.checked;
          this.chosen();
        },
      });
      return h(
        'li',
        {},
        h(
          'label',
          {},
          box,
          h('span', { class: 'mono file-path', text: this.bundle.nameOf(entry.path) }),
          h('span', { class: 'soft file-note', text: note }),
          h('span', { class: 'num soft', text: bytes(entry.file.size) }),
        ),
      );
    };
    const sorted = [...files].sort(
      (a, b) => (b.path === job) - (a.path === job) || isYaml(b.path) - isYaml(a.path) || a.path.localeCompare(b.path),
    );
    const only = () => {
      for (const entry of files) entry.on = this.bundle.isNamed(entry);
      this.draw();
      this.chosen();
    };
    return h(
      'section',
      { class: 'panel-box', 'aria-label': 'Files that are sent' },
      h(
        'div',
        { class: 'box-head' },
        h('h2', { text: 'Files that are sent' }),
        h('span', { class: 'soft', text: 'as the job’s folder sees them' }),
        h('span', { class: 'spring' }),
        files.length > 1
          ? h('button', {
              type: 'button',
              class: 'small',
              text: 'Only those named',
              title: 'Files that no YAML names are left out. Textures that meshes name (.mtl, .gltf) are such.',
              testid: 'only-named',
              onclick: only,
            })
          : null,
        h('button', {
          type: 'button',
          class: 'small',
          text: 'Remove all',
          testid: 'remove-all',
          onclick: () => this.reset(),
        }),
      ),
      h(
        'ul',
        { class: 'file-list', testid: 'file-list' },
        sorted.slice(0, MOST_LISTED).map(row),
        sorted.length > MOST_LISTED
          ? h('li', { class: 'soft', text: `and ${whole(sorted.length - MOST_LISTED)} more` })
          : null,
      ),
    );
  }
}
