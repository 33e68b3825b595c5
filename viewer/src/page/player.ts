// Play, pause, scrub, speed, loop: the clock and its buttons.

import { advance, fitting, SPEEDS, type Clock } from "../data/clock.ts";
import type { Run } from "../data/run.ts";
import { short, timeText } from "../data/text.ts";
import type { TimeWindow } from "../plots/window.ts";
import { $, choices, h } from "./dom.ts";

/** Steps of the slider. */
const FINE = 2000;

export class Player {
  readonly clock: Clock;
  private last = 0;
  private slider = $<HTMLInputElement>("slider");

  constructor(private run: Run, private part: TimeWindow, private times: ArrayLike<number>, private show: (t: number, seconds: number) => void) {
    const speed = fitting(part.last - part.first);
    this.clock = { t: part.first, from: part.first, to: part.last, speed, loop: true, playing: false };
    part.changed(() => {
      [this.clock.from, this.clock.to] = [part.from, part.to];
      if (this.clock.t < part.from || this.clock.t > part.to) this.seek(part.from);
    });
    choices($("speed"), SPEEDS.map((s) => `${short(s)}×`), SPEEDS.indexOf(speed));
    $<HTMLSelectElement>("speed").onchange = (e) => (this.clock.speed = SPEEDS[Number((e.target as HTMLSelectElement).value)]!);
    $<HTMLInputElement>("loop").onchange = (e) => (this.clock.loop = (e.target as HTMLInputElement).checked);
    $("play").onclick = () => this.toggle();
    this.slider.max = String(FINE);
    this.slider.oninput = () => this.seek(part.first + ((part.last - part.first) * Number(this.slider.value)) / FINE);
    this.slider.addEventListener("keydown", (e) => this.key(e));
    addEventListener("keydown", (e) => {
      const at = e.target as HTMLElement;
      // whoever types or presses a button means that
      if (e.ctrlKey || e.metaKey || e.altKey || at.closest("input, select, textarea, button, summary, pre")) return;
      if (e.key === " ") {
        e.preventDefault();
        this.toggle();
      } else this.key(e);
    });
    const marks = $("marks");
    for (const { t, text } of run.events) {
      const mark = h("span", { title: text });
      mark.style.left = `${(100 * (t - part.first)) / (part.last - part.first || 1)}%`;
      marks.append(mark);
    }
  }

  /** Arrows go from snapshot to snapshot. */
  private key(e: KeyboardEvent): void {
    const { clock, times } = this;
    const eps = 1e-9 * (this.part.last - this.part.first);
    const next = Array.from(times).find((t) => t > clock.t + eps);
    const before = Array.from(times).findLast((t) => t < clock.t - eps);
    const to: Record<string, number | undefined> = { ArrowRight: next, ArrowLeft: before, Home: this.part.first, End: this.part.last };
    if (!(e.key in to)) return;
    e.preventDefault();
    if (to[e.key] !== undefined) this.seek(to[e.key]!);
  }

  toggle(): void {
    const { clock } = this;
    clock.playing = !clock.playing;
    if (clock.playing) {
      if (clock.t >= clock.to && !clock.loop) clock.t = clock.from;
      this.last = performance.now();
      requestAnimationFrame((now) => this.tick(now));
    }
    this.show(clock.t, 0);
  }

  private tick(now: number): void {
    if (!this.clock.playing) return;
    // a page that was in the background doesn't leap
    const seconds = Math.min(0.25, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    advance(this.clock, seconds);
    this.show(this.clock.t, this.clock.playing ? seconds : 0);
    requestAnimationFrame((next) => this.tick(next));
  }

  seek(t: number): void {
    this.clock.t = Math.min(this.part.last, Math.max(this.part.first, t));
    this.show(this.clock.t, 0);
  }

  /** Shows the time. */
  paint(): void {
    const { clock, part } = this;
    const span = part.last - part.first;
    const text = `${timeText(clock.t, span)} ${this.run.axis.unit}`.trim();
    $("time").textContent = text;
    this.slider.value = String(Math.round((FINE * (clock.t - part.first)) / (span || 1)));
    this.slider.setAttribute("aria-valuetext", text);
    const word = clock.playing ? "Pause" : "Play";
    if ($("play").textContent !== word) $("play").textContent = word;
  }
}
