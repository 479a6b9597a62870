// The files of a submission: what was given, which of them is the job, what the coordinator said about them.
import { clearlyFirst, documentsOf, folderOf, fromFolder, isHidden, isNamed, isYaml, likelyJobs } from './gather.js';

const SCENES = /\.(glb|gltf|pbrt|obj)$/i;

export class Bundle {
  constructor() {
    this.clear();
  }

  clear() {
    /** [{path, file, on: whether it is sent}], and sha256 once it is known. */
    this.files = [];
    /** The YAML files: [{path, text}]. */
    this.documents = [];
    /** The path of the job; null while nobody has said which it is. */
    this.job = null;
    /** Complaints (yaml_text.js) about what was sent last. */
    this.found = [];
  }

  /** Takes in files ([{path, file}]). Throws an Error that says why none of them is of use; then nothing has changed. */
  async add(files) {
    const good = files.filter(({ path }) => !isHidden(path));
    if (good.length === 0) throw new Error('There is no file in it.');
    // Another job begins anew; what is no job of its own joins the files that are there.
    const others = await documentsOf(good);
    const fresh = others.some(({ path, text }) => /^hyades:/m.test(text) && path !== this.job);
    const byPath = new Map(fresh ? [] : this.files.map((entry) => [entry.path, entry]));
    for (const entry of good) byPath.set(entry.path, { ...entry, on: true });
    const documents = await documentsOf([...byPath.values()]);
    if (documents.length === 0) {
      throw new Error(
        good.some(({ path }) => SCENES.test(path))
          ? 'A scene of another tool needs a job: a YAML file with “include: SCENE”. Or use hyades submit.'
          : 'There is no YAML file in it: a job is one.',
      );
    }
    const before = fresh ? null : this.job;
    this.files = [...byPath.values()];
    this.documents = documents;
    this.found = [];
    const jobs = this.jobs();
    this.job = jobs.includes(before) ? before : clearlyFirst(documents) ? jobs[0] : null;
  }

  /** What can be the job, the likeliest first. */
  jobs() {
    return likelyJobs(this.documents);
  }

  textOf(path) {
    return this.documents.find((document) => document.path === path)?.text ?? '';
  }

  /** Puts another text in the place of a document's. */
  replace(path, text) {
    const entry = this.files.find((other) => other.path === path);
    entry.file = new File([text], entry.file.name);
    this.documents.find((document) => document.path === path).text = text;
    this.found = [];
  }

  /** What a path is called from the job's folder. */
  nameOf(path) {
    return fromFolder(folderOf(this.job ?? ''), path);
  }

  /** What the job is called: as it says itself, else by its file or its folder. */
  title() {
    const named = /^name:\s*["']?([^"'#\n]+?)["']?\s*(#.*)?$/m.exec(this.textOf(this.job))?.[1];
    const plain = this.job.slice(this.job.lastIndexOf('/') + 1).replace(/\.ya?ml$/i, '');
    const folder = folderOf(this.job).split('/').filter(Boolean).pop();
    return named ?? (plain === 'job' && folder ? folder : plain);
  }

  /** Whether the job, or a YAML beside it, names the file. Textures that meshes name are not found by this. */
  isNamed({ path }) {
    return (
      isYaml(path) ||
      isNamed(
        path,
        this.documents.map(({ text }) => text),
      )
    );
  }

  /** The files that are sent. */
  chosen() {
    return this.files.filter(({ on, path }) => on || path === this.job);
  }

  /** The document that a complaint is about; null: none of them. */
  documentOf({ file }) {
    const same = ({ path }) => this.nameOf(path) === file || path === file || path.endsWith(`/${file}`);
    return this.documents.find(same)?.path ?? null;
  }
}
