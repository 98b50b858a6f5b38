// SPDX-License-Identifier: Apache-2.0
// Integers coded as zigzag byte planes, and the differences that they stand for (docs/reference/report_format.md).

/** n signed integers from `planes` byte planes. */
export function fromPlanes(bytes: Uint8Array, n: number, planes: number): Int32Array {
  if (bytes.length !== n * planes) throw new Error(`${bytes.length} bytes where ${n} integers of ${planes} bytes were announced`);
  const out = new Int32Array(n);
  for (let p = 0; p < planes; p++) {
    const shift = 8 * p;
    const start = p * n;
    for (let i = 0; i < n; i++) out[i] |= bytes[start + i] << shift;
  }
  for (let i = 0; i < n; i++) out[i] = (out[i] >>> 1) ^ -(out[i] & 1);
  return out;
}

/** Turns differences to the value `stride` places before into values, in place. */
export function runningSum(values: Int32Array, stride: number): void {
  for (let i = stride; i < values.length; i++) values[i] += values[i - stride];
}

/** Turns the differences of a chunk of `count` frames of `n` integers into values, in place. `base`: what frame 0 is relative to. */
export function undoTimeDifferences(values: Int32Array, n: number, count: number, order: number, base: Int32Array | null): void {
  if (base) for (let i = 0; i < n; i++) values[i] += base[i];
  for (let k = 1; k < count; k++) {
    const at = k * n;
    if (order === 2 && k > 1) for (let i = 0; i < n; i++) values[at + i] += 2 * values[at - n + i] - values[at - 2 * n + i];
    else for (let i = 0; i < n; i++) values[at + i] += values[at - n + i];
  }
}

export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** The contents of a zlib stream. */
export async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
