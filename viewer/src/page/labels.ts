// Names beside the parts, as text over the picture.

import { seen } from "../space/frame.ts";
import { project } from "../space/orbit.ts";
import type { Stage } from "../space/stage.ts";
import { h } from "./dom.ts";

export class Labels {
  private marks: HTMLElement[];

  constructor(private box: HTMLElement, private stage: Stage) {
    const names = [...stage.field.bodies.map((b) => b.name), ...stage.field.lines.map((l) => l.name)];
    this.marks = names.map((name) => h("span", {}, name));
    box.append(...this.marks);
  }

  draw(width: number, height: number): void {
    const { stage, box } = this;
    box.hidden = !stage.names;
    if (!stage.names) return;
    const bodies = stage.poses.map((p) => p.x);
    const middles = stage.lines.map(({ x, count }) => {
      const i = 3 * (count >> 1);
      return [x[i] ?? NaN, x[i + 1] ?? NaN, x[i + 2] ?? NaN] as [number, number, number];
    });
    [...bodies, ...middles].forEach((x, i) => {
      const [right, up, depth] = project(stage.orbit, seen(stage.stand, x), width / height);
      const mark = this.marks[i]!;
      const shown = depth > 0 && Math.abs(right) < 0.5 && Math.abs(up) < 0.5;
      mark.style.display = shown ? "" : "none";
      if (shown) mark.style.transform = `translate(${(width * (0.5 + right) + 8).toFixed(0)}px, ${(height * (0.5 - up) - 18).toFixed(0)}px)`;
    });
  }
}
