// The surface of waves against the sum as it is written.

import assert from "node:assert/strict";
import { test } from "node:test";
import { CELLS, Surface } from "../src/data/sea.ts";

const waves = [
  [1.2, 0.04, 0.01, 0.62, 1.0],
  [0.5, -0.02, 0.05, 0.73, 4.0],
];

test("the surface is the sum over all waves that its cells can show", () => {
  const all = Float32Array.from([...waves, [0.3, 4, 3, 7, 0]].flat());
  const surface = new Surface({ all, ramp: 20 }, [-100, -50], 320);
  assert.equal(surface.left.count, 1);
  assert.ok(Math.abs(surface.left.share - 0.09 / (1.44 + 0.25 + 0.09)) < 1e-6);
  for (const t of [-1, 0, 5, 20, 3600]) {
    surface.to(t);
    const risen = t <= 0 ? 0 : t >= 20 ? 1 : (1 - Math.cos((Math.PI * t) / 20)) / 2;
    let worst = 0;
    for (let j = 0; j <= CELLS; j += 7) {
      for (let k = 0; k <= CELLS; k += 5) {
        const [x, y] = [-100 + (320 / CELLS) * k, -50 + (320 / CELLS) * j];
        // wavenumbers and frequencies are those that single precision holds
        const at = (i: number) => {
          const [a, kx, ky, omega, phase] = all.subarray(5 * i, 5 * i + 5);
          return a! * Math.cos(kx! * x + ky! * y - omega! * t + phase!);
        };
        worst = Math.max(worst, Math.abs(surface.heights[j * (CELLS + 1) + k]! - risen * (at(0) + at(1))));
      }
    }
    assert.ok(worst < 1e-6, `${worst} at ${t}`);
  }
});
