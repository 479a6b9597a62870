// Files can be dropped anywhere on the page: they go to the view that submits.
import { h, toast } from './dom.js';
import { icon } from './icons.js';
import { ofDrop } from './gather.js';
import { to } from './router.js';

// What was dropped elsewhere, for the view to take; and who takes files now.
let waiting = null;
let taker = null;

function give(files) {
  if (taker) taker(files);
  else {
    waiting = files;
    location.hash = to('submit');
  }
}

/** From now on files can be dropped anywhere on the page. */
export function offerDrop() {
  const veil = h(
    'div',
    { class: 'veil', hidden: true, testid: 'veil' },
    h('p', {}, icon('submit'), 'Drop a job with its files'),
  );
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

/** From now on `take(files)` gets what is dropped, at once what was dropped before; null: nobody does. */
export function takeDrops(take) {
  taker = take;
  if (!take || !waiting) return;
  const files = waiting;
  waiting = null;
  take(files);
}
