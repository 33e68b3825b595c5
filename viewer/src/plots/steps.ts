// How long the steps of the solver were, and what kept them so.

import uPlot from "uplot";
import type { Run, Steps } from "../data/run.ts";
import { short } from "../data/text.ts";
import { $, h } from "../page/dom.ts";
import { styled } from "../space/picture.ts";
import { axes, clicked, Cursor, HEIGHT, seriesColour } from "./chart.ts";
import type { TimeWindow } from "./window.ts";

export class StepPlot {
  private plot: uPlot;
  private cursor: Cursor;
  private box = $("steps");

  constructor(run: Run, steps: Steps, private part: TimeWindow, seek: (t: number) => void) {
    const { t, least, greatest, cause, causes, counts } = steps;
    const all = counts.reduce((sum, n) => sum + n, 0);
    const used = causes.map((_, i) => i).filter((i) => counts[i]! > 0).sort((a, b) => counts[b]! - counts[a]!);
    const share = (i: number) => `${short((100 * counts[i]!) / all, 3)} %`;
    $("steps-keys").append(...used.map((i, k) => h("span", { class: "key" }, h("i", { class: `dot c${k % 7}`, "aria-hidden": "true" }), `${causes[i]!} ${share(i)}`)));
    $("steps-told").textContent = "Sizes of steps and what kept them from being longer; the band goes from the smallest to the largest of those that are drawn together.";
    const positive = (a: Float64Array) => Array.from(a, (x) => (x > 0 ? x : null));
    const of = (i: number) => Array.from(greatest, (h, k) => (cause[k] === i && h > 0 ? h : null));
    const edge = { stroke: "transparent", width: 0, points: { show: false } };
    this.plot = new uPlot({
      width: this.box.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: { sync: { key: "t", setSeries: false }, drag: { x: true, y: false, dist: 4 }, points: { show: false }, y: false },
      scales: { x: { time: false, ...(!part.whole && { min: part.from, max: part.to }) }, y: { distr: 3 } },
      axes: axes(`${run.axis.name} [${run.axis.unit || "-"}]`, { y: true }),
      series: [{}, edge, edge, ...used.map((_, k) => ({ stroke: () => seriesColour(k), paths: () => null, points: { show: true, size: 4, width: 0, fill: () => seriesColour(k) } }))],
      bands: [{ series: [2, 1], fill: () => styled("--band") }],
    }, [Array.from(t), positive(least), positive(greatest), ...used.map(of)] as uPlot.AlignedData, this.box);
    this.cursor = new Cursor(this.plot);
    clicked(this.plot, seek);
    this.plot.over.addEventListener("dblclick", () => part.set(-Infinity, Infinity));
    this.box.setAttribute("role", "img");
    this.box.setAttribute("aria-label", `${all} steps, limited by ${used.map((i) => `${causes[i]!} ${share(i)}`).join(", ")}`);
    part.changed(() => this.zoom());
  }

  private zoom(): void {
    this.plot.setScale("x", { min: this.part.from, max: this.part.to });
    queueMicrotask(() => queueMicrotask(() => this.cursor.again()));
  }

  to(t: number): void {
    this.cursor.to(t);
  }

  resize(): void {
    const width = this.box.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
    this.cursor.again();
  }

  recolour(): void {
    this.plot.redraw(false, true);
  }
}
