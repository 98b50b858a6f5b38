// SPDX-License-Identifier: Apache-2.0
// The surface of one organ. Its buffers are made once and written in place for every picture.
import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, FrontSide, Group, Mesh, ShaderMaterial, Sphere, Vector3 } from 'three';
import type { Surface } from '../data/surface';
import { organMaterial, setOpacity, type SharedUniforms } from './material';

export class Organ {
  readonly object = new Group();
  readonly material: ShaderMaterial;
  private geometry = new BufferGeometry();
  private position: BufferAttribute;
  private normal: BufferAttribute;
  private scalar: BufferAttribute;
  private depthFirst: Mesh;
  private surfaceMesh: Mesh;

  constructor(
    readonly surface: Surface,
    shared: SharedUniforms,
    colour: string,
    opacity: number,
    order: number,
  ) {
    const n = surface.nodes.length;
    this.position = new BufferAttribute(new Float32Array(3 * n), 3).setUsage(DynamicDrawUsage);
    this.normal = new BufferAttribute(new Float32Array(3 * n), 3).setUsage(DynamicDrawUsage);
    this.scalar = new BufferAttribute(new Float32Array(n), 1).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute('position', this.position);
    this.geometry.setAttribute('normal', this.normal);
    this.geometry.setAttribute('scalar', this.scalar);
    this.geometry.setIndex(new BufferAttribute(n < 65536 ? Uint16Array.from(surface.triangles) : surface.triangles, 1));
    this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    this.material = organMaterial(shared, colour, opacity);
    // A translucent organ shows its nearest surface only: its depth is drawn first, its colour where that depth is.
    const depthOnly = this.material.clone();
    depthOnly.colorWrite = false;
    depthOnly.uniforms = this.material.uniforms;
    this.depthFirst = new Mesh(this.geometry, depthOnly);
    this.surfaceMesh = new Mesh(this.geometry, this.material);
    for (const mesh of [this.depthFirst, this.surfaceMesh]) mesh.frustumCulled = false;
    this.depthFirst.renderOrder = 10 * order;
    this.surfaceMesh.renderOrder = 10 * order + 1;
    this.object.add(this.depthFirst, this.surfaceMesh);
    this.setOpacity(opacity);
  }

  /** Organs are drawn in this order, and each translucent one after those inside it. */
  setOpacity(opacity: number): void {
    setOpacity(this.material, opacity);
    this.depthFirst.visible = this.material.transparent;
    (this.depthFirst.material as ShaderMaterial).transparent = this.material.transparent;
  }

  /** Seen through everything, edges more than faces: for comparison with what is drawn solid. */
  makeGhost(): void {
    this.material.depthTest = this.material.depthWrite = false;
    this.material.side = FrontSide;
    this.depthFirst.visible = false;
  }

  setColour(colour: string): void {
    (this.material.uniforms.colour.value as Color).set(colour);
  }

  set clipped(on: boolean) {
    this.material.uniforms.clipped.value = on ? 1 : 0;
  }

  /** Takes the organ's nodes from the mesh's positions, and its normals from its facets (weighted by area). */
  update(nodes: Float32Array): void {
    const x = this.position.array as Float32Array;
    const n = this.normal.array as Float32Array;
    const { nodes: own, triangles } = this.surface;
    for (let i = 0, k = 0; i < own.length; i++, k += 3) {
      const from = 3 * own[i];
      x[k] = nodes[from];
      x[k + 1] = nodes[from + 1];
      x[k + 2] = nodes[from + 2];
    }
    n.fill(0);
    for (let f = 0; f < triangles.length; f += 3) {
      const a = 3 * triangles[f];
      const b = 3 * triangles[f + 1];
      const c = 3 * triangles[f + 2];
      const ux = x[b] - x[a];
      const uy = x[b + 1] - x[a + 1];
      const uz = x[b + 2] - x[a + 2];
      const vx = x[c] - x[a];
      const vy = x[c + 1] - x[a + 1];
      const vz = x[c + 2] - x[a + 2];
      // Metres squared are small; the scale keeps them from vanishing in the shader's normalisation.
      const nx = 1e4 * (uy * vz - uz * vy);
      const ny = 1e4 * (uz * vx - ux * vz);
      const nz = 1e4 * (ux * vy - uy * vx);
      n[a] += nx;
      n[a + 1] += ny;
      n[a + 2] += nz;
      n[b] += nx;
      n[b + 1] += ny;
      n[b + 2] += nz;
      n[c] += nx;
      n[c + 1] += ny;
      n[c + 2] += nz;
    }
    this.position.needsUpdate = true;
    this.normal.needsUpdate = true;
  }

  updateScalar(values: Float32Array): void {
    const s = this.scalar.array as Float32Array;
    const own = this.surface.nodes;
    for (let i = 0; i < own.length; i++) s[i] = values[own[i]];
    this.scalar.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
    (this.depthFirst.material as ShaderMaterial).dispose();
  }
}
