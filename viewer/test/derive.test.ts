import assert from "node:assert/strict";
import { test } from "node:test";
import { angles, clearances, derive, distance } from "../src/data/derive.ts";
import type { Field, Line, Solid, V3 } from "../src/data/run.ts";

const near = (a: number, b: number, tolerance = 1e-6) => assert.ok(Math.abs(a - b) < tolerance, `${a} ${b}`);
const place = { position: [0, 0, 0] as V3, orientation: [1, 0, 0, 0] as [number, number, number, number] };

function line(x: number[]): Line {
  const n = x.length / 3;
  return { name: "hose", kind: "", place: "", diameter: 0.2, counts: [n], starts: [0], s: Float32Array.from({ length: n }, (_, i) => i), x: Float32Array.from(x), quantities: [] };
}

function field(over: Partial<Field>): Field {
  return { origin: [0, 0, 0], times: Float64Array.of(0), lines: [], bodies: [], forces: [], shapes: [], water: null, waves: null, bed: null, ...over };
}

test("angles are those of the line's direction", () => {
  const up = angles(line([0, 0, 0, 3, 4, 5, 6, 8, 10]));
  for (const angle of up) near(angle, 45, 1e-4);
  assert.ok(Number.isNaN(angles(line([1, 2, 3]))[0]!));
});

/** Whether a point lies inside of a solid. */
function inside(solid: Solid, [x, y, z]: V3): boolean {
  if (solid.type === "ball") return Math.hypot(x, y, z) < solid.radius;
  if (solid.type === "cylinder") return Math.hypot(x, y) < solid.radius && Math.abs(z) < solid.half!;
  if (solid.type === "box") return [x, y, z].every((v, i) => Math.abs(v) < solid.half[i]!);
  return z < 0;
}

test("distances change as fast as points move away, and their sign on the surface", () => {
  const solids: Solid[] = [{ type: "plane" }, { type: "ball", radius: 1.5 }, { type: "cylinder", radius: 1, half: 2 }, { type: "box", half: [1, 2, 0.5] }];
  let seed = 3;
  const random = () => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32 - 0.5) * 6;
  for (const solid of solids) for (let k = 0; k < 200; k++) {
    const p: V3 = [random(), random(), random()];
    const d = distance(solid, p);
    assert.equal(d < 0, inside(solid, p), `${solid.type} ${p}`);
    // down its slope by its size is the surface
    const e = 1e-6;
    const slope = [0, 1, 2].map((i) => (distance(solid, p.map((v, j) => v + (i === j ? e : 0)) as V3) - distance(solid, p.map((v, j) => v - (i === j ? e : 0)) as V3)) / (2 * e));
    const size = Math.hypot(...slope);
    if (Math.abs(size - 1) < 1e-3) near(distance(solid, p.map((v, i) => v - d * slope[i]!) as V3), 0, 1e-4);
    assert.ok(size < 1.001 && (size > 0.99 || k > 0));
  }
  near(distance({ type: "tube", radius: 1, half: null }, [0.4, 0, 9]), 0.6);
  near(distance({ type: "tube", radius: 1, half: 2 }, [1, 0, 5]), 3);
});

test("a mesh is as far away as the box that it is made of, inside and outside, and an open one has no inside", () => {
  const half: V3 = [1, 2, 0.5];
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [0, 1, 2].map((i) => ((k >> i) & 1 ? half[i]! : -half[i]!)));
  const sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const halves = (all: number[][]) => Uint32Array.from(all.flatMap(([a, b, c, d]) => [a!, b!, c!, a!, c!, d!]));
  const mesh: Solid = { type: "mesh", points: Float32Array.from(corners), triangles: halves(sides) };
  let seed = 5;
  const random = () => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32 - 0.5) * 6;
  for (let k = 0; k < 200; k++) {
    const p: V3 = [random(), random(), random()];
    near(distance(mesh, p), distance({ type: "box", half }, p), 1e-6);
  }
  const lid: Solid = { type: "mesh", points: Float32Array.from(corners), triangles: halves([sides[1]!]) };
  near(distance(lid, [0, 0, 0.3]), 0.2);
  near(distance(lid, [0, 0, 0.7]), 0.2);
});

test("clearances are from the surface of the line to what is nearest, also of bodies that turn", () => {
  const of = line([0, 0, 3, 4, 0, 3, 10, 0, 3]);
  const half = Math.SQRT1_2;
  // a box that stands on end is upright again on a body that lies on its side
  const box = { name: "", solid: { type: "box" as const, half: [2, 0.5, 0.5] as V3 }, pose: { position: [1, 0, 0] as V3, orientation: [half, 0, 0, half] as [number, number, number, number] } };
  const body = { name: "ship", kind: "", place: "", shapes: [box], x: Float32Array.of(10, 0, 0), q: Float32Array.of(half, 0, 0, half) };
  const all = field({ bed: 0, lines: [of], bodies: [body], shapes: [{ name: "", solid: { type: "ball", radius: 1 }, pose: { ...place, position: [4, 0, 5] } }] });
  const [a, b, c] = clearances(all, of);
  near(a!, 2.9);
  near(b!, 0.9);
  // at (10, 1, 0), its long edges along -x again
  near(c!, Math.hypot(0.5, 2.5) - 0.1, 1e-5);
  derive(all);
  assert.deepEqual(of.quantities.map((q) => q.name), ["angle to the horizontal", "clearance"]);
  near(of.quantities[1]!.values[0]!, 2.9);
});

test("where nothing is near there is no clearance to tell", () => {
  const of = line([0, 0, 0, 1, 0, 0]);
  derive(field({ lines: [of] }));
  assert.deepEqual(of.quantities.map((q) => q.name), ["angle to the horizontal"]);
});
