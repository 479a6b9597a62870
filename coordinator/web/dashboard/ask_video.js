// A video of the frames that are finished now, also of jobs that make none: asked for here, made by the coordinator.
import * as api from './api.js';
import { ask } from './dialog.js';
import { counted } from './format.js';
import { h, keyed, say, setAttribute, setText, toast } from './dom.js';
import { icon } from './icons.js';
import { whyNotJob } from './me.js';

/** How long until it is asked again how far a video is, ms. */
const ASK_AGAIN = 1500;

const isOver = ({ state }) => state === 'done' || state === 'failed';

/** How a video that is not there yet is shown. */
export function howFar({ file, frames, state, reason }) {
  if (state === 'waiting') return `${file}: waits until other videos are made`;
  if (state === 'making') return `${file}: is being made of ${counted(frames, 'frame')}`;
  return `${file}: could not be made: ${reason}`;
}

/** What the dialog's fields ask for; throws where that is none. */
export function videoRequest(file, rate) {
  const wish = {};
  if (file.trim() !== '') wish.file = file.trim();
  if (rate.trim() !== '') {
    wish.rate = Number(rate);
    if (!(wish.rate > 0)) throw new Error('Frames per second: a number above 0 is needed.');
  }
  return wish;
}

async function askForVideo(job) {
  const file = h('input', { type: 'text', placeholder: 'the job’s name.mp4', autofocus: true, testid: 'video-file' });
  const rate = h('input', { type: 'text', inputMode: 'decimal', placeholder: 'as the job has it', testid: 'video-rate' });
  let asked = null;
  await ask({
    title: 'Make a video',
    testid: 'video-dialog',
    body: [
      h('p', {}, h('b', { text: job.name }), ' · of the PNG, JPEG or TIFF pictures of all frames that are finished now.'),
      h('label', { class: 'field' }, 'File (.mp4, .mov or .webm)', file),
      h('label', { class: 'field' }, 'Frames per second', rate),
    ],
    buttons: [
      { value: '', text: 'Close' },
      { value: 'make', text: 'Make', kind: 'primary' },
    ],
    check: async () => {
      asked = await api.askForVideo(job.id, videoRequest(file.value, rate.value));
    },
  });
  return asked;
}

/** The button, and what is told of videos that are not there yet. `whenMade()`: one more is among the outputs. */
export function videoMaker(state, whenMade) {
  const stop = new AbortController();
  const lines = h('ul', { class: 'named', 'aria-live': 'polite', testid: 'videos-asked' });
  const button = h(
    'button',
    {
      type: 'button',
      testid: 'make-video',
      onclick: async () => {
        const asked = await askForVideo(state.job);
        if (asked) {
          say(howFar(asked));
          open.add(asked.id); // it may be there before it is looked at
          look();
        }
      },
    },
    icon('video'),
    'Make a video',
  );
  const open = new Set();
  let timer = 0;

  const look = async () => {
    clearTimeout(timer);
    try {
      const { videos } = await api.videos(state.id, stop.signal);
      for (const video of videos) {
        if (!isOver(video)) open.add(video.id);
        else if (open.delete(video.id)) {
          if (video.state === 'done') whenMade();
          toast(video.state === 'done' ? `${video.file} is there` : howFar(video), video.state === 'done' ? 'good' : 'bad');
        }
      }
      keyed(
        lines,
        videos.filter(({ state: now }) => now !== 'done'),
        (video) => `${video.id} ${video.state}`,
        (video) => h('li', { class: 'soft', text: howFar(video) }),
      );
      if (open.size > 0) timer = setTimeout(look, ASK_AGAIN);
    } catch {
      if (!stop.signal.aborted && open.size > 0) timer = setTimeout(look, ASK_AGAIN);
    }
  };
  look();
  return {
    button,
    lines,
    update: () => {
      const { job } = state;
      const why = !job || job.frames_done === 0 ? 'No frame is finished yet.' : whyNotJob(job);
      button.disabled = why !== '';
      setAttribute(button, 'title', why);
    },
    leave: () => {
      clearTimeout(timer);
      stop.abort();
    },
  };
}
