// SPDX-License-Identifier: Apache-2.0
// A small report with known contents, coded as docs/reference/report_format.md says: a cube of fetal skin, 60 mm wide, that goes down
// 120 mm in 600 s beside a bone, inside a box of abdomen.
import { deflateSync } from 'node:zlib';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Field, Manifest, RunInfo } from '../src/data/format';

export const VIEWER = fileURLToPath(new URL('../dist/viewer.html', import.meta.url));
export const QUANTUM = 2e-5;
export const DURATION = 600;
export const FRAMES = 13;
export const DESCENT_MM = 120;

export class Blobs {
  readonly data: Buffer[] = [];
  readonly raw: number[] = [];
  add(bytes: Uint8Array): number {
    this.data.push(deflateSync(bytes));
    this.raw.push(bytes.length);
    return this.data.length - 1;
  }
}

/** Zigzag byte planes, with as few planes as the values need. */
export function toPlanes(values: ArrayLike<number>): { bytes: Uint8Array; planes: number } {
  const u = Array.from(values, (d) => (d >= 0 ? 2 * d : -2 * d - 1));
  const largest = u.reduce((a, b) => Math.max(a, b), 0);
  let planes = 1;
  while (planes < 4 && largest >= 256 ** planes) planes++;
  const bytes = new Uint8Array(planes * u.length);
  for (let p = 0; p < planes; p++) u.forEach((v, i) => (bytes[p * u.length + i] = Math.floor(v / 256 ** p) % 256));
  return { bytes, planes };
}

const pack = (blobs: Blobs, values: ArrayLike<number>) => {
  const { bytes, planes } = toPlanes(values);
  return { blob: blobs.add(bytes), planes };
};
const differences = (values: number[], stride = 1) => values.map((v, i) => (i < stride ? v : v - values[i - stride]));

/** The differences in time of frames, as a chunk holds them. */
export function timeDifferences(frames: number[][], order: number, base: number[] | null): number[] {
  return frames.flatMap((frame, k) =>
    frame.map((q, i) => {
      if (k === 0) return q - (base ? base[i] : 0);
      if (order === 2 && k >= 2) return q - 2 * frames[k - 1][i] + frames[k - 2][i];
      return q - frames[k - 1][i];
    }),
  );
}

/** A box cut into n³ cells of six tets (Kuhn), all of positive volume. */
export function box(centre: number[], size: number[], n: number, firstNode: number): { nodes: number[][]; tets: number[][] } {
  const at = (i: number, j: number, k: number) => firstNode + i + (n + 1) * (j + (n + 1) * k);
  const nodes: number[][] = [];
  for (let k = 0; k <= n; k++)
    for (let j = 0; j <= n; j++)
      for (let i = 0; i <= n; i++) nodes.push([i, j, k].map((c, axis) => centre[axis] + size[axis] * (c / n - 0.5)));
  const tets: number[][] = [];
  const orders = [
    [0, 1, 2],
    [1, 2, 0],
    [2, 0, 1],
    [0, 2, 1],
    [2, 1, 0],
    [1, 0, 2],
  ];
  for (let k = 0; k < n; k++)
    for (let j = 0; j < n; j++)
      for (let i = 0; i < n; i++)
        orders.forEach((order, o) => {
          const c = [i, j, k];
          const tet = [at(c[0], c[1], c[2])];
          for (const axis of order) {
            c[axis]++;
            tet.push(at(c[0], c[1], c[2]));
          }
          // Odd orders of the axes are mirrored.
          if (o >= 3) [tet[2], tet[3]] = [tet[3], tet[2]];
          tets.push(tet);
        });
  return { nodes, tets };
}

export interface Options {
  name?: string;
  /** How far the cube goes down [mm]. */
  descent?: number;
  text?: string;
}

export const MARKUP = '<img src=x onerror="window.broken=1"><b>bold</b>';

/** A run whose texts hold markup, so that every test sees what becomes of it. */
export function makeRun(blobs: Blobs, options: Options = {}): RunInfo {
  const name = options.name ?? 'cube';
  const descent = options.descent ?? DESCENT_MM;
  const parts = [
    { region: 0, ...box([0, 0, 0], [0.06, 0.06, 0.06], 2, 0) },
    { region: 1, ...box([-0.09, 0, -0.05], [0.03, 0.06, 0.14], 1, 27) },
    { region: 2, ...box([0.09, 0, -0.05], [0.03, 0.06, 0.14], 1, 35) },
  ];
  const nodes = parts.flatMap((part) => part.nodes);
  const tets = parts.flatMap((part) => part.tets);
  const region = parts.flatMap((part) => part.tets.map(() => part.region));
  const N = nodes.length;
  const moving = parts[0].nodes.length;
  const quantised = (down: number) =>
    [0, 1, 2].flatMap((axis) => nodes.map((x, i) => Math.round((x[axis] - (axis === 2 && i < moving ? down : 0)) / QUANTUM)));
  const rest = quantised(0);
  const times = Array.from({ length: FRAMES }, (_, k) => (k * DURATION) / (FRAMES - 1));
  const positions = times.map((t) => quantised((descent / 1000) * (t / DURATION)));
  // The cube is stretched evenly: 1 at the start, 3.5 at the end.
  const stretch = times.map((t) => nodes.map((_, i) => (i < moving ? Math.round(250 * (t / DURATION)) : 0)));
  const chunks = (frames: number[][], base: number[] | null, orders: number[]) => {
    const half = 7;
    return [frames.slice(0, half), frames.slice(half)].map((part, c) => ({
      first: c * half,
      count: part.length,
      order: orders[c],
      ...pack(blobs, timeDifferences(part, orders[c], base)),
    }));
  };
  const rows = 61;
  const time = Array.from({ length: rows }, (_, i) => (i * DURATION) / (rows - 1));
  const columns: [string, string, (t: number) => number][] = [
    ['time_s', 's', (t) => t],
    ['head_x_mm', 'mm', () => 0],
    ['head_y_mm', 'mm', () => 0],
    ['head_z_mm', 'mm', (t) => (-descent * t) / DURATION],
    ['pressure_contraction_mmhg', 'mmHg', (t) => (t % 200 > 60 && t % 200 < 120 ? 50 : 10)],
    ['pressure_push_mmhg', 'mmHg', (t) => (t % 200 > 70 && t % 200 < 110 ? 80 : NaN)],
  ];
  const curves = Buffer.from(new Float32Array(columns.flatMap(([, , f]) => time.map(f))).buffer);
  const rowsOfVerdict = [
    {
      group: 'paper',
      number: null,
      what: 'head displacement, Z',
      expected: '184 mm',
      source: 'paper',
      obtained: `${descent} mm`,
      state: 'outside',
    },
    { group: 'band', number: 1, what: 'contractions to birth', expected: '6–10', source: 'paper', obtained: '3', state: 'outside' },
    { group: 'band', number: 8, what: 'inverted elements', expected: '0', source: 'numerics', obtained: '0', state: 'inside' },
    {
      group: 'band',
      number: 11,
      what: 'robustness',
      expected: 'born',
      source: 'targets',
      obtained: 'needs several runs',
      state: 'not_asked',
    },
  ];
  return {
    name,
    folder: `/results/${name}`,
    status: 'finished',
    notes: [`a note with markup: ${MARKUP}`],
    description: MARKUP,
    scenario: `# ${MARKUP}\nname: ${name}\n`,
    summary: { outcome: 'born', birth_time_s: 590, contractions: 3, head_displacement_mm: { x: 0, y: 0, z: descent } },
    log: `log of ${name}`,
    duration_s: DURATION,
    verdict: { met: false, line: '1 of 3 inside', inside: 1, outside: 2, not_asked: 1, rows: rowsOfVerdict },
    provenance: [{ what: 'version', value: '0.0.0-test' }],
    declared: [{ what: 'resolution', value: 'toy' }],
    calibrated: [{ what: 'nothing', value: 'to nothing' }],
    events: [
      { time_s: 60, event: 'contraction', number: 1 },
      { time_s: 300, event: 'crowning' },
      { time_s: 590, event: 'birth' },
    ],
    contractions: [60, 260, 460].map((t) => ({ start_s: t, plateau_s: t + 20, plateau_end_s: t + 40, end_s: t + 60 })),
    curves: { rows, columns: columns.map(([n, unit]) => ({ name: n, unit })), blob: blobs.add(curves) },
    plots: [
      {
        id: 'head_z',
        title: 'Head, cranio-caudal (Z)',
        figure: 'Fig. 12',
        unit: 'mm',
        columns: [{ name: 'head_z_mm', label: 'Z' }],
        marks: [{ kind: 'band', low: -100, high: -80, label: 'band', source: 'paper' }],
        references: [
          {
            label: 'imposed',
            source: 'paper',
            points: [
              [0, 0],
              [600, -184],
            ],
          },
        ],
      },
      {
        id: 'loads',
        title: 'Contraction and push',
        figure: 'Fig. 9',
        unit: 'mmHg',
        columns: [
          { name: 'pressure_contraction_mmhg', label: 'contraction' },
          { name: 'pressure_push_mmhg', label: 'push, "with" comma' },
        ],
        marks: [],
        references: [],
      },
      {
        id: 'absent',
        title: 'Absent',
        figure: '',
        unit: '',
        columns: [{ name: 'no_such_column', label: 'none' }],
        marks: [],
        references: [],
      },
    ],
    mesh: {
      nodes: N,
      tets: tets.length,
      regions: [
        { id: 0, name: 'fetal_skin', label: 'Fetal skin', organ: 'fetus', kind: 'fetus' },
        { id: 1, name: 'innominate_left', label: 'Left innominate', organ: 'abdomen', kind: 'bone' },
        { id: 2, name: 'abdomen', label: MARKUP, organ: 'abdomen', kind: 'soft' },
      ],
      corners: pack(blobs, differences(tets.flat(), 4)),
      region: pack(blobs, differences(region)),
      rest: pack(blobs, differences(rest)),
      landmarks: [{ name: 'head_centre', label: 'Centre of the skull', position: [0, 0, 0] }],
    },
    frames: {
      times_s: times,
      quantum: QUANTUM,
      position: { chunks: chunks(positions, rest, [2, 1]) },
      fields: [
        // Derived: no chunks, no range of its own.
        { name: 'displacement', label: 'Total displacement', unit: 'mm', scale: [0, 200], derived: 'displacement' } as unknown as Field,
        {
          name: 'stretch',
          label: 'Largest stretch',
          unit: '',
          offset: 1,
          quantum: 0.01,
          scale: [1, 3.5],
          min: 1,
          max: 3.5,
          chunks: chunks(stretch, null, [1, 2]),
        },
      ],
    },
  };
}

export function makeManifest(runs: RunInfo[], blobs: Blobs): Manifest {
  return {
    format: 'carus-report-1',
    generator: { version: '0.0.0-test', commit: 'none' },
    created: '2026-01-01T00:00:00Z',
    title: runs[0].name,
    runs,
    ghost: null,
    comparison:
      runs.length > 1
        ? {
            rows: [
              { what: 'head displacement z', unit: 'mm', values: runs.map((_, k) => 120 - 60 * k) },
              { what: 'not there', unit: '', values: runs.map((_, k) => (k ? null : 1)) },
            ],
          }
        : null,
    blobs: blobs.data.map((data, k) => ({ bytes: data.length, raw: blobs.raw[k] })),
    live: null,
  };
}

const escaped = (json: string) => json.replace(/[<>&\u2028\u2029]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, '0')}`);

export function scripts(manifest: Manifest | string, blobs: Blobs): string {
  const json = typeof manifest === 'string' ? manifest : escaped(JSON.stringify(manifest));
  const data = blobs.data.map((bytes, k) => `<script id="carus-blob-${k}" type="text/plain">${bytes.toString('base64')}</script>`);
  return [`<script id="carus-manifest" type="application/json">${json}</script>`, ...data].join('\n');
}

/** The viewer with `payload` at its place. */
export function spliced(payload: string): string {
  const viewer = readFileSync(VIEWER, 'utf8');
  const place = '<!--CARUS-DATA-->';
  if (viewer.split(place).length !== 2) throw new Error(`${VIEWER}: the place of the data is not there exactly once`);
  return viewer.replace(place, () => payload);
}

const folder = mkdtempSync(join(tmpdir(), 'carus-viewer-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
let pages = 0;

/** Writes a page and gives its file:// address. */
export function onDisk(html: string): string {
  const file = join(folder, `report${pages++}.html`);
  writeFileSync(file, html);
  return `file://${file}`;
}

export function report(...options: Options[]): string {
  const blobs = new Blobs();
  const runs = (options.length ? options : [{}]).map((o) => makeRun(blobs, o));
  return onDisk(spliced(scripts(makeManifest(runs, blobs), blobs)));
}
