// SPDX-License-Identifier: Apache-2.0
// The report's data as docs/reference/report_format.md defines it. Members may be missing in a damaged page, so what is
// read is completed here once; the rest of the viewer relies on these types.

export interface BlobInfo {
  bytes: number;
  raw: number;
  src?: string;
}
export interface Packed {
  blob: number;
  planes: number;
}
export interface Chunk extends Packed {
  first: number;
  count: number;
  order: number;
}
export interface Field {
  name: string;
  label: string;
  unit: string;
  offset: number;
  quantum: number;
  scale: [number, number];
  min: number;
  max: number;
  derived?: string;
  chunks: Chunk[];
}
export interface Region {
  id: number;
  name: string;
  label: string;
  organ: string;
  kind: string;
}
export interface Landmark {
  name: string;
  label: string;
  position: [number, number, number];
}
export interface MeshInfo {
  nodes: number;
  tets: number;
  regions: Region[];
  corners: Packed;
  region: Packed;
  rest: Packed;
  landmarks: Landmark[];
}
export interface FramesInfo {
  times_s: number[];
  quantum: number;
  position: { chunks: Chunk[] };
  fields: Field[];
}
export interface Verdict {
  met: boolean;
  line: string;
  inside: number;
  outside: number;
  not_asked: number;
  rows: VerdictRow[];
}
export interface VerdictRow {
  group: string;
  number: number | null;
  what: string;
  expected: string;
  source: string;
  obtained: string;
  state: string;
}
export interface Mark {
  kind: 'band' | 'value';
  low?: number | null;
  high?: number | null;
  value?: number | null;
  label: string;
  source: string;
}
export interface Reference {
  label: string;
  source: string;
  points: [number, number][];
}
export interface Plot {
  id: string;
  title: string;
  figure: string;
  unit: string;
  columns: { name: string; label: string }[];
  marks: Mark[];
  references: Reference[];
}
export interface Contraction {
  start_s: number;
  plateau_s: number;
  plateau_end_s: number;
  end_s: number;
}
export interface BirthEvent {
  time_s: number;
  event: string;
  [key: string]: unknown;
}
export interface Fact {
  what: string;
  value: string;
}
export interface RunInfo {
  name: string;
  folder: string;
  status: string;
  notes: string[];
  description: string;
  scenario: string;
  summary: Record<string, unknown> | null;
  log: string;
  duration_s: number;
  verdict: Verdict;
  provenance: Fact[];
  declared: Fact[];
  calibrated: Fact[];
  events: BirthEvent[];
  contractions: Contraction[];
  curves: { rows: number; columns: { name: string; unit: string }[]; blob: number } | null;
  plots: Plot[];
  mesh: MeshInfo | null;
  frames: FramesInfo | null;
}
export interface Manifest {
  format: string;
  generator: { version: string; commit: string };
  created: string;
  title: string;
  runs: RunInfo[];
  ghost: number | null;
  comparison: { rows: { what: string; unit: string; values: (number | null)[] }[] } | null;
  blobs: BlobInfo[];
  live: { src: string; every_s: number } | null;
}

export const FORMAT = 'carus-report-1';

/** What a person is told when the page holds nothing that can be shown. */
export class ReportError extends Error {}

type Loose = Record<string, unknown>;
const isObject = (value: unknown): value is Loose => typeof value === 'object' && value !== null && !Array.isArray(value);
const list = <T>(value: unknown): T[] => (Array.isArray(value) ? (value as T[]) : []);
const text = (value: unknown): string => (value === undefined || value === null ? '' : String(value));
const finite = (value: unknown, otherwise: number): number => (typeof value === 'number' && Number.isFinite(value) ? value : otherwise);

/** The manifest in `json`; throws a ReportError that says what is wrong with it. */
export function parseManifest(json: string): Manifest {
  let data: unknown;
  try {
    data = JSON.parse(json);
  } catch (error) {
    throw new ReportError(`The data of this page is damaged or cut short: ${error instanceof Error ? error.message : 'not JSON'}.`);
  }
  if (!isObject(data)) throw new ReportError('The data of this page is not a report.');
  if (data.format !== FORMAT)
    throw new ReportError(
      `This viewer reads data of the format "${FORMAT}"; the page holds "${text(data.format) || 'none'}". Make it again with carus report.`,
    );
  const runs = list<unknown>(data.runs).filter(isObject).map(completeRun);
  if (!runs.length) throw new ReportError('This report holds no run.');
  const generator = isObject(data.generator) ? data.generator : {};
  const ghost = finite(data.ghost, -1);
  return {
    format: FORMAT,
    generator: { version: text(generator.version), commit: text(generator.commit) },
    created: text(data.created),
    title: text(data.title) || runs[0].name,
    runs,
    ghost: Number.isInteger(ghost) && ghost > 0 && ghost < runs.length ? ghost : null,
    comparison: isObject(data.comparison) ? (data.comparison as unknown as Manifest['comparison']) : null,
    blobs: list(data.blobs),
    live: isObject(data.live) ? (data.live as unknown as Manifest['live']) : null,
  };
}

/** Derived fields have no chunks; a scale that is none becomes 0…1, so that nothing is divided by zero. */
function completeField(field: Field): Field {
  const [low, high] = list<number>(field.scale);
  const scale: [number, number] = Number.isFinite(low) && Number.isFinite(high) && high > low ? [low, high] : [0, 1];
  return { ...field, label: text(field.label) || field.name, unit: text(field.unit), scale, chunks: list(field.chunks) };
}

function completeRun(run: Loose): RunInfo {
  const notes = list<unknown>(run.notes).map(text);
  const verdict = isObject(run.verdict) ? run.verdict : {};
  const mesh = isObject(run.mesh) ? (run.mesh as unknown as MeshInfo) : null;
  let frames = isObject(run.frames) ? (run.frames as unknown as FramesInfo) : null;
  if (frames && !(list(frames.times_s).length && list(frames.position?.chunks).length)) frames = null;
  const curves = isObject(run.curves) && finite(run.curves.rows, 0) > 0 ? (run.curves as unknown as RunInfo['curves']) : null;
  return {
    name: text(run.name) || 'run',
    folder: text(run.folder),
    status: text(run.status) || 'finished',
    notes,
    description: text(run.description),
    scenario: text(run.scenario),
    summary: isObject(run.summary) ? run.summary : null,
    log: text(run.log),
    duration_s: Math.max(finite(run.duration_s, 0), frames ? frames.times_s[frames.times_s.length - 1] : 0),
    verdict: {
      met: verdict.met === true,
      line: text(verdict.line),
      inside: finite(verdict.inside, 0),
      outside: finite(verdict.outside, 0),
      not_asked: finite(verdict.not_asked, 0),
      rows: list<VerdictRow>(verdict.rows).filter(isObject) as unknown as VerdictRow[],
    },
    provenance: list(run.provenance),
    declared: list(run.declared),
    calibrated: list(run.calibrated),
    events: list<BirthEvent>(run.events).filter((event) => isObject(event) && Number.isFinite(event.time_s)),
    contractions: list<Contraction>(run.contractions).filter((c) => isObject(c) && Number.isFinite(c.start_s) && Number.isFinite(c.end_s)),
    curves,
    plots: list<Plot>(run.plots).map((plot) => ({
      ...plot,
      columns: list(plot.columns),
      marks: list(plot.marks),
      references: list(plot.references),
    })),
    mesh: mesh && { ...mesh, regions: list(mesh.regions), landmarks: list(mesh.landmarks) },
    frames: mesh &&
      frames && {
        ...frames,
        fields: list<Field>(frames.fields)
          .filter(isObject)
          .map((field) => completeField(field as unknown as Field)),
      },
  };
}
