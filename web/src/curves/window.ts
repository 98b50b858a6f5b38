// SPDX-License-Identifier: Apache-2.0
// The part of the time axis that all plots show [min].

export class Window {
  low: number;
  high: number;
  private listeners: (() => void)[] = [];

  constructor(private whole: number) {
    this.low = 0;
    this.high = whole;
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  range(): [number, number] {
    return [this.low, this.high];
  }

  set(low: number, high: number): void {
    this.low = Math.max(0, low);
    this.high = Math.min(this.whole, high);
    for (const listener of this.listeners) listener();
  }

  /** Shows `factor` times as much, with `about` staying where it is if it is in sight, else in the middle. */
  zoom(factor: number, about: number): void {
    const span = Math.min(this.whole, Math.max(this.whole / 500, factor * (this.high - this.low)));
    const inside = about >= this.low && about <= this.high;
    const f = inside && this.high > this.low ? (about - this.low) / (this.high - this.low) : 0.5;
    const low = Math.min(this.whole - span, Math.max(0, about - f * span));
    this.set(low, low + span);
  }

  reset(): void {
    this.set(0, this.whole);
  }
}
