// Which files a person has given, which of them is the job, and what they are called from there.

/** Larger ones are no job. */
const LARGEST_JOB = 8 * 1024 * 1024;
const MOST_FILES = 10000;

const entriesOf = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
const fileOf = (entry) => new Promise((resolve, reject) => entry.file(resolve, reject));

async function walk(entry, folder, into) {
  if (into.length > MOST_FILES) throw new Error(`More than ${MOST_FILES} files: drop the job's own folder.`);
  const path = folder + entry.name;
  if (entry.isFile) {
    into.push({ path, file: await fileOf(entry) });
    return;
  }
  if (isHidden(entry.name)) return;
  const reader = entry.createReader();
  // A reader gives some entries at a time, none at the end.
  for (let some = await entriesOf(reader); some.length > 0; some = await entriesOf(reader)) {
    for (const child of some) await walk(child, `${path}/`, into);
  }
}

/** What was dropped: [{path, file}], folders walked through. Has to be called while the event is handled. */
export function ofDrop(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length === 0) return Promise.resolve(ofInput(transfer.files));
  return (async () => {
    const into = [];
    for (const entry of entries) await walk(entry, '', into);
    return into;
  })();
}

/** What was picked in a file field. */
export const ofInput = (files) => [...files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));

/** What systems and tools leave in folders, nobody's job. */
export const isHidden = (path) =>
  path.split('/').some((part) => part.startsWith('.') || ['Thumbs.db', 'desktop.ini', '__MACOSX'].includes(part));

export const isYaml = (path) => /\.ya?ml$/i.test(path);

/** The folder of a path, with '/' at its end; '' at the top. */
export const folderOf = (path) => path.slice(0, path.lastIndexOf('/') + 1);

/** What `path` is called from `folder` ('a/b/'): '../' leads up. */
export function fromFolder(folder, path) {
  const here = folder.split('/').filter(Boolean);
  const there = path.split('/');
  let same = 0;
  while (same < here.length && same < there.length - 1 && here[same] === there[same]) ++same;
  return '../'.repeat(here.length - same) + there.slice(same).join('/');
}

/** The files that a YAML text includes, as it calls them. */
export function includesOf(text) {
  const found = [];
  const lines = text.split(/\r?\n/);
  lines.forEach((line, i) => {
    const hit = /^include:\s*(.*)$/.exec(line);
    if (!hit) return;
    let value = hit[1].replace(/\s+#.*$/, '').trim();
    if (value === '') {
      for (let k = i + 1; k < lines.length && /^\s*-\s|^\s*$/.test(lines[k]); ++k)
        value += `,${lines[k].replace(/^\s*-\s*/, '')}`;
    }
    for (const name of value.replace(/^\[|\]$/g, '').split(',')) {
      const clean = name
        .replace(/\s+#.*$/, '')
        .trim()
        .replace(/^["']|["']$/g, '');
      if (clean) found.push(clean);
    }
  });
  return found;
}

const resolve = (folder, name) => {
  const parts = folder.split('/').filter(Boolean);
  for (const part of name.split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '.' && part !== '') parts.push(part);
  }
  return parts.join('/');
};

/**
 * Which of the YAML files can be the job, the likeliest first: [{path, text}] -> paths. Those that others include come last; before them
 * those that say what a job says; 'job.yaml' and what lies higher wins.
 */
export function likelyJobs(documents) {
  const included = new Set(
    documents.flatMap(({ path, text }) => includesOf(text).map((name) => resolve(folderOf(path), name))),
  );
  const weight = ({ path, text }) => {
    let sum = 0;
    if (/^hyades:/m.test(text)) sum += 8;
    if (/^(film|outputs|frames|camera):/m.test(text)) sum += 4;
    if (/(^|\/)job\.ya?ml$/i.test(path)) sum += 2;
    if (included.has(path)) sum -= 20;
    return sum - path.split('/').length * 0.1;
  };
  return [...documents].sort((a, b) => weight(b) - weight(a) || a.path.localeCompare(b.path)).map(({ path }) => path);
}

/** Whether only one of them can be meant: nobody needs to be asked then. */
export function clearlyFirst(documents) {
  const included = new Set(
    documents.flatMap(({ path, text }) => includesOf(text).map((name) => resolve(folderOf(path), name))),
  );
  return (
    documents.filter(({ path, text }) => /^hyades:/m.test(text) && !included.has(path)).length === 1 ||
    documents.length === 1
  );
}

/** The YAML files among them, with their texts. */
export async function documentsOf(files) {
  const list = [];
  for (const { path, file } of files) {
    if (isYaml(path) && !isHidden(path) && file.size <= LARGEST_JOB) list.push({ path, text: await file.text() });
  }
  return list;
}

/** Whether some text names the file: by its name, or with '#' for digits (sequences). */
export function isNamed(path, texts) {
  const name = path.slice(path.lastIndexOf('/') + 1);
  const sequence = name.replace(/\d+(?=\.[^.]*$)/, (digits) => '#'.repeat(digits.length));
  return texts.some(
    (text) =>
      text.includes(name) ||
      (sequence !== name && text.includes(sequence)) ||
      (/<udim>/i.test(text) && text.includes(name.replace(/\d{4}(?=\.)/, '<UDIM>'))),
  );
}

/** Reads '1-24x2, 30' as the API's frames; throws an Error that says what is wrong. */
export function framesOf(text) {
  const ranges = [];
  for (const part of text
    .split(',')
    .map((piece) => piece.trim())
    .filter(Boolean)) {
    const hit = /^(\d+)(?:\s*-\s*(\d+)(?:\s*x\s*(\d+))?)?$/.exec(part);
    if (!hit) throw new Error(`Frames: '${part}' is not like 7, 1-24 or 1-24x2.`);
    const first = Number(hit[1]);
    const last = hit[2] === undefined ? first : Number(hit[2]);
    const step = hit[3] === undefined ? 1 : Number(hit[3]);
    if (last < first) throw new Error(`Frames: '${part}' ends before it begins.`);
    if (step < 1) throw new Error(`Frames: the step of '${part}' has to be 1 or more.`);
    ranges.push({ first, last, step });
  }
  return ranges;
}
