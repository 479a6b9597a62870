// Line icons on a grid of 16, drawn with the colour of the text.
import { s } from './dom.js';

const PATHS = {
  farm: 'M2 13V9M6 13V5M10 13V8M14 13V3',
  jobs: 'M2.5 4h11M2.5 8h11M2.5 12h7',
  workers: 'M2.5 3.5h11v6h-11zM5.5 13h5M8 9.5V13',
  submit: 'M8 11V3M4.5 6.5 8 3l3.5 3.5M3 13.5h10',
  system: 'M8 2.5a5.5 5.5 0 1 0 0 11zM8 2.5a5.5 5.5 0 0 1 0 11',
  light:
    'M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6M8 1.5v1.4M8 13.1v1.4M1.5 8h1.4M13.1 8h1.4M3.4 3.4l1 1M11.6 11.6l1 1M12.6 3.4l-1 1M4.4 11.6l-1 1',
  dark: 'M13 9.5A5.5 5.5 0 0 1 6.5 3 5.5 5.5 0 1 0 13 9.5',
  help: 'M5.8 6.1a2.2 2.2 0 1 1 3.2 2c-.7.4-1 .8-1 1.6M8 12.2v.3',
  pause: 'M5.5 3.5v9M10.5 3.5v9',
  play: 'M5 3.2v9.6l7.5-4.8z',
  cancel: 'M4 4l8 8M12 4l-8 8',
  retry: 'M12.8 8a4.8 4.8 0 1 1-1.5-3.5M12.8 2v3h-3',
  trash: 'M3 4.5h10M6.5 4.5v-2h3v2M4.5 4.5l.6 9h5.8l.6-9',
  download: 'M8 2.5v8M4.5 7 8 10.5 11.5 7M3 13.5h10',
  warning: 'M8 2.5 14.2 13H1.8zM8 6.5v3M8 11.2v.3',
  info: 'M8 2a6 6 0 1 0 0 12A6 6 0 0 0 8 2M8 7.2v3.8M8 4.8v.3',
  good: 'M3 8.5 6.5 12 13 4.5',
  search: 'M7 2.8a4.2 4.2 0 1 0 0 8.4 4.2 4.2 0 0 0 0-8.4M10 10l3.5 3.5',
  left: 'M10 3 5 8l5 5',
  right: 'M6 3l5 5-5 5',
  video: 'M2.5 3.5h11v9h-11zM5 3.5v9M11 3.5v9M2.5 8h11',
  edit: 'M3 13l.6-2.8L10.8 3 13 5.2 5.8 12.4z',
  folder: 'M2 4.5V12.5h12v-7H8L6.5 3.5H2z',
  fit: 'M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10',
};

/** An icon for beside a text: screen readers skip it. */
export const icon = (name) =>
  s('svg', { class: 'icon', viewBox: '0 0 16 16', 'aria-hidden': 'true' }, s('path', { d: PATHS[name] }));

/** The mark: the V of the Hyades with Aldebaran, which only stands before them. */
export const mark = () =>
  s(
    'svg',
    { class: 'mark', viewBox: '0 0 32 32', 'aria-hidden': 'true' },
    s('path', { d: 'M8 5.5 11.6 13 13.5 19.5 17 26 19.5 19 26 8.5' }),
    ...[
      [8, 5.5, 2],
      [11.6, 13, 1.5],
      [13.5, 19.5, 1.8],
      [17, 26, 2.1],
      [19.5, 19, 1.8],
    ].map(([cx, cy, r]) => s('circle', { cx, cy, r })),
    s('circle', { class: 'giant', cx: 26, cy: 8.5, r: 3.1 }),
  );
