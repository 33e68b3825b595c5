import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { advance, fitting, SPEEDS } from "../src/data/clock.ts";
import { decode, numbers } from "../src/data/decode.ts";
import { envelope, range } from "../src/data/envelope.ts";
import { along, heading, moment, points, pose, settle, turned } from "../src/data/motion.ts";
import type { Body, Line } from "../src/data/run.ts";
import { short, timeText, withUnit } from "../src/data/text.ts";
import { TimeWindow } from "../src/plots/window.ts";

/** What the Rust side does to rows of numbers. */
function packed(values: number[], columns: number, code: number): Uint8Array {
  const bits = new Int32Array(Float32Array.from(values).buffer);
  const out = new Uint8Array(4 * bits.length);
  bits.forEach((b, k) => {
    const before = (rows: number) => bits[k - rows * columns] ?? 0;
    const guess = code === 0 || k < columns ? 0 : code === 1 || k < 2 * columns ? before(1) : 2 * before(1) - before(2);
    const d = (b - guess) | 0;
    const zigzag = (d << 1) ^ (d >> 31);
    for (let plane = 0; plane < 4; plane++) out[plane * bits.length + k] = (zigzag >>> (8 * plane)) & 255;
  });
  return out;
}

test("numbers come back bit by bit, whatever guess they were stored by", () => {
  const values = [1, -2.5, 1e-30, -1e30, 0, 3.25, NaN, 7, -0.1, 1e10, 2, 3].map(Math.fround);
  for (const code of [0, 1, 2]) for (const columns of [1, 2, 3]) {
    const bytes = packed(values, columns, code);
    assert.deepEqual([...numbers(bytes, { at: 0, rows: values.length / columns, columns, code })], values);
  }
});

test("a block becomes a run", async () => {
  const arrays: Uint8Array[] = [];
  let at = 0;
  const put = (values: number[], columns: number, from = 0) => {
    const bytes = packed(values, columns, 1);
    const place = { at, rows: values.length / columns, columns, code: 1, from };
    at += bytes.length;
    arrays.push(bytes);
    return place;
  };
  const line = {
    name: "hose", kind: "cable", place: "", diameter: 0.1, counts: [0, 2], s: put([0, 1], 1), position: put([0, 0, 0, 1, 0, 0], 3),
    quantities: [{ name: "tension", unit: "N", values: put([5, 6], 1) }],
  };
  const plane = { name: "", solid: { type: "plane" }, pose: { position: [100, 50, -3], orientation: [1, 0, 0, 0] } };
  const text = JSON.stringify({
    version: 1, title: "ü </script>", history: [{ name: "t", unit: "s", values: put([0, 0.5], 1, 1e6) }],
    field: { origin: [0, 0, 0], times: put([0, 1], 1), lines: [line], bodies: [], shapes: [plane], water: null, waves: null, bed: null },
  });
  const json = new TextEncoder().encode(text);
  const head = new Uint8Array(4);
  new DataView(head.buffer).setUint32(0, json.length, true);
  const run = await decode(deflateSync(Buffer.concat([head, json, ...arrays])).toString("base64"));
  assert.equal(run.title, "ü </script>");
  assert.deepEqual([...run.history[0]!.values], [1e6, 1e6 + 0.5]);
  assert.deepEqual(run.field.lines[0]!.starts, [0, 0]);
  assert.deepEqual([...run.field.lines[0]!.quantities[0]!.values], [5, 6]);
  // a plane is drawn where the motion is
  assert.deepEqual(run.field.shapes[0]!.pose.position, [0, 0, -3]);
});

test("data of another version is refused", async () => {
  const json = new TextEncoder().encode('{"version":99}');
  const head = new Uint8Array([json.length, 0, 0, 0]);
  await assert.rejects(decode(deflateSync(Buffer.concat([head, json])).toString("base64")), /version 99/);
});

const line: Line = {
  name: "hose", kind: "cable", place: "", diameter: 0.1, counts: [2, 2, 3], starts: [0, 2, 4],
  s: Float32Array.of(0, 1, 0, 1, 0, 1, 2),
  x: Float32Array.of(0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 2, 0, 0, 4, 0, 1, 4, 0, 2, 4, 0),
  quantities: [{ name: "tension", unit: "N", values: Float32Array.of(1, 2, 3, 4, 5, 6, 7) }],
};

test("between two snapshots a line is between them, unless its points change in number", () => {
  const out = new Float32Array(9);
  assert.equal(along(line, line.x, 3, { k: 0, f: 0.25 }, out), 2);
  assert.deepEqual([...out.subarray(0, 6)], [0, 0.5, 0, 1, 0.5, 0]);
  assert.equal(along(line, line.x, 3, { k: 1, f: 0.4 }, out), 2);
  assert.equal(along(line, line.x, 3, { k: 1, f: 0.6 }, out), 3);
  assert.equal(out[7], 4);
});

test("points without a place go to one that has", () => {
  const x = Float32Array.of(NaN, 0, 0, 1, 2, 3, 4, NaN, 6, 7, 8, 9);
  assert.ok(settle(x, 4));
  assert.deepEqual([...x], [1, 2, 3, 1, 2, 3, 1, 2, 3, 7, 8, 9]);
  assert.ok(!settle(Float32Array.of(NaN, 0, 0), 1) && !settle(new Float32Array(), 0));
});

test("moments of times", () => {
  const times = [0, 1, 3];
  assert.deepEqual(moment(times, -1), { k: 0, f: 0 });
  assert.deepEqual(moment(times, 2), { k: 1, f: 0.5 });
  assert.deepEqual(moment(times, 3), { k: 2, f: 0 });
  assert.deepEqual(moment(times, 9), { k: 2, f: 0 });
  assert.deepEqual(moment([], 1), { k: 0, f: 0 });
});

test("a body turns by the shorter way", () => {
  const half = Math.SQRT1_2;
  const body: Body = { name: "b", kind: "", place: "", shapes: [], x: Float32Array.of(0, 0, 0, 2, 0, 0), q: Float32Array.of(1, 0, 0, 0, -half, 0, 0, -half) };
  const middle = pose(body, { k: 0, f: 0.5 });
  assert.deepEqual(middle.x, [1, 0, 0]);
  assert.ok(Math.abs(heading(middle.q) - Math.PI / 4) < 1e-6, "an eighth of a turn, not three eighths");
  const x = turned([half, 0, 0, half], [1, 0, 0]);
  assert.ok(Math.abs(x[1] - 1) < 1e-12 && Math.abs(x[0]) < 1e-12);
  const [start] = points({ origin: [0, 0, 0], times: new Float64Array(3), lines: [line], bodies: [], forces: [], shapes: [], water: null, waves: null, bed: null });
  assert.deepEqual(start!.at({ k: 1, f: 0 }), [0, 2, 0]);
});

test("the envelope is that of the window, its mean is over time", () => {
  const still = { ...line, counts: [2, 2, 2], starts: [0, 2, 4], s: Float32Array.of(0, 1), x: line.x.slice(0, 18) };
  const of = { name: "tension", unit: "N", values: Float32Array.of(0, 10, 4, 10, 2, NaN) };
  const all = envelope(still, of, [0, 1, 4], 0, 4)!;
  assert.deepEqual([...all.least], [0, 10]);
  assert.deepEqual([...all.greatest], [4, 10]);
  // trapezoids: (0 + 4) / 2 for one second, (4 + 2) / 2 for three
  assert.ok(Math.abs(all.mean[0]! - (2 + 9) / 4) < 1e-12);
  assert.deepEqual(all.highest, { value: 10, s: 1, t: 0 });
  // half a second of 0, two of 4, one and a half of 2, about 11/4
  const variance = (0.5 * (0 - 2.75) ** 2 + 2 * (4 - 2.75) ** 2 + 1.5 * (2 - 2.75) ** 2) / 4;
  assert.ok(Math.abs(all.deviation[0]! - Math.sqrt(variance)) < 1e-12);
  assert.equal(all.deviation[1], 0);
  assert.deepEqual([...envelope(still, of, [0, 1, 4], 0.5, 4)!.least], [2, 10]);
  assert.equal(envelope(still, of, [0, 1, 4], 5, 6), null);
});

test("the envelope of a line that grows", () => {
  const found = envelope(line, line.quantities[0]!, [0, 1, 2], 0, 2)!;
  assert.equal(found.s.length, 200);
  assert.equal(found.greatest[199], 7);
  assert.equal(found.least[0], 1);
  assert.deepEqual(found.highest, { value: 7, s: 2, t: 2 });
});

test("a few peaks don't take all of a scale", () => {
  const values = Float32Array.from({ length: 1000 }, (_, i) => (i === 500 ? 1000 : (i % 100) / 100));
  const { low, high, beyond } = range([values]);
  assert.ok(low === 0 && high < 1 && beyond);
  assert.deepEqual(range([Float32Array.of(1, 2, NaN)]), { low: 1, high: 2, beyond: false });
  assert.deepEqual(range([]), { low: 0, high: 1, beyond: false });
});

test("the clock loops or stops", () => {
  const clock = { t: 9, from: 0, to: 10, speed: 2, loop: true, playing: true };
  advance(clock, 1);
  assert.deepEqual([clock.t, clock.playing], [1, true]);
  Object.assign(clock, { t: 9, loop: false });
  advance(clock, 1);
  assert.deepEqual([clock.t, clock.playing], [10, false]);
  assert.equal(fitting(20), 1);
  assert.ok(SPEEDS.includes(fitting(0)) && SPEEDS.includes(fitting(1e9)));
});

test("numbers as people read them", () => {
  assert.equal(short(1234.56), "1235");
  assert.equal(short(-0.001234), "−0.001234");
  assert.equal(short(1.5e-7), "1.5e−7");
  assert.equal(short(2e9), "2e9");
  assert.equal(short(NaN), "–");
  assert.equal(withUnit(12345, "N"), "12.35 kN");
  assert.equal(withUnit(12345, "m"), "12350 m");
  assert.equal(withUnit(0.5, ""), "0.5");
  assert.equal(timeText(1.23456, 60), "1.23");
  assert.equal(timeText(1.23456, 0.001), "1.234560");
});

test("a window stays within the run", () => {
  const part = new TimeWindow(0, 10);
  let told = 0;
  part.changed(() => told++);
  part.set(-5, 4);
  assert.deepEqual([part.from, part.to, told], [0, 4, 1]);
  part.set(7, 7);
  assert.ok(part.whole);
  part.set(NaN, 3);
  assert.ok(part.whole && told === 2);
});
