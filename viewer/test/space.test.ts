import assert from "node:assert/strict";
import { test } from "node:test";
import type { Field, V3 } from "../src/data/run.ts";
import { Arrows } from "../src/space/arrows.ts";
import { viridis } from "../src/space/colour.ts";
import { edges } from "../src/space/edges.ts";
import { seen, stand } from "../src/space/frame.ts";
import { axes, eye, fit, pan, project, rotate, VIEWS, type Orbit } from "../src/space/orbit.ts";
import { Stage } from "../src/space/stage.ts";
import { SIDES, tube, tubeIndex } from "../src/space/tube.ts";

const near = (a: number, b: number, tolerance = 1e-6) => assert.ok(Math.abs(a - b) < tolerance, `${a} ${b}`);

test("a tube has its radius everywhere and its normals point away from the line", () => {
  const n = 40;
  const x = new Float32Array(3 * n);
  for (let i = 0; i < n; i++) x.set([Math.cos(i / 4), Math.sin(i / 4), i / 10], 3 * i);
  const out = { positions: new Float32Array(3 * SIDES * n), normals: new Float32Array(3 * SIDES * n) };
  tube(x, n, 0.1, out);
  for (let i = 0; i < n; i++) for (let j = 0; j < SIDES; j++) {
    const k = 3 * (i * SIDES + j);
    const away = [0, 1, 2].map((c) => out.positions[k + c]! - x[3 * i + c]!);
    near(Math.hypot(...away), 0.1);
    near(away.reduce((sum, a, c) => sum + a * out.normals[k + c]!, 0), 0.1);
  }
  const index = tubeIndex(n);
  assert.equal(Math.max(...index), n * SIDES - 1);
  // neighbours of a ring stay neighbours: the tube doesn't twist
  for (let i = 0; i + 1 < n; i++) {
    const [a, b] = [3 * i * SIDES, 3 * (i + 1) * SIDES];
    const turn = [0, 1, 2].reduce((sum, c) => sum + out.normals[a + c]! * out.normals[b + c]!, 0);
    assert.ok(turn > 0.95);
  }
});

test("a tube of points that coincide has no NaN", () => {
  const out = { positions: new Float32Array(9 * SIDES), normals: new Float32Array(9 * SIDES) };
  tube(new Float32Array(9), 3, 1, out);
  assert.ok(out.positions.every(Number.isFinite));
  tube(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 0, 0), 3, 1, out);
  assert.ok(out.positions.every(Number.isFinite) && out.normals.every(Number.isFinite));
});

test("the camera: what is fitted is seen, what is at the target is in the middle", () => {
  for (const [azimuth, elevation] of Object.values(VIEWS)) for (const aspect of [0.5, 1, 2]) {
    const orbit: Orbit = { target: [0, 0, 0], distance: 1, azimuth: azimuth!, elevation: elevation! };
    const [low, high]: [V3, V3] = [[-1, 2, -30], [50, 4, 0]];
    fit(orbit, [low, high], aspect);
    const [x, y, depth] = project(orbit, orbit.target, aspect);
    near(x, 0);
    near(y, 0);
    near(depth, orbit.distance);
    for (let corner = 0; corner < 8; corner++) {
      const p = [0, 1, 2].map((i) => ((corner >> i) & 1 ? high[i] : low[i])) as V3;
      const [u, v, d] = project(orbit, p, aspect);
      assert.ok(Math.abs(u) < 0.5 && Math.abs(v) < 0.5 && d > 0, `${u} ${v} ${d}`);
    }
  }
});

test("turning keeps the distance, moving keeps the view", () => {
  const orbit: Orbit = { target: [1, 2, 3], distance: 5, azimuth: 0.3, elevation: 0.2 };
  rotate(orbit, 0.5, 10);
  near(orbit.elevation, Math.PI / 2);
  near(Math.hypot(...eye(orbit).map((x, i) => x - orbit.target[i]!)), 5);
  const before = project(orbit, [1, 2, 3], 1);
  pan(orbit, 0.25, 0);
  const after = project(orbit, [1, 2, 3], 1);
  near(after[0] - before[0], -0.25);
  const [r, u, b] = axes(orbit);
  for (const [p, q] of [[r, u], [u, b], [b, r]] as [V3, V3][]) near(p[0] * q[0] + p[1] * q[1] + p[2] * q[2], 0);
});

test("a frame that turns with its point sees it at rest", () => {
  const point = { name: "ship", at: ({ k }: { k: number }): V3 => [10 * k, k, 2], heading: ({ k }: { k: number }) => 0.4 * k };
  for (const k of [0, 1, 2]) {
    const at = stand({ point, turns: true }, { k, f: 0 });
    assert.deepEqual(seen(at, point.at({ k })), [0, 0, 2]);
    const bow: V3 = [10 * k + 3 * Math.cos(0.4 * k), k + 3 * Math.sin(0.4 * k), 2];
    seen(at, bow).forEach((x, i) => near(x, [3, 0, 2][i]!));
  }
  assert.deepEqual(stand({ point: null, turns: false }, { k: 0, f: 0 }), { x: [0, 0, 0], angle: 0 });
});

test("the scale of colours grows lighter", () => {
  const light = (c: number[]) => 0.2126 * c[0]! + 0.7152 * c[1]! + 0.0722 * c[2]!;
  const shades = Array.from({ length: 41 }, (_, i) => light(viridis(i / 40)));
  assert.ok(shades.every((s, i) => i === 0 || s > shades[i - 1]!));
  assert.deepEqual(viridis(7), viridis(1));
});

test("edges of solids lie on them", () => {
  for (const [x, y, z] of edges({ type: "cylinder", radius: 2, half: 3 }, 9).flat()) {
    near(Math.hypot(x, y), 2);
    near(Math.abs(z), 3);
  }
  assert.ok(edges({ type: "tube", radius: 1, half: null }, 9).flat().every((p) => Math.abs(p[2]) === 9));
  assert.equal(edges({ type: "box", half: [1, 2, 3] }, 9).flat().length, 18);
  assert.equal(edges({ type: "mesh", points: Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), triangles: Uint32Array.of(0, 1, 2) }, 9).length, 1);
});

function field(): Field {
  const times = Float64Array.from({ length: 5 }, (_, k) => k);
  const x = Float32Array.from({ length: 5 * 6 }, (_, i) => (i % 3 === 0 ? 100 * Math.floor(i / 6) + (i % 6 === 0 ? 0 : 1) : 0));
  const line = { name: "hose", kind: "cable", place: "", diameter: 0.001, counts: Array(5).fill(2), starts: [0, 2, 4, 6, 8], s: Float32Array.of(0, 1), x,
    quantities: [{ name: "tension", unit: "N", values: Float32Array.from({ length: 10 }, (_, i) => i) }] };
  return { origin: [0, 0, 0], times, lines: [line], bodies: [], forces: [], shapes: [], water: 0, waves: null, bed: null };
}

test("the stage stays with a line that is small beside its path", () => {
  const stage = new Stage(field());
  assert.equal(stage.followed?.name, "hose, middle");
  assert.ok(stage.exaggeration >= 5, "what is thin is drawn thicker");
  stage.fit("now", 1);
  const before = stage.orbit.target[0];
  // all of the line is seen
  for (const x of [0, 1]) assert.ok(Math.abs(project(stage.orbit, [x, 0, 0], 1)[0]) < 0.5);
  stage.to(1.5);
  near(stage.lines[0]!.x[0]!, 150);
  stage.to(2.5);
  near(stage.orbit.target[0] - before, 250, 1e-4);
  assert.equal(stage.reached, 3);
  assert.deepEqual([...stage.trail.subarray(6, 9)], [201, 0, 0]);
});

test("in the frame of its own point a trail stands still", () => {
  const stage = new Stage(field());
  stage.view({ point: stage.points[0]!, turns: false });
  for (let k = 0; k < 5; k++) assert.deepEqual([...stage.trail.subarray(3 * k, 3 * k + 3)], [1, 0, 0]);
});

test("a stage without anything, and one of points that aren't there", () => {
  const empty = new Stage({ origin: [0, 0, 0], times: new Float64Array(), lines: [], bodies: [], forces: [], shapes: [], water: null, waves: null, bed: null });
  empty.to(3);
  empty.fit("all", 1);
  assert.ok(Number.isFinite(empty.orbit.distance));
  const gone = field();
  gone.lines[0]!.x.fill(NaN);
  const stage = new Stage(gone);
  stage.to(1);
  stage.fit("now", 1);
  assert.ok(stage.orbit.target.every(Number.isFinite) && Number.isFinite(stage.orbit.distance));
});

test("arrows are as long as their forces say, and are where they act", () => {
  const force = (kind: string, size: number) => ({
    name: kind === "reaction" ? "reaction: pin" : kind, kind, x: Float32Array.of(0, 0, 0, 2, 0, 0, NaN, NaN, NaN), f: Float32Array.of(0, 0, size, 0, 0, 3 * size, 0, 0, size),
  });
  const arrows = new Arrows([force("reaction", 100), force("weight", 1e6)], 10);
  assert.deepEqual(arrows.kinds, [{ name: "reaction: pin", shown: true }, { name: "weight", shown: false }]);
  arrows.to({ k: 0, f: 0.5 });
  const [pin, weight] = arrows.actors;
  assert.deepEqual([pin!.x, pin!.f, pin!.seen, weight!.seen], [[1, 0, 0], [0, 0, 200], true, false]);
  // what usually is the largest takes a share of the size: at least 95 of a hundred snapshots have no larger one
  near(100 * arrows.scale, 1.5);
  arrows.factor = 2;
  near(100 * arrows.scale, 3);
  near(arrows.round(3), 100);
  near(arrows.round(2), 50);
  // beside a far larger one it is as short as needs be
  arrows.factor = 1;
  arrows.kinds[1]!.shown = true;
  arrows.measure();
  near(1e6 * arrows.scale, 5);
  arrows.to({ k: 2, f: 0 });
  assert.ok(!arrows.actors[0]!.seen, "one that has no place isn't drawn");
  // what alone is there is shown
  assert.ok(new Arrows([force("weight", 1)], 1).kinds[0]!.shown);
  assert.ok(Number.isNaN(new Arrows([], 1).round(1)));
});

test("a trail begins where its motion does", () => {
  const stage = new Stage(field(), [0, 3]);
  stage.to(2.5);
  assert.deepEqual([stage.since, stage.reached], [0, 3]);
  stage.to(3);
  assert.deepEqual([stage.since, stage.reached], [3, 4]);
  stage.to(4);
  assert.deepEqual([stage.since, stage.reached], [3, 5]);
});
