// A run as the page holds it: what report/src/page wrote, with its arrays unpacked.

export type V3 = [number, number, number];

export interface Run {
  title: string;
  subtitle: string;
  status: string;
  scene: string;
  summary: Entry[];
  warnings: string[];
  notes: string[];
  events: Event[];
  settings: Entry[];
  energy: Entry[];
  /** What else there is to tell, each with a title. */
  sections: { title: string; entries: Entry[] }[];
  /** Tables, such as statistics. */
  listings: Listing[];
  /** Range graphs along lines. */
  ranges: Range[];
  /** Time or load factor. */
  axis: { name: string; unit: string };
  /** The first column is the axis. */
  history: Column[];
  panels: Panel[];
  /** How long steps were and what kept them so; null where there were none. */
  steps: Steps | null;
  /** Where another motion begins that has nothing to do with the one before, such as the next mode. */
  restarts: number[];
  field: Field;
  /** What was left out, in words. */
  thinned: string[];
}

export interface Entry {
  name: string;
  value: string;
}

export interface Event {
  t: number;
  text: string;
}

export interface Column {
  name: string;
  unit: string;
  values: Float64Array;
}

/** Steps of the solver, some together: one number of each array for all of them. */
export interface Steps {
  /** Time at the end [s]. */
  t: Float64Array;
  /** Sizes of the smallest and the largest [s]. */
  least: Float64Array;
  greatest: Float64Array;
  /** Number of what most of them were limited by. */
  cause: Float64Array;
  /** What steps were limited by, and how many were by each, of all steps. */
  causes: string[];
  counts: number[];
}

/** Columns of one unit that are drawn together, by number. */
export interface Panel {
  title: string;
  unit: string;
  columns: number[];
}

export interface Field {
  /** What positions are counted from [m]. */
  origin: V3;
  times: Float64Array;
  lines: Line[];
  bodies: Body[];
  forces: Force[];
  shapes: Shape[];
  water: number | null;
  /** The waves on it; null where it is still. */
  waves: Waves | null;
  bed: number | null;
}

/** Regular waves `a cos(k·x - ω t + φ)`, counted from the origin of the field. */
export interface Waves {
  /** Amplitude [m], wavenumbers along x and y [1/m], frequency [rad/s] and phase [rad] of each. */
  all: Float32Array;
  /** Time in which they rise from still water [s]. */
  ramp: number;
}

/** Between what a quantity was along a line, over all steps of the solver from `window[0]` to `window[1]` [s]. */
export interface Range {
  name: string;
  quantity: string;
  unit: string;
  window: [number, number];
  s: Float64Array;
  start: Float64Array;
  least: Float64Array;
  mean: Float64Array;
  greatest: Float64Array;
  deviation: Float64Array;
  t_least: Float64Array;
  t_greatest: Float64Array;
}

/** A table of texts; the first cell names its row. */
export interface Listing {
  title: string;
  headings: string[];
  rows: string[][];
  note: string;
}

export interface Line {
  name: string;
  kind: string;
  place: string;
  /** [m] */
  diameter: number;
  /** Number of points of each snapshot. */
  counts: number[];
  /** Points of all snapshots before each. */
  starts: number[];
  /** Arc lengths [m]: of one snapshot if they are the same for all. */
  s: Float32Array;
  /** Three for each point [m]. */
  x: Float32Array;
  quantities: Quantity[];
}

export interface Quantity {
  name: string;
  unit: string;
  /** One for each point. */
  readonly values: Float32Array;
}

export interface Body {
  name: string;
  kind: string;
  place: string;
  shapes: Shape[];
  /** Three for each snapshot [m]. */
  x: Float32Array;
  /** Four for each snapshot, the real part first. */
  q: Float32Array;
}

/** A force that acts at a point that may move; it isn't there where its numbers aren't. */
export interface Force {
  name: string;
  /** Such as `reaction`, `drag`: forces of one kind are shown together. */
  kind: string;
  /** Three for each snapshot [m]. */
  x: Float32Array;
  /** Three for each snapshot [N]. */
  f: Float32Array;
}

/** Null lengths have no end. */
export type Solid =
  | { type: "plane" }
  | { type: "ball"; radius: number }
  | { type: "cylinder" | "tube"; radius: number; half: number | null }
  | { type: "box"; half: V3 }
  | { type: "mesh"; points: Float32Array; triangles: Uint32Array };

export interface Shape {
  name: string;
  solid: Solid;
  pose: { position: V3; orientation: [number, number, number, number] };
}

/** Number of the first arc length of a snapshot. */
export function firstS(line: Line, k: number): number {
  return line.s.length === line.x.length / 3 ? line.starts[k]! : 0;
}
