// Submitting a job from the browser: give files, see what is sent, send.
import * as api from './api.js';
import { bytes, counted, whole } from './format.js';
import { clearlyFirst, documentsOf, folderOf, framesOf, fromFolder, isHidden, isNamed, isYaml, likelyJobs, ofDrop, ofInput } from './gather.js';
import { complaints, yamlLines } from './yaml_text.js';
import { h, say, setText, toast } from './dom.js';
import { hashAll, uploadAll } from './upload.js';
import { recall, remember } from './memory.js';
import { EXAMPLE } from './example.js';
import { icon } from './icons.js';
import { learnJobs } from './farm_state.js';
import { to } from './router.js';

const MOST_LISTED = 400;

// What was dropped elsewhere, for the view to take; and the view that is shown.
let waiting = null;
let shownView = null;

function give(files) {
  if (shownView) shownView.add(files);
  else {
    waiting = files;
    location.hash = to('submit');
  }
}

/** From now on files can be dropped anywhere on the page. */
export function offerDrop() {
  const veil = h('div', { class: 'veil', hidden: true, testid: 'veil' }, h('p', {}, icon('submit'), 'Drop a job with its files'));
  document.body.append(veil);
  const carries = (event) => event.dataTransfer?.types.includes('Files');
  let depth = 0;
  addEventListener('dragenter', (event) => {
    if (!carries(event)) return;
    ++depth;
    veil.hidden = false;
  });
  addEventListener('dragleave', (event) => {
    if (carries(event) && --depth <= 0) veil.hidden = true;
  });
  addEventListener('dragover', (event) => carries(event) && event.preventDefault());
  addEventListener('drop', async (event) => {
    if (!carries(event)) return;
    event.preventDefault();
    depth = 0;
    veil.hidden = true;
    try {
      give(await ofDrop(event.dataTransfer));
    } catch (error) {
      toast(error.message, 'bad');
    }
  });
}

const randomKey = () => Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, '0')).join('');

class SubmitView {
  constructor() {
    this.title = 'Submit';
    this.files = [];
    this.documents = [];
    this.job = null;
    this.found = [];
    this.key = randomKey();
    this.makePick();
    this.makeOptions();
    this.review = h('div', { class: 'submit-grid', hidden: true });
    this.status = h('div', { class: 'send-status', role: 'status', 'aria-live': 'polite' });
    this.node = h('div', { class: 'view' }, h('div', { class: 'view-head' }, h('h1', { text: 'Submit a job' })), this.pick, this.review);
    shownView = this;
    if (waiting) {
      const files = waiting;
      waiting = null;
      this.add(files);
    }
  }

  makePick() {
    const take = (field) => { this.add(ofInput(field.files)); field.value = ''; };
    const files = h('input', { type: 'file', multiple: true, hidden: true, testid: 'pick-files', onchange: () => take(files) });
    const folder = h('input', { type: 'file', webkitdirectory: true, hidden: true, testid: 'pick-folder', onchange: () => take(folder) });
    this.pick = h('section', { class: 'pick', testid: 'pick', 'aria-label': 'Files' }, files, folder,
      h('p', { class: 'pick-title', text: 'Drop the job’s folder here' }),
      h('p', { class: 'soft', text: 'A YAML file with the meshes and pictures that it names, or the whole folder. Files that the coordinator has already are not sent again.' }),
      h('div', { class: 'buttons' },
        h('button', { type: 'button', class: 'primary', onclick: () => folder.click() }, icon('folder'), 'Choose a folder'),
        h('button', { type: 'button', text: 'Choose files', onclick: () => files.click() }),
        h('button', { type: 'button', class: 'plain', text: 'Try a small example', testid: 'example', onclick: () => this.add([{ path: 'first-light.yaml', file: new File([EXAMPLE], 'first-light.yaml') }]) })));
  }

  makeOptions() {
    const field = (label, input, hint) => h('label', { class: 'field' }, label, input, hint ? h('span', { class: 'hint', text: hint }) : null);
    const number = (testid, placeholder, min = 0) => h('input', { type: 'number', step: 1, min, placeholder, testid });
    this.fields = {
      document: h('select', { testid: 'document-choice', onchange: () => this.chooseJob(this.fields.document.value) }),
      name: h('input', { type: 'text', maxlength: 100, required: true, testid: 'name' }),
      owner: h('input', { type: 'text', maxlength: 100, value: recall('owner', ''), autocomplete: 'username', testid: 'owner-field' }),
      priority: h('input', { type: 'number', step: 1, value: 0, testid: 'priority-option' }),
      frames: h('input', { type: 'text', placeholder: 'as the document says', testid: 'frames-option' }),
      samples: number('samples-option', 'as the document says', 1),
      tags: h('input', { type: 'text', placeholder: 'any worker', testid: 'tags-option' }),
      workers: number('workers-option', 'no limit', 1),
      memory: h('input', { type: 'number', step: 'any', min: 0, placeholder: 'any', testid: 'memory-option' }),
      attempts: number('attempts-option', '3', 1),
      order: h('select', { testid: 'order-option' }, h('option', { value: 'sequential', text: 'One frame after the other' }), h('option', { value: 'progressive', text: 'All frames a little at a time' })),
    };
    const f = this.fields;
    this.asks = h('p', { class: 'asks', hidden: true, text: 'Several files could be the job. Which one is it?' });
    this.send = h('button', { type: 'submit', form: 'options', class: 'primary large', testid: 'send', text: 'Submit' });
    this.form = h('form', { id: 'options', class: 'panel-box options', 'aria-label': 'Options', onsubmit: (event) => { event.preventDefault(); this.submit(); } },
      h('div', { class: 'option-grid' },
        h('div', { class: 'wide' }, this.asks, field('Job document', f.document)),
        h('div', { class: 'wide' }, field('Name', f.name)), field('Owner', f.owner), field('Priority', f.priority, 'higher goes first'),
        field('Frames', f.frames, 'such as 1-24x2, 30'), field('Samples per pixel', f.samples)),
      h('details', { class: 'option-more' }, h('summary', { text: 'Where and in which order' }), h('div', { class: 'option-grid' },
        h('div', { class: 'wide' }, field('Order', f.order, 'the second shows the whole film early')), field('Tags', f.tags, 'workers need all of them'), field('Workers at once', f.workers),
        field('Memory, GiB', f.memory, 'a worker needs at least'), field('Attempts', f.attempts, 'failures of a unit that stop its frame'))));
  }

  async add(files) {
    if (this.sending) {
      toast('A job is being sent: stop that first.', 'bad');
      return;
    }
    const good = files.filter(({ path }) => !isHidden(path));
    if (good.length === 0) {
      toast('There is no file in it.', 'bad');
      return;
    }
    // Another job begins anew; what is no job of its own joins the files that are there.
    const fresh = (await documentsOf(good)).some(({ path, text }) => /^hyades:/m.test(text) && path !== this.job);
    if (fresh) this.reset();
    const byPath = new Map(this.files.map((entry) => [entry.path, entry]));
    for (const entry of good) byPath.set(entry.path, { ...entry, on: true });
    const documents = await documentsOf([...byPath.values()]);
    if (documents.length === 0) {
      toast(good.some(({ path }) => /\.(glb|gltf|pbrt|obj)$/i.test(path)) ? 'A scene of another tool needs a job: a YAML file with “include: SCENE”. Or use hyades submit.' : 'There is no YAML file in it: a job is one.', 'bad');
      return;
    }
    this.files = [...byPath.values()];
    this.documents = documents;
    this.found = [];
    const jobs = likelyJobs(documents);
    this.fields.document.replaceChildren(...(clearlyFirst(documents) || this.job ? [] : [h('option', { value: '', text: 'Choose…' })]), ...jobs.map((path) => h('option', { value: path, text: path })));
    const known = this.job && jobs.includes(this.job) ? this.job : clearlyFirst(documents) ? jobs[0] : '';
    this.asks.hidden = known !== '';
    this.fields.document.value = known;
    this.chooseJob(known);
    this.pick.classList.add('less');
    this.review.hidden = false;
  }

  chooseJob(path) {
    this.job = path || null;
    this.asks.hidden = this.job !== null;
    this.found = [];
    if (this.job) {
      const text = this.textOf(this.job);
      const named = /^name:\s*["']?([^"'#\n]+?)["']?\s*(#.*)?$/m.exec(text)?.[1];
      const plain = path.slice(path.lastIndexOf('/') + 1).replace(/\.ya?ml$/i, '');
      const folder = folderOf(path).split('/').filter(Boolean).pop();
      this.fields.name.value = named ?? (plain === 'job' && folder ? folder : plain);
    }
    this.draw();
  }

  textOf(path) {
    return this.documents.find((document) => document.path === path)?.text ?? '';
  }

  draw() {
    const open = this.shownDocument ?? this.job ?? this.documents[0].path;
    this.review.replaceChildren(h('div', { class: 'submit-main' }, this.problemBox(), this.documentBox(open), this.filesBox()), h('div', { class: 'submit-side' }, this.form, h('div', { class: 'send panel-box' }, this.sum(), this.send, this.status)));
    this.send.disabled = !this.job;
  }

  problemBox() {
    if (this.found.length === 0) return null;
    const list = h('ul', { class: 'problem-list' }, this.found.map((complaint) => h('li', {},
      complaint.line > 0 ? [h('button', { type: 'button', class: 'link mono', text: `${complaint.file}:${complaint.line}`, onclick: () => this.goTo(complaint) }), ' '] : null, complaint.text)));
    return h('section', { class: 'problem-box', role: 'alert', testid: 'problems' }, h('h2', { text: this.found.length === 1 ? 'The job was not taken' : `The job was not taken: ${this.found.length} complaints` }), list);
  }

  documentOf(complaint) {
    const folder = folderOf(this.job ?? '');
    return this.documents.find(({ path }) => fromFolder(folder, path) === complaint.file || path === complaint.file || path.endsWith(`/${complaint.file}`))?.path ?? null;
  }

  goTo(complaint) {
    this.shownDocument = this.documentOf(complaint);
    this.draw();
    const line = this.review.querySelector(`#line-${complaint.line}`);
    line?.scrollIntoView({ block: 'center' });
  }

  documentBox(open) {
    const text = this.textOf(open);
    const about = this.found.filter((complaint) => complaint.line > 0 && this.documentOf(complaint) === open);
    const tabs = this.documents.length > 1 ? h('select', { 'aria-label': 'Shown document', testid: 'shown-document', onchange: (event) => { this.shownDocument = event.target.value; this.draw(); } }, this.documents.map(({ path }) => h('option', { value: path, text: path }))) : h('span', { class: 'mono', text: open });
    if (this.documents.length > 1) tabs.value = open;
    const edit = h('button', { type: 'button', class: 'small', testid: 'edit', onclick: () => this.edit(open) }, icon('edit'), 'Edit');
    const body = this.editing === open ? this.editor(open, text) : h('div', { class: 'document-text' }, yamlLines(text, about));
    return h('section', { class: 'panel-box', 'aria-label': 'Document' }, h('div', { class: 'box-head' }, h('h2', { text: 'Document' }), tabs, h('span', { class: 'spring' }), this.editing === open ? null : edit), body);
  }

  edit(path) {
    this.editing = path;
    this.draw();
    this.review.querySelector('textarea').focus();
  }

  editor(path, text) {
    const area = h('textarea', { class: 'mono editor', spellcheck: 'false', 'aria-label': `Text of ${path}`, testid: 'editor', value: text, rows: Math.min(40, text.split('\n').length + 2) });
    const done = (keep) => {
      if (keep) this.replace(path, area.value);
      this.editing = null;
      this.draw();
    };
    return h('div', { class: 'editor-box' }, area, h('div', { class: 'buttons' },
      h('button', { type: 'button', class: 'primary', text: 'Keep for this submission', testid: 'edit-keep', onclick: () => done(true) }), h('button', { type: 'button', text: 'Discard', onclick: () => done(false) }),
      h('span', { class: 'soft', text: 'Your file stays as it is.' })));
  }

  replace(path, text) {
    const entry = this.files.find((other) => other.path === path);
    entry.file = new File([text], entry.file.name);
    this.documents.find((document) => document.path === path).text = text;
    this.found = [];
  }

  chosen() {
    return this.files.filter(({ on, path }) => on || path === this.job);
  }

  sum() {
    const files = this.chosen();
    this.sumNode = h('p', { class: 'send-sum', testid: 'send-sum', text: `${counted(files.length, 'file')}, ${bytes(files.reduce((sum, { file }) => sum + file.size, 0))}` });
    return this.sumNode;
  }

  filesBox() {
    const texts = this.documents.map(({ text }) => text);
    const folder = folderOf(this.job ?? '');
    const row = (entry) => {
      const named = entry.path === this.job || isYaml(entry.path) || isNamed(entry.path, texts);
      const box = h('input', { type: 'checkbox', checked: entry.on || entry.path === this.job, disabled: entry.path === this.job, testid: 'file-on', onchange: () => { entry.on = box.checked; this.sumNode.replaceWith(this.sum()); } });
      return h('li', {}, h('label', {}, box, h('span', { class: 'mono file-path', text: fromFolder(folder, entry.path) }),
        h('span', { class: 'soft file-note', text: entry.path === this.job ? 'the job' : named ? '' : 'not named in the YAML' }), h('span', { class: 'num soft', text: bytes(entry.file.size) })));
    };
    const sorted = [...this.files].sort((a, b) => (b.path === this.job) - (a.path === this.job) || isYaml(b.path) - isYaml(a.path) || a.path.localeCompare(b.path));
    const only = () => {
      for (const entry of this.files) entry.on = isYaml(entry.path) || isNamed(entry.path, texts);
      this.draw();
    };
    return h('section', { class: 'panel-box', 'aria-label': 'Files that are sent' },
      h('div', { class: 'box-head' }, h('h2', { text: 'Files that are sent' }), h('span', { class: 'soft', text: 'as the job’s folder sees them' }), h('span', { class: 'spring' }),
        this.files.length > 1 ? h('button', { type: 'button', class: 'small', text: 'Only those named', title: 'Files that no YAML names are left out. Textures that meshes name (.mtl, .gltf) are such.', testid: 'only-named', onclick: only }) : null,
        h('button', { type: 'button', class: 'small', text: 'Remove all', testid: 'remove-all', onclick: () => this.reset() })),
      h('ul', { class: 'file-list', testid: 'file-list' }, sorted.slice(0, MOST_LISTED).map(row), sorted.length > MOST_LISTED ? h('li', { class: 'soft', text: `and ${whole(sorted.length - MOST_LISTED)} more` }) : null));
  }

  reset() {
    this.files = [];
    this.documents = [];
    this.job = null;
    this.shownDocument = null;
    this.found = [];
    this.review.hidden = true;
    this.pick.classList.remove('less');
  }

  submission(files) {
    const { fields: f } = this;
    const folder = folderOf(this.job);
    const body = { name: f.name.value.trim(), document: fromFolder(folder, this.job), files: files.map(({ path, file, sha256 }) => ({ path: fromFolder(folder, path), sha256, size: file.size })), idempotency_key: this.key, priority: Number(f.priority.value) || 0, frame_order: f.order.value };
    const ranges = framesOf(f.frames.value);
    if (ranges.length > 0) body.frames = ranges;
    if (f.owner.value.trim()) body.owner = f.owner.value.trim();
    if (f.samples.value) body.samples = Number(f.samples.value);
    if (f.workers.value) body.max_workers = Number(f.workers.value);
    if (f.attempts.value) body.max_attempts = Number(f.attempts.value);
    if (f.memory.value) body.memory_bytes = Math.round(Number(f.memory.value) * 2 ** 30);
    const tags = f.tags.value.split(/[,\s]+/).filter(Boolean);
    if (tags.length > 0) body.tags = tags;
    return body;
  }

  async submit() {
    if (this.sending) {
      this.sending.abort();
      return;
    }
    remember('owner', this.fields.owner.value.trim());
    this.found = [];
    const files = this.chosen();
    const stop = new AbortController();
    try {
      framesOf(this.fields.frames.value);
    } catch (error) {
      this.tell(error.message, true);
      return;
    }
    this.sending = stop;
    setText(this.send, 'Stop');
    this.send.classList.remove('primary');
    const gauge = h('progress', { max: 1, value: 0, 'aria-label': 'Upload' });
    const line = h('p', {});
    this.status.replaceChildren(gauge, line);
    try {
      const all = files.reduce((sum, { file }) => sum + file.size, 0) || 1;
      await hashAll(files, (read) => { gauge.value = (read / all) * 0.3; setText(line, `Reading ${bytes(read)} of ${bytes(all)}`); }, stop.signal);
      for (;;) {
        await uploadAll(files, (now) => {
          gauge.value = 0.3 + 0.7 * (now.total > 0 ? now.sent / now.total : 1);
          setText(line, now.waiting ? `Waiting: ${now.waiting}. It goes on by itself.` : `Sending ${bytes(now.sent)} of ${bytes(now.total)} · ${now.path}`);
        }, stop.signal);
        setText(line, 'The coordinator reads the job…');
        gauge.removeAttribute('value');
        try {
          const { job, existed } = await api.submit(this.submission(files));
          this.taken(job, existed);
          return;
        } catch (error) {
          // A file was swept in between: it is sent again.
          if (error.missing.length > 0 && !this.again) {
            this.again = true;
            continue;
          }
          if (error.retryAfterMs > 0 || error.code === 'unreachable' || error.code === 'unavailable') {
            setText(line, `Waiting: ${error.message}. It goes on by itself.`);
            await new Promise((resolve) => setTimeout(resolve, error.retryAfterMs || 2000));
            if (stop.signal.aborted) throw new DOMException('stopped', 'AbortError');
            continue;
          }
          throw error;
        }
      }
    } catch (error) {
      this.refused(error);
    } finally {
      this.sending = null;
      this.again = false;
      setText(this.send, 'Submit');
      this.send.classList.add('primary');
    }
  }

  tell(text, bad = false) {
    this.status.replaceChildren(h('p', { class: bad ? 'problem' : '', text, testid: 'send-message' }));
  }

  taken(job, existed) {
    learnJobs([job]);
    toast(existed ? `${job.name} was there already` : `${job.name} was taken in as job ${job.id}`);
    this.key = randomKey();
    if (shownView === this) location.hash = to('job', { job: job.id });
  }

  refused(error) {
    if (error.name === 'AbortError') {
      this.tell('Stopped. What has come is kept for a while: submitting again goes on there.');
      return;
    }
    if (error.code === 'invalid_argument') {
      this.found = complaints(error.message);
      const first = this.found.find(({ line }) => line > 0);
      if (first) this.shownDocument = this.documentOf(first) ?? this.shownDocument;
      this.tell('');
      this.draw();
      scrollTo({ top: 0 });
      say(`The job was not taken: ${counted(this.found.length, 'complaint')}.`);
      return;
    }
    this.tell(error.missing?.length > 0 ? `${error.message} (${counted(error.missing.length, 'file')})` : error.message, true);
  }

  leave() {
    shownView = null;
    this.sending?.abort();
  }
}

/** The view. */
export const submitView = () => new SubmitView();
