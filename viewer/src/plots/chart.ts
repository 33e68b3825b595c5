// What all plots have in common.

import uPlot from "uplot";
import { short } from "../data/text.ts";
import { styled } from "../space/picture.ts";

export const HEIGHT = 190;

/** Colours that differ in lightness as well as in hue. */
export function seriesColour(i: number): string {
  return styled(`--c${i % 7}`);
}

export function axisStyle(): Pick<uPlot.Axis, "stroke" | "grid" | "ticks" | "font"> {
  return {
    stroke: () => styled("--muted"),
    grid: { stroke: () => styled("--line"), width: 1 },
    ticks: { stroke: () => styled("--line"), width: 1, size: 4 },
    font: "11px system-ui, sans-serif",
  };
}

/** Axes that say little: numbers below and at the left. */
export function axes(label: string, log: { x?: boolean; y?: boolean } = {}): uPlot.Axis[] {
  // a logarithmic axis has powers of ten alone, at most a dozen; uPlot's own end in rounding far below 1
  const splits = (_: uPlot, _axis: number, low: number, high: number) => {
    const [first, last] = [Math.ceil(Math.log10(low) - 1e-6), Math.floor(Math.log10(high) + 1e-6)];
    const step = Math.max(1, Math.ceil((last - first) / 11));
    return Array.from({ length: Math.max(0, Math.floor((last - first) / step) + 1) }, (_, k) => 10 ** (first + step * k));
  };
  const values = (_: uPlot, splits: (number | null)[]) => splits.map((x) => (x === null ? "" : short(x)));
  const style = axisStyle();
  const own = (log?: boolean) => (log ? { ...style, splits, filter: (_: uPlot, all: number[]) => all } : style);
  return [
    { ...own(log.x), values, size: 24, gap: 3, label, labelSize: 15, labelGap: 2, labelFont: "11px system-ui, sans-serif" },
    { ...own(log.y), values, size: 58, gap: 3 },
  ];
}

/** A line that is put at a place over a plot without drawing the plot anew. */
export class Cursor {
  private element = document.createElement("div");
  private place = NaN;

  constructor(private plot: uPlot) {
    this.element.className = "now";
    plot.over.append(this.element);
  }

  to(x: number): void {
    this.place = x;
    const left = this.plot.valToPos(x, "x");
    const seen = left >= -1 && left <= this.plot.over.clientWidth + 1;
    this.element.style.display = seen ? "block" : "none";
    if (seen) this.element.style.transform = `translateX(${left.toFixed(1)}px)`;
  }

  /** After the plot was zoomed or made larger. */
  again(): void {
    if (!Number.isNaN(this.place)) this.to(this.place);
  }
}

/** A click that isn't the end of a drag. */
export function clicked(plot: uPlot, act: (x: number) => void): void {
  let from = NaN;
  plot.over.addEventListener("pointerdown", (e) => (from = e.clientX));
  plot.over.addEventListener("click", (e) => {
    if (Math.abs(e.clientX - from) < 4) act(plot.posToVal(e.offsetX, "x"));
  });
}
