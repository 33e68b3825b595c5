// The picture of the motion with its choices: frame, point to follow, trail, colours, thickness.

import { short, withUnit } from "../data/text.ts";
import type { Run } from "../data/run.ts";
import { DARK, gradient, LIGHT } from "../space/colour.ts";
import { ANGLE } from "../space/orbit.ts";
import { Flat } from "../space/flat.ts";
import type { Frame } from "../space/frame.ts";
import { gestures } from "../space/gestures.ts";
import type { Picture } from "../space/picture.ts";
import { Stage } from "../space/stage.ts";
import { Webgl } from "../space/webgl.ts";
import { $, choices, h } from "./dom.ts";
import { Labels } from "./labels.ts";
import { Quality } from "./quality.ts";
import { dark } from "./theme.ts";

export class View {
  readonly stage: Stage;
  readonly picture: Picture;
  readonly quality = new Quality();
  private labels: Labels;
  private box = $("space");
  private size: [number, number] = [0, 0];
  private ratio = 0;
  private waiting = false;
  private moving = false;

  constructor(run: Run) {
    this.stage = new Stage(run.field, run.restarts);
    this.stage.dark = dark();
    this.picture = this.start();
    this.box.prepend(this.picture.canvas);
    this.sayWaves();
    this.labels = new Labels($("labels"), this.stage);
    gestures(this.box, this.stage.orbit, {
      moved: () => this.soon(),
      fit: () => this.fit("now"),
      view: (name) => this.turn(name),
    });
    this.choices();
    this.resize();
    this.fit(this.stage.followed ? "now" : "all");
  }

  private start(): Picture {
    try {
      if (location.hash === "#flat") throw new Error("asked for");
      return new Webgl(this.stage);
    } catch {
      $("flat").hidden = false;
      return new Flat(this.stage);
    }
  }

  /** What the surface of the water doesn't show. */
  private sayWaves(): void {
    const { sea } = this.stage;
    if (!sea || sea.left.count === 0) return;
    const share = withUnit(100 * sea.left.share, "%", 2);
    $("short-waves").textContent = `Waves shorter than ${short(sea.shortest, 2)} m, ${share} of the energy, aren't drawn.`;
    $("short-waves").hidden = false;
  }

  private choices(): void {
    const { stage } = this;
    const names = stage.points.map((p) => p.name);
    const frames: [string, Frame][] = [["ground", { point: null, turns: false }]];
    for (const point of stage.points) {
      frames.push([point.name, { point, turns: false }]);
      if (point.heading) frames.push([`${point.name}, turning`, { point, turns: true }]);
    }
    const number = (e: Event) => Number((e.target as HTMLSelectElement).value);
    choices($("frame"), frames.map(([name]) => name), 0);
    $("frame").onchange = (e) => {
      stage.view(frames[number(e)]![1]);
      this.fit(stage.frame.point || stage.followed ? "now" : "all");
    };
    choices($("follow"), ["nothing", ...names], stage.followed ? stage.points.indexOf(stage.followed) + 1 : 0);
    $("follow").onchange = (e) => {
      stage.follow(stage.points[number(e) - 1] ?? null);
      this.fit(stage.followed ? "now" : "all");
    };
    choices($("trail"), ["none", ...names], stage.trailed ? stage.points.indexOf(stage.trailed) + 1 : 0);
    $("trail").onchange = (e) => {
      stage.retrail(stage.points[number(e) - 1] ?? null);
      this.soon();
    };
    choices($("colour"), [...stage.scales.map((s) => s.name), "one colour"], 0);
    $("colour").onchange = (e) => {
      stage.scale = stage.scales[number(e)] ?? null;
      this.legend();
      this.soon();
    };
    const thick = $<HTMLInputElement>("thick");
    const factor = () => {
      const raw = 10 ** Number(thick.value);
      return raw < 10 ? Math.round(10 * raw) / 10 : Math.round(raw);
    };
    const say = () => {
      $("thick-value").textContent = `${short(stage.exaggeration, 3)}×`;
      thick.setAttribute("aria-valuetext", `${short(stage.exaggeration, 3)} times`);
    };
    thick.value = String(Math.log10(stage.exaggeration));
    thick.oninput = () => {
      stage.exaggeration = factor();
      say();
      this.soon();
    };
    say();
    $<HTMLInputElement>("names").onchange = (e) => {
      stage.names = (e.target as HTMLInputElement).checked;
      this.soon();
    };
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-view]")) button.onclick = () => this.turn(button.dataset.view!);
    $("fit").onclick = () => this.fit("now");
    $("fit-all").onclick = () => this.fit("all");
    this.forces();
    this.legend();
    $("choose-colour").hidden = stage.scales.length === 0;
    $("choose-thick").hidden = stage.lines.length === 0;
  }

  /** Which kinds of forces are drawn, and how long. */
  private forces(): void {
    const { arrows } = this.stage;
    const drawn = () => {
      this.stage.to(this.time());
      this.keys();
      this.soon();
    };
    $("force-kinds").append(...arrows.kinds.map((kind, i) => {
      const box = h("input", { type: "checkbox" });
      box.checked = kind.shown;
      box.onchange = () => {
        kind.shown = box.checked;
        arrows.measure();
        drawn();
      };
      return h("label", {}, box, h("i", { class: `swatch f${i % 6}`, "aria-hidden": "true" }), kind.name);
    }));
    const length = $<HTMLInputElement>("force-length");
    const say = () => {
      const text = `${short(arrows.factor, 2)}×`;
      $("force-length-value").textContent = text;
      length.setAttribute("aria-valuetext", `${short(arrows.factor, 2)} times`);
    };
    length.oninput = () => {
      arrows.factor = 10 ** Number(length.value);
      say();
      this.soon();
    };
    say();
    for (const id of ["choose-forces", "choose-length"]) $(id).hidden = arrows.actors.length === 0;
    this.keys();
  }

  /** Which colour of arrow is which kind. */
  private keys(): void {
    const shown = this.stage.arrows.kinds.map(({ name, shown }, i) => shown && h("span", { class: "key" }, h("i", { class: `swatch f${i % 6}` }), name));
    $("forces-keys").replaceChildren(...shown.filter((key) => key !== false));
    $("forces-legend").hidden = !shown.some(Boolean);
  }

  /** An arrow of a round force, as long as arrows at the middle of the picture are. */
  private bar(height: number): void {
    const { arrows, orbit } = this.stage;
    if ($("forces-legend").hidden) return;
    const pixel = (2 * orbit.distance * Math.tan(ANGLE / 2)) / height;
    const force = arrows.round(90 * pixel);
    const [line, text] = [$("forces-bar").children[0] as HTMLElement, $("forces-bar").children[1]!];
    const words = Number.isFinite(force) ? withUnit(force, "N") : "";
    if (text.textContent !== words) text.textContent = words;
    line.style.width = `${Number.isFinite(force) ? ((force * arrows.scale) / pixel).toFixed(0) : 0}px`;
  }

  private legend(): void {
    const { scale } = this.stage;
    $("legend").hidden = !scale;
    if (!scale) return;
    const { name, unit, low, high, beyond } = scale;
    const middle = (low + high) / 2;
    // what rounding leaves is nothing
    const text = (x: number) => short(Math.abs(x) < 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? 0 : x, 3);
    $("legend-name").textContent = `${name} [${unit || "-"}]`;
    $("legend-bar").style.background = gradient(this.stage.dark ? DARK : LIGHT);
    $("legend-ticks").replaceChildren(...[text(low), text(middle), `${beyond ? "≥ " : ""}${text(high)}`].map((text) => {
      const tick = document.createElement("span");
      tick.textContent = text;
      return tick;
    }));
  }

  private turn(name: string): void {
    this.stage.turn(name);
    this.fit(this.stage.followed || this.stage.frame.point ? "now" : "all");
  }

  fit(what: "now" | "all"): void {
    this.stage.fit(what, this.size[0] / (this.size[1] || 1));
    this.soon();
  }

  /** Everything at a time; `seconds` since the frame before while it plays. */
  to(t: number, seconds: number): void {
    this.moving = seconds > 0;
    if (this.moving) this.quality.took(seconds);
    this.stage.to(t);
    this.draw();
  }

  /** Draws once before the next frame, however often it is asked. */
  soon(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  private draw(): void {
    const [width, height] = this.size;
    if (width < 1 || height < 1) return;
    const ratio = this.quality.ratio(this.moving);
    if (ratio !== this.ratio) this.picture.resize(width, height, (this.ratio = ratio));
    this.picture.draw(this.stage);
    this.labels.draw(width, height);
    this.bar(height);
  }

  resize(): void {
    const size: [number, number] = [this.box.clientWidth, this.box.clientHeight];
    if (size[0] === this.size[0] && size[1] === this.size[1]) return;
    this.size = size;
    this.ratio = 0;
    this.draw();
  }

  recolour(): void {
    this.stage.dark = dark();
    this.legend();
    this.stage.to(this.time());
    this.picture.recolour(this.stage);
    this.draw();
  }

  /** The time that the picture shows; set by who owns the clock. */
  time: () => number = () => 0;
}
