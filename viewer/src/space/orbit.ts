// The camera: it looks at a target from a distance, z up.

import type { V3 } from "../data/run.ts";

export interface Orbit {
  target: V3;
  distance: number;
  /** Of the eye about z, from x [rad]. */
  azimuth: number;
  /** Of the eye above the target [rad]. */
  elevation: number;
}

/** Angle of view from top to bottom [rad]. */
export const ANGLE = 0.6;

export type Box = [V3, V3];

export const VIEWS: Record<string, [number, number]> = {
  space: [-2.2, 0.4],
  top: [-Math.PI / 2, Math.PI / 2],
  side: [-Math.PI / 2, 0],
  end: [Math.PI, 0],
};

export function rotate(orbit: Orbit, right: number, up: number): void {
  orbit.azimuth -= right;
  orbit.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, orbit.elevation + up));
}

export function zoom(orbit: Orbit, factor: number): void {
  orbit.distance = Math.min(1e7, Math.max(1e-3, orbit.distance * factor));
}

/** Unit vectors to the right, up and to the eye. */
export function axes({ azimuth, elevation }: Orbit): [V3, V3, V3] {
  const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
  return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
}

/** Moves the target across the view by shares of the view's height. */
export function pan(orbit: Orbit, right: number, up: number): void {
  const [r, u] = axes(orbit);
  const height = 2 * orbit.distance * Math.tan(ANGLE / 2);
  for (let i = 0; i < 3; i++) orbit.target[i]! += height * (right * r[i]! + up * u[i]!);
}

export function eye(orbit: Orbit): V3 {
  const back = axes(orbit)[2];
  return orbit.target.map((x, i) => x + orbit.distance * back[i]!) as V3;
}

/** Looks at the middle of a box from where all of it is seen. */
export function fit(orbit: Orbit, [low, high]: Box, aspect: number): void {
  orbit.target = low.map((x, i) => (x + high[i]!) / 2) as V3;
  const [r, u, b] = axes(orbit);
  const half = low.map((x, i) => (high[i]! - x) / 2);
  // half of the box's shadow along an axis of the view
  const extent = (axis: V3) => axis.reduce((sum, x, i) => sum + Math.abs(x) * half[i]!, 0);
  const tangent = Math.tan(ANGLE / 2);
  const needed = Math.max(extent(u) / tangent, extent(r) / (tangent * aspect)) + extent(b);
  orbit.distance = 1.12 * needed || 1;
}

/** Looks at a point from where all within `radius` of it is seen, however it turns. */
export function fitBall(orbit: Orbit, centre: V3, radius: number, aspect: number): void {
  orbit.target = [...centre];
  orbit.distance = (1.05 * radius) / (Math.sin(ANGLE / 2) * Math.min(1, aspect)) || 1;
}

/** Where a point appears, in shares of the view from its middle: right and up, and its distance from the eye. */
export function project(orbit: Orbit, x: V3, aspect: number): V3 {
  const [r, u, b] = axes(orbit);
  const d = x.map((v, i) => v - orbit.target[i]!) as V3;
  const dot = (a: V3) => a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
  const depth = orbit.distance - dot(b);
  const scale = 1 / (2 * Math.tan(ANGLE / 2) * depth);
  return [(dot(r) * scale) / aspect, dot(u) * scale, depth];
}
