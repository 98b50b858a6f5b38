// SPDX-License-Identifier: Apache-2.0
// Pictures and movies of what is on the screen, with the time and the colour scale written on them.
import type { Clock } from '../clock';
import type { Field } from '../data/format';
import { clockText } from '../ui/text';
import { scaleTicks } from '../ui/legend';
import type { Viewer } from '../viewer';
import { colourAt } from './colormap';

/** Draws the picture and its caption into `target`: in full sharpness and at its size if `sharp`, else as it is into the size that `target` has. */
export function compose(target: HTMLCanvasElement, viewer: Viewer, caption: string, background: string, ink: string, sharp: boolean): void {
  viewer.stage.drawNow(sharp);
  const source = viewer.stage.canvas;
  // A movie keeps the size it began with.
  if (sharp) {
    target.width = source.width;
    target.height = source.height;
  }
  const ctx = target.getContext('2d')!;
  const unit = Math.max(1, target.height / 700);
  ctx.fillStyle = background;
  ctx.fillRect(0, 0, target.width, target.height);
  ctx.drawImage(source, 0, 0, target.width, target.height);
  ctx.fillStyle = ink;
  ctx.font = `600 ${16 * unit}px system-ui, sans-serif`;
  ctx.textAlign = 'left';
  ctx.fillText(caption, 14 * unit, 26 * unit);
  const field = viewer.fieldShown;
  if (field) drawScale(ctx, field, 14 * unit, 44 * unit, unit, ink);
}

function drawScale(ctx: CanvasRenderingContext2D, field: Field, x: number, y: number, unit: number, ink: string): void {
  ctx.font = `${12 * unit}px system-ui, sans-serif`;
  ctx.fillText(`${field.label}${field.unit ? ` [${field.unit}]` : ''}`, x, y + 10 * unit);
  const [top, height] = [y + 20 * unit, 140 * unit];
  for (let i = 0; i < height; i++) {
    const colour = colourAt(1 - i / height).map((c) => Math.round(255 * c));
    ctx.fillStyle = `rgb(${colour.join(' ')})`;
    ctx.fillRect(x, top + i, 14 * unit, 1.5);
  }
  ctx.fillStyle = ink;
  for (const { at, label } of scaleTicks(field)) ctx.fillText(label, x + 20 * unit, top + (1 - at) * height + 4 * unit);
}

export const captionOf = (name: string, clock: Clock): string => `${name} · ${clockText(clock.time)} min`;

/** A movie of the picture while it runs; WebM. */
export class Recorder {
  private canvas = document.createElement('canvas');
  private recorder: MediaRecorder | null = null;
  private parts: Blob[] = [];

  get recording(): boolean {
    return this.recorder !== null;
  }

  static get supported(): boolean {
    return typeof MediaRecorder !== 'undefined' && 'captureStream' in HTMLCanvasElement.prototype;
  }

  start(viewer: Viewer, draw: (canvas: HTMLCanvasElement) => void): void {
    this.canvas.width = viewer.stage.canvas.width;
    this.canvas.height = viewer.stage.canvas.height;
    draw(this.canvas);
    const type = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'].find((t) => MediaRecorder.isTypeSupported(t));
    if (!type) throw new Error('This browser cannot write WebM.');
    this.parts = [];
    const pixels = viewer.stage.canvas.width * viewer.stage.canvas.height;
    this.recorder = new MediaRecorder(this.canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: Math.min(2e7, 8 * pixels) });
    this.recorder.ondataavailable = (event) => this.parts.push(event.data);
    this.recorder.start(1000);
  }

  /** Called for every picture while recording. */
  frame(draw: (canvas: HTMLCanvasElement) => void): void {
    if (this.recorder) draw(this.canvas);
  }

  async stop(): Promise<Blob> {
    const recorder = this.recorder;
    if (!recorder) return new Blob();
    this.recorder = null;
    await new Promise<void>((done) => {
      recorder.onstop = () => done();
      recorder.stop();
    });
    return new Blob(this.parts, { type: 'video/webm' });
  }
}
