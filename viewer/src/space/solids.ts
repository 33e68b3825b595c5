// Geometries of three.js for the solids, round ones along z.

import { BoxGeometry, BufferAttribute, BufferGeometry, CylinderGeometry, PlaneGeometry, SphereGeometry } from "three";
import type { Solid } from "../data/run.ts";

/** What has no end is cut off at `reach` [m]. */
export function geometry(solid: Solid, reach: number): BufferGeometry {
  switch (solid.type) {
    case "plane":
      return new PlaneGeometry(2 * reach, 2 * reach);
    case "ball":
      return new SphereGeometry(solid.radius, 32, 20);
    case "cylinder":
    case "tube": {
      const half = Math.min(solid.half ?? reach, 1e6);
      return new CylinderGeometry(solid.radius, solid.radius, 2 * half, 40, 1, solid.type === "tube").rotateX(Math.PI / 2);
    }
    case "box":
      return new BoxGeometry(...(solid.half.map((h) => 2 * h) as [number, number, number]));
    case "mesh": {
      const shape = new BufferGeometry();
      shape.setAttribute("position", new BufferAttribute(solid.points, 3));
      shape.setIndex(new BufferAttribute(solid.triangles, 1));
      shape.computeVertexNormals();
      return shape;
    }
  }
}
