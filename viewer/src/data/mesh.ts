// How far points are from meshes.

import { Triangle, Vector3 } from "three";

/** A mesh that is asked for distances. */
export class Faces {
  private readonly all: { face: Triangle; middle: Vector3; reach: number }[] = [];
  private readonly least = new Vector3(Infinity, Infinity, Infinity);
  private readonly most = new Vector3(-Infinity, -Infinity, -Infinity);

  constructor(points: Float32Array, triangles: Uint32Array) {
    for (let k = 0; k + 2 < triangles.length; k += 3) {
      const corners = [0, 1, 2].map((i) => new Vector3().fromArray(points, 3 * triangles[k + i]!)) as [Vector3, Vector3, Vector3];
      const face = new Triangle(...corners);
      const middle = face.getMidpoint(new Vector3());
      this.all.push({ face, middle, reach: Math.max(...corners.map((c) => c.distanceTo(middle))) });
      for (const corner of corners) {
        this.least.min(corner);
        this.most.max(corner);
      }
    }
  }

  /** Distance of a point from the surface [m]; below zero inside a closed mesh. */
  distance(point: Vector3): number {
    const foot = new Vector3();
    let least = Infinity;
    for (const { face, middle, reach } of this.all) {
      if (point.distanceTo(middle) - reach >= least) continue;
      face.closestPointToPoint(point, foot);
      least = Math.min(least, point.distanceTo(foot));
    }
    return this.holds(point) ? -least : least;
  }

  /** Whether the mesh is closed around a point: its faces fill more of the sphere of view than an open surface can. */
  private holds(point: Vector3): boolean {
    const within = (["x", "y", "z"] as const).every((i) => point[i] >= this.least[i] && point[i] <= this.most[i]);
    if (!within) return false;
    const [a, b, c, across] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
    let angle = 0;
    for (const { face } of this.all) {
      a.subVectors(face.a, point);
      b.subVectors(face.b, point);
      c.subVectors(face.c, point);
      const [la, lb, lc] = [a.length(), b.length(), c.length()];
      const sides = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
      angle += 2 * Math.atan2(a.dot(across.crossVectors(b, c)), sides);
    }
    return Math.abs(angle) > 0.6 * 4 * Math.PI;
  }
}
