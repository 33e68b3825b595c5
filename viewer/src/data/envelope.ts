// Least, mean and greatest value and the standard deviation at each place of a line, over all or some of the snapshots.

import { firstS, type Line, type Quantity, type Range } from "./run.ts";

export interface Extreme {
  value: number;
  s: number;
  t: number;
}

export interface Envelope {
  /** Arc lengths [m]. */
  s: Float64Array;
  least: Float64Array;
  mean: Float64Array;
  greatest: Float64Array;
  /** Standard deviation over time. */
  deviation: Float64Array;
  lowest: Extreme;
  highest: Extreme;
}

/** Places of a line whose points change. */
const PLACES = 200;

/** The envelope over the snapshots from `from` to `to`; `null` if none of them has a value. */
export function envelope(line: Line, of: Quantity, times: ArrayLike<number>, from: number, to: number): Envelope | null {
  const shared = line.s.length !== line.x.length / 3 || times.length === 1;
  const places = shared ? Float64Array.from(line.s) : even(line.s);
  const n = places.length;
  const least = new Float64Array(n).fill(Infinity);
  const greatest = new Float64Array(n).fill(-Infinity);
  const sum = new Float64Array(n);
  const squares = new Float64Array(n);
  const first = new Float64Array(n).fill(NaN);
  const weights = new Float64Array(n);
  const lowest: Extreme = { value: Infinity, s: NaN, t: NaN };
  const highest: Extreme = { value: -Infinity, s: NaN, t: NaN };
  for (let k = 0; k < times.length; k++) {
    const t = times[k]!;
    if (t < from || t > to) continue;
    // the mean over time: snapshots need not be evenly spaced
    const weight = weightOf(times, k, from, to);
    const start = line.starts[k]!;
    for (let i = 0; i < line.counts[k]!; i++) {
      const value = of.values[start + i]!;
      const s = line.s[firstS(line, k) + i]!;
      if (value < lowest.value) Object.assign(lowest, { value, s, t });
      if (value > highest.value) Object.assign(highest, { value, s, t });
    }
    for (let i = 0; i < n; i++) {
      const value = shared ? of.values[start + i]! : between(line, of, k, places[i]!);
      if (!Number.isFinite(value)) continue;
      least[i] = Math.min(least[i]!, value);
      greatest[i] = Math.max(greatest[i]!, value);
      sum[i]! += weight * value;
      // counted from the first value: the mean may be far larger than what it varies by
      if (Number.isNaN(first[i]!)) first[i] = value;
      squares[i]! += weight * (value - first[i]!) ** 2;
      weights[i]! += weight;
    }
  }
  if (!Number.isFinite(lowest.value)) return null;
  const mean = sum.map((x, i) => x / weights[i]!);
  const deviation = mean.map((m, i) => Math.sqrt(Math.max(0, squares[i]! / weights[i]! - (m - first[i]!) ** 2)));
  const gap = (x: number) => (Number.isFinite(x) ? x : NaN);
  return { s: places, least: least.map(gap), mean, greatest: greatest.map(gap), deviation, lowest, highest };
}

/** The envelope of a range graph, which has seen all steps of its own time. */
export function ranged({ s, least, mean, greatest, deviation, t_least, t_greatest }: Range): Envelope | null {
  const lowest: Extreme = { value: Infinity, s: NaN, t: NaN };
  const highest: Extreme = { value: -Infinity, s: NaN, t: NaN };
  for (let i = 0; i < s.length; i++) {
    if (least[i]! < lowest.value) Object.assign(lowest, { value: least[i]!, s: s[i]!, t: t_least[i]! });
    if (greatest[i]! > highest.value) Object.assign(highest, { value: greatest[i]!, s: s[i]!, t: t_greatest[i]! });
  }
  return Number.isFinite(lowest.value) ? { s, least, mean, greatest, deviation, lowest, highest } : null;
}

/** Half of the time to the neighbours that count. */
function weightOf(times: ArrayLike<number>, k: number, from: number, to: number): number {
  const t = times[k]!;
  const before = k > 0 && times[k - 1]! >= from ? t - times[k - 1]! : 0;
  const after = k + 1 < times.length && times[k + 1]! <= to ? times[k + 1]! - t : 0;
  return (before + after) / 2 || 1;
}

function even(s: Float32Array): Float64Array {
  let low = Infinity;
  let high = -Infinity;
  for (const x of s) {
    low = Math.min(low, x);
    high = Math.max(high, x);
  }
  return low < high ? Float64Array.from({ length: PLACES }, (_, i) => low + ((high - low) * i) / (PLACES - 1)) : new Float64Array();
}

/** The value at arc length `s`, NaN where the line isn't. */
function between(line: Line, of: Quantity, k: number, s: number): number {
  const start = line.starts[k]!;
  for (let i = 1; i < line.counts[k]!; i++) {
    const [a, b] = [line.s[start + i - 1]!, line.s[start + i]!];
    if (s >= a && s <= b) {
      const f = b > a ? (s - a) / (b - a) : 0;
      return of.values[start + i - 1]! * (1 - f) + of.values[start + i]! * f;
    }
  }
  return NaN;
}

/** Where a scale of colours goes from and to: a few peaks don't take all of it. */
export function range(values: ArrayLike<number>[]): { low: number; high: number; beyond: boolean } {
  let low = Infinity;
  let high = -Infinity;
  const some: number[] = [];
  for (const array of values) {
    const stride = Math.max(1, Math.floor(array.length / 20000));
    for (let i = 0; i < array.length; i++) {
      const x = array[i]!;
      if (!Number.isFinite(x)) continue;
      low = Math.min(low, x);
      high = Math.max(high, x);
      if (i % stride === 0) some.push(x);
    }
  }
  if (!(low <= high)) return { low: 0, high: 1, beyond: false };
  some.sort((a, b) => a - b);
  const most = some[Math.floor(0.995 * (some.length - 1))] ?? high;
  const beyond = high - low > 2 * (most - low) && most > low;
  return { low, high: beyond ? most : high, beyond };
}
