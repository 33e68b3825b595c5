// The histories: a plot for each panel that was chosen, with one cursor of time.

import uPlot from "uplot";
import { moment } from "../data/motion.ts";
import type { Panel, Run } from "../data/run.ts";
import { short, withUnit } from "../data/text.ts";
import { h } from "../page/dom.ts";
import { styled } from "../space/picture.ts";
import { axes, clicked, Cursor, HEIGHT, seriesColour } from "./chart.ts";
import type { TimeWindow } from "./window.ts";

const SHOWN_FIRST = 6;

interface Shown {
  figure: HTMLElement;
  plot: uPlot;
  cursor: Cursor;
  readouts: HTMLElement[];
}

export class Histories {
  private shown = new Map<number, Shown>();
  private time: number[];
  private hovered: number | null = null;
  private t = NaN;
  private quiet = false;

  constructor(private run: Run, private box: HTMLElement, private part: TimeWindow, private seek: (t: number) => void) {
    this.time = Array.from(run.history[0]?.values ?? []);
    part.changed(() => this.zoom());
    for (let k = 0; k < Math.min(SHOWN_FIRST, run.panels.length); k++) this.show(k, true);
  }

  /** Names of the panels, for a choice. */
  names(): string[] {
    const { panels } = this.run;
    return panels.map(({ title, unit }) => (panels.filter((p) => p.title === title).length > 1 ? `${title} [${unit || "-"}]` : title));
  }

  has(k: number): boolean {
    return this.shown.has(k);
  }

  show(k: number, on: boolean): void {
    const old = this.shown.get(k);
    if (on === !!old) return;
    if (old) {
      old.plot.destroy();
      old.figure.remove();
      this.shown.delete(k);
      return;
    }
    const next = [...this.shown.keys()].filter((i) => i > k).sort((a, b) => a - b)[0];
    const made = this.make(this.run.panels[k]!, next === undefined ? null : this.shown.get(next)!.figure);
    this.shown.set(k, made);
    if (!Number.isNaN(this.t)) this.to(this.t);
  }

  private make(panel: Panel, before: Element | null): Shown {
    const columns = panel.columns.map((k) => this.run.history[k]!);
    const stem = columns.length > 1 ? common(columns.map((c) => c.name)) : 0;
    const readouts = columns.map(() => h("b"));
    const keys = columns.map((c, i) => h("span", { class: "key", title: c.name }, swatch(i), columns.length > 1 ? c.name.slice(stem) : "", " ", readouts[i]!));
    const caption = h("figcaption", {}, h("span", { class: "what" }, `${panel.title} [${panel.unit || "-"}]`), ...keys);
    const body = h("div", { class: "plot", role: "img", "aria-label": told(panel.title, columns) });
    const figure = h("figure", {}, caption, body);
    this.box.insertBefore(figure, before);
    const data = [this.time, ...columns.map((c) => Array.from(c.values, (x) => (Number.isFinite(x) ? x : null)))] as uPlot.AlignedData;
    const label = `${this.run.axis.name} [${this.run.axis.unit || "-"}]`;
    const plot = new uPlot({
      width: body.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: { sync: { key: "t", setSeries: false }, drag: { x: true, y: false, dist: 4 }, points: { size: 6 }, y: false },
      scales: { x: { time: false, ...(!this.part.whole && { min: this.part.from, max: this.part.to }) } },
      axes: axes(label),
      series: [{}, ...columns.map((_, i) => ({ stroke: () => seriesColour(i), width: 1.5, points: { show: this.time.length < 3 } }))],
      hooks: {
        draw: [(u) => this.marks(u)],
        setScale: [(u, key) => key === "x" && this.zoomed(u)],
        setCursor: [(u) => this.hover(u)],
      },
    }, data, body);
    clicked(plot, this.seek);
    plot.over.addEventListener("dblclick", () => this.part.set(-Infinity, Infinity));
    return { figure, plot, cursor: new Cursor(plot), readouts };
  }

  /** Events, as thin lines behind the curves. */
  private marks(u: uPlot): void {
    const { left, top, width, height } = u.bbox;
    u.ctx.save();
    u.ctx.strokeStyle = styled("--event");
    u.ctx.setLineDash([4, 4]);
    for (const { t } of this.run.events) {
      const x = u.valToPos(t, "x", true);
      if (x < left || x > left + width) continue;
      u.ctx.beginPath();
      u.ctx.moveTo(x, top);
      u.ctx.lineTo(x, top + height);
      u.ctx.stroke();
    }
    u.ctx.restore();
  }

  private zoomed(u: uPlot): void {
    const { min, max } = u.scales.x!;
    if (this.quiet || min == null || max == null) return;
    this.part.set(min, max);
  }

  private zoom(): void {
    this.quiet = true;
    for (const { plot } of this.shown.values()) plot.setScale("x", { min: this.part.from, max: this.part.to });
    // plots set their scales in a microtask
    queueMicrotask(() => queueMicrotask(() => {
      this.quiet = false;
      for (const { cursor } of this.shown.values()) cursor.again();
    }));
  }

  private hover(u: uPlot): void {
    const at = u.cursor.idx ?? null;
    if (at === this.hovered) return;
    this.hovered = at;
    this.read();
  }

  /** The cursor goes to a time; `read` writes the values there as well. */
  to(t: number, read = true): void {
    this.t = t;
    for (const { cursor } of this.shown.values()) cursor.to(t);
    if (read && this.hovered === null) this.read();
  }

  private read(): void {
    const at = this.hovered === null ? moment(this.time, this.t) : { k: this.hovered, f: 0 };
    for (const [k, { readouts, figure }] of this.shown) {
      const { columns, unit } = this.run.panels[k]!;
      columns.forEach((c, i) => {
        const values = this.run.history[c]!.values;
        const [a, b] = [values[at.k] ?? NaN, values[at.k + 1] ?? NaN];
        readouts[i]!.textContent = withUnit(at.f > 0 ? a + at.f * (b - a) : a, unit);
      });
      figure.classList.toggle("hovered", this.hovered !== null);
    }
  }

  resize(): void {
    for (const { plot, figure, cursor } of this.shown.values()) {
      const width = figure.querySelector(".plot")!.clientWidth;
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: HEIGHT });
      cursor.again();
    }
  }

  recolour(): void {
    for (const { plot } of this.shown.values()) plot.redraw(false, true);
  }
}

function swatch(i: number): HTMLElement {
  return h("i", { class: `swatch c${i % 7}`, "aria-hidden": "true" });
}

/** How many characters names share up to their last dot. */
function common(names: string[]): number {
  const first = names[0]!;
  let n = first.lastIndexOf(".") + 1;
  while (n > 0 && !names.every((name) => name.startsWith(first.slice(0, n)))) n = first.lastIndexOf(".", n - 2) + 1;
  return n;
}

/** A plot in words. */
function told(title: string, columns: Run["history"]): string {
  const ranges = columns.map(({ name, unit, values }) => {
    const finite = values.filter(Number.isFinite);
    const [low, high] = finite.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
    return `${name} from ${short(low)} to ${short(high)} ${unit}`;
  });
  return `${title}: ${ranges.join("; ")}`;
}
