// What a picture of the stage can do, whatever it is drawn with.

import type { Stage } from "./stage.ts";

export interface Picture {
  readonly canvas: HTMLCanvasElement;
  readonly kind: "webgl" | "flat";
  /** Size in pixels of the page, and how many of the screen each has. */
  resize(width: number, height: number, ratio: number): void;
  draw(stage: Stage): void;
  /** Colours of the page have changed. */
  recolour(stage: Stage): void;
}

/** The colour of a kind of force. */
export function kindColour(kind: number): string {
  return styled(`--f${kind % 6}`);
}

/** A colour of the page's style. */
export function styled(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
