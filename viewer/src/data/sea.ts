// The surface of waves: a sum over all of them on a grid of places.

import type { Waves } from "./run.ts";

/** Cells along either side of the grid. */
export const CELLS = 64;

/** Elevations over a square of water, at the corners of its cells. */
export class Surface {
  /** Above still water [m], row by row along y. */
  readonly heights = new Float32Array((CELLS + 1) ** 2);
  /** Length of the shortest wave that such cells can show [m]. */
  readonly shortest: number;
  /** How many waves are too short to be shown, and their share of the energy. */
  readonly left: { count: number; share: number };
  /** Standard deviation of what is shown, once the waves have risen [m]. */
  readonly deviation: number;
  private kept: number[] = [];

  /** A square of water with its corner at `low` and sides of this length [m]. */
  constructor(private waves: Waves, readonly low: [number, number], readonly side: number) {
    const cell = side / CELLS;
    this.shortest = 4 * cell;
    const { all } = waves;
    let [count, energy, whole] = [0, 0, 0];
    for (let i = 0; i < all.length; i += 5) {
      const [a, kx, ky] = [all[i]!, all[i + 1]!, all[i + 2]!];
      whole += a * a;
      if (Math.hypot(kx, ky) * this.shortest <= 2 * Math.PI) this.kept.push(i);
      else {
        count++;
        energy += a * a;
      }
    }
    this.deviation = Math.sqrt((whole - energy) / 2);
    this.left = { count, share: whole > 0 ? energy / whole : 0 };
  }

  /** How far the waves have risen. */
  risen(t: number): number {
    const { ramp } = this.waves;
    if (t >= ramp) return 1;
    return t <= 0 ? 0 : (1 - Math.cos((Math.PI * t) / ramp)) / 2;
  }

  /** Raises the surface to what it is at a time [s]. */
  to(t: number): void {
    const { heights, low, side, waves: { all } } = this;
    const [n, cell, risen] = [CELLS + 1, side / CELLS, this.risen(t)];
    heights.fill(0);
    if (risen === 0) return;
    for (const i of this.kept) {
      const [a, kx, ky, omega, phase] = [all[i]!, all[i + 1]!, all[i + 2]!, all[i + 3]!, all[i + 4]!];
      // along rows and columns the angle grows by as much each time: turning replaces sines
      const [cx, sx, cy, sy] = [Math.cos(kx * cell), Math.sin(kx * cell), Math.cos(ky * cell), Math.sin(ky * cell)];
      const start = kx * low[0] + ky * low[1] - omega * t + phase;
      let [rc, rs] = [risen * a * Math.cos(start), risen * a * Math.sin(start)];
      for (let j = 0; j < n; j++) {
        let [c, s] = [rc, rs];
        for (let k = 0; k < n; k++) {
          heights[j * n + k]! += c;
          const turned = c * cx - s * sx;
          s = s * cx + c * sx;
          c = turned;
        }
        const turned = rc * cy - rs * sy;
        rs = rs * cy + rc * sy;
        rc = turned;
      }
    }
  }
}
