// SHA-256 in pieces (FIPS 180-4, section 6.2): browsers have it for secure pages only, and for whole files in memory only.

/** The first 32 bits of the fractions of the cube roots of the first 64 primes (4.2.2), and of the square roots of the first 8 (5.3.3). */
function constants() {
  const primes = [];
  for (let n = 2; primes.length < 64; ++n) if (primes.every((p) => n % p !== 0)) primes.push(n);
  // Exactly, by integers: the root of p * 2^(32 * power), whose lowest 32 bits are the fraction's.
  const root = (p, power) => {
    const aim = BigInt(p) << BigInt(32 * power);
    let low = 0n;
    let high = 1n << 42n;
    while (high - low > 1n) {
      const middle = (low + high) / 2n;
      if (middle ** BigInt(power) <= aim) low = middle;
      else high = middle;
    }
    return Number(low & 0xffffffffn);
  };
  return {
    rounds: Uint32Array.from(primes, (p) => root(p, 3)),
    start: Uint32Array.from(primes.slice(0, 8), (p) => root(p, 2)),
  };
}

const { rounds: K, start: H0 } = constants();

/** Takes bytes in any pieces; `hex()` ends it. Files up to 2^53 bytes. */
export class Sha256 {
  constructor() {
    this.state = H0.slice();
    this.block = new Uint8Array(64);
    this.filled = 0;
    this.length = 0;
    this.words = new Uint32Array(64);
  }

  update(bytes) {
    this.length += bytes.length;
    let at = 0;
    if (this.filled > 0) {
      at = Math.min(64 - this.filled, bytes.length);
      this.block.set(bytes.subarray(0, at), this.filled);
      this.filled += at;
      if (this.filled < 64) return this;
      this.mix(this.block, 0);
      this.filled = 0;
    }
    for (; at + 64 <= bytes.length; at += 64) this.mix(bytes, at);
    this.block.set(bytes.subarray(at), 0);
    this.filled = bytes.length - at;
    return this;
  }

  hex() {
    const bits = this.length * 8;
    const tail = new Uint8Array((this.filled < 56 ? 64 : 128) - this.filled);
    tail[0] = 0x80;
    const view = new DataView(tail.buffer);
    view.setUint32(tail.length - 8, Math.floor(bits / 2 ** 32));
    view.setUint32(tail.length - 4, bits >>> 0);
    this.update(tail);
    return Array.from(this.state, (word) => word.toString(16).padStart(8, '0')).join('');
  }

  mix(bytes, at) {
    const w = this.words;
    for (let t = 0; t < 16; ++t, at += 4)
      w[t] = (bytes[at] << 24) | (bytes[at + 1] << 16) | (bytes[at + 2] << 8) | bytes[at + 3];
    for (let t = 16; t < 64; ++t) {
      const x = w[t - 15];
      const y = w[t - 2];
      const small0 = ((x >>> 7) | (x << 25)) ^ ((x >>> 18) | (x << 14)) ^ (x >>> 3);
      const small1 = ((y >>> 17) | (y << 15)) ^ ((y >>> 19) | (y << 13)) ^ (y >>> 10);
      w[t] = (small1 + w[t - 7] + small0 + w[t - 16]) | 0;
    }
    const s = this.state;
    let [a, b, c, d, e, f, g, h] = s;
    for (let t = 0; t < 64; ++t) {
      const big1 = ((e >>> 6) | (e << 26)) ^ ((e >>> 11) | (e << 21)) ^ ((e >>> 25) | (e << 7));
      const t1 = (h + big1 + ((e & f) ^ (~e & g)) + K[t] + w[t]) | 0;
      const big0 = ((a >>> 2) | (a << 30)) ^ ((a >>> 13) | (a << 19)) ^ ((a >>> 22) | (a << 10));
      const t2 = (big0 + ((a & b) ^ (a & c) ^ (b & c))) | 0;
      h = g;
      g = f;
      f = e;
      e = (d + t1) | 0;
      d = c;
      c = b;
      b = a;
      a = (t1 + t2) | 0;
    }
    s[0] += a;
    s[1] += b;
    s[2] += c;
    s[3] += d;
    s[4] += e;
    s[5] += f;
    s[6] += g;
    s[7] += h;
  }
}

const SLICE = 4 * 1024 * 1024;
/** Up to here the browser's own is asked, which wants the file in memory. */
const WHOLE = 64 * 1024 * 1024;

/** The digest of a file, lower-case hexadecimal. `told(bytes)` now and then. */
export async function digestOf(file, told = () => {}) {
  if (file.size <= WHOLE && globalThis.crypto?.subtle) {
    const digest = await crypto.subtle.digest('SHA-256', await file.arrayBuffer());
    told(file.size);
    return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, '0')).join('');
  }
  const sum = new Sha256();
  for (let at = 0; at < file.size; at += SLICE) {
    sum.update(new Uint8Array(await file.slice(at, at + SLICE).arrayBuffer()));
    told(Math.min(file.size, at + SLICE));
  }
  return sum.hex();
}
