// What is on the stage at a time: both pictures, with and without WebGL, draw this.

import { range } from "../data/envelope.ts";
import { along, moment, points, pose, settle, type Moment, type Point, type Pose } from "../data/motion.ts";
import type { Field, Line, Quantity, V3 } from "../data/run.ts";
import { Surface } from "../data/sea.ts";
import { Arrows } from "./arrows.ts";
import { DARK, LIGHT, viridis } from "./colour.ts";
import { seen, stand, type Frame, type Stand } from "./frame.ts";
import { fit, fitBall, type Box, type Orbit, VIEWS } from "./orbit.ts";

/** A quantity on all lines that have it. */
export interface Scale {
  name: string;
  unit: string;
  low: number;
  high: number;
  /** Whether some values are above `high`. */
  beyond: boolean;
}

/** A line as it is drawn. */
export interface LineActor {
  line: Line;
  count: number;
  x: Float32Array;
  /** Three for each point, 0 … 1. */
  colour: Float32Array;
}

/** How large the square of water is, in sizes of all that happens. */
export const WATER = 1.6;

export class Stage {
  readonly field: Field;
  readonly points: Point[];
  readonly scales: Scale[];
  readonly lines: LineActor[];
  arrows: Arrows;
  poses: Pose[] = [];
  stand: Stand = { x: [0, 0, 0], angle: 0 };
  frame: Frame = { point: null, turns: false };
  followed: Point | null = null;
  trailed: Point | null = null;
  scale: Scale | null;
  /** How many times as thick as they are lines are drawn. */
  exaggeration = 1;
  /** Diameter of lines that have none [m]. */
  private hair = 0;
  dark = false;
  names = false;
  orbit: Orbit = { target: [0, 0, 0], distance: 1, azimuth: VIEWS.space![0], elevation: VIEWS.space![1] };
  /** The path of the followed point in the frame, for all snapshots; those from `since` until `reached` are shown. */
  trail = new Float32Array();
  since = 0;
  reached = 0;
  /** Size of all that happens on the ground [m]. */
  readonly size: number;
  readonly whole: Box;
  /** The water where there are waves on it. */
  readonly sea: Surface | null;
  private values: Float32Array;
  private last: V3 | null = null;
  private at: Moment = { k: 0, f: 0 };

  /** `restarts` are times at which another motion begins, which has no trail from before. */
  constructor(field: Field, private restarts: number[] = []) {
    this.field = field;
    this.points = points(field);
    this.scales = scales(field.lines);
    this.scale = this.scales[0] ?? null;
    this.lines = field.lines.map((line) => {
      const most = Math.max(0, ...line.counts);
      return { line, count: 0, x: new Float32Array(3 * most), colour: new Float32Array(3 * most) };
    });
    this.values = new Float32Array(Math.max(0, ...field.lines.flatMap((l) => l.counts)));
    this.arrows = new Arrows([], 1);
    this.whole = this.wholeBox();
    this.size = diagonal(this.whole);
    const [low, high] = this.whole;
    const side = WATER * this.size;
    const corner = [0, 1].map((i) => (low[i]! + high[i]! - side) / 2) as [number, number];
    this.sea = field.waves && new Surface(field.waves, corner, side);
    this.trailed = this.points.find((p) => p.name.endsWith(", end")) ?? this.points[0] ?? null;
    this.to(field.times[0] ?? 0);
    this.arrows = new Arrows(field.forces, diagonal(this.box()));
    this.arrows.to(this.at);
    this.thick();
    // a line that is small beside its path is lost in it: stay with it
    const here = this.box();
    if (diagonal(here) < this.size / 2.5) this.follow(this.points.find((p) => p.name.endsWith(", middle")) ?? this.points[0] ?? null);
    this.retrail();
  }

  /** Diameter that a line is drawn with [m]; one without is as thick as needs be to be seen. */
  drawn(line: Line): number {
    return (line.diameter > 0 ? line.diameter : this.hair) * this.exaggeration;
  }

  /** The first exaggeration: lines are seen as such, and thick ones stay as they are. */
  private thick(): void {
    const diameter = Math.max(0, ...this.field.lines.map((l) => l.diameter));
    const seen = 0.006 * diagonal(this.box());
    const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
    this.exaggeration = diameter > 0 ? (steps.find((s) => s * diameter >= seen) ?? 1000) : 1;
    this.hair = seen / this.exaggeration;
  }

  /** Puts everything where it is at a time. */
  to(t: number): void {
    const at = moment(this.field.times, t);
    this.sea?.to(t);
    this.at = at;
    this.stand = stand(this.frame, at);
    this.poses = this.field.bodies.map((body) => pose(body, at));
    for (const actor of this.lines) {
      actor.count = along(actor.line, actor.line.x, 3, at, actor.x);
      if (!settle(actor.x, actor.count)) actor.count = 0;
      this.paint(actor);
    }
    this.arrows.to(at);
    this.reach();
    const here = this.here();
    if (here && this.last) for (let i = 0; i < 3; i++) this.orbit.target[i]! += here[i]! - this.last[i]!;
    if (here) this.last = here;
  }

  private reach(): void {
    const { k } = this.at;
    this.reached = this.trail.length > 0 ? k + 1 : 0;
    const times = this.field.times;
    const begun = this.restarts.findLast((t) => t <= (times[k] ?? 0)) ?? -Infinity;
    this.since = 0;
    while (this.since < k && times[this.since]! < begun) this.since++;
  }

  /** The followed point in the frame, if it is there. */
  private here(): V3 | null {
    const here = this.followed && seen(this.stand, this.followed.at(this.at));
    return here?.every(Number.isFinite) ? here : null;
  }

  private paint({ line, count, colour }: LineActor): void {
    const of = this.scale && find(line, this.scale);
    if (!of) {
      colour.fill(this.dark ? 0.75 : 0.35);
      return;
    }
    const { low, high } = this.scale!;
    const span = high - low || 1;
    along(line, of.values, 1, this.at, this.values);
    const part = this.dark ? DARK : LIGHT;
    for (let i = 0; i < count; i++) {
      const share = (this.values[i]! - low) / span;
      const c = Number.isNaN(share) ? [0.5, 0.5, 0.5] : viridis(share, part);
      colour[3 * i] = c[0]!;
      colour[3 * i + 1] = c[1]!;
      colour[3 * i + 2] = c[2]!;
    }
  }

  /** The camera goes with a point from now on. */
  follow(point: Point | null): void {
    this.followed = point;
    this.last = this.here();
  }

  view(frame: Frame): void {
    this.frame = frame;
    this.stand = stand(frame, this.at);
    this.last = this.here();
    this.retrail();
  }

  /** The path of the followed point as the frame sees it. */
  retrail(point = this.trailed): void {
    this.trailed = point;
    const count = point ? this.field.times.length : 0;
    this.trail = new Float32Array(3 * count);
    for (let k = 0; k < count; k++) {
      const m = { k, f: 0 };
      this.trail.set(seen(stand(this.frame, m), point!.at(m)), 3 * k);
    }
    if (!settle(this.trail, count)) this.trail = new Float32Array();
    this.reach();
  }

  /** What moves, as it is now in the frame. */
  box(): Box {
    const grow = growing();
    for (const { x, count } of this.lines) for (let i = 0; i < count; i++) grow.add(seen(this.stand, [x[3 * i]!, x[3 * i + 1]!, x[3 * i + 2]!]));
    this.poses.forEach((p, i) => {
      const r = Math.max(0, ...this.field.bodies[i]!.shapes.map((s) => radius(s.solid) + Math.hypot(...s.pose.position)));
      for (const sign of [-r, r]) grow.add(seen(this.stand, p.x.map((v) => v + sign) as V3));
    });
    return grow.box();
  }

  private wholeBox(): Box {
    const grow = growing();
    for (const { x } of this.field.lines) for (let i = 0; i < x.length; i += 3) grow.add([x[i]!, x[i + 1]!, x[i + 2]!]);
    for (const { x } of this.field.bodies) for (let i = 0; i < x.length; i += 3) grow.add([x[i]!, x[i + 1]!, x[i + 2]!]);
    return grow.box();
  }

  fit(what: "now" | "all", aspect: number): void {
    const here = this.here();
    if (here && what === "now") {
      const [low, high] = this.box();
      // half of what is there, and what lies to one side of the point
      const far = Math.hypot(...here.map((x, i) => Math.max(x - low[i]!, high[i]! - x)));
      fitBall(this.orbit, here, Math.min(far, diagonal([low, high])), aspect);
    } else fit(this.orbit, what === "now" || this.frame.point ? this.box() : this.whole, aspect);
  }

  turn(view: string): void {
    const [azimuth, elevation] = VIEWS[view] ?? VIEWS.space!;
    Object.assign(this.orbit, { azimuth, elevation });
  }
}

export function find(line: Line, { name, unit }: { name: string; unit: string }): Quantity | undefined {
  return line.quantities.find((q) => q.name === name && q.unit === unit);
}

function scales(lines: Line[]): Scale[] {
  const all: Scale[] = [];
  for (const { name, unit } of lines.flatMap((l) => l.quantities)) {
    if (all.some((s) => s.name === name && s.unit === unit)) continue;
    // only what is looked at is gone through
    let known: ReturnType<typeof range> | null = null;
    const measured = () => (known ??= range(lines.flatMap((l) => find(l, { name, unit })?.values ?? [])));
    all.push({ name, unit, get low() { return measured().low; }, get high() { return measured().high; }, get beyond() { return measured().beyond; } });
  }
  return all;
}

function growing() {
  const low: V3 = [Infinity, Infinity, Infinity];
  const high: V3 = [-Infinity, -Infinity, -Infinity];
  return {
    add(x: V3) {
      if (!x.every(Number.isFinite)) return;
      for (let i = 0; i < 3; i++) {
        low[i] = Math.min(low[i]!, x[i]!);
        high[i] = Math.max(high[i]!, x[i]!);
      }
    },
    box: (): Box => (low[0] <= high[0] ? [low, high] : [[-1, -1, -1], [1, 1, 1]]),
  };
}

export function diagonal([low, high]: Box): number {
  return Math.hypot(...high.map((h, i) => h - low[i]!)) || 1;
}

/** How far a solid reaches from its origin; endless ones count as nothing. */
function radius(solid: Field["shapes"][number]["solid"]): number {
  if (solid.type === "ball") return solid.radius;
  if (solid.type === "cylinder" || solid.type === "tube") return Math.hypot(solid.radius, solid.half ?? 0);
  if (solid.type === "box") return Math.hypot(...solid.half);
  if (solid.type === "mesh") return solid.points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
  return 0;
}
