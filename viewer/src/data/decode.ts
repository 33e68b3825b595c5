// Text to numbers: base64, inflate, byte planes, guesses. The other half is report/src/page/{block,pack}.rs.

import { turned } from "./motion.ts";
import type { Body, Field, Force, Line, Run, Shape, V3 } from "./run.ts";

const VERSION = 1;

/** Where an array is among the bytes that follow the JSON text. */
interface Place {
  at: number;
  rows: number;
  columns: number;
  code: number;
  from?: number;
}

/** A run from the text of the page's data. */
export async function decode(text: string): Promise<Run> {
  const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const run = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  if (run.version !== VERSION) throw new Error(`data of version ${run.version}, page of version ${VERSION}`);
  const arrays = bytes.subarray(4 + length);
  const get = (place: Place) => numbers(arrays, place);
  for (const column of run.history) column.values = wide(get(column.values), column.values);
  if (run.steps) for (const key of ["t", "least", "greatest", "cause"]) run.steps[key] = wide(get(run.steps[key]), run.steps[key]);
  run.steps ??= null;
  run.restarts ??= [];
  run.listings ??= [];
  run.ranges ??= [];
  for (const range of run.ranges) for (const key of ["s", "start", "least", "mean", "greatest", "deviation", "t_least", "t_greatest"]) range[key] = wide(get(range[key]), range[key]);
  run.field = field(run.field, get);
  return run as Run;
}

/** The numbers of an array, without what is added to them. */
export function numbers(bytes: Uint8Array, { at, rows, columns, code }: Place): Float32Array {
  const count = rows * columns;
  const bits = new Int32Array(count);
  for (let k = 0; k < count; k++) {
    const left = bytes[at + k]! | (bytes[at + count + k]! << 8) | (bytes[at + 2 * count + k]! << 16) | (bytes[at + 3 * count + k]! << 24);
    const rest = (left >>> 1) ^ -(left & 1);
    let guess = 0;
    if (code > 0 && k >= columns) {
      guess = bits[k - columns]!;
      if (code > 1 && k >= 2 * columns) guess = 2 * guess - bits[k - 2 * columns]!;
    }
    bits[k] = rest + guess;
  }
  return new Float32Array(bits.buffer);
}

function wide(values: Float32Array, place: Place): Float64Array {
  const from = place.from ?? 0;
  return Float64Array.from(values, (x) => x + from);
}

// what JSON.parse gave, with places of arrays instead of arrays
/* eslint-disable @typescript-eslint/no-explicit-any */
function field(raw: any, get: (place: Place) => Float32Array): Field {
  const times = wide(get(raw.times), raw.times);
  const lines = raw.lines.map((line: any): Line => {
    const counts: number[] = typeof line.counts === "number" ? Array(times.length).fill(line.counts) : line.counts;
    let sum = 0;
    const starts = counts.map((n) => (sum += n) - n);
    const quantities = line.quantities.map((q: any) => ({ ...q, values: get(q.values) }));
    const { name, kind, place, diameter } = line;
    return { name, kind, place, diameter, counts, starts, s: get(line.s), x: get(line.position), quantities };
  });
  const bodies = raw.bodies.map((body: any): Body => {
    const { name, kind, place } = body;
    const shapes = body.shapes.map((s: any) => shape(s, get));
    return { name, kind, place, shapes, x: get(body.position), q: get(body.orientation) };
  });
  const forces = (raw.forces ?? []).map((force: any): Force => ({ name: force.name, kind: force.kind, x: get(force.position), f: get(force.force) }));
  const waves = raw.waves ? { ramp: raw.waves.ramp, all: get(raw.waves.all) } : null;
  return { ...raw, waves, times, lines, bodies, forces, shapes: raw.shapes.map((s: any) => near(shape(s, get))) };
}

/** A plane has no middle: the foot of the field's origin will do. */
function near(shape: Shape): Shape {
  if (shape.solid.type !== "plane") return shape;
  const { position: p, orientation } = shape.pose;
  const n = turned(orientation, [0, 0, 1]);
  const height = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
  return { ...shape, pose: { orientation, position: n.map((x) => height * x + 0) as V3 } };
}

function shape(raw: any, get: (place: Place) => Float32Array): Shape {
  if (raw.solid.type !== "mesh") return raw;
  const solid = { type: "mesh" as const, points: get(raw.solid.points), triangles: Uint32Array.from(get(raw.solid.triangles)) };
  return { ...raw, solid };
}
