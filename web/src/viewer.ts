// SPDX-License-Identifier: Apache-2.0
// The 3-D part: what is shown, how, and at which moment. Knows the scene; the panels know it.
import { Ray, Vector2, Vector3 } from 'three';
import type { Clock } from './clock';
import type { Field, Region } from './data/format';
import type { Run } from './data/run';
import { Body } from './scene/body';
import type { CutPlane } from './scene/caps';
import { SharedUniforms } from './scene/material';
import { Measure, Trail } from './scene/overlays';
import type { Look } from './scene/palette';
import { pick } from './scene/pick';
import { Stage, type ViewName } from './scene/stage';

export type Axis = 'sagittal' | 'coronal' | 'axial';
export const AXES: Record<Axis, { label: string; index: 0 | 1 | 2; low: string; high: string; view: ViewName; flippedView: ViewName }> = {
  coronal: { label: 'Coronal', index: 1, low: 'back', high: 'front', view: 'front', flippedView: 'back' },
  sagittal: { label: 'Sagittal', index: 0, low: 'left', high: 'right', view: 'right', flippedView: 'left' },
  axial: { label: 'Axial', index: 2, low: 'caudal', high: 'cranial', view: 'above', flippedView: 'vulva' },
};

export interface Cut {
  axis: Axis;
  /** Where along the axis [mm]. */
  at_mm: number;
  flipped: boolean;
  wholeFetus: boolean;
}

/** What a person has chosen; survives a new state of a running birth. */
export class Choices {
  looks = new Map<string, Look>();
  field = '';
  cut: Cut | null = null;
  lastCut: Partial<Record<Axis, number>> = {};
  flipped = false;
  wholeFetus = false;
  trail = true;
  axes = false;
  ghost: number | null = null;
  pose: { position: number[]; target: number[] } | null = null;
  time = 0;
  /** Of a birth in progress: show what is new without asking. */
  follow = false;
}

const GHOST_COLOUR = '#1f78d1';

export class Viewer {
  readonly stage: Stage;
  body!: Body;
  ghost: Body | null = null;
  readonly measure = new Measure();
  measuring = false;
  private trail: Trail | null = null;
  private shared = new SharedUniforms();
  private ghostShared = new SharedUniforms();
  private moved = true;
  private bounds_mm: [number, number][] = [];
  private listeners: (() => void)[] = [];
  private waitingView = true;
  private field: Field | undefined;

  constructor(
    host: HTMLElement,
    readonly runs: Run[],
    private clock: Clock,
    readonly choices: Choices,
  ) {
    this.stage = new Stage(host);
    this.stage.scene.add(this.measure.object);
    clock.onChange(() => (this.moved = true));
    this.pickOnClick();
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  /** Something was chosen: the panels follow, and the picture. */
  changed(): void {
    this.moved = true;
    for (const listener of this.listeners) listener();
  }

  /** Shows `run`, whose mesh is open. */
  show(run: Run): void {
    this.body?.dispose();
    this.trail?.dispose();
    this.measure.clear();
    this.body = new Body(run, this.shared, this.choices.looks, null);
    this.stage.scene.add(this.body.object);
    this.trail = Trail.of(run);
    if (this.trail) this.stage.scene.add(this.trail.object);
    run.onChange = (error) => this.arrived(error);
    this.setField(this.choices.field);
    this.fit();
    if (this.choices.pose) {
      this.stage.setPose(this.choices.pose);
      this.waitingView = false;
    }
    this.changed();
  }

  onError: (error: Error) => void = () => undefined;

  /** Called when a piece has been decoded, or could not be. */
  onDecoded: () => void = () => undefined;

  private arrived(error?: Error): void {
    if (error) this.onError(error);
    if (this.waiting || (this.ghost && !this.ghost.current)) this.moved = true;
    this.load();
    this.onDecoded();
  }

  /** Whether something is shown that is not decoded yet. */
  get waiting(): boolean {
    return !this.body.current || (this.field !== undefined && !this.body.fieldCurrent);
  }

  private load(): void {
    this.body.run.loadAround(this.clock.time, this.choices.field);
    this.ghost?.run.loadAround(this.clock.time, '');
  }

  /** Measures what there is to see, and frames it the first time. */
  fit(): void {
    const box = this.body.bounds();
    this.stage.setBounds(box);
    this.bounds_mm = [0, 1, 2].map((a) => [Math.floor(1000 * box.min.getComponent(a)), Math.ceil(1000 * box.max.getComponent(a))]);
    if (this.waitingView) this.stage.look('oblique', false);
    this.waitingView = false;
  }

  get fieldShown(): Field | undefined {
    return this.field;
  }
  get hasTrail(): boolean {
    return this.trail !== null;
  }

  setField(name: string): void {
    this.field = this.body.run.field(name);
    this.choices.field = this.field ? name : '';
    this.shared.mapped.value = this.field ? 1 : 0;
    if (this.field) this.shared.range.value.set(this.field.scale[0], this.field.scale[1]);
    this.changed();
  }

  setGhost(run: Run | null): void {
    this.ghost?.dispose();
    this.ghost = null;
    this.choices.ghost = run ? run.index : null;
    if (run?.mesh) {
      this.ghost = new Body(run, this.ghostShared, this.choices.looks, GHOST_COLOUR);
      this.stage.scene.add(this.ghost.object);
      run.onChange = (error) => this.arrived(error);
    }
    this.changed();
  }

  applyLooks(): void {
    this.body.applyLooks();
    this.ghost?.applyLooks();
    this.changed();
  }

  range(axis: Axis): [number, number] {
    return this.bounds_mm[AXES[axis].index] ?? [-100, 100];
  }

  setCut(axis: Axis | null): void {
    const before = this.choices.cut;
    if (before) this.choices.lastCut[before.axis] = before.at_mm;
    if (!axis) this.choices.cut = null;
    else {
      const [low, high] = this.range(axis);
      const middle = axis === 'axial' ? 0.5 * (low + high) : 0;
      const at_mm = this.choices.lastCut[axis] ?? Math.min(high, Math.max(low, middle));
      this.choices.cut = { axis, at_mm, flipped: this.choices.flipped, wholeFetus: this.choices.wholeFetus };
      this.faceCut();
    }
    this.changed();
  }

  /** Turns the camera so that it looks onto the cut. */
  faceCut(): void {
    const cut = this.choices.cut;
    if (!cut) return;
    const axis = AXES[cut.axis];
    this.stage.look(cut.flipped ? axis.flippedView : axis.view);
  }

  changeCut(change: Partial<Cut>): void {
    if (!this.choices.cut) return;
    Object.assign(this.choices.cut, change);
    this.choices.flipped = this.choices.cut.flipped;
    this.choices.wholeFetus = this.choices.cut.wholeFetus;
    this.changed();
  }

  private planeNow: CutPlane = { x: 0, y: 0, z: 0, offset: 0 };
  private plane(): CutPlane | null {
    const cut = this.choices.cut;
    if (!cut) return null;
    const sign = cut.flipped ? -1 : 1;
    const index = AXES[cut.axis].index;
    this.planeNow.x = index === 0 ? sign : 0;
    this.planeNow.y = index === 1 ? sign : 0;
    this.planeNow.z = index === 2 ? sign : 0;
    // A hair off whole millimetres, where symmetric meshes have whole sheets of nodes.
    this.planeNow.offset = (sign * (cut.at_mm + 0.013)) / 1000;
    return this.planeNow;
  }

  private whole = (region: Region): boolean => this.choices.cut?.wholeFetus === true && region.kind === 'fetus';

  /** Brings the scene to the clock's time and to what is chosen, if anything changed. */
  private update(): void {
    if (!this.moved) return;
    const { time } = this.clock;
    this.moved = false;
    const plane = this.plane();
    if (plane) this.shared.clip.value.set(plane.x, plane.y, plane.z, plane.offset);
    this.body.moveTo(time, this.field);
    this.body.cut(plane, this.whole);
    this.ghost?.moveTo(time, undefined);
    if (this.trail) {
      this.trail.moveTo(time);
      this.trail.show(this.choices.trail, this.choices.axes);
    }
    this.measure.update(this.body.nodes);
    this.stage.redraw();
  }

  /** Loads what is missing, updates the scene and draws. */
  tick(now: number, seconds: number): void {
    this.load();
    this.update();
    this.trail?.setPixelRatio(this.stage.pixelRatio);
    this.measure.setPixelRatio(this.stage.pixelRatio);
    this.stage.tick(now, seconds);
  }

  /** A click without a drag picks, while measuring. */
  private pickOnClick(): void {
    const canvas = this.stage.canvas;
    const start = new Vector2();
    canvas.addEventListener('pointerdown', (event) => start.set(event.clientX, event.clientY));
    canvas.addEventListener('pointerup', (event) => {
      if (!this.measuring || event.button !== 0 || Math.hypot(event.clientX - start.x, event.clientY - start.y) > 4) return;
      const box = canvas.getBoundingClientRect();
      this.pickAt((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    });
  }

  /** Picks at a place of the picture, 0…1 from its upper left. */
  pickAt(x: number, y: number): void {
    this.update();
    const { camera } = this.stage;
    camera.updateMatrixWorld();
    const plane = this.plane();
    const at = (u: number, v: number) => {
      const direction = new Vector3(2 * u - 1, 1 - 2 * v, 0.5).unproject(camera).sub(camera.position).normalize();
      return pick(this.body, new Ray(camera.position.clone(), direction), plane, (entry) => this.whole(entry.region));
    };
    // A ray exactly through an edge may slip between its two facets: then one beside it, less than a pixel away.
    const hit = at(x, y) ?? at(x + 3e-4, y + 2e-4);
    if (!hit) return;
    this.measure.add(hit.point);
    this.changed();
  }

  setMeasuring(on: boolean): void {
    this.measuring = on;
    if (!on) this.measure.clear();
    this.stage.canvas.classList.toggle('picking', on);
    this.changed();
  }

  dispose(): void {
    this.choices.pose = this.stage.pose();
    this.body?.dispose();
    this.ghost?.dispose();
    this.stage.dispose();
  }
}
