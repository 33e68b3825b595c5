// The part of the time that is looked at: plots, envelopes and the player share it.

export class TimeWindow {
  from: number;
  to: number;
  readonly first: number;
  readonly last: number;
  private readonly heard: (() => void)[] = [];

  constructor(first: number, last: number) {
    [this.first, this.last] = [first, last];
    [this.from, this.to] = [first, last];
  }

  get whole(): boolean {
    return this.from <= this.first && this.to >= this.last;
  }

  /** Whatever lies outside of the run is cut off; an empty window is the whole run. */
  set(from: number, to: number): void {
    const low = Math.max(this.first, Math.min(from, to));
    const high = Math.min(this.last, Math.max(from, to));
    const [a, b] = high > low ? [low, high] : [this.first, this.last];
    if (a === this.from && b === this.to) return;
    [this.from, this.to] = [a, b];
    for (const tell of this.heard) tell();
  }

  changed(tell: () => void): void {
    this.heard.push(tell);
  }
}
