// Whose motion is seen: from the ground, or from a point that moves and may turn.

import type { Moment, Point } from "../data/motion.ts";
import type { V3 } from "../data/run.ts";

export interface Frame {
  point: Point | null;
  /** Whether it turns about z with its point. */
  turns: boolean;
}

/** Where the frame is and how it is turned about z. */
export interface Stand {
  x: V3;
  angle: number;
}

export function stand({ point, turns }: Frame, at: Moment): Stand {
  const x = point?.at(at) ?? [0, 0, 0];
  // a point that isn't there yet takes the frame nowhere
  if (!x.every(Number.isFinite)) return { x: [0, 0, 0], angle: 0 };
  return { x: point ? [x[0], x[1], 0] : x, angle: turns ? (point?.heading?.(at) ?? 0) : 0 };
}

/** A point of the ground, as the frame sees it. */
export function seen({ x: [x, y, z], angle }: Stand, p: V3): V3 {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [dx, dy] = [p[0] - x, p[1] - y];
  return [c * dx + s * dy, c * dy - s * dx, p[2] - z];
}
