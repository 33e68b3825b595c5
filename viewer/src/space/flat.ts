// The stage drawn by lines in a plane canvas, where there is no WebGL.

import { turned } from "../data/motion.ts";
import type { Shape, V3 } from "../data/run.ts";
import { CELLS, type Surface } from "../data/sea.ts";
import { edges } from "./edges.ts";
import { seen } from "./frame.ts";
import { ANGLE, project } from "./orbit.ts";
import { kindColour, styled, type Picture } from "./picture.ts";
import { WATER, type Stage } from "./stage.ts";

type Put = (x: V3) => V3;

export class Flat implements Picture {
  readonly kind = "flat";
  readonly canvas = document.createElement("canvas");
  private pen: CanvasRenderingContext2D;
  private ratio = 1;
  private colours: Record<string, string> = {};
  private shapes = new Map<Shape, V3[][]>();

  constructor(stage: Stage) {
    // drawn by the processor: where there is no WebGL, there is rarely a good graphics card
    const pen = this.canvas.getContext("2d", { willReadFrequently: true });
    if (!pen) throw new Error("no canvas");
    this.pen = pen;
    this.recolour(stage);
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    Object.assign(this.canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    Object.assign(this.canvas.style, { width: `${width}px`, height: `${height}px` });
  }

  recolour(_stage: Stage): void {
    for (const name of ["space", "sea", "bed", "grid", "trail", "body", "solid", "point"]) this.colours[name] = styled(`--${name}`);
  }

  draw(stage: Stage): void {
    const { pen } = this;
    const { width, height } = this.canvas;
    pen.fillStyle = this.colours.space!;
    pen.fillRect(0, 0, width, height);
    const aspect = width / height;
    /** From the frame to pixels and depth. */
    const shown: Put = (x) => {
      const [right, up, depth] = project(stage.orbit, x, aspect);
      return [width * (0.5 + right), height * (0.5 - up), depth];
    };
    const ground: Put = (x) => shown(seen(stage.stand, x));
    pen.lineWidth = this.ratio;
    this.levels(stage, ground);
    for (const shape of stage.field.shapes) this.solid(shape, stage.size, ground, this.colours.solid!);
    stage.field.bodies.forEach((body, i) => {
      const { x, q } = stage.poses[i]!;
      const put: Put = (p) => ground(turned(q, p).map((v, j) => v + x[j]!) as V3);
      for (const shape of body.shapes) this.solid(shape, stage.size, put, this.colours.body!);
      if (body.shapes.length === 0) this.dot(ground(x), this.colours.point!);
    });
    this.trail(stage, shown);
    this.lines(stage, ground, height);
    this.arrows(stage, ground);
  }

  private arrows(stage: Stage, put: Put): void {
    const { actors, scale } = stage.arrows;
    this.pen.lineWidth = 2 * this.ratio;
    for (const { x, f, kind, seen } of actors) {
      if (!seen) continue;
      const [from, to] = [put(x), put(x.map((v, i) => v + scale * f[i]!) as V3)];
      if (!(from[2] > 0 && to[2] > 0)) continue;
      this.pen.strokeStyle = kindColour(kind);
      const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
      const length = Math.hypot(dx, dy) || 1;
      const head = Math.min(9 * this.ratio, 0.4 * length) / length;
      const barb = (sign: number): V3 => [to[0] - head * (dx - 0.45 * sign * dy), to[1] - head * (dy + 0.45 * sign * dx), 1];
      this.path([from, to]);
      this.path([barb(1), to, barb(-1)]);
    }
  }

  private solid(shape: Shape, reach: number, put: Put, colour: string): void {
    let lines = this.shapes.get(shape);
    if (!lines) this.shapes.set(shape, (lines = edges(shape.solid, reach)));
    this.pen.strokeStyle = colour;
    const { position, orientation } = shape.pose;
    for (const line of lines) this.path(line.map((x) => put(turned(orientation, x).map((v, i) => v + position[i]!) as V3)));
  }

  /** A polyline, broken where it goes behind the eye. */
  private path(points: V3[]): void {
    this.pen.beginPath();
    let drawing = false;
    for (const [x, y, depth] of points) {
      if (!(depth > 0)) drawing = false;
      else if (drawing) this.pen.lineTo(x, y);
      else {
        this.pen.moveTo(x, y);
        drawing = true;
      }
    }
    this.pen.stroke();
  }

  private dot([x, y, depth]: V3, colour: string): void {
    if (!(depth > 0)) return;
    this.pen.fillStyle = colour;
    this.pen.beginPath();
    this.pen.arc(x, y, 5 * this.ratio, 0, 2 * Math.PI);
    this.pen.fill();
  }

  private levels({ field, whole: [low, high], size, sea }: Stage, put: Put): void {
    const [x, y] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const half = (WATER / 2) * size;
    const level = (z: number, name: string, alpha: number) => {
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([i, j]) => put([x + half * i!, y + half * j!, z]));
      this.pen.globalAlpha = alpha;
      this.pen.fillStyle = this.colours[name]!;
      if (corners.every((c) => c[2] > 0)) {
        this.pen.beginPath();
        for (const c of corners) this.pen.lineTo(c[0], c[1]);
        this.pen.fill();
      }
      this.pen.strokeStyle = this.colours.grid!;
      this.pen.globalAlpha = 0.5;
      for (let i = -6; i <= 6; i++) {
        const u = (half * i) / 6;
        this.path([put([x + u, y - half, z]), put([x + u, y + half, z])]);
        this.path([put([x - half, y + u, z]), put([x + half, y + u, z])]);
      }
      this.pen.globalAlpha = 1;
    };
    if (field.bed !== null) level(field.bed - field.origin[2], "bed", 0.25);
    if (field.water !== null && sea) this.waves(sea, field.water - field.origin[2], put);
    else if (field.water !== null) level(field.water - field.origin[2], "sea", 0.12);
  }

  /** Every fourth row and column of the surface. */
  private waves({ heights, low, side }: Surface, z: number, put: Put): void {
    const [n, cell] = [CELLS + 1, side / CELLS];
    const corner = (k: number, j: number) => put([low[0] + cell * k, low[1] + cell * j, z + heights[j * n + k]!]);
    const all = Array.from({ length: n }, (_, i) => i);
    this.pen.strokeStyle = this.colours.sea!;
    this.pen.globalAlpha = 0.45;
    for (let i = 0; i < n; i += 4) {
      this.path(all.map((k) => corner(k, i)));
      this.path(all.map((j) => corner(i, j)));
    }
    this.pen.globalAlpha = 1;
  }

  private trail(stage: Stage, put: Put): void {
    this.pen.strokeStyle = this.colours.trail!;
    const all: V3[] = [];
    for (let k = stage.since; k < stage.reached; k++) all.push(put(Array.from(stage.trail.subarray(3 * k, 3 * k + 3)) as V3));
    if (all.length > 1) this.path(all);
  }

  private lines(stage: Stage, put: Put, height: number): void {
    this.pen.lineCap = "round";
    for (const { line, x, colour, count } of stage.lines) {
      const at = Array.from({ length: count }, (_, i) => put([x[3 * i]!, x[3 * i + 1]!, x[3 * i + 2]!]));
      for (let i = 0; i + 1 < count; i++) {
        const [a, b] = [at[i]!, at[i + 1]!];
        if (!(a[2] > 0 && b[2] > 0)) continue;
        const thick = (height * stage.drawn(line)) / (2 * Math.tan(ANGLE / 2) * a[2]);
        this.pen.lineWidth = Math.max(2 * this.ratio, thick);
        this.pen.strokeStyle = `rgb(${[0, 1, 2].map((j) => Math.round(255 * colour[3 * i + j]!)).join(" ")})`;
        this.pen.beginPath();
        this.pen.moveTo(a[0], a[1]);
        this.pen.lineTo(b[0], b[1]);
        this.pen.stroke();
      }
    }
  }
}
