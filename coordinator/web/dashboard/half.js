// Pictures as 16-bit floats: what /picture?format=half answers.

/** The value of a half float (IEEE 754 binary16). */
export function halfToFloat(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1024 + fraction) * 2 ** (exponent - 25);
}

let table = null;

/** All 65,536 values, for those who need many. */
export function halfTable() {
  table ??= Float32Array.from({ length: 65536 }, (_, bits) => halfToFloat(bits));
  return table;
}

/** What stands in all channels of a pixel that has no samples yet: minus infinity, which no light is. */
export const UNSAMPLED = 0xfc00;

/** Machines that keep the high byte first have to turn the picture's bytes. */
const BIG_ENDIAN = new Uint8Array(new Uint16Array([1]).buffer)[0] === 0;

function leaveOut(planes, mask) {
  for (let i = 0; i < mask.length; ++i) {
    if (mask[i] !== 0) continue;
    for (let at = i; at < planes.length; at += mask.length) planes[at] = UNSAMPLED;
  }
}

/**
 * Reads an answer: {width, height, channels, layer, layers, samples, exact, planes} with `planes` the bits, one plane after the
 * other, row by row from the top; pixels that its mask leaves out are UNSAMPLED. Throws an Error where it is not what it says.
 */
export function readHalf(buffer) {
  const bytes = new Uint8Array(buffer);
  const end = bytes.indexOf(10);
  if (end < 0 || end > 65536) throw new Error('the picture has no header');
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const { width, height, channels } = head;
  const count = width * height * channels.length;
  if (!(width > 0 && height > 0 && channels.length > 0)) throw new Error('the picture is empty');
  const most = count * 2 + (head.mask ? width * height : 0);
  if (bytes.length - end - 1 !== most)
    throw new Error(`the picture has ${bytes.length - end - 1} bytes instead of ${most}`);
  const body = buffer.slice(end + 1, end + 1 + count * 2);
  if (BIG_ENDIAN) {
    const view = new DataView(body);
    for (let i = 0; i < count; ++i) new Uint16Array(body)[i] = view.getUint16(2 * i, true);
  }
  const planes = new Uint16Array(body);
  if (head.mask) leaveOut(planes, bytes.subarray(end + 1 + count * 2));
  return { ...head, layers: head.layers ?? [], planes };
}

/** The values of a pixel, one for each channel; null outside. */
export function pixel(picture, x, y) {
  const { width, height, channels, planes } = picture;
  if (x < 0 || y < 0 || x >= width || y >= height) return null;
  return channels.map((_, c) => halfToFloat(planes[(c * height + y) * width + x]));
}

/** Some 20,000 values of the picture's first channel (or of `of(values)` over all), sorted, without NaN and infinity. */
export function sorted(picture, of = null) {
  const { width, height, channels, planes } = picture;
  const count = width * height;
  const step = Math.max(1, Math.floor(count / 20000));
  const values = halfTable();
  const list = [];
  const one = new Array(channels.length);
  for (let i = 0; i < count; i += step) {
    let value = values[planes[i]];
    if (of) {
      for (let c = 0; c < one.length; ++c) one[c] = values[planes[c * count + i]];
      value = of(one, i);
    }
    if (Number.isFinite(value)) list.push(value);
  }
  return Float64Array.from(list).sort();
}

/** The value below which a share of sorted values lies; 0 of none. */
export const quantile = (values, share) =>
  values.length === 0 ? 0 : values[Math.min(values.length - 1, Math.floor(share * values.length))];
