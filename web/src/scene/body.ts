// SPDX-License-Identifier: Apache-2.0
// One run's organs at a moment: positions between frames, colours by a field, the cut.
import { Box3, Color, Group, Vector3 } from 'three';
import type { Field, Region } from '../data/format';
import type { Run } from '../data/run';
import { Caps, type CutPlane } from './caps';
import type { SharedUniforms } from './material';
import { Organ } from './organ';
import { drawingOrder, lookOf, type Look } from './palette';

export interface OrganEntry {
  region: Region;
  organ: Organ;
  look: Look;
  capColour: Color;
}

/** Bones are rigid: they keep their colour when values are shown, and give the rest its place. */
const keepsColour = (region: Region): boolean => region.kind === 'bone';

export class Body {
  readonly object = new Group();
  readonly entries: OrganEntry[] = [];
  /** Positions now [m]. */
  readonly nodes: Float32Array;
  /** Values of the field shown now. */
  readonly values: Float32Array;
  readonly caps: Caps;
  /** Whether `nodes` are those of the time last asked for. */
  current = false;
  private valuesCurrent = false;
  private byRegion = new Map<number, OrganEntry>();
  private time = 0;

  constructor(
    readonly run: Run,
    shared: SharedUniforms,
    looks: Map<string, Look>,
    private ghostColour: string | null,
  ) {
    const mesh = run.mesh!;
    this.nodes = mesh.rest.slice();
    this.values = new Float32Array(mesh.rest.length / 3);
    this.caps = new Caps(mesh, shared);
    this.caps.object.visible = false;
    for (const surface of mesh.surfaces) {
      const region = run.info.mesh!.regions.find((r) => r.id === surface.region) ?? {
        id: surface.region,
        name: `region_${surface.region}`,
        label: `Region ${surface.region}`,
        organ: '',
        kind: '',
      };
      let look = looks.get(region.name);
      if (!look) looks.set(region.name, (look = lookOf(region)));
      const order = ghostColour ? 8 : Math.max(0, drawingOrder(region));
      const organ = new Organ(surface, shared, ghostColour ?? look.colour, ghostColour ? 0.26 : look.opacity, order);
      if (ghostColour) {
        organ.material.uniforms.mapped = { value: 0 };
        organ.makeGhost();
      } else if (keepsColour(region)) organ.material.uniforms.mapped = { value: 0 };
      const entry = { region, organ, look, capColour: new Color(look.colour) };
      this.entries.push(entry);
      this.byRegion.set(region.id, entry);
      this.object.add(organ.object);
      organ.update(this.nodes);
    }
    this.object.add(this.caps.object);
    this.applyLooks();
  }

  /** Takes over visibility, colour and opacity. */
  applyLooks(): void {
    for (const { organ, look, region, capColour } of this.entries) {
      capColour.set(look.colour);
      if (this.ghostColour) {
        // The ghost is of what one compares: not of what would hide it.
        organ.object.visible = look.visible && region.kind === 'fetus' && region.name === 'fetal_skin';
        continue;
      }
      organ.object.visible = look.visible && look.opacity > 0.01;
      organ.setColour(look.colour);
      organ.setOpacity(look.opacity);
    }
    if (this.ghostColour && !this.entries.some((entry) => entry.organ.object.visible))
      for (const { organ, look } of this.entries) organ.object.visible = look.visible;
  }

  /** Moves to `time`; what is not decoded yet stays as it was, and `current` says so. */
  moveTo(time: number, field: Field | undefined): void {
    this.time = time;
    this.current = this.run.positionsAt(time, this.nodes);
    if (this.current) for (const { organ } of this.entries) if (organ.object.visible) organ.update(this.nodes);
    this.colourBy(field);
  }

  private colourBy(field: Field | undefined): void {
    this.valuesCurrent = field !== undefined && this.run.fieldAt(field, this.time, this.nodes, this.values);
    if (this.valuesCurrent) for (const { organ } of this.entries) if (organ.object.visible) organ.updateScalar(this.values);
  }

  get fieldCurrent(): boolean {
    return this.valuesCurrent;
  }

  private whole: (region: Region) => boolean = () => false;
  private capColourOf = (id: number): Color | null => {
    const entry = this.byRegion.get(id)!;
    return entry.organ.object.visible && !this.whole(entry.region) ? entry.capColour : null;
  };
  private plainOf = (id: number): boolean => keepsColour(this.byRegion.get(id)!.region);

  /** Cuts by `plane` (null: not at all) the organs for which `whole` is false. */
  cut(plane: CutPlane | null, whole: (region: Region) => boolean): void {
    this.caps.object.visible = plane !== null && this.ghostColour === null;
    for (const { organ, region } of this.entries) organ.clipped = plane !== null && !whole(region);
    if (!plane || this.ghostColour) return;
    this.whole = whole;
    this.caps.update(this.nodes, this.valuesCurrent ? this.values : null, plane, this.capColourOf, this.plainOf);
  }

  /** The space that the organs take at rest and at the first and last frames that are decoded. */
  bounds(): Box3 {
    const box = new Box3();
    const point = new Vector3();
    const add = (nodes: Float32Array, from: number, to: number) => {
      for (let k = from; k < to; k += 3) box.expandByPoint(point.set(nodes[k], nodes[k + 1], nodes[k + 2]));
    };
    const rest = this.run.mesh!.rest;
    add(rest, 0, rest.length);
    for (const frame of [0, this.run.times.length - 1]) {
      const here = this.run.positions?.at(frame);
      if (here) add(here.values, here.offset, here.offset + rest.length);
    }
    return box;
  }

  dispose(): void {
    for (const { organ } of this.entries) organ.dispose();
    this.caps.dispose();
    this.object.removeFromParent();
  }
}
