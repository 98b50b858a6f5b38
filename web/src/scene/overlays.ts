// SPDX-License-Identifier: Apache-2.0
// Drawn over the organs: the head's trail and axes, a measurement.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  DynamicDrawUsage,
  Group,
  Line,
  LineBasicMaterial,
  LinearFilter,
  Points,
  PointsMaterial,
  Quaternion,
  Vector3,
} from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Run } from '../data/run';
import { locate } from './pick';
import type { MaterialPoint } from './caps';

const over = { depthTest: false, depthWrite: false, transparent: true };

function lineMaterial(color: number, opacity: number): LineBasicMaterial {
  return new LineBasicMaterial({ color, opacity, ...over });
}

const TRAIL = 0xe6501b;
/** Size of dots in CSS pixels. */
const DOT = 11;

const wideLine = (color: number, linewidth: number, opacity: number) => new LineMaterial({ color, linewidth, opacity, ...over });

/** Round dots. */
function dotMaterial(color: number): PointsMaterial {
  const side = 32;
  const pixels = new Uint8Array(4 * side * side);
  for (let i = 0; i < side * side; i++) {
    const r = Math.hypot((i % side) - 15.5, Math.floor(i / side) - 15.5);
    pixels.set([255, 255, 255, Math.round(255 * Math.min(1, Math.max(0, 15.5 - r)))], 4 * i);
  }
  const map = new DataTexture(pixels, side, side);
  map.magFilter = LinearFilter;
  map.needsUpdate = true;
  return new PointsMaterial({ color, size: DOT, sizeAttenuation: false, map, ...over });
}

/** Head's path from the curves: the skull's centre at rest plus its displacement. */
export class Trail {
  readonly object = new Group();
  private axes: LineSegments2;
  private time: Float32Array;
  private path: Float32Array;
  private turns: Float32Array[] | null;
  private past: Line2;
  /** From the last row of the curves to the head. */
  private newest: Line;
  private marker: Points;
  private trail = new Group();
  /** The head's centre now. */
  readonly head = new Vector3();
  private turn = new Quaternion();
  private vector = new Vector3();

  /** Null if the curves do not tell where the head is. */
  static of(run: Run): Trail | null {
    const curves = run.curves;
    const xyz = curves && ['head_x_mm', 'head_y_mm', 'head_z_mm'].map((name) => curves.column(name));
    if (!curves || !xyz || xyz.some((column) => !column) || !run.mesh) return null;
    const centre = headCentre(run);
    return centre ? new Trail(run, xyz as Float32Array[], centre) : null;
  }

  private constructor(run: Run, xyz: Float32Array[], centre: Vector3) {
    const rows = run.curves!.rows;
    this.time = run.curves!.time;
    this.path = new Float32Array(3 * rows);
    for (let i = 0; i < rows; i++) for (let a = 0; a < 3; a++) this.path[3 * i + a] = centre.getComponent(a) + xyz[a][i] / 1000;
    const turns = ['head_turn_x_deg', 'head_turn_y_deg', 'head_turn_z_deg'].map((name) => run.curves!.column(name));
    this.turns = turns.every((column) => column) ? (turns as Float32Array[]) : null;
    const all = new Line2(new LineGeometry().setPositions(this.path), wideLine(TRAIL, 1.5, 0.4));
    this.past = new Line2(new LineGeometry().setPositions(this.path), wideLine(TRAIL, 3, 1));
    const ends = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3).setUsage(DynamicDrawUsage));
    this.newest = new Line(ends, lineMaterial(TRAIL, 1));
    const at = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(3), 3).setUsage(DynamicDrawUsage));
    this.marker = new Points(at, dotMaterial(TRAIL));
    this.trail.add(all, this.past, this.newest, this.marker);
    const arm = 0.075;
    const arms = new LineSegmentsGeometry()
      .setPositions([0, 0, 0, arm, 0, 0, 0, 0, 0, 0, arm, 0, 0, 0, 0, 0, 0, arm])
      .setColors(AXIS_COLOURS.flatMap((c) => [...c, ...c]));
    this.axes = new LineSegments2(arms, new LineMaterial({ vertexColors: true, linewidth: 3, ...over }));
    this.object.add(this.trail, this.axes);
    for (const thing of [all, this.past, this.newest, this.marker, this.axes]) {
      thing.frustumCulled = false;
      thing.renderOrder = 200;
    }
  }

  setPixelRatio(ratio: number): void {
    (this.marker.material as PointsMaterial).size = DOT * ratio;
  }

  show(trail: boolean, axes: boolean): void {
    this.trail.visible = trail;
    this.axes.visible = axes;
  }

  moveTo(time: number): void {
    const rows = this.time.length;
    let i = 0;
    while (i < rows - 2 && this.time[i + 1] <= time) i++;
    const j = Math.min(i + 1, rows - 1);
    const span = this.time[j] - this.time[i];
    const f = span > 0 ? Math.min(1, Math.max(0, (time - this.time[i]) / span)) : 0;
    const lerp = (values: Float32Array, stride = 1, at = 0) =>
      values[stride * i + at] + f * (values[stride * j + at] - values[stride * i + at]);
    this.head.set(lerp(this.path, 3, 0), lerp(this.path, 3, 1), lerp(this.path, 3, 2));
    this.past.geometry.instanceCount = i;
    this.past.visible = i > 0;
    const newest = this.newest.geometry.getAttribute('position') as BufferAttribute;
    newest.setXYZ(0, this.path[3 * i], this.path[3 * i + 1], this.path[3 * i + 2]);
    newest.setXYZ(1, this.head.x, this.head.y, this.head.z);
    newest.needsUpdate = true;
    const marker = this.marker.geometry.getAttribute('position') as BufferAttribute;
    marker.setXYZ(0, this.head.x, this.head.y, this.head.z);
    marker.needsUpdate = true;
    this.axes.position.copy(this.head);
    if (this.turns) {
      // Rotation vector: axis times angle.
      this.vector.set(lerp(this.turns[0]), lerp(this.turns[1]), lerp(this.turns[2])).multiplyScalar(Math.PI / 180);
      const angle = this.vector.length();
      if (angle > 1e-9) this.turn.setFromAxisAngle(this.vector.divideScalar(angle), angle);
      else this.turn.identity();
      this.axes.quaternion.copy(this.turn);
    }
  }

  dispose(): void {
    this.object.removeFromParent();
  }
}

export const AXIS_COLOURS: [number, number, number][] = [
  [0.84, 0.2, 0.1],
  [0.1, 0.55, 0.3],
  [0.1, 0.35, 0.85],
];

function headCentre(run: Run): Vector3 | null {
  const info = run.info.mesh!;
  const named = info.landmarks.find((landmark) => landmark.name === 'head_centre');
  if (named) return new Vector3(...named.position);
  const skull = info.regions.find((region) => region.name === 'skull');
  const surface = run.mesh!.surfaces.find((s) => s.region === skull?.id);
  if (!surface) return null;
  const sum = new Vector3();
  const point = new Vector3();
  for (const node of surface.nodes) sum.add(point.fromArray(run.mesh!.rest, 3 * node));
  return sum.divideScalar(surface.nodes.length);
}

/** Two picked points, the line between them and its length. */
export class Measure {
  readonly object = new Group();
  readonly points: MaterialPoint[] = [];
  private line: Line;
  private dots: Points;
  private places = [new Vector3(), new Vector3()];
  readonly middle = new Vector3();
  length_mm = 0;

  constructor() {
    const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3).setUsage(DynamicDrawUsage));
    this.line = new Line(geometry, lineMaterial(0x111827, 1));
    this.dots = new Points(geometry, dotMaterial(0x111827));
    for (const thing of [this.line, this.dots]) {
      thing.frustumCulled = false;
      thing.renderOrder = 210;
      this.object.add(thing);
    }
    this.clear();
  }

  setPixelRatio(ratio: number): void {
    (this.dots.material as PointsMaterial).size = DOT * ratio;
  }

  setColour(colour: string): void {
    (this.line.material as LineBasicMaterial).color.set(colour);
    (this.dots.material as PointsMaterial).color.set(colour);
  }

  add(point: MaterialPoint): void {
    if (this.points.length === 2) this.points.length = 0;
    this.points.push(point);
  }

  clear(): void {
    this.points.length = 0;
    this.object.visible = false;
  }

  update(nodes: Float32Array): void {
    const n = this.points.length;
    this.object.visible = n > 0;
    if (!n) return;
    const attribute = this.line.geometry.getAttribute('position') as BufferAttribute;
    for (let i = 0; i < n; i++) {
      locate(this.points[i], nodes, this.places[i]);
      attribute.setXYZ(i, this.places[i].x, this.places[i].y, this.places[i].z);
    }
    attribute.needsUpdate = true;
    this.line.geometry.setDrawRange(0, n);
    this.line.visible = n === 2;
    this.length_mm = n === 2 ? 1000 * this.places[0].distanceTo(this.places[1]) : 0;
    this.middle.copy(this.places[0]).lerp(this.places[n - 1], 0.5);
  }

  get complete(): boolean {
    return this.points.length === 2;
  }
}
