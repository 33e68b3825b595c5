// Fewer pixels while a slow machine plays; all of them when it stands still.

export class Quality {
  private share = 1;
  private mean = 0;
  private frames = 0;

  /** Takes the time of a frame; whether the share of pixels has changed. */
  took(seconds: number): boolean {
    this.mean = this.mean === 0 ? seconds : 0.85 * this.mean + 0.15 * seconds;
    if (++this.frames < 10) return false;
    const wanted = this.mean > 1 / 28 ? this.share * 0.8 : this.mean < 1 / 55 ? this.share * 1.1 : this.share;
    const share = Math.min(1, Math.max(0.5, wanted));
    if (Math.abs(share - this.share) < 0.02) return false;
    this.share = share;
    this.frames = 0;
    this.mean = 0;
    return true;
  }

  /** Whether the machine has trouble to keep up: what isn't the picture is then drawn less often. */
  get slow(): boolean {
    return this.mean > 1 / 40 || this.share < 1;
  }

  /** Pixels of the screen for each of the page. */
  ratio(moving: boolean): number {
    const full = Math.min(2, devicePixelRatio || 1);
    return moving ? full * this.share : full;
  }
}
