// The job's YAML as it was submitted.
import { documentOf } from './api.js';
import { h } from './dom.js';
import { yamlLines } from './yaml_text.js';

/** The tab. */
export function documentTab(state) {
  const stop = new AbortController();
  const node = h('div', { testid: 'document' }, h('p', { class: 'soft pad', text: 'Asking…' }));
  documentOf(state.id, stop.signal)
    .then((text) => {
      const file = new Blob([text], { type: 'text/yaml' });
      const save = h('a', {
        class: 'button',
        href: URL.createObjectURL(file),
        download: `job-${state.id}.yaml`,
        text: 'Download',
      });
      node.replaceChildren(
        h(
          'div',
          { class: 'filters pad' },
          h('p', { class: 'soft', text: 'As it was submitted.' }),
          h('span', { class: 'spring' }),
          save,
        ),
        yamlLines(text),
      );
    })
    .catch((error) => {
      if (error.name !== 'AbortError') node.replaceChildren(h('p', { class: 'problem pad', text: error.message }));
    });
  return { node, leave: () => stop.abort() };
}
