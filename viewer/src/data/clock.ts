// Time of the run against time on the wall.

export interface Clock {
  t: number;
  from: number;
  to: number;
  /** Seconds of the run per second. */
  speed: number;
  loop: boolean;
  playing: boolean;
}

/** Goes on by some seconds on the wall; stops or starts over at the end. */
export function advance(clock: Clock, seconds: number): void {
  const span = clock.to - clock.from;
  const t = clock.t + seconds * clock.speed;
  if (t <= clock.to) clock.t = Math.max(t, clock.from);
  else if (clock.loop && span > 0) clock.t = clock.from + ((t - clock.from) % span);
  else {
    clock.t = clock.to;
    clock.playing = false;
  }
}

export const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/** The speed that shows a run in about twenty seconds. */
export function fitting(span: number): number {
  const wanted = Math.log((span || 1) / 20);
  return SPEEDS.reduce((best, s) => (Math.abs(Math.log(s) - wanted) < Math.abs(Math.log(best) - wanted) ? s : best));
}
