// SPDX-License-Identifier: Apache-2.0
// Surfaces of regions: a facet is on the surface of a region if no other tet of that region shares it.

export interface Surface {
  region: number;
  /** Mesh nodes on the surface. */
  nodes: Uint32Array;
  /** Corners of its facets as places in `nodes`, turned outwards. */
  triangles: Uint32Array;
}

// Facets of a tet (a, b, c, d) with positive volume, outwards.
const FACETS = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1];

/** Tets by region: the numbers of the tets in the order of their regions, and where each region starts. */
export interface Grouped {
  regions: Int32Array;
  start: Uint32Array;
  tets: Uint32Array;
}

export function groupByRegion(region: Int32Array): Grouped {
  const counts = new Map<number, number>();
  for (const r of region) counts.set(r, (counts.get(r) ?? 0) + 1);
  const regions = Int32Array.from([...counts.keys()].sort((a, b) => a - b));
  const start = new Uint32Array(regions.length + 1);
  const next = new Map<number, number>();
  regions.forEach((r, k) => {
    next.set(r, start[k]);
    start[k + 1] = start[k] + counts.get(r)!;
  });
  const tets = new Uint32Array(region.length);
  for (let t = 0; t < region.length; t++) {
    const at = next.get(region[t])!;
    tets[at] = t;
    next.set(region[t], at + 1);
  }
  return { regions, start, tets };
}

/** The surface of the region whose tets are `tets`. Cost: linear in the number of tets, by a hash table of facets. */
export function surfaceOf(region: number, corners: Uint32Array, tets: Uint32Array): Surface {
  const facets = 4 * tets.length;
  let size = 16;
  while (size < 2 * facets) size *= 2;
  const table = new Int32Array(size).fill(-1);
  const inner = new Uint8Array(facets);
  const key = new Uint32Array(3 * facets);
  for (let t = 0, f = 0; t < tets.length; t++) {
    const at = 4 * tets[t];
    for (let k = 0; k < 12; k += 3, f++) {
      const a = corners[at + FACETS[k]];
      const b = corners[at + FACETS[k + 1]];
      const c = corners[at + FACETS[k + 2]];
      const low = Math.min(a, b, c);
      const high = Math.max(a, b, c);
      const middle = a + b + c - low - high;
      key[3 * f] = low;
      key[3 * f + 1] = middle;
      key[3 * f + 2] = high;
      let slot = (Math.imul(low, 73856093) ^ Math.imul(middle, 19349663) ^ Math.imul(high, 83492791)) & (size - 1);
      for (; table[slot] >= 0; slot = (slot + 1) & (size - 1)) {
        const g = table[slot];
        if (key[3 * g] === low && key[3 * g + 1] === middle && key[3 * g + 2] === high) {
          inner[f] = inner[g] = 1;
          break;
        }
      }
      if (table[slot] < 0) table[slot] = f;
    }
  }
  const place = new Map<number, number>();
  const triangles: number[] = [];
  for (let t = 0, f = 0; t < tets.length; t++) {
    for (let k = 0; k < 12; k += 3, f++) {
      if (inner[f]) continue;
      for (let i = 0; i < 3; i++) {
        const node = corners[4 * tets[t] + FACETS[k + i]];
        let at = place.get(node);
        if (at === undefined) place.set(node, (at = place.size));
        triangles.push(at);
      }
    }
  }
  return { region, nodes: Uint32Array.from(place.keys()), triangles: Uint32Array.from(triangles) };
}
