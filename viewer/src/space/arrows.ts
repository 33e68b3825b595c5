// Forces as arrows from the points where they act.

import type { Moment } from "../data/motion.ts";
import type { Force, V3 } from "../data/run.ts";

export interface ArrowActor {
  force: Force;
  /** Number of the group that it is shown with. */
  kind: number;
  /** Where it acts [m]. */
  x: V3;
  /** The force [N]. */
  f: V3;
  /** Whether it is to be drawn. */
  seen: boolean;
}

/** What is there all the time and rarely asked for. */
const QUIET = /^(weight|buoyancy|added mass)/;
/** Length of the middle one of the arrows, and the most that the longest may have, in parts of what is there. */
const LENGTH = 0.15;
const LONGEST = 0.5;
/** Of the sizes that a force has at all snapshots this share isn't above what counts as its size. */
const USUAL = 0.95;
/** Up to so many reactions can be chosen one by one. */
const FEW = 8;

export class Arrows {
  readonly actors: ArrowActor[];
  readonly kinds: { name: string; shown: boolean }[];
  /** Times as long as they are at first. */
  factor = 1;
  /** Length of a newton at first [m]. */
  private unit = 0;

  constructor(forces: Force[], private size: number) {
    const few = forces.filter((f) => f.kind === "reaction").length <= FEW;
    const group = (f: Force) => (few && f.kind === "reaction" ? f.name : f.kind);
    this.kinds = [...new Set(forces.map(group))].map((name) => ({ name, shown: !QUIET.test(name) }));
    if (!this.kinds.some((k) => k.shown)) for (const kind of this.kinds) kind.shown = true;
    this.actors = forces.map((force) => ({ force, kind: this.kinds.findIndex((k) => k.name === group(force)), x: [0, 0, 0], f: [0, 0, 0], seen: false }));
    this.measure();
  }

  /** Length of a newton [m]. */
  get scale(): number {
    return this.unit * this.factor;
  }

  /** Finds a length for those that are shown: the middle one is seen well, and the largest doesn't leave the picture. */
  measure(): void {
    const shown = this.actors.filter((a) => this.kinds[a.kind]!.shown);
    const usual = shown.map(({ force: { f } }) => {
      const sizes = Array.from({ length: f.length / 3 }, (_, k) => Math.hypot(f[3 * k]!, f[3 * k + 1]!, f[3 * k + 2]!));
      const sorted = sizes.filter((x) => x > 0).sort((a, b) => a - b);
      return sorted[Math.floor(USUAL * (sorted.length - 1))] ?? 0;
    }).filter((x) => x > 0).sort((a, b) => a - b);
    const [middle, most] = [usual[(usual.length - 1) >> 1], usual.at(-1)];
    this.unit = middle && most ? Math.min((LENGTH * this.size) / middle, (LONGEST * this.size) / most) : 0;
  }

  /** Puts all of them where they are. */
  to({ k, f: share }: Moment): void {
    for (const actor of this.actors) {
      const mix = (of: Float32Array) => [0, 1, 2].map((i) => {
        const a = of[3 * k + i]!;
        return share > 0 ? a + share * (of[3 * k + 3 + i]! - a) : a;
      }) as V3;
      actor.x = mix(actor.force.x);
      actor.f = mix(actor.force.f);
      const size = Math.hypot(...actor.f);
      actor.seen = this.kinds[actor.kind]!.shown && size > 0 && [...actor.x, ...actor.f].every(Number.isFinite);
    }
  }

  /** A force that is a round number, and whose arrow is about so long [m]. */
  round(length: number): number {
    const wanted = length / this.scale;
    if (!(wanted > 0) || !Number.isFinite(wanted)) return NaN;
    const power = 10 ** Math.floor(Math.log10(wanted));
    return power * ([5, 2, 1].find((m) => m * power <= wanted * 1.000001) ?? 1);
  }
}
