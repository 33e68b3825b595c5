import assert from "node:assert/strict";
import { test } from "node:test";
import { densityUnit, evenly, peak, transform, welch } from "../src/data/spectrum.ts";

/** Numbers without pattern, 0 to 1. */
function noise(seed = 1): () => number {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

test("the transform is that of its definition", () => {
  const [n, random] = [16, noise()];
  const x = Array.from({ length: n }, () => [random() - 0.5, random() - 0.5] as const);
  const [re, im] = [Float64Array.from(x, (v) => v[0]), Float64Array.from(x, (v) => v[1])];
  transform(re, im);
  for (let k = 0; k < n; k++) {
    let [a, b] = [0, 0];
    x.forEach(([u, v], i) => {
      const angle = (-2 * Math.PI * k * i) / n;
      a += u * Math.cos(angle) - v * Math.sin(angle);
      b += u * Math.sin(angle) + v * Math.cos(angle);
    });
    assert.ok(Math.hypot(re[k]! - a, im[k]! - b) < 1e-13);
  }
});

test("the integral of a spectrum is the variance", () => {
  // of sines that fill the pieces it is so exactly: amplitude squared over two
  const step = 0.05;
  const sines = Float64Array.from({ length: 1024 }, (_, i) => 7 + 3 * Math.sin((2 * Math.PI * 16 * i) / 256) + Math.cos((2 * Math.PI * 40 * i) / 256));
  const spectrum = welch({ values: sines, step }, 7);
  assert.equal(spectrum.pieces, 7);
  assert.ok(Math.abs(spectrum.variance / 5 - 1) < 1e-12, `${spectrum.variance}`);
  assert.ok(Math.abs(peak(spectrum) - 16 / (256 * step)) < 1e-12);
  // of noise but for what windows weigh otherwise; its density is flat: variance over the highest frequency
  const random = noise(7);
  const values = Float64Array.from({ length: 20000 }, () => random() - 0.5);
  const flat = welch({ values, step }, 63);
  assert.ok(Math.abs(12 * flat.variance - 1) < 0.02, `${flat.variance}`);
  const highest = 0.5 / step;
  const middle = flat.density.subarray(8, flat.density.length - 8);
  const mean = middle.reduce((sum, s) => sum + s, 0) / middle.length;
  assert.ok(Math.abs(mean * 12 * highest - 1) < 0.03, `${mean * 12 * highest}`);
});

test("a length that is no power of two loses nothing", () => {
  const values = Float64Array.from({ length: 1000 }, (_, i) => 2 * Math.sin((2 * Math.PI * 20 * i) / 1000));
  const { variance, pieces } = welch({ values, step: 0.1 }, 1);
  assert.equal(pieces, 1);
  assert.ok(Math.abs(variance / 2 - 1) < 1e-12, `${variance}`);
});

test("uneven instants, windows and gaps become an even series", () => {
  const t = [0, 0.5, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
  const line = evenly(t, t.map((x) => 2 * x), 0, 20)!;
  assert.equal(line.values.length, 12);
  line.values.forEach((y, i) => assert.ok(Math.abs(y - 2 * line.step * i) < 1e-12));
  const part = evenly(t, t, 2, 10)!;
  assert.deepEqual([part.values[0], part.values.length, part.step], [2, 9, 1]);
  const y = t.map((x) => (x === 2 ? NaN : x));
  assert.deepEqual([evenly(t, y, 0, 20)!.values[0], evenly(t, y, 0, 20)!.values.length], [3, 9]);
  assert.equal(evenly(t, y, 0, 5), null);
  assert.equal(evenly([], [], 0, 1), null);
});

test("densities have the square of the unit over the frequency", () => {
  assert.deepEqual(["N", "m/s", "N m", "", "-"].map(densityUnit), ["N²/Hz", "(m/s)²/Hz", "(N m)²/Hz", "1/Hz", "1/Hz"]);
});
