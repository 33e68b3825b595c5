// Mouse, fingers and keys turn, move and approach.

import { pan, rotate, zoom, type Orbit } from "./orbit.ts";

export interface Asked {
  /** The camera has moved. */
  moved(): void;
  fit(): void;
  view(name: string): void;
}

const STEP = 0.08;

/** One finger or the left button turns; two fingers, the right button or shift move; wheel and pinch approach. */
export function gestures(element: HTMLElement, orbit: Orbit, asked: Asked): void {
  const down = new Map<number, [number, number]>();
  const height = () => element.clientHeight || 1;
  element.addEventListener("contextmenu", (e) => e.preventDefault());
  element.addEventListener("pointerdown", (e) => {
    element.setPointerCapture(e.pointerId);
    down.set(e.pointerId, [e.clientX, e.clientY]);
  });
  const up = (e: PointerEvent) => down.delete(e.pointerId);
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  element.addEventListener("pointermove", (e) => {
    const before = down.get(e.pointerId);
    if (!before) return;
    const [dx, dy] = [e.clientX - before[0], e.clientY - before[1]];
    if (down.size === 2) {
      const other = [...down].find(([id]) => id !== e.pointerId)![1];
      const apart = (p: [number, number]) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      zoom(orbit, apart(before) / apart([e.clientX, e.clientY]));
      // both fingers move it, each by its half
      pan(orbit, -dx / 2 / height(), dy / 2 / height());
    } else if (e.buttons & 6 || e.shiftKey) pan(orbit, -dx / height(), dy / height());
    else rotate(orbit, (3 * dx) / height(), (3 * dy) / height());
    down.set(e.pointerId, [e.clientX, e.clientY]);
    asked.moved();
  });
  element.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(orbit, Math.exp(0.0012 * Math.max(-200, Math.min(200, e.deltaMode === 1 ? 30 * e.deltaY : e.deltaY))));
    asked.moved();
  }, { passive: false });
  element.addEventListener("dblclick", () => asked.fit());
  element.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (!key(e, orbit, asked)) return;
    e.preventDefault();
    e.stopPropagation();
    asked.moved();
  });
}

function key(e: KeyboardEvent, orbit: Orbit, asked: Asked): boolean {
  const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const arrow = arrows[e.key];
  if (arrow && e.shiftKey) pan(orbit, STEP * arrow[0], STEP * arrow[1]);
  else if (arrow) rotate(orbit, 1.5 * STEP * arrow[0], 1.5 * STEP * arrow[1]);
  else if (e.key === "+" || e.key === "=") zoom(orbit, 1 / 1.15);
  else if (e.key === "-") zoom(orbit, 1.15);
  else if (e.key === "f" || e.key === "F") asked.fit();
  else if ("1234".includes(e.key)) asked.view(["space", "top", "side", "end"][Number(e.key) - 1]!);
  else return false;
  return true;
}
