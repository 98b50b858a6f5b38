// SPDX-License-Identifier: Apache-2.0
// The one time of the page: the organs, the curves and the timeline all follow it.

export const SPEEDS = [10, 30, 60, 120, 240];

export class Clock {
  time = 0;
  playing = false;
  /** Seconds of labour in a second. */
  speed = 60;
  private listeners: (() => void)[] = [];

  constructor(
    public duration: number,
    /** Times of the frames, for stepping. */
    public frames: number[],
  ) {}

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  private changed(): void {
    for (const listener of this.listeners) listener();
  }

  set(time: number): void {
    const to = Math.min(this.duration, Math.max(0, time));
    if (to === this.time) return;
    this.time = to;
    this.changed();
  }

  play(on: boolean): void {
    if (on && this.time >= this.duration) this.time = 0;
    this.playing = on;
    this.changed();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.changed();
  }

  /** To the frame that lies `n` further on (back if negative), and stops there. */
  step(n: number): void {
    this.playing = false;
    const frames = this.frames;
    if (!frames.length) {
      this.time = Math.min(this.duration, Math.max(0, this.time + n * 10));
    } else {
      // Times between two frames count as belonging to the earlier one going on, to the later one going back.
      const tolerance = 1e-6 * (this.duration || 1);
      let k = n > 0 ? frames.findLastIndex((t) => t <= this.time + tolerance) : frames.findIndex((t) => t >= this.time - tolerance);
      if (k < 0) k = n > 0 ? -1 : frames.length;
      this.time = Math.min(this.duration, frames[Math.min(frames.length - 1, Math.max(0, k + n))]);
    }
    this.changed();
  }

  tick(seconds: number): void {
    if (!this.playing) return;
    this.time = Math.min(this.duration, this.time + seconds * this.speed);
    if (this.time >= this.duration) this.playing = false;
    this.changed();
  }
}
