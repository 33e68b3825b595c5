// Power spectral densities by Welch's method (IEEE Transactions on Audio and Electroacoustics 15, 1967, 70-73).

/** One-sided: its integral over frequency is the variance. */
export interface Spectrum {
  /** Frequencies, evenly from 0 [1/s]. */
  f: Float64Array;
  /** [unit²/Hz] */
  density: Float64Array;
  /** Pieces that it is the mean of. */
  pieces: number;
  /** The integral of the density without the mean [unit²]. */
  variance: number;
}

/** A series at even instants. */
export interface Even {
  values: Float64Array;
  /** Between two of them [s]. */
  step: number;
}

/** A piece shorter than this tells nothing. */
const LEAST = 8;

/**
 * The values between two times at as many even instants, on the lines between the given ones; gaps end the series, of
 * whose pieces the longest is taken. `null` where too little is left.
 */
export function evenly(t: ArrayLike<number>, y: ArrayLike<number>, from: number, to: number): Even | null {
  let best: [number, number] = [0, 0];
  let start = -1;
  for (let k = 0; k <= t.length; k++) {
    const is = k < t.length && t[k]! >= from && t[k]! <= to && Number.isFinite(y[k]!);
    if (is && start < 0) start = k;
    if (!is && start >= 0) {
      if (k - start > best[1] - best[0]) best = [start, k];
      start = -1;
    }
  }
  const [first, end] = best;
  const n = end - first;
  const span = n > 1 ? t[end - 1]! - t[first]! : 0;
  if (n < LEAST || !(span > 0)) return null;
  const step = span / (n - 1);
  const values = new Float64Array(n);
  let k = first;
  for (let i = 0; i < n; i++) {
    const at = t[first]! + step * i;
    while (k < end - 2 && t[k + 1]! < at) k++;
    const width = t[k + 1]! - t[k]!;
    const share = width > 0 ? Math.min(1, Math.max(0, (at - t[k]!) / width)) : 0;
    values[i] = y[k]! + share * (y[k + 1]! - y[k]!);
  }
  return { values, step };
}

/**
 * The mean of the densities of `pieces` pieces of equal length that overlap by half, each without its mean and under a
 * Hann window. Fewer pieces tell frequencies better apart, more of them scatter less.
 */
export function welch({ values, step }: Even, pieces: number): Spectrum {
  const n = values.length;
  const length = Math.max(LEAST, Math.min(n, Math.floor((2 * n) / (pieces + 1))));
  const shift = Math.max(1, Math.floor(length / 2));
  const count = Math.floor((n - length) / shift) + 1;
  let size = 1;
  while (size < length) size *= 2;
  const window = Float64Array.from({ length }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / length));
  const power = window.reduce((sum, w) => sum + w * w, 0);
  const half = size / 2;
  const density = new Float64Array(half + 1);
  const [re, im] = [new Float64Array(size), new Float64Array(size)];
  for (let piece = 0; piece < count; piece++) {
    const part = values.subarray(piece * shift, piece * shift + length);
    const mean = part.reduce((sum, x) => sum + x, 0) / length;
    re.fill(0);
    im.fill(0);
    for (let i = 0; i < length; i++) re[i] = window[i]! * (part[i]! - mean);
    transform(re, im);
    for (let k = 0; k <= half; k++) {
      // both halves of the spectrum are told as one
      const sides = k === 0 || k === half ? 1 : 2;
      density[k]! += (sides * step * (re[k]! ** 2 + im[k]! ** 2)) / (power * count);
    }
  }
  const width = 1 / (size * step);
  const f = Float64Array.from({ length: half + 1 }, (_, k) => k * width);
  return { f, density, pieces: count, variance: density.reduce((sum, s) => sum + s * width, 0) };
}

/** The discrete Fourier transform in place, of a length that is a power of two (Cooley and Tukey 1965). */
export function transform(re: Float64Array, im: Float64Array): void {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j]!, re[i]!];
      [im[i], im[j]] = [im[j]!, im[i]!];
    }
  }
  for (let length = 2; length <= n; length *= 2) {
    const half = length / 2;
    for (let k = 0; k < half; k++) {
      const angle = (-2 * Math.PI * k) / length;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      for (let i = k; i < n; i += length) {
        const [x, y] = [re[i + half]! * c - im[i + half]! * s, re[i + half]! * s + im[i + half]! * c];
        [re[i + half], im[i + half]] = [re[i]! - x, im[i]! - y];
        re[i]! += x;
        im[i]! += y;
      }
    }
  }
}

/** Frequency of the largest density but that of the mean; NaN if nothing moves. */
export function peak({ f, density }: Spectrum): number {
  let best = -1;
  for (let k = 1; k < f.length; k++) if (density[k]! > 0 && (best < 0 || density[k]! > density[best]!)) best = k;
  return best < 0 ? NaN : f[best]!;
}

/** The unit of a density. */
export function densityUnit(unit: string): string {
  if (!unit || unit === "-") return "1/Hz";
  return /^[^\s/·*]+$/.test(unit) ? `${unit}²/Hz` : `(${unit})²/Hz`;
}
