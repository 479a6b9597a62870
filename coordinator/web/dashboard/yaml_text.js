// YAML as lines to look at: numbered, lightly coloured, with complaints below the lines that they are about.
import { h } from './dom.js';

// What a browser shows at once without standing still, and the longest line that is coloured.
const MOST_CHARACTERS = 1 << 20;
const MOST_LINES = 20000;
const MOST_COLOURED = 2000;

/** Cuts a line into [kind, text] pieces that join to the line; kinds: '', 'key', 'text', 'remark'. */
export function pieces(line) {
  if (line.length > MOST_COLOURED) return [['', line]];
  const parts = [];
  let rest = line;
  const lead = /^(\s*(?:- +)*)/.exec(rest)[0];
  if (lead) parts.push(['', lead]);
  rest = rest.slice(lead.length);
  while (rest !== '') {
    let hit;
    const before = parts.length > 0 ? parts[parts.length - 1][1] : ' ';
    if (rest.startsWith('#') && /\s$|^$/.test(before)) hit = ['remark', rest];
    else if ((hit = /^"(?:[^"\\]|\\.)*"|^'(?:[^']|'')*'/.exec(rest))) hit = ['text', hit[0]];
    else if ((hit = /^[\w][\w .-]*(?=:(\s|$))/.exec(rest))) hit = ['key', hit[0]];
    else if ((hit = /^[^\s"'#,{}[\]:]+/.exec(rest))) hit = ['', hit[0]];
    else hit = ['', rest[0]];
    parts.push(hit);
    rest = rest.slice(hit[1].length);
  }
  return parts;
}

/**
 * Reads complaints: lines 'FILE:LINE:COLUMN: text' (FILE may hold ':'), others belong to no line. Returns [{file, line, column, text}],
 * line 0 where there is none.
 */
export function complaints(message) {
  const list = [];
  for (const line of message.split('\n')) {
    if (line.trim() === '') continue;
    const hit = /^(.+?):(\d+):(\d+): (.*)$/.exec(line);
    const last = list[list.length - 1];
    if (hit) list.push({ file: hit[1], line: Number(hit[2]), column: Number(hit[3]), text: hit[4] });
    else if (/^\s/.test(line) && last) last.text += `\n${line.trim()}`;
    else list.push({ file: '', line: 0, column: 0, text: line });
  }
  return list;
}

/** The lines of a text that are shown, those of its beginning, and whether there are more. */
export function shownLines(text) {
  const lines = text.slice(0, MOST_CHARACTERS).replace(/\r\n?/g, '\n').replace(/\n$/, '').split('\n');
  return { lines: lines.slice(0, MOST_LINES), more: text.length > MOST_CHARACTERS || lines.length > MOST_LINES };
}

/** The text as a list of lines, of a very long one the beginning; `found`: complaints about this file. */
export function yamlLines(text, found = []) {
  const { lines, more } = shownLines(text);
  const below = found.filter((complaint) => complaint.line > lines.length);
  const words = ({ text: what, line, column }) =>
    line > lines.length ? `line ${line}: ${what}` : column > 0 ? `column ${column}: ${what}` : what;
  const said = (complaint) => h('span', { class: 'complaint', testid: 'complaint', text: words(complaint) });
  return h(
    'ol',
    { class: 'code', tabindex: 0, 'aria-label': 'Document' },
    lines.map((line, i) => {
      const here = found.filter((complaint) => complaint.line === i + 1);
      return h(
        'li',
        { class: here.length > 0 ? 'wrong' : null, id: here.length > 0 ? `line-${i + 1}` : null },
        h(
          'span',
          {},
          pieces(line).map(([kind, piece]) => (kind ? h('span', { class: kind, text: piece }) : piece)),
        ),
        here.map(said),
      );
    }),
    more ? h('li', { class: 'wrong' }, 'The text goes on: too long to be shown whole', below.map(said)) : null,
  );
}
