// What follows from the places of a line's points: angle and clearance, computed when they are first looked at.

import { Vector3 } from "three";
import { Faces } from "./mesh.ts";
import { turned, type Pose } from "./motion.ts";
import type { Field, Line, Quantity, Shape, Solid, V3 } from "./run.ts";

/** Adds what can be derived to the quantities of all lines. */
export function derive(field: Field): void {
  const obstacles = around(field);
  for (const line of field.lines) {
    if (line.quantities.some((q) => q.name === "displacement")) continue;
    line.quantities.push(lazy("angle to the horizontal", "°", () => angles(line)));
    if (obstacles.length > 0) line.quantities.push(lazy("clearance", "m", () => clearances(field, line, obstacles)));
  }
}

function lazy(name: string, unit: string, make: () => Float32Array): Quantity {
  let made: Float32Array | null = null;
  return { name, unit, get values() { return (made ??= make()); } };
}

/** How steeply the line rises at each point [°], by the neighbours of the point. */
export function angles(line: Line): Float32Array {
  const out = new Float32Array(line.x.length / 3).fill(NaN);
  line.counts.forEach((count, k) => {
    const start = line.starts[k]!;
    for (let i = 0; i < count && count > 1; i++) {
      const [a, b] = [3 * (start + Math.max(0, i - 1)), 3 * (start + Math.min(count - 1, i + 1))];
      const [dx, dy, dz] = [0, 1, 2].map((j) => line.x[b + j]! - line.x[a + j]!) as V3;
      out[start + i] = (Math.atan2(dz, Math.hypot(dx, dy)) * 180) / Math.PI;
    }
  });
  return out;
}

/** A solid, and where it is at each snapshot. */
interface Obstacle {
  shape: Shape;
  /** The body that carries it; `null` on the ground. */
  body: Field["bodies"][number] | null;
}

function around(field: Field): Obstacle[] {
  const ground: Obstacle[] = field.shapes.map((shape) => ({ shape, body: null }));
  const carried: Obstacle[] = field.bodies.flatMap((body) => body.shapes.map((shape) => ({ shape, body })));
  const bed: Obstacle[] = field.bed === null ? [] : [{
    shape: { name: "bed", solid: { type: "plane" }, pose: { position: [0, 0, field.bed - field.origin[2]], orientation: [1, 0, 0, 0] } }, body: null,
  }];
  return [...bed, ...ground, ...carried];
}

/** How far the surface of the line is from the nearest solid at each point [m]; below zero inside of one. */
export function clearances(field: Field, line: Line, obstacles = around(field)): Float32Array {
  const out = new Float32Array(line.x.length / 3).fill(NaN);
  line.counts.forEach((count, k) => {
    const seats = obstacles.flatMap(({ shape, body }) => {
      const own = shape.pose;
      if (!body) return [{ solid: shape.solid, x: own.position, q: own.orientation }];
      const [x, q] = [Array.from(body.x.subarray(3 * k, 3 * k + 3)) as V3, Array.from(body.q.subarray(4 * k, 4 * k + 4)) as Pose["q"]];
      if (!x.every(Number.isFinite) || !q.every(Number.isFinite)) return [];
      const arm = turned(q, own.position);
      return [{ solid: shape.solid, x: x.map((v, i) => v + arm[i]!) as V3, q: times(q, own.orientation) }];
    });
    for (let i = line.starts[k]!; i < line.starts[k]! + count; i++) {
      let least = Infinity;
      for (const { solid, x, q } of seats) {
        const away: V3 = [line.x[3 * i]! - x[0], line.x[3 * i + 1]! - x[1], line.x[3 * i + 2]! - x[2]];
        least = Math.min(least, distance(solid, turned([q[0], -q[1], -q[2], -q[3]], away)));
      }
      if (Number.isFinite(least)) out[i] = least - line.diameter / 2;
    }
  });
  return out;
}

function times([a, b, c, d]: Pose["q"], [w, x, y, z]: Pose["q"]): Pose["q"] {
  return [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w];
}

/** Distance of a point in the axes of a solid from its surface [m]; below zero inside. */
export function distance(solid: Solid, [x, y, z]: V3): number {
  const outside = (over: number[]) => Math.hypot(...over.map((d) => Math.max(d, 0))) + Math.min(0, Math.max(...over));
  switch (solid.type) {
    case "plane":
      return z;
    case "ball":
      return Math.hypot(x, y, z) - solid.radius;
    case "cylinder":
      return outside([Math.hypot(x, y) - solid.radius, Math.abs(z) - (solid.half ?? Infinity)]);
    case "tube": {
      // a thin wall, from either side
      return Math.hypot(Math.hypot(x, y) - solid.radius, Math.max(0, Math.abs(z) - (solid.half ?? Infinity)));
    }
    case "box":
      return outside([x, y, z].map((v, i) => Math.abs(v) - solid.half[i]!));
    case "mesh":
      return faces(solid).distance(new Vector3(x, y, z));
  }
}

const known = new WeakMap<Solid, Faces>();

/** The faces of a mesh, which are made once. */
function faces(solid: Solid & { type: "mesh" }): Faces {
  let made = known.get(solid);
  if (!made) known.set(solid, (made = new Faces(solid.points, solid.triangles)));
  return made;
}
