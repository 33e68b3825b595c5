// A line as a tube: rings of corners around its points, turned along so that it doesn't twist.

export interface Tube {
  positions: Float32Array;
  normals: Float32Array;
}

/** Corners of a ring. */
export const SIDES = 8;

/** Triangles between the rings of `points` points. */
export function tubeIndex(points: number): Uint32Array {
  const index = new Uint32Array(Math.max(0, points - 1) * SIDES * 6);
  let k = 0;
  for (let i = 0; i + 1 < points; i++) {
    for (let j = 0; j < SIDES; j++) {
      const [a, b] = [i * SIDES + j, i * SIDES + ((j + 1) % SIDES)];
      index.set([a, b, b + SIDES, a, b + SIDES, a + SIDES], k);
      k += 6;
    }
  }
  return index;
}

/** Puts rings of `radius` around `count` points. */
export function tube(x: Float32Array, count: number, radius: number, out: Tube): void {
  // the first normal: across the direction in which the line goes least
  let [nx, ny, nz] = [0, 0, 0];
  for (let i = 0; i < count; i++) {
    const [a, b] = [3 * Math.max(0, i - 1), 3 * Math.min(count - 1, i + 1)];
    let [tx, ty, tz] = [x[b]! - x[a]!, x[b + 1]! - x[a + 1]!, x[b + 2]! - x[a + 2]!];
    const length = Math.hypot(tx, ty, tz) || 1;
    [tx, ty, tz] = [tx / length, ty / length, tz / length];
    if (i === 0) {
      const [ax, ay, az] = [Math.abs(tx), Math.abs(ty), Math.abs(tz)];
      [nx, ny, nz] = az <= ax && az <= ay ? [0, 0, 1] : ay <= ax ? [0, 1, 0] : [1, 0, 0];
    }
    const along = nx * tx + ny * ty + nz * tz;
    [nx, ny, nz] = [nx - along * tx, ny - along * ty, nz - along * tz];
    const size = Math.hypot(nx, ny, nz);
    // the line turned back on itself: any normal will do
    if (size < 1e-6) [nx, ny, nz] = Math.abs(tz) < 0.9 ? [-ty, tx, 0] : [0, -tz, ty];
    const unit = Math.hypot(nx, ny, nz) || 1;
    [nx, ny, nz] = [nx / unit, ny / unit, nz / unit];
    const [bx, by, bz] = [ty * nz - tz * ny, tz * nx - tx * nz, tx * ny - ty * nx];
    for (let j = 0; j < SIDES; j++) {
      const angle = (2 * Math.PI * j) / SIDES;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const k = 3 * (i * SIDES + j);
      const [mx, my, mz] = [c * nx + s * bx, c * ny + s * by, c * nz + s * bz];
      out.normals[k] = mx;
      out.normals[k + 1] = my;
      out.normals[k + 2] = mz;
      out.positions[k] = x[3 * i]! + radius * mx;
      out.positions[k + 1] = x[3 * i + 1]! + radius * my;
      out.positions[k + 2] = x[3 * i + 2]! + radius * mz;
    }
  }
}
