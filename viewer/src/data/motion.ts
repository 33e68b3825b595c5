// Where things are at a time between two snapshots.

import type { Body, Field, Line, V3 } from "./run.ts";

/** A snapshot and the share of the way to the next. */
export interface Moment {
  k: number;
  f: number;
}

/** The moment of a time; the ends stand for what is beyond them. */
export function moment(times: ArrayLike<number>, t: number): Moment {
  const last = times.length - 1;
  if (last < 1 || !(t > times[0]!)) return { k: 0, f: 0 };
  if (t >= times[last]!) return { k: last, f: 0 };
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= t) low = middle;
    else high = middle;
  }
  return { k: low, f: (t - times[low]!) / (times[high]! - times[low]!) };
}

/** The snapshot that a line is drawn from: one whose points change in number isn't drawn between two. */
function steady(line: Line, { k, f }: Moment): Moment {
  if (f === 0 || line.counts[k] === line.counts[k + 1]) return { k, f };
  return { k: f < 0.5 ? k : k + 1, f: 0 };
}

/** Numbers of a line's points, `width` for each; `out` must be long enough. Returns the number of points. */
export function along(line: Line, of: Float32Array, width: number, at: Moment, out: Float32Array): number {
  const { k, f } = steady(line, at);
  const count = line.counts[k] ?? 0;
  const from = width * (line.starts[k] ?? 0);
  const n = width * count;
  if (f === 0) out.set(of.subarray(from, from + n));
  else for (let i = 0; i < n; i++) out[i] = of[from + i]! + f * (of[from + n + i]! - of[from + i]!);
  return count;
}

/** Points without a place go to the one before them, or to the first that has one. Returns whether there is any. */
export function settle(x: Float32Array, count: number): boolean {
  const there = (i: number) => Number.isFinite(x[3 * i]! + x[3 * i + 1]! + x[3 * i + 2]!);
  let first = 0;
  while (first < count && !there(first)) first++;
  for (let i = 0; i < first && first < count; i++) x.copyWithin(3 * i, 3 * first, 3 * first + 3);
  for (let i = first + 1; i < count; i++) if (!there(i)) x.copyWithin(3 * i, 3 * i - 3, 3 * i);
  return first < count;
}

export interface Pose {
  x: V3;
  q: [number, number, number, number];
}

/** Where a body is: places straight, turns by the shorter way. */
export function pose(body: Body, { k, f }: Moment): Pose {
  const g = f === 0 ? 0 : 1;
  const mix = (of: Float32Array, width: number, i: number, sign = 1) =>
    of[width * k + i]! + (g ? f * (sign * of[width * (k + 1) + i]! - of[width * k + i]!) : 0);
  let dot = 0;
  for (let i = 0; i < 4 && g; i++) dot += body.q[4 * k + i]! * body.q[4 * k + 4 + i]!;
  const sign = dot < 0 ? -1 : 1;
  const q = [0, 1, 2, 3].map((i) => mix(body.q, 4, i, sign));
  const norm = Math.hypot(...q) || 1;
  return { x: [0, 1, 2].map((i) => mix(body.x, 3, i)) as V3, q: q.map((v) => v / norm) as Pose["q"] };
}

/** Turns a vector by a unit quaternion. */
export function turned([w, x, y, z]: Pose["q"], v: V3): V3 {
  const t: V3 = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
}

/** The angle of a body's x about z. */
export function heading(q: Pose["q"]): number {
  const [x, y] = turned(q, [1, 0, 0]);
  return Math.atan2(y, x);
}

/** A point that can be followed. */
export interface Point {
  name: string;
  at(moment: Moment): V3;
  /** How it is turned about z, if it is something that turns. */
  heading?(moment: Moment): number;
}

/** Bodies, then the ends and middles of lines. */
export function points(field: Field): Point[] {
  const all: Point[] = field.bodies.map((body) => ({
    name: body.name,
    at: (m) => pose(body, m).x,
    ...(body.shapes.length > 0 && { heading: (m: Moment) => heading(pose(body, m).q) }),
  }));
  for (const line of field.lines) {
    const buffer = new Float32Array(3 * Math.max(0, ...line.counts));
    const at = (share: number) => (m: Moment): V3 => {
      const n = along(line, line.x, 3, m, buffer);
      const i = 3 * Math.round(share * (n - 1));
      return n > 0 ? [buffer[i]!, buffer[i + 1]!, buffer[i + 2]!] : [NaN, NaN, NaN];
    };
    for (const [name, share] of [["start", 0], ["middle", 0.5], ["end", 1]] as const) all.push({ name: `${line.name}, ${name}`, at: at(share) });
  }
  return all;
}
