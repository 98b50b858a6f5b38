// SPDX-License-Identifier: Apache-2.0
// On the picture: the colour scale with its unit, the directions of the axes, the length measured.
import { Vector3 } from 'three';
import type { BirthEvent, Field, RunInfo } from '../data/format';
import { cssGradient } from '../scene/colormap';
import { AXIS_COLOURS } from '../scene/overlays';
import type { Viewer } from '../viewer';
import { h, svg } from './dom';
import { numberText, withUnit, words } from './text';

/** Ticks of a scale: five, at even places. */
export function scaleTicks(field: Field): { at: number; label: string }[] {
  const [low, high] = field.scale;
  return [0, 0.25, 0.5, 0.75, 1].map((f) => {
    let label = numberText(low + f * (high - low));
    if (f === 1 && field.max > high + 1e-9) label = `≥ ${label}`;
    if (f === 0 && field.min < low - 1e-9) label = `≤ ${label}`;
    return { at: f, label };
  });
}

export class ScaleLegend {
  readonly element = h('div', { class: 'scale', role: 'img' });
  private shown: Field | undefined | null = null;

  follow(field: Field | undefined): void {
    if (field === this.shown) return;
    this.shown = field;
    this.element.hidden = !field;
    if (!field) return;
    const bar = h('div', { class: 'bar' });
    bar.style.background = cssGradient('to top');
    const ticks = h('div', { class: 'ticks' });
    for (const { at, label } of scaleTicks(field)) {
      const tick = h('span', {}, label);
      tick.style.bottom = `${100 * at}%`;
      ticks.append(tick);
    }
    this.element.replaceChildren(
      h('b', {}, field.label),
      h('span', { class: 'scale-unit' }, field.unit || 'ratio'),
      h('div', { class: 'scale-body' }, bar, ticks),
    );
    this.element.setAttribute(
      'aria-label',
      `Colour scale: ${field.label}, from ${numberText(field.scale[0])} (dark) to ${withUnit(numberText(field.scale[1]), field.unit)} (light)`,
    );
  }
}

const NAMES = ['X right', 'Y front', 'Z up'];

/** The axes as the camera sees them. */
export class Triad {
  readonly element = svg('svg', {
    class: 'triad',
    viewBox: '-64 -52 128 104',
    role: 'img',
    'aria-label': 'Axes: X to the right of the mother, Y to the front, Z towards the head',
  });
  private arms = NAMES.map((name, axis) => {
    const colour = `rgb(${AXIS_COLOURS[axis].map((c) => Math.round(255 * c)).join(' ')})`;
    const arm = svg('line', { x1: 0, y1: 0, stroke: colour, 'stroke-width': 3, 'stroke-linecap': 'round' });
    const label = svg('text', { 'text-anchor': 'middle', 'dominant-baseline': 'central', fill: 'currentColor', 'font-size': 10 });
    label.textContent = name;
    const group = svg('g', {}, arm, label);
    return { arm, label, group };
  });
  private vector = new Vector3();

  constructor() {
    this.element.append(...this.arms.map((arm) => arm.group));
  }

  follow(viewer: Viewer): void {
    const rotation = viewer.stage.camera.matrixWorldInverse;
    this.arms.forEach(({ arm, label, group }, axis) => {
      const v = this.vector.set(0, 0, 0).setComponent(axis, 1).transformDirection(rotation);
      arm.setAttribute('x2', (27 * v.x).toFixed(1));
      arm.setAttribute('y2', (-27 * v.y).toFixed(1));
      label.setAttribute('x', (27 * v.x + 18 * Math.sign(Math.round(4 * v.x))).toFixed(1));
      label.setAttribute('y', (-27 * v.y - 9 * (Math.abs(v.y) > 0.2 ? Math.sign(v.y) : 0)).toFixed(1));
      const seen = Math.hypot(v.x, v.y) > 0.25;
      label.style.display = seen ? '' : 'none';
      group.setAttribute('opacity', seen ? '1' : '0.4');
    });
  }
}

/** Which contraction or rest it is, and what has happened last. */
export class Moment {
  readonly element = h('div', { class: 'moment' });
  private shown = '';

  follow(run: RunInfo, time: number): void {
    const text = momentText(run, time);
    if (text === this.shown) return;
    this.shown = text;
    this.element.textContent = text;
  }
}

export function momentText(run: RunInfo, time: number): string {
  const n = run.contractions.filter((c) => c.start_s <= time).length;
  const last = run.contractions[n - 1];
  const parts: string[] = [];
  if (run.contractions.length)
    parts.push(!last ? 'Before the first contraction' : time <= last.end_s ? `Contraction ${n}` : `Rest after contraction ${n}`);
  let before: BirthEvent | null = null;
  for (const event of run.events)
    if (event.event !== 'contraction' && event.time_s <= time && (!before || event.time_s >= before.time_s)) before = event;
  if (before) parts.push(words(before.event));
  return parts.join(' · ');
}

export class MeasureLabel {
  readonly element = h('div', { class: 'measure-label', hidden: true, role: 'status' });
  private at = { x: 0, y: 0 };

  follow(viewer: Viewer): void {
    const { measure } = viewer;
    const shown = measure.complete && viewer.stage.project(measure.middle, this.at);
    this.element.hidden = !shown;
    if (!shown) return;
    const text = `${measure.length_mm.toFixed(1)} mm`;
    if (this.element.textContent !== text) this.element.textContent = text;
    this.element.style.transform = `translate(${this.at.x.toFixed(0)}px, ${this.at.y.toFixed(0)}px) translate(-50%, -150%)`;
  }
}
