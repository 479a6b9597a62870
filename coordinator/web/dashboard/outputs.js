// The finished files of a job.
import { archiveAddress, outputAddress, outputs } from './api.js';
import { videoMaker } from './ask_video.js';
import { bytes, counted } from './format.js';
import { h, keyed, setText } from './dom.js';
import { icon } from './icons.js';
import { Table } from './table.js';

const VIDEO = /\.(mp4|mov|webm)$/i;
/** What browsers show themselves; others are saved. */
const SHOWN = /\.(png|jpe?g|mp4|webm|mov|txt|json)$/i;

function pathCell(state) {
  return (td, output) => {
    if (!td.firstChild) td.append(h('span', { class: 'two' }, h('a', { class: 'row-link', testid: 'output' })));
    const link = td.firstChild.firstChild;
    setText(link, output.id);
    const shown = SHOWN.test(output.id);
    link.href = outputAddress(state.id, output.id, !shown);
    if (shown) {
      link.target = '_blank';
      link.rel = 'noopener';
    }
    link.title = output.id;
  };
}

/** The tab. */
export function outputsTab(state) {
  const videos = h('div', { class: 'videos' });
  const summary = h('p', { class: 'soft' });
  const search = h('input', {
    type: 'search',
    placeholder: 'Part of a name',
    'aria-label': 'Search files',
    testid: 'output-search',
    oninput: () => draw(),
  });
  const all = h(
    'a',
    { class: 'button primary', href: archiveAddress(state.id), download: '', testid: 'outputs-archive' },
    icon('download'),
    'Download all (zip)',
  );
  const table = new Table({
    label: 'Finished files',
    testid: 'outputs-table',
    rowKey: ({ id }) => id,
    sort: { key: 'path', down: false },
    empty: () =>
      h('p', {
        class: 'soft',
        text:
          list.length > 0
            ? 'No file is called like that.'
            : 'No finished files yet. Each frame writes its files when it is done.',
      }),
    columns: [
      { key: 'path', label: 'File', sort: ({ id }) => id, up: true, cell: pathCell(state) },
      {
        key: 'frame',
        label: 'Frame',
        kind: 'num',
        drop: 1,
        sort: ({ frame }) => frame,
        up: true,
        cell: (td, { frame }) => setText(td, frame),
      },
      {
        key: 'size',
        label: 'Size',
        kind: 'num',
        sort: ({ size }) => size,
        cell: (td, { size }) => setText(td, bytes(size)),
      },
      {
        key: 'digest',
        label: 'SHA-256',
        drop: 2,
        cell: (td, { sha256 }) => {
          td.className = 'mono soft drop2';
          setText(td, `${sha256.slice(0, 12)}…`);
          td.title = sha256;
        },
      },
      {
        key: 'save',
        label: '',
        spoken: 'Download',
        kind: 'end',
        cell: (td, { id }) =>
          td.replaceChildren(
            h('a', {
              href: outputAddress(state.id, id, true),
              download: '',
              text: 'Download',
              'aria-label': `Download ${id}`,
              testid: 'download',
            }),
          ),
      },
    ],
  });
  const maker = videoMaker(state, () => ask());
  const head = h('div', { class: 'outputs-head pad' }, search, summary, h('span', { class: 'spring' }), maker.button, all);
  const node = h('div', {}, head, maker.lines, videos, table.node);
  const stop = new AbortController();
  let list = [];
  let known = -1;
  let busy = false;
  let again = false;

  const draw = () => {
    const word = search.value.toLowerCase();
    table.setRows(list.filter(({ id }) => id.toLowerCase().includes(word)));
    setText(
      summary,
      list.length > 0 ? `${counted(list.length, 'file')}, ${bytes(list.reduce((sum, { size }) => sum + size, 0))}` : '',
    );
    head.hidden = list.length === 0;
    keyed(
      videos,
      list.filter(({ id }) => VIDEO.test(id)),
      ({ id, sha256 }) => `${id} ${sha256}`,
      ({ id }) =>
        h('video', {
          src: outputAddress(state.id, id),
          controls: true,
          preload: 'metadata',
          loop: true,
          'aria-label': `Video ${id}`,
          testid: 'video',
        }),
    );
  };
  const ask = async () => {
    if (busy) {
      again = true;
      return;
    }
    busy = true;
    try {
      ({ outputs: list } = await outputs(state.id, stop.signal));
      draw();
    } catch {
      known = -1;
    }
    busy = false;
    if (again) {
      again = false;
      ask();
    }
  };
  // Files come with frames, a video with the end of the job.
  const update = () => {
    maker.update();
    const { job } = state;
    const now = job ? `${job.frames_done} ${job.state}` : -1;
    if (now === known || busy) return;
    known = now;
    ask();
  };
  draw();
  update();
  return {
    node,
    update,
    shown: draw,
    step: (by) => table.step(by),
    leave: () => {
      stop.abort();
      maker.leave();
      table.leave();
    },
  };
}
