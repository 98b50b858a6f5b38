// SPDX-License-Identifier: Apache-2.0
// One run as the viewer uses it: its mesh, its frames as they get decoded, its curves.
import type { Decoder } from './decoder';
import type { Chunk, Field, FramesInfo, MeshInfo, RunInfo } from './format';
import type { MeshAnswer } from './worker';

/** Decoded frames kept at most, in bytes; beyond that the chunks farthest from the current time are dropped. */
const KEEP_BYTES = 900e6;

type Slot = { state: 'none' | 'asked' | 'failed' } | { state: 'here'; values: Float32Array };

/** A quantity over time: chunks of frames, decoded on demand. */
class Series {
  private slots: Slot[];
  constructor(
    readonly width: number,
    private chunks: Chunk[],
    private decode: (chunk: Chunk) => Promise<Float32Array>,
    private changed: (error?: Error) => void,
  ) {
    this.slots = chunks.map(() => ({ state: 'none' }));
  }

  chunkOf(frame: number): number {
    return this.chunks.findIndex((chunk) => frame >= chunk.first && frame < chunk.first + chunk.count);
  }

  /** Where frame `frame` starts in `values`, or null while it is not decoded. */
  at(frame: number): { values: Float32Array; offset: number } | null {
    const c = this.chunkOf(frame);
    const slot = this.slots[c];
    if (slot?.state !== 'here') return null;
    return { values: slot.values, offset: (frame - this.chunks[c].first) * this.width };
  }

  /** Whether the piece that holds frame `frame`, or the next frame, could not be read. */
  failedAt(frame: number): boolean {
    return this.slots[this.chunkOf(frame)]?.state === 'failed' || this.slots[this.chunkOf(frame + 1)]?.state === 'failed';
  }

  isHere(c: number): boolean {
    return this.slots[c].state === 'here';
  }
  get count(): number {
    return this.chunks.length;
  }
  get decoded(): number {
    return this.slots.filter((slot) => slot.state === 'here').length;
  }
  get busy(): boolean {
    return this.slots.some((slot) => slot.state === 'asked');
  }
  frames(c: number): [number, number] {
    return [this.chunks[c].first, this.chunks[c].first + this.chunks[c].count - 1];
  }

  async load(c: number): Promise<void> {
    if (this.slots[c].state !== 'none') return;
    this.slots[c] = { state: 'asked' };
    try {
      this.slots[c] = { state: 'here', values: await this.decode(this.chunks[c]) };
      this.changed();
    } catch (error) {
      this.slots[c] = { state: 'failed' };
      this.changed(error instanceof Error ? error : new Error(String(error)));
    }
  }

  /** The nearest chunk to `frame` that is still to be asked for, those ahead first; −1 if there is none within the budget. */
  wanted(frame: number): number {
    const here = Math.max(0, this.chunkOf(frame));
    const size = 4 * this.width * (this.chunks[0]?.count ?? 1);
    const ahead = Math.max(2, Math.floor(KEEP_BYTES / size));
    for (let k = 0; k < Math.min(this.slots.length, ahead); k++) {
      const c = (here + k) % this.slots.length;
      if (this.slots[c].state === 'none') {
        if (this.decoded >= ahead) this.dropFarthest(here);
        return c;
      }
    }
    return -1;
  }

  private dropFarthest(here: number): void {
    for (let k = this.slots.length - 1; k > 1; k--) {
      const c = (here + k) % this.slots.length;
      if (this.slots[c].state === 'here') {
        this.slots[c] = { state: 'none' };
        return;
      }
    }
  }
}

export interface Curves {
  rows: number;
  time: Float32Array;
  column(name: string): Float32Array | null;
  names: string[];
}

export class Run {
  mesh: MeshAnswer | null = null;
  curves: Curves | null = null;
  positions: Series | null = null;
  private fields = new Map<string, Series>();
  /** Called whenever a chunk has arrived or failed. */
  onChange: (error?: Error) => void = () => undefined;

  constructor(
    readonly index: number,
    readonly info: RunInfo,
    private decoder: Decoder,
  ) {}

  get times(): number[] {
    return this.info.frames?.times_s ?? [];
  }

  async openCurves(): Promise<void> {
    const info = this.info.curves;
    if (!info) return;
    const columns = info.columns;
    const data = await this.decoder.ask<Float32Array>({
      task: 'curves',
      source: await this.decoder.source(info.blob),
      values: columns.length * info.rows,
    });
    const index = new Map(columns.map((column, k) => [column.name, k]));
    const column = (name: string) => {
      const k = index.get(name);
      return k === undefined ? null : data.subarray(k * info.rows, (k + 1) * info.rows);
    };
    const time = column('time_s');
    if (time) this.curves = { rows: info.rows, time, column, names: columns.map((c) => c.name) };
  }

  /** Decodes the mesh and makes ready for the frames; nothing if the run has none. */
  async openMesh(): Promise<void> {
    if (this.mesh || !this.info.mesh || !this.info.frames) return;
    const info: MeshInfo = this.info.mesh;
    const frames: FramesInfo = this.info.frames;
    const [corners, region, rest] = await Promise.all([info.corners, info.region, info.rest].map((packed) => this.decoder.part(packed)));
    this.mesh = await this.decoder.ask<MeshAnswer>({
      task: 'mesh',
      run: this.index,
      nodes: info.nodes,
      tets: info.tets,
      quantum: frames.quantum,
      corners,
      region,
      rest,
    });
    this.positions = new Series(
      3 * info.nodes,
      frames.position.chunks,
      async (chunk) =>
        this.decoder.ask<Float32Array>({
          task: 'positions',
          run: this.index,
          part: await this.decoder.part(chunk),
          count: chunk.count,
          order: chunk.order,
        }),
      (error) => this.onChange(error),
    );
  }

  field(name: string): Field | undefined {
    return this.info.frames?.fields.find((field) => field.name === name);
  }

  private seriesOf(field: Field): Series {
    let series = this.fields.get(field.name);
    if (!series) {
      series = new Series(
        this.info.mesh!.nodes,
        field.chunks,
        async (chunk) =>
          this.decoder.ask<Float32Array>({
            task: 'field',
            run: this.index,
            part: await this.decoder.part(chunk),
            count: chunk.count,
            order: chunk.order,
            offset: field.offset,
            quantum: field.quantum,
          }),
        (error) => this.onChange(error),
      );
      this.fields.set(field.name, series);
    }
    return series;
  }

  /** The frame at or before `time`, and how far the next one is reached, 0…1. */
  locate(time: number, out: { frame: number; mix: number }): void {
    const times = this.times;
    let low = 0;
    let high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    const next = Math.min(low + 1, times.length - 1);
    const span = times[next] - times[low];
    out.frame = low;
    out.mix = span > 0 ? Math.min(1, Math.max(0, (time - times[low]) / span)) : 0;
  }

  private place = { frame: 0, mix: 0 };

  private interpolate(series: Series, time: number, out: Float32Array): boolean {
    this.locate(time, this.place);
    const { frame, mix } = this.place;
    const a = series.at(frame);
    const b = mix > 0 ? series.at(frame + 1) : a;
    if (!a || !b) return false;
    const [from, to] = [a.offset, b.offset];
    if (mix === 0) out.set(a.values.subarray(from, from + series.width));
    else for (let i = 0; i < series.width; i++) out[i] = a.values[from + i] + mix * (b.values[to + i] - a.values[from + i]);
    return true;
  }

  /** Current positions [m] at `time`, linear between frames; false (and `out` as before) while they are not decoded. */
  positionsAt(time: number, out: Float32Array): boolean {
    return this.positions !== null && this.interpolate(this.positions, time, out);
  }

  /** A field's nodal values at `time`, given the positions then. */
  fieldAt(field: Field, time: number, positions: Float32Array, out: Float32Array): boolean {
    if (field.derived === 'displacement') {
      const rest = this.mesh!.rest;
      for (let i = 0, k = 0; i < out.length; i++, k += 3)
        out[i] = 1000 * Math.hypot(positions[k] - rest[k], positions[k + 1] - rest[k + 1], positions[k + 2] - rest[k + 2]);
      return true;
    }
    return this.interpolate(this.seriesOf(field), time, out);
  }

  /** Whether what would be shown at `time` could not be read. */
  failedAt(time: number, fieldName: string): boolean {
    this.locate(time, this.place);
    const frame = this.place.frame;
    return this.positions?.failedAt(frame) === true || this.fields.get(fieldName)?.failedAt(frame) === true;
  }

  /** Asks for the next chunk that is missing near `time`: positions first, then the field shown. One at a time. */
  loadAround(time: number, fieldName: string): void {
    if (!this.positions) return;
    this.locate(time, this.place);
    const field = this.field(fieldName);
    const series = field && field.chunks.length ? [this.positions, this.seriesOf(field)] : [this.positions];
    if (series.some((s) => s.busy)) return;
    // What is on the screen comes first, then the rest of each.
    const frame = this.place.frame;
    const urgent = series.find((s) => !s.at(frame) && s.wanted(frame) === s.chunkOf(frame));
    for (const s of urgent ? [urgent] : series) {
      const c = s.wanted(frame);
      if (c >= 0) {
        void s.load(c);
        return;
      }
    }
  }

  /** Parts of the time axis whose positions are decoded, as [from, to] in seconds. */
  decodedSpans(): [number, number][] {
    const spans: [number, number][] = [];
    for (let c = 0; c < (this.positions?.count ?? 0); c++) {
      if (!this.positions!.isHere(c)) continue;
      const [first, last] = this.positions!.frames(c);
      spans.push([this.times[first], this.times[Math.min(last + 1, this.times.length - 1)]]);
    }
    return spans;
  }
}
