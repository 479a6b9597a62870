// YAML as lines to look at: numbered, lightly coloured, with complaints below the lines that they are about.
import { h } from './dom.js';

/** Cuts a line into [kind, text] pieces that join to the line; kinds: '', 'key', 'text', 'remark'. */
export function pieces(line) {
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

/** The text as a list of lines; `found`: complaints about this file. */
export function yamlLines(text, found = []) {
  const lines = text.replace(/\r\n?/g, '\n').replace(/\n$/, '').split('\n');
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
        here.map(({ text: words, column }) =>
          h('span', {
            class: 'complaint',
            testid: 'complaint',
            text: column > 0 ? `column ${column}: ${words}` : words,
          }),
        ),
      );
    }),
  );
}
