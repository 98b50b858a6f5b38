// SPDX-License-Identifier: Apache-2.0
// The data of one plot: the columns of all runs and the reference curves on a common axis of time.
import uPlot from 'uplot';
import type { Plot } from '../data/format';
import type { Run } from '../data/run';

export interface Line {
  label: string;
  run: number;
  column: number;
  reference: boolean;
  /** Its own samples: minutes and values (NaN where there is none). */
  x: ArrayLike<number>;
  y: ArrayLike<number>;
}

export function linesOf(plot: Plot, runs: Run[]): Line[] {
  const lines: Line[] = [];
  runs.forEach((run, r) => {
    const curves = run.curves;
    if (!curves) return;
    const minutes = Float64Array.from(curves.time, (t) => t / 60);
    plot.columns.forEach((column, c) => {
      const y = curves.column(column.name);
      if (!y) return;
      const label = runs.length > 1 ? `${run.info.name}: ${column.label}` : column.label;
      lines.push({ label, run: r, column: c, reference: false, x: minutes, y });
    });
  });
  plot.references.forEach((reference, k) => {
    const points = reference.points.filter((p) => Array.isArray(p) && p.length === 2);
    lines.push({
      label: reference.label,
      run: 0,
      column: plot.columns.length + k,
      reference: true,
      x: points.map((p) => p[0] / 60),
      y: points.map((p) => p[1]),
    });
  });
  return lines;
}

/** Aligned for uPlot; null where a line has no value. */
export function align(lines: Line[]): uPlot.AlignedData {
  const tables = lines.map(
    (line) => [Array.from(line.x), Array.from(line.y, (v) => (Number.isFinite(v) ? v : null))] as unknown as uPlot.AlignedData,
  );
  return tables.length === 1 ? tables[0] : uPlot.join(tables);
}

/** Last rows and last frames differ by rounding [min]. */
const SLACK = 0.02;

/** A line's value at `minutes`, straight between its samples; NaN outside. */
export function valueAt(line: Line, minutes: number): number {
  const { x, y } = line;
  const n = x.length;
  if (!n || minutes < x[0] - SLACK || minutes > x[n - 1] + SLACK) return NaN;
  let low = 0;
  let high = n - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= minutes) low = middle;
    else high = middle;
  }
  if (n === 1 || x[high] === x[low]) return y[low];
  const f = Math.min(1, Math.max(0, (minutes - x[low]) / (x[high] - x[low])));
  return f === 0 ? y[low] : f === 1 ? y[high] : y[low] + f * (y[high] - y[low]);
}

const cell = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);

/** The plot as CSV: time in seconds, one column per line, the unit at the end of its name. */
export function toCsv(lines: Line[], unit: string): string {
  const suffix = unit ? ` [${unit}]` : '';
  const header = ['time_s', ...lines.map((line) => line.label + suffix)].map(cell).join(',');
  const times = [...new Set(lines.flatMap((line) => Array.from(line.x)))].sort((a, b) => a - b);
  const rows = times.map((minutes) =>
    [+(minutes * 60).toPrecision(9), ...lines.map((line) => valueAt(line, minutes))]
      .map((v) => (Number.isFinite(v) ? String(+v.toPrecision(7)) : ''))
      .join(','),
  );
  return `${header}\n${rows.join('\n')}\n`;
}
