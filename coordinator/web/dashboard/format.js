// Numbers and times as people read them: three digits, a unit, no more.

const PREFIXES = ['', 'k', 'M', 'G', 'T', 'P', 'E'];

function three(value) {
  if (value >= 99.95) return value.toFixed(0);
  if (value >= 9.995) return value.toFixed(1);
  return value.toFixed(2);
}

/** 12345678 -> '12.3 M'. Below 1000 whole numbers stay whole. */
export function short(value) {
  if (!Number.isFinite(value)) return '–';
  if (Math.abs(value) < 999.5) return Number.isInteger(value) ? String(value) : three(value);
  let step = 0;
  let rest = Math.abs(value);
  while (rest >= 999.5 && step < PREFIXES.length - 1) {
    rest /= 1000;
    ++step;
  }
  return `${value < 0 ? '-' : ''}${three(rest)} ${PREFIXES[step]}`;
}

/** 12345 -> '12,345'. */
export const whole = (value) => Math.round(value).toLocaleString('en-GB');

/** 1 -> '1 frame', 3 -> '3 frames'. */
export const counted = (count, noun) => `${whole(count)} ${noun}${count === 1 ? '' : 's'}`;

/** Samples per second: '12.3 Msamples/s'; '–' where unknown. */
export function rate(value) {
  if (!(value > 0)) return '–';
  const text = short(value);
  return `${text}${/[a-zA-Z]$/.test(text) ? '' : ' '}samples/s`;
}

/** The same where none is known to be none: '0 samples/s'. */
export const rateInWords = (value) => (value > 0 ? rate(value) : '0 samples/s');

/** 1536 -> '1.50 KiB'. */
export function bytes(value) {
  if (!(value >= 0)) return '–';
  if (value < 1024) return `${value} B`;
  const units = ['KiB', 'MiB', 'GiB', 'TiB', 'PiB'];
  let step = -1;
  let rest = value;
  do {
    rest /= 1024;
    ++step;
  } while (rest >= 999.5 && step < units.length - 1);
  return `${three(rest)} ${units[step]}`;
}

/** Seconds -> '12 s', '3 min 20 s', '2 h 05 min', '3 d 4 h'. */
export function duration(seconds) {
  if (!Number.isFinite(seconds) || seconds < 0) return '–';
  const total = Math.round(seconds);
  if (total < 60) return `${total} s`;
  if (total < 3600) return `${Math.floor(total / 60)} min ${String(total % 60).padStart(2, '0')} s`;
  if (total < 86400)
    return `${Math.floor(total / 3600)} h ${String(Math.floor((total % 3600) / 60)).padStart(2, '0')} min`;
  return `${Math.floor(total / 86400)} d ${Math.floor((total % 86400) / 3600)} h`;
}

/** Seconds of cores -> core-hours: '12.3', '< 0.01'; '–' where nothing was rendered. */
export function coreHours(seconds) {
  if (!(seconds > 0)) return '–';
  const hours = seconds / 3600;
  if (hours < 0.01) return '< 0.01';
  return hours < 999.5 ? three(hours) : whole(hours);
}

/** 12.3, 'EUR' -> '12.30 EUR'. */
export function money(amount, currency) {
  const text =
    amount > 0 && amount < 0.01
      ? '< 0.01'
      : amount.toLocaleString('en-GB', { minimumFractionDigits: 2, maximumFractionDigits: 2 });
  return currency ? `${text} ${currency}` : text;
}

/** A share 0..1 -> '42 %'; '100 %' only when whole, '0 %' only when nothing. */
export function percent(share) {
  if (!(share > 0)) return '0 %';
  if (share >= 1) return '100 %';
  if (share < 0.01) return '< 1 %';
  return `${Math.min(99, Math.floor(share * 100))} %`;
}

const two = (value) => String(value).padStart(2, '0');

/** Milliseconds since 1970 -> '14:03:09'. */
export function clock(ms) {
  const time = new Date(ms);
  return `${two(time.getHours())}:${two(time.getMinutes())}:${two(time.getSeconds())}`;
}

/** '14:03' today, else '22 Nov 14:03', of another year '22 Nov 2025'. */
export function moment(ms, now = Date.now()) {
  if (!ms) return '–';
  const time = new Date(ms);
  const today = new Date(now);
  const hours = `${two(time.getHours())}:${two(time.getMinutes())}`;
  if (time.toDateString() === today.toDateString()) return hours;
  const month = ['Jan', 'Feb', 'Mar', 'Apr', 'May', 'Jun', 'Jul', 'Aug', 'Sep', 'Oct', 'Nov', 'Dec'][time.getMonth()];
  if (time.getFullYear() !== today.getFullYear()) return `${time.getDate()} ${month} ${time.getFullYear()}`;
  return `${time.getDate()} ${month} ${hours}`;
}

/** '5 s ago'. */
export function ago(ms, now = Date.now()) {
  const seconds = Math.max(0, (now - ms) / 1000);
  if (seconds < 2) return 'now';
  if (seconds < 90) return `${Math.round(seconds)} s ago`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min ago`;
  if (seconds < 129600) return `${Math.round(seconds / 3600)} h ago`;
  return `${Math.round(seconds / 86400)} d ago`;
}

/** A light value of a pixel: four digits that matter. */
export function value(number) {
  if (Number.isNaN(number)) return 'NaN';
  if (!Number.isFinite(number)) return number > 0 ? '∞' : '-∞';
  if (number === 0) return '0';
  const size = Math.abs(number);
  if (size >= 10000 || size < 0.0005) return number.toExponential(2);
  return number
    .toPrecision(4)
    .replace(/(\.\d*?)0+$/, '$1')
    .replace(/\.$/, '');
}

/** A noise with two digits, never in powers of ten: '0.016', '1.6', '160'. */
export function noise(number) {
  if (!Number.isFinite(number)) return '–';
  if (number >= 9.95) return number.toFixed(0);
  if (number >= 0.995) return number.toFixed(1);
  if (!(number > 0)) return '0';
  if (number < 1e-6) return '< 0.000001';
  return number.toFixed(1 - Math.floor(Math.log10(number))).replace(/0+$/, '');
}

/** A digest by its beginning; other texts as they are. */
export const brief = (text) => (/^[0-9a-f]{40,}$/.test(text) ? text.slice(0, 8) : text);

/** 'a', 'a and b', 'a, b and c'. */
export function listed(texts) {
  if (texts.length < 2) return texts.join('');
  return `${texts.slice(0, -1).join(', ')} and ${texts[texts.length - 1]}`;
}
