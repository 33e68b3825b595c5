// A scale of colours that grows lighter from end to end: viridis.

const STOPS = [
  [68, 1, 84], [72, 38, 119], [63, 71, 136], [49, 102, 142], [38, 130, 142],
  [31, 157, 138], [53, 183, 121], [108, 206, 90], [180, 222, 44], [253, 231, 37],
] as const;

/** The part of the scale that is told from the background. */
export const LIGHT: [number, number] = [0, 0.92];
export const DARK: [number, number] = [0.14, 1];

/** Red, green and blue, 0 … 1, at a share of the scale. */
export function viridis(share: number, [low, high]: [number, number] = [0, 1]): [number, number, number] {
  const u = (low + (high - low) * Math.min(Math.max(share, 0), 1)) * (STOPS.length - 1);
  const k = Math.min(Math.floor(u), STOPS.length - 2);
  const mix = (i: 0 | 1 | 2) => (STOPS[k]![i] + (u - k) * (STOPS[k + 1]![i] - STOPS[k]![i])) / 255;
  return [mix(0), mix(1), mix(2)];
}

/** The scale as a gradient of CSS. */
export function gradient(part: [number, number]): string {
  const stops = Array.from({ length: 10 }, (_, i) => `rgb(${viridis(i / 9, part).map((c) => Math.round(255 * c)).join(" ")})`);
  return `linear-gradient(90deg, ${stops.join(", ")})`;
}
