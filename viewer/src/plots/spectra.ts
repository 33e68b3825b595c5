// The spectrum of a record over the window of time.

import uPlot from "uplot";
import type { Run } from "../data/run.ts";
import { densityUnit, evenly, peak, welch, type Spectrum } from "../data/spectrum.ts";
import { short, withUnit } from "../data/text.ts";
import { $, choices, h } from "../page/dom.ts";
import { axes, HEIGHT, seriesColour } from "./chart.ts";
import type { TimeWindow } from "./window.ts";

const PIECES = [1, 3, 7, 15, 31];
/** What is less than this part of the peak isn't looked at. */
const DEPTH = 1e-8;

export class Spectra {
  private plot: uPlot | null = null;
  private box = $("spectrum");
  private told = $("spectrum-told");
  private found: Spectrum | null = null;
  private column = 1;
  private pieces = 7;
  private log = true;
  /** It is computed when it comes into sight. */
  private due = true;
  private seen = false;

  constructor(private run: Run, private part: TimeWindow) {
    choices($("spectrum-of"), run.history.slice(1).map((c) => `${c.name} [${c.unit || "-"}]`), 0);
    $<HTMLSelectElement>("spectrum-of").onchange = (e) => this.choose(1 + Number((e.target as HTMLSelectElement).value));
    choices($("spectrum-pieces"), PIECES.map(String), PIECES.indexOf(this.pieces));
    $<HTMLSelectElement>("spectrum-pieces").onchange = (e) => {
      this.pieces = PIECES[Number((e.target as HTMLSelectElement).value)]!;
      this.again();
    };
    const log = $<HTMLInputElement>("spectrum-log");
    log.onchange = () => {
      this.log = log.checked;
      this.again();
    };
    part.changed(() => this.again());
    new IntersectionObserver(([entry]) => {
      this.seen = entry!.isIntersecting;
      if (this.due) this.again();
    }).observe($("spectra"));
  }

  /** Another record, by its number in the history. */
  choose(column: number): void {
    this.column = column;
    this.again();
  }

  again(): void {
    this.due = !this.seen;
    if (this.due) return;
    const { run, part } = this;
    const { name, unit, values } = run.history[this.column]!;
    const even = evenly(run.history[0]!.values, values, part.from, part.to);
    this.found = even && welch(even, this.pieces);
    this.plot?.destroy();
    this.plot = null;
    this.say(unit, even ? even.step : NaN);
    if (!this.found) return;
    const { f, density } = this.found;
    const top = density.reduce((most, x, k) => (k > 0 ? Math.max(most, x) : most), 0);
    // the mean is no frequency, and a logarithm needs something
    const shown = Array.from(density, (x, k) => (k === 0 || (this.log && !(x > 0)) ? null : x));
    const scale = this.log ? { distr: 3 as const } : {};
    const range = (_: uPlot, low: number, high: number): [number, number] => (high > 0 ? [Math.max(low, DEPTH * high) / 1.5, 1.5 * high] : [1e-3, 1]);
    this.plot = new uPlot({
      width: this.box.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: { drag: { x: true, y: false, dist: 4 }, y: false, points: { size: 6 } },
      scales: { x: { time: false, ...scale, ...(this.log && { range: [f[1]!, f.at(-1)!] as [number, number] }) }, y: { ...scale, ...(this.log && { range }) } },
      axes: axes("f [Hz]", { x: this.log, y: this.log }),
      series: [{}, { stroke: () => seriesColour(0), width: 1.25, points: { show: false }, ...(!this.log && { fill: () => "transparent" }) }],
      hooks: { setCursor: [(u) => this.hover(u, unit)] },
    }, [Array.from(f).slice(1), shown.slice(1)] as uPlot.AlignedData, this.box);
    this.box.setAttribute("role", "img");
    this.box.setAttribute("aria-label", `Spectrum of ${name}: largest at ${short(peak(this.found))} Hz, up to ${short(top)} ${densityUnit(unit)}`);
  }

  private say(unit: string, step: number): void {
    const { found, part } = this;
    if (!found) {
      this.told.replaceChildren("Too few values in this window.");
      return;
    }
    const at = peak(found);
    const first = Number.isFinite(at) ? h("span", {}, h("b", {}, `Peak at ${withUnit(at, "Hz", 3)}`), `, a period of ${withUnit(1 / at, "s", 3)}`) : "Nothing moves.";
    const spread = h("span", {}, `standard deviation ${withUnit(Math.sqrt(found.variance), unit)}`);
    const notes = [`${found.pieces} ${found.pieces > 1 ? "pieces" : "piece"} under Hann windows, ${densityUnit(unit)}, up to ${withUnit(0.5 / step, "Hz", 3)}`];
    if (!part.whole) notes.push("of the window of time");
    if (this.run.thinned.some((text) => text.includes("rows of the history"))) notes.push("the history on this page is thinned: don't trust the highest frequencies");
    this.told.replaceChildren(first, spread, h("span", { class: "muted" }, notes.join("; ")), h("span", { class: "hovered-value" }));
  }

  private hover(u: uPlot, unit: string): void {
    const out = this.told.querySelector(".hovered-value");
    const i = u.cursor.idx;
    if (!out || !this.found) return;
    const { f, density } = this.found;
    out.textContent = i == null ? "" : `${withUnit(f[i + 1]!, "Hz")}: ${short(density[i + 1]!)} ${densityUnit(unit)}`;
  }

  resize(): void {
    const width = this.box.clientWidth;
    if (this.plot && width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
  }

  recolour(): void {
    if (!this.seen) this.seen = true;
    if (this.due) this.again();
    else this.plot?.redraw(false, true);
  }
}
