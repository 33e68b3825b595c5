// Least, mean, greatest and standard deviation along a line, with the present curve over them.

import uPlot from "uplot";
import { envelope, ranged, type Envelope } from "../data/envelope.ts";
import { along, moment } from "../data/motion.ts";
import { firstS, type Line, type Quantity, type Range, type Run } from "../data/run.ts";
import { timeText, withUnit } from "../data/text.ts";
import { h } from "../page/dom.ts";
import { styled } from "../space/picture.ts";
import { axes } from "./chart.ts";
import type { TimeWindow } from "./window.ts";

const HEIGHT = 230;

/** What is drawn: a quantity over the snapshots of the window, or a range graph over all steps of its own time. */
export interface Drawn {
  title: string;
  unit: string;
  line?: Line;
  quantity?: Quantity;
  range?: Range;
}

export class Envelopes {
  private plot: uPlot | null = null;
  private now = document.createElement("canvas");
  private t = 0;
  private values = new Float32Array();
  private found: Envelope | null = null;
  private seen = true;

  constructor(
    private run: Run, private box: HTMLElement, private told: HTMLElement, private part: TimeWindow,
    public drawn: Drawn, private seek: (t: number) => void,
  ) {
    this.now.className = "overlay";
    this.now.setAttribute("aria-hidden", "true");
    part.changed(() => this.again());
    // out of sight it needn't be drawn
    new IntersectionObserver(([entry]) => {
      this.seen = entry!.isIntersecting;
      this.curve();
    }).observe(box);
    this.again();
  }

  choose(drawn: Drawn): void {
    this.drawn = drawn;
    this.again();
  }

  /** Everything anew: another line, quantity or window. */
  again(): void {
    const { drawn: { line, quantity, range }, part } = this;
    this.found = range ? ranged(range) : line && quantity ? envelope(line, quantity, this.run.field.times, part.from, part.to) : null;
    this.values = new Float32Array(Math.max(0, ...(line?.counts ?? [])));
    this.plot?.destroy();
    this.plot = null;
    this.say();
    if (!this.found) return;
    const { s, least, mean, greatest, deviation } = this.found;
    const spread = (sign: number) => mean.map((m, i) => m + sign * deviation[i]!);
    const data = [s, greatest, mean, least, spread(1), spread(-1)].map((a) => Array.from(a, (x) => (Number.isFinite(x) ? x : null))) as unknown as uPlot.AlignedData;
    const line1 = (dash?: number[], width = 1.25) => ({ stroke: () => styled("--c0"), width, points: { show: false }, ...(dash && { dash }) });
    this.plot = new uPlot({
      width: this.box.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: { drag: { x: true, y: false, dist: 4 }, y: false, points: { size: 6 } },
      scales: { x: { time: false } },
      axes: axes("s [m]"),
      series: [{}, line1(), line1([5, 4]), line1(), line1([1, 3], 1), line1([1, 3], 1)],
      bands: [{ series: [1, 3], fill: () => styled("--band") }, { series: [4, 5], fill: () => styled("--band") }],
      hooks: { draw: [() => this.curve()], setCursor: [(u) => this.hover(u)] },
    }, data, this.box);
    this.plot.over.append(this.now);
    this.curve();
  }

  private say(): void {
    const { found, drawn: { unit, range }, part } = this;
    if (!found) {
      this.told.replaceChildren("No values in this window.");
      return;
    }
    const span = this.part.last - this.part.first;
    const { name, unit: axis } = this.run.axis;
    const place = (what: string, { value, s, t }: Envelope["lowest"]) => {
      const button = h("button", { type: "button", class: "link" }, `${name} = ${timeText(t, span)} ${axis}`);
      button.addEventListener("click", () => this.seek(t));
      return h("span", {}, h("b", {}, `${what} ${withUnit(value, unit)}`), ` at s = ${withUnit(s, "m")}, `, button);
    };
    const [from, to] = range?.window.map((t) => timeText(t, span)) ?? [];
    const over = range ? `over all steps from ${from} to ${to} ${axis}` : part.whole ? "over the whole run" : `from ${timeText(part.from, span)} to ${timeText(part.to, span)} ${axis}`;
    this.told.replaceChildren(place("Greatest", found.highest), place("Least", found.lowest), h("span", { class: "muted" }, over), h("span", { class: "hovered-value" }));
  }

  private hover(u: uPlot): void {
    const out = this.told.querySelector(".hovered-value");
    const i = u.cursor.idx;
    if (!out || !this.found) return;
    if (i == null) {
      out.textContent = "";
      return;
    }
    const { s, least, mean, greatest, deviation } = this.found;
    const { unit } = this.drawn;
    const text = (of: Float64Array) => withUnit(of[i]!, unit, 3);
    out.textContent = `s = ${withUnit(s[i]!, "m")}: ${text(least)} · ${text(mean)} ± ${text(deviation)} · ${text(greatest)}`;
  }

  to(t: number): void {
    this.t = t;
    this.curve();
  }

  /** The present curve, on a canvas of its own: the plot below stays as it is. */
  private curve(): void {
    const { plot, drawn: { line, quantity } } = this;
    // drawn by the processor: small, and often before a slow graphics card
    const pen = this.now.getContext("2d", { willReadFrequently: true });
    if (!plot || !pen || !this.seen || !plot.over.clientWidth) return;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [plot.over.clientWidth, plot.over.clientHeight];
    if (this.now.width !== Math.round(width * ratio) || this.now.height !== Math.round(height * ratio)) {
      [this.now.width, this.now.height] = [Math.round(width * ratio), Math.round(height * ratio)];
      [this.now.style.width, this.now.style.height] = [`${width}px`, `${height}px`];
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    // a range graph may be of what snapshots don't know
    if (!line || !quantity) return;
    const at = moment(this.run.field.times, this.t);
    const count = along(line, quantity.values, 1, at, this.values);
    const k = line.counts[at.k] === count ? at.k : Math.min(at.k + 1, line.counts.length - 1);
    const start = firstS(line, k);
    pen.strokeStyle = styled("--now");
    pen.lineWidth = 2;
    pen.beginPath();
    let drawing = false;
    for (let i = 0; i < count; i++) {
      const value = this.values[i]!;
      if (!Number.isFinite(value)) {
        drawing = false;
        continue;
      }
      const [x, y] = [plot.valToPos(line.s[start + i]!, "x"), plot.valToPos(value, "y")];
      if (drawing) pen.lineTo(x, y);
      else pen.moveTo(x, y);
      drawing = true;
    }
    pen.stroke();
  }

  resize(): void {
    const width = this.box.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
  }

  /** Also before the page is printed, when all of it is in sight. */
  recolour(): void {
    this.seen = true;
    this.plot?.redraw(false, true);
  }
}
