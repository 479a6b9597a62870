// Submitting a job from the browser: give files, see what is sent, send.
import * as api from './api.js';
import { bytes, counted } from './format.js';
import { h, say, setText, toast } from './dom.js';
import { hashAll, rest, uploadAll } from './upload.js';
import { Bundle } from './bundle.js';
import { complaints } from './yaml_text.js';
import { learnJobs } from './farm_state.js';
import { Options } from './submit_options.js';
import { pickBox } from './pick_box.js';
import { Review } from './review.js';
import { takeDrops } from './drop.js';
import { whyNotSubmit } from './me.js';
import { to } from './router.js';

const randomKey = () =>
  Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, '0')).join('');

class SubmitView {
  constructor() {
    this.title = 'Submit';
    this.bundle = new Bundle();
    this.pick = pickBox((files) => this.add(files));
    this.options = new Options({ choose: (path) => this.choose(path), submit: () => this.submit() });
    this.review = new Review(this.bundle, { chosen: () => this.tellSum(), reset: () => this.reset() });
    this.send = h('button', {
      type: 'submit',
      form: 'options',
      class: 'primary large',
      testid: 'send',
      disabled: Boolean(whyNotSubmit()),
      title: whyNotSubmit(),
      text: 'Submit',
    });
    this.sum = h('p', { class: 'send-sum', testid: 'send-sum' });
    this.status = h('div', { class: 'send-status', role: 'status', 'aria-live': 'polite' });
    const box = h('div', { class: 'send panel-box' }, this.sum, this.send, this.status);
    const side = h('div', { class: 'submit-side' }, this.options.form, box);
    this.body = h('div', { class: 'submit-grid', hidden: true }, this.review.node, side);
    const head = h('div', { class: 'view-head' }, h('h1', { text: 'Submit a job' }));
    this.node = h('div', { class: 'view' }, head, this.pick, this.body);
    takeDrops((files) => this.add(files));
  }

  async add(files) {
    if (this.sending) {
      toast('A job is being sent: stop that first.', 'bad');
      return;
    }
    try {
      await this.bundle.add(files);
    } catch (error) {
      toast(error.message, 'bad');
      return;
    }
    this.review.clear();
    this.options.setJobs(this.bundle.jobs(), this.bundle.job);
    this.choose(this.bundle.job);
    this.pick.classList.add('less');
    this.body.hidden = false;
  }

  choose(path) {
    this.bundle.job = path || null;
    this.bundle.found = [];
    if (this.bundle.job) this.options.settled();
    this.draw();
  }

  draw() {
    this.review.draw();
    this.tellSum();
    this.send.disabled = !this.bundle.job || Boolean(whyNotSubmit());
  }

  tellSum() {
    const files = this.bundle.chosen();
    setText(
      this.sum,
      `${counted(files.length, 'file')}, ${bytes(files.reduce((sum, { file }) => sum + file.size, 0))}`,
    );
  }

  reset() {
    this.bundle.clear();
    this.review.clear();
    this.body.hidden = true;
    this.pick.classList.remove('less');
  }

  submission(options, files) {
    const { bundle } = this;
    const body = {
      ...options,
      name: bundle.title(),
      document: bundle.nameOf(bundle.job),
      files: files.map(({ path, file, sha256 }) => ({ path: bundle.nameOf(path), sha256, size: file.size })),
    };
    // The same again, after an answer that was lost, is the same job; anything else is another one.
    const content = JSON.stringify(body);
    if (content !== this.content) this.key = randomKey();
    this.content = content;
    return { ...body, idempotency_key: this.key };
  }

  async submit() {
    if (this.sending) {
      this.sending.abort();
      return;
    }
    let options;
    try {
      options = this.options.read();
    } catch (error) {
      this.tell(error.message, true);
      return;
    }
    const stop = new AbortController();
    this.sending = stop;
    this.bundle.found = [];
    setText(this.send, 'Stop');
    this.send.classList.remove('primary');
    this.gauge = h('progress', { max: 1, value: 0, 'aria-label': 'Upload' });
    this.line = h('p', {});
    this.status.replaceChildren(this.gauge, this.line);
    try {
      const { job, existed, warnings } = await this.bring(options, this.bundle.chosen(), stop.signal);
      learnJobs([job]);
      this.content = null;
      toast(existed ? `${job.name} was there already` : `${job.name} was taken in as job ${job.id}`);
      for (const warning of warnings) toast(warning, 'bad');
      if (!this.left) location.hash = to('job', { job: job.id });
    } catch (error) {
      this.refused(error);
    } finally {
      this.sending = null;
      setText(this.send, 'Submit');
      this.send.classList.add('primary');
    }
  }

  // Reads, uploads and submits; what the coordinator says then.
  async bring(options, files, signal) {
    const all = files.reduce((sum, { file }) => sum + file.size, 0) || 1;
    const read = (count) => this.tellProgress((0.3 * count) / all, `Reading ${bytes(count)} of ${bytes(all)}`);
    await hashAll(files, read, signal);
    let again = true;
    for (;;) {
      await uploadAll(files, (now) => this.tellUpload(now), signal);
      this.tellProgress(null, 'The coordinator reads the job…');
      try {
        return await api.submit(this.submission(options, files));
      } catch (error) {
        if (error.missing?.length > 0 && again) {
          // A file was swept in between: it is sent again.
          again = false;
        } else if (error.retryAfterMs > 0 || error.code === 'unreachable' || error.code === 'unavailable') {
          this.tellProgress(null, `Waiting: ${error.message}. It goes on by itself.`);
          await rest(error.retryAfterMs || 2000, signal);
        } else {
          throw error;
        }
      }
    }
  }

  tellProgress(share, text) {
    if (share === null) this.gauge.removeAttribute('value');
    else this.gauge.value = share;
    setText(this.line, text);
  }

  tellUpload({ sent, total, path, waiting }) {
    const share = 0.3 + 0.7 * (total > 0 ? sent / total : 1);
    const going = `Sending ${bytes(sent)} of ${bytes(total)} · ${path}`;
    this.tellProgress(share, waiting ? `Waiting: ${waiting}. It goes on by itself.` : going);
  }

  tell(text, bad = false) {
    this.status.replaceChildren(h('p', { class: bad ? 'problem' : '', text, testid: 'send-message' }));
  }

  refused(error) {
    if (error.name === 'AbortError') {
      this.tell('Stopped. What has come is kept for a while: submitting again goes on there.');
    } else if (error.code === 'invalid_argument') {
      const found = complaints(error.message);
      this.bundle.found = found;
      const first = found.find(({ line }) => line > 0);
      if (first) this.review.open = this.bundle.documentOf(first) ?? this.review.open;
      this.tell('');
      this.draw();
      scrollTo({ top: 0 });
      say(`The job was not taken: ${counted(found.length, 'complaint')}.`);
    } else {
      const files = error.missing?.length > 0 ? ` (${counted(error.missing.length, 'file')})` : '';
      this.tell(error.message + files, true);
    }
  }

  leave() {
    this.left = true;
    takeDrops(null);
    this.sending?.abort();
  }
}

/** The view. */
export const submitView = () => new SubmitView();
