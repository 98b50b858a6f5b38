// SPDX-License-Identifier: Apache-2.0
// Decoding, off the main thread: inflates, undoes the differences, finds the surfaces. One answer per question, in order.
import { fromBase64, fromPlanes, inflate, runningSum, undoTimeDifferences } from './codec';
import { groupByRegion, surfaceOf, type Grouped, type Surface } from './surface';

/** A compressed blob: base64 text from the page or bytes fetched from a server. */
export type Source = string | ArrayBuffer;
export interface Part {
  source: Source;
  planes: number;
}
export type Question =
  | { task: 'mesh'; run: number; nodes: number; tets: number; quantum: number; corners: Part; region: Part; rest: Part }
  | { task: 'positions'; run: number; part: Part; count: number; order: number }
  | { task: 'field'; run: number; part: Part; count: number; order: number; offset: number; quantum: number }
  | { task: 'curves'; source: Source; values: number };
export interface MeshAnswer {
  corners: Uint32Array;
  rest: Float32Array;
  grouped: Grouped;
  surfaces: Surface[];
}
export type Answer = MeshAnswer | Float32Array;
export type Reply = { id: number; answer: Answer } | { id: number; error: string };

const runs = new Map<number, { nodes: number; quantum: number; rest: Int32Array }>();

const unpack = async (source: Source) => inflate(typeof source === 'string' ? fromBase64(source) : new Uint8Array(source));
const integers = async (part: Part, n: number) => fromPlanes(await unpack(part.source), n, part.planes);

/** Coordinates stored as all x, all y, all z become x, y, z of each node, in metres. */
function interleave(planar: Int32Array, from: number, nodes: number, quantum: number, out: Float32Array, to: number): void {
  for (let i = 0; i < nodes; i++) {
    out[to + 3 * i] = quantum * planar[from + i];
    out[to + 3 * i + 1] = quantum * planar[from + nodes + i];
    out[to + 3 * i + 2] = quantum * planar[from + 2 * nodes + i];
  }
}

function opened(run: number) {
  const known = runs.get(run);
  if (!known) throw new Error('frames asked for before their mesh');
  return known;
}

async function answer(question: Question): Promise<Answer> {
  switch (question.task) {
    case 'curves': {
      const bytes = await unpack(question.source);
      if (bytes.length !== 4 * question.values) throw new Error(`${bytes.length} bytes of curves, ${4 * question.values} announced`);
      return new Float32Array(bytes.buffer, bytes.byteOffset, question.values).slice();
    }
    case 'mesh': {
      const { nodes, tets, quantum } = question;
      const corners = await integers(question.corners, 4 * tets);
      runningSum(corners, 4);
      const region = await integers(question.region, tets);
      runningSum(region, 1);
      const rest = await integers(question.rest, 3 * nodes);
      runningSum(rest, 1);
      for (const corner of corners) if (corner < 0 || corner >= nodes) throw new Error(`a tet refers to node ${corner} of ${nodes}`);
      runs.set(question.run, { nodes, quantum, rest });
      const positions = new Float32Array(3 * nodes);
      interleave(rest, 0, nodes, quantum, positions, 0);
      const unsigned = Uint32Array.from(corners);
      const grouped = groupByRegion(region);
      const surfaces = Array.from(grouped.regions, (r, k) =>
        surfaceOf(r, unsigned, grouped.tets.subarray(grouped.start[k], grouped.start[k + 1])),
      );
      return { corners: unsigned, rest: positions, grouped, surfaces };
    }
    case 'positions': {
      const { nodes, quantum, rest } = opened(question.run);
      const values = await integers(question.part, 3 * nodes * question.count);
      undoTimeDifferences(values, 3 * nodes, question.count, question.order, rest);
      const out = new Float32Array(values.length);
      for (let k = 0; k < question.count; k++) interleave(values, 3 * nodes * k, nodes, quantum, out, 3 * nodes * k);
      return out;
    }
    case 'field': {
      const { nodes } = opened(question.run);
      const values = await integers(question.part, nodes * question.count);
      undoTimeDifferences(values, nodes, question.count, question.order, null);
      const out = new Float32Array(values.length);
      for (let i = 0; i < values.length; i++) out[i] = question.offset + question.quantum * values[i];
      return out;
    }
  }
}

let last: Promise<void> = Promise.resolve();
self.onmessage = (message: MessageEvent<{ id: number; question: Question }>) => {
  const { id, question } = message.data;
  last = last.then(async () => {
    try {
      const result = await answer(question);
      const transfer = result instanceof Float32Array ? [result.buffer] : [result.corners.buffer, result.rest.buffer];
      postMessage({ id, answer: result } satisfies Reply, { transfer });
    } catch (error) {
      postMessage({ id, error: error instanceof Error ? error.message : String(error) } satisfies Reply);
    }
  });
};
