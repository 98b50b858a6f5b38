// SPDX-License-Identifier: Apache-2.0
// The cut itself: every tet that the clip plane crosses gives one or two triangles on the plane (marching tetrahedra), in the colour of
// its organ, and every facet of a surface that it crosses a piece of outline. Buffers grow when needed and are otherwise reused.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  ShaderMaterial,
  Sphere,
  Vector3,
} from 'three';
import type { MeshAnswer } from '../data/worker';
import { capMaterial, type SharedUniforms } from './material';

/** A point of the material: weights of up to four mesh nodes. */
export interface MaterialPoint {
  nodes: [number, number, number, number];
  weights: [number, number, number, number];
}

export interface CutPlane {
  x: number;
  y: number;
  z: number;
  /** Points with n·x above this are taken away. */
  offset: number;
}

/** The shader's sign for a vertex that keeps its organ's colour whatever is mapped. */
const NO_VALUE = -1e9;

export class Caps {
  readonly object = new Group();
  private material: ShaderMaterial;
  private geometry = new BufferGeometry();
  private outline = new BufferGeometry();
  private distance: Float32Array;
  private position = new Float32Array(0);
  private tint = new Float32Array(0);
  private scalar = new Float32Array(0);
  private edge = new Float32Array(0);
  private lines: LineSegments;
  /** Vertices of the caps now. */
  count = 0;
  private plain = false;
  /** The tet that each cap triangle was cut from. */
  private owner = new Uint32Array(0);

  constructor(
    private mesh: MeshAnswer,
    shared: SharedUniforms,
  ) {
    this.distance = new Float32Array(mesh.rest.length / 3);
    this.material = capMaterial(shared);
    for (const geometry of [this.geometry, this.outline]) geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    this.grow(3 * 4096);
    this.growEdge(2 * 4096);
    const faces = new Mesh(this.geometry, this.material);
    this.lines = new LineSegments(this.outline, new LineBasicMaterial({ color: 0x1b2230, transparent: true, opacity: 0.75 }));
    faces.frustumCulled = this.lines.frustumCulled = false;
    faces.renderOrder = 0;
    this.lines.renderOrder = 1;
    this.object.add(faces, this.lines);
  }

  private grow(vertices: number): void {
    const copy = <A extends Float32Array | Uint32Array>(to: A, from: A) => (to.set(from as never), to);
    this.position = copy(new Float32Array(3 * vertices), this.position);
    this.tint = copy(new Float32Array(3 * vertices), this.tint);
    this.scalar = copy(new Float32Array(vertices), this.scalar);
    this.owner = copy(new Uint32Array(vertices / 3), this.owner);
    this.geometry.dispose();
    this.geometry.setAttribute('position', new BufferAttribute(this.position, 3).setUsage(DynamicDrawUsage));
    this.geometry.setAttribute('tint', new BufferAttribute(this.tint, 3).setUsage(DynamicDrawUsage));
    this.geometry.setAttribute('scalar', new BufferAttribute(this.scalar, 1).setUsage(DynamicDrawUsage));
  }

  private growEdge(vertices: number): void {
    const bigger = new Float32Array(3 * vertices);
    bigger.set(this.edge);
    this.edge = bigger;
    this.outline.dispose();
    this.outline.setAttribute('position', new BufferAttribute(bigger, 3).setUsage(DynamicDrawUsage));
  }

  /** Cuts the regions for which `colour` gives one. `values`: nodal values for the colour scale, or null; those of `plain` keep their colour. */
  update(
    nodes: Float32Array,
    values: Float32Array | null,
    plane: CutPlane,
    colour: (region: number) => Color | null,
    plain: (region: number) => boolean,
  ): void {
    const d = this.distance;
    for (let i = 0, k = 0; i < d.length; i++, k += 3)
      d[i] = plane.x * nodes[k] + plane.y * nodes[k + 1] + plane.z * nodes[k + 2] - plane.offset;
    const { corners, grouped } = this.mesh;
    this.count = 0;
    for (let g = 0; g < grouped.regions.length; g++) {
      const c = colour(grouped.regions[g]);
      if (!c) continue;
      this.plain = plain(grouped.regions[g]);
      for (let at = grouped.start[g]; at < grouped.start[g + 1]; at++) {
        const t = grouped.tets[at];
        const k = 4 * t;
        const above =
          (d[corners[k]] > 0 ? 1 : 0) | (d[corners[k + 1]] > 0 ? 2 : 0) | (d[corners[k + 2]] > 0 ? 4 : 0) | (d[corners[k + 3]] > 0 ? 8 : 0);
        if (above !== 0 && above !== 15) this.cut(t, above, nodes, values, c);
      }
    }
    const line = this.lines.material as LineBasicMaterial;
    line.color.setHex(values ? 0xffffff : 0x1b2230);
    line.opacity = values ? 0.55 : 0.75;
    this.geometry.setDrawRange(0, this.count);
    for (const name of ['position', 'tint', 'scalar']) {
      const attribute = this.geometry.getAttribute(name) as BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
    this.outlines(nodes, colour);
  }

  /** Adds the triangles that the plane cuts from tet t; `above` holds a bit per corner beyond the plane. */
  private cut(t: number, above: number, nodes: Float32Array, values: Float32Array | null, colour: Color): void {
    const { corners } = this.mesh;
    const k = 4 * t;
    let ups = 0;
    for (let i = 0; i < 4; i++) ups += (above >> i) & 1;
    // One corner apart from the other three, or two and two: then the four crossed edges in the order that goes round.
    if (ups !== 2) {
      const bit = ups === 1 ? above : 15 ^ above;
      const lone = bit === 1 ? 0 : bit === 2 ? 1 : bit === 4 ? 2 : 3;
      this.begin(t);
      for (let i = 0; i < 4; i++) if (i !== lone) this.crossing(corners[k + lone], corners[k + i], nodes, values, colour);
      return;
    }
    let a = -1;
    let b = -1;
    let c = -1;
    let e = -1;
    for (let i = 0; i < 4; i++) {
      if ((above >> i) & 1) {
        if (a < 0) a = corners[k + i];
        else b = corners[k + i];
      } else if (c < 0) c = corners[k + i];
      else e = corners[k + i];
    }
    this.begin(t);
    this.crossing(a, c, nodes, values, colour);
    this.crossing(a, e, nodes, values, colour);
    this.crossing(b, e, nodes, values, colour);
    this.begin(t);
    this.crossing(a, c, nodes, values, colour);
    this.crossing(b, e, nodes, values, colour);
    this.crossing(b, c, nodes, values, colour);
  }

  private begin(tet: number): void {
    if (this.count + 3 > this.scalar.length) this.grow(2 * this.scalar.length);
    this.owner[this.count / 3] = tet;
  }

  private crossing(i: number, j: number, nodes: Float32Array, values: Float32Array | null, colour: Color): void {
    const f = this.distance[i] / (this.distance[i] - this.distance[j]);
    const at = 3 * this.count;
    for (let axis = 0; axis < 3; axis++) this.position[at + axis] = nodes[3 * i + axis] + f * (nodes[3 * j + axis] - nodes[3 * i + axis]);
    this.tint[at] = colour.r;
    this.tint[at + 1] = colour.g;
    this.tint[at + 2] = colour.b;
    this.scalar[this.count] = this.plain ? NO_VALUE : values ? values[i] + f * (values[j] - values[i]) : 0;
    this.count++;
  }

  private outlines(nodes: Float32Array, colour: (region: number) => Color | null): void {
    const d = this.distance;
    let n = 0;
    for (const surface of this.mesh.surfaces) {
      if (!colour(surface.region)) continue;
      const own = surface.nodes;
      const triangles = surface.triangles;
      for (let f = 0; f < triangles.length; f += 3) {
        const a = own[triangles[f]];
        const b = own[triangles[f + 1]];
        const c = own[triangles[f + 2]];
        const [p, q, r] = [d[a] > 0, d[b] > 0, d[c] > 0];
        if (p === q && q === r) continue;
        if (3 * (n + 2) > this.edge.length) this.growEdge((2 * this.edge.length) / 3);
        if (p !== q) n = this.edgePoint(a, b, nodes, n);
        if (q !== r) n = this.edgePoint(b, c, nodes, n);
        if (r !== p) n = this.edgePoint(c, a, nodes, n);
      }
    }
    this.outline.setDrawRange(0, n);
    const attribute = this.outline.getAttribute('position') as BufferAttribute;
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, 3 * n);
    attribute.needsUpdate = true;
  }

  private edgePoint(i: number, j: number, nodes: Float32Array, n: number): number {
    const f = this.distance[i] / (this.distance[i] - this.distance[j]);
    for (let axis = 0; axis < 3; axis++) this.edge[3 * n + axis] = nodes[3 * i + axis] + f * (nodes[3 * j + axis] - nodes[3 * i + axis]);
    return n + 1;
  }

  /** Triangle k of the caps: where its corners are in `positions`, and its tet. */
  get triangles(): { positions: Float32Array; owner: Uint32Array; count: number } {
    return { positions: this.position, owner: this.owner, count: this.count / 3 };
  }

  dispose(): void {
    this.geometry.dispose();
    this.outline.dispose();
    this.material.dispose();
    (this.lines.material as LineBasicMaterial).dispose();
  }
}
