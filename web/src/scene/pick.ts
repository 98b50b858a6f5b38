// SPDX-License-Identifier: Apache-2.0
// What is under the pointer: a point of the material, so that a measurement goes along with the motion.
import { Ray, Vector3 } from 'three';
import type { Body, OrganEntry } from './body';
import type { CutPlane, MaterialPoint } from './caps';

export interface Hit {
  point: MaterialPoint;
  entry: OrganEntry | null;
  distance: number;
}

/** Organs below this opacity are looked through if something more solid is behind them. */
const SOLID = 0.5;

const [A, B, C, AT] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];

/** The nearest point that `ray` meets on what is drawn of `body`; null if none. `plane` cuts the organs for which `whole` is false. */
export function pick(body: Body, ray: Ray, plane: CutPlane | null, whole: (entry: OrganEntry) => boolean): Hit | null {
  const found: { [solid: string]: Hit | null } = { true: null, false: null };
  const keep = (solid: boolean, hit: Hit) => {
    const before = found[String(solid)];
    if (!before || hit.distance < before.distance) found[String(solid)] = hit;
  };
  for (const entry of body.entries) {
    if (!entry.organ.object.visible) continue;
    const { nodes, triangles } = entry.organ.surface;
    const cut = plane && !whole(entry) ? plane : null;
    for (let f = 0; f < triangles.length; f += 3) {
      const [i, j, k] = [nodes[triangles[f]], nodes[triangles[f + 1]], nodes[triangles[f + 2]]];
      A.fromArray(body.nodes, 3 * i);
      B.fromArray(body.nodes, 3 * j);
      C.fromArray(body.nodes, 3 * k);
      if (!ray.intersectTriangle(A, B, C, false, AT)) continue;
      if (cut && AT.x * cut.x + AT.y * cut.y + AT.z * cut.z > cut.offset) continue;
      const [u, v, w] = barycentric(AT);
      keep(entry.look.opacity >= SOLID, {
        point: { nodes: [i, j, k, i], weights: [u, v, w, 0] },
        entry,
        distance: ray.origin.distanceTo(AT),
      });
    }
  }
  if (plane && body.caps.object.visible) {
    const { positions, owner, count } = body.caps.triangles;
    for (let t = 0; t < count; t++) {
      A.fromArray(positions, 9 * t);
      B.fromArray(positions, 9 * t + 3);
      C.fromArray(positions, 9 * t + 6);
      if (!ray.intersectTriangle(A, B, C, false, AT)) continue;
      const corners = body.run.mesh!.corners.subarray(4 * owner[t], 4 * owner[t] + 4);
      const point: MaterialPoint = { nodes: [corners[0], corners[1], corners[2], corners[3]], weights: inTet(body.nodes, corners, AT) };
      keep(true, { point, entry: null, distance: ray.origin.distanceTo(AT) });
    }
  }
  return found.true ?? found.false;
}

/** Weights of A, B, C at a point of their plane. */
function barycentric(p: Vector3): [number, number, number] {
  const ab = B.clone().sub(A);
  const ac = C.clone().sub(A);
  const ap = p.clone().sub(A);
  const n = ab.clone().cross(ac);
  const area = n.lengthSq();
  const v = ap.clone().cross(ac).dot(n) / area;
  const w = ab.cross(ap).dot(n) / area;
  return [1 - v - w, v, w];
}

/** Weights of a tet's corners at a point in it. */
function inTet(nodes: Float32Array, corners: Uint32Array, p: Vector3): [number, number, number, number] {
  const at = (i: number) => new Vector3().fromArray(nodes, 3 * corners[i]);
  const a = at(0);
  const [b, c, d] = [at(1).sub(a), at(2).sub(a), at(3).sub(a)];
  const q = p.clone().sub(a);
  const volume = b.dot(c.clone().cross(d));
  const wb = q.dot(c.clone().cross(d)) / volume;
  const wc = b.dot(q.clone().cross(d)) / volume;
  const wd = b.dot(c.clone().cross(q)) / volume;
  return [1 - wb - wc - wd, wb, wc, wd];
}

/** Where a point of the material is now. */
export function locate(point: MaterialPoint, nodes: Float32Array, out: Vector3): Vector3 {
  out.set(0, 0, 0);
  for (let i = 0; i < 4; i++) {
    const k = 3 * point.nodes[i];
    out.x += point.weights[i] * nodes[k];
    out.y += point.weights[i] * nodes[k + 1];
    out.z += point.weights[i] * nodes[k + 2];
  }
  return out;
}
