// Solids as lines, for the picture without WebGL.

import type { Solid, V3 } from "../data/run.ts";

const AROUND = 24;

function circle(radius: number, at: (c: number, s: number) => V3): V3[] {
  return Array.from({ length: AROUND + 1 }, (_, i) => {
    const a = (2 * Math.PI * i) / AROUND;
    return at(radius * Math.cos(a), radius * Math.sin(a));
  });
}

/** Polylines of a solid in its own axes; what has no end is cut off at `reach` [m]. */
export function edges(solid: Solid, reach: number): V3[][] {
  switch (solid.type) {
    case "plane": {
      const lines: V3[][] = [];
      for (let i = -4; i <= 4; i++) {
        const u = (reach * i) / 4;
        lines.push([[u, -reach, 0], [u, reach, 0]], [[-reach, u, 0], [reach, u, 0]]);
      }
      return lines;
    }
    case "ball":
      return [circle(solid.radius, (c, s) => [c, s, 0]), circle(solid.radius, (c, s) => [c, 0, s]), circle(solid.radius, (c, s) => [0, c, s])];
    case "cylinder":
    case "tube": {
      const half = solid.half ?? reach;
      const rings = [-half, half].map((z) => circle(solid.radius, (c, s) => [c, s, z]));
      const sides = [0, 6, 12, 18].map((i) => [rings[0]![i]!, rings[1]![i]!]);
      return [...rings, ...sides];
    }
    case "box": {
      const [a, b, c] = solid.half;
      const ring = (z: number): V3[] => [[-a, -b, z], [a, -b, z], [a, b, z], [-a, b, z], [-a, -b, z]];
      return [ring(-c), ring(c), ...[0, 1, 2, 3].map((i) => [ring(-c)[i]!, ring(c)[i]!])];
    }
    case "mesh": {
      const corner = (k: number) => Array.from(solid.points.subarray(3 * k, 3 * k + 3)) as V3;
      const lines: V3[][] = [];
      const stride = Math.max(1, Math.floor(solid.triangles.length / 9000)) * 3;
      for (let i = 0; i + 2 < solid.triangles.length; i += stride) {
        const [p, q, r] = [0, 1, 2].map((j) => corner(solid.triangles[i + j]!));
        lines.push([p!, q!, r!, p!]);
      }
      return lines;
    }
  }
}
