// Where files are chosen or dropped.
import { EXAMPLE } from './example.js';
import { h } from './dom.js';
import { icon } from './icons.js';
import { ofInput } from './gather.js';

/** The box for files; `add(files)` gets those that are chosen. */
export function pickBox(add) {
  const take = (field) => {
    add(ofInput(field.files));
    field.value = '';
  };
  const files = h('input', {
    type: 'file',
    multiple: true,
    hidden: true,
    testid: 'pick-files',
    onchange: () => take(files),
  });
  const folder = h('input', {
    type: 'file',
    webkitdirectory: true,
    hidden: true,
    testid: 'pick-folder',
    onchange: () => take(folder),
  });
  return h(
    'section',
    { class: 'pick', testid: 'pick', 'aria-label': 'Files' },
    files,
    folder,
    h('p', { class: 'pick-title', text: 'Drop the job’s folder here' }),
    h('p', {
      class: 'soft',
      text: 'A YAML file with the meshes and pictures that it names, or the whole folder. Files that the coordinator has already are not sent again.',
    }),
    h(
      'div',
      { class: 'buttons' },
      h(
        'button',
        { type: 'button', class: 'primary', onclick: () => folder.click() },
        icon('folder'),
        'Choose a folder',
      ),
      h('button', { type: 'button', text: 'Choose files', onclick: () => files.click() }),
      h('button', {
        type: 'button',
        class: 'plain',
        text: 'Try a small example',
        testid: 'example',
        onclick: () => add([{ path: 'first-light.yaml', file: new File([EXAMPLE], 'first-light.yaml') }]),
      }),
    ),
  );
}
