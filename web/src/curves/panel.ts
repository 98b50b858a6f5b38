// SPDX-License-Identifier: Apache-2.0
// All plots, one under or beside the other.
import type { Clock } from '../clock';
import type { Run } from '../data/run';
import { download, fileName, h, iconButton } from '../ui/dom';
import { Chart } from './chart';
import { Window } from './window';

export class CurvesPanel {
  readonly element: HTMLElement;
  private charts: Chart[];
  private sight: IntersectionObserver;
  private sizes: ResizeObserver;

  constructor(runs: Run[], clock: Clock) {
    const window = new Window(Math.max(clock.duration / 60, 1e-3));
    this.charts = (runs.find((run) => run.info.plots.length) ?? runs[0]).info.plots.map((plot) => new Chart(plot, runs, clock, window));
    const grid = h('div', { class: 'charts' }, ...this.charts.map((chart) => chart.element));
    this.element = h(
      'section',
      { class: 'curves', 'aria-labelledby': 'curves-title' },
      h(
        'header',
        { class: 'section-head' },
        h('h2', { id: 'curves-title' }, 'Curves'),
        h('span', { class: 'key' }, h('i', { class: 'key-contraction' }), 'contraction', h('i', { class: 'key-band' }), 'expected'),
        h('span', { class: 'spacer' }),
        h(
          'span',
          { class: 'tools', role: 'group', 'aria-label': 'Zoom' },
          iconButton('plus', 'Zoom in', () => window.zoom(0.5, clock.time / 60)),
          iconButton('minus', 'Zoom out', () => window.zoom(2, clock.time / 60)),
          iconButton('reset', 'All of the time', () => window.reset()),
        ),
        h(
          'button',
          { type: 'button', class: 'quiet', click: () => saveAll(runs), disabled: !runs.some((run) => run.curves) },
          'All as CSV',
        ),
      ),
      h('p', { class: 'hint' }, 'Click or drag to move the time, Shift and drag to zoom, double click for all.'),
      this.charts.length ? grid : h('p', { class: 'absent' }, 'This run has no curves to draw.'),
    );
    this.sight = new IntersectionObserver(
      (entries) => {
        for (const entry of entries) this.charts.find((chart) => chart.element === entry.target)?.setVisible(entry.isIntersecting);
      },
      { rootMargin: '200px' },
    );
    this.sizes = new ResizeObserver(() => {
      for (const chart of this.charts) chart.resize();
    });
    for (const chart of this.charts) this.sight.observe(chart.element);
    this.sizes.observe(grid);
    window.onChange(() => {
      for (const chart of this.charts) chart.moved();
    });
  }

  follow(): void {
    for (const chart of this.charts) chart.follow();
  }

  recolour(): void {
    for (const chart of this.charts) chart.recolour();
  }

  dispose(): void {
    this.sight.disconnect();
    this.sizes.disconnect();
  }
}

/** Every column of every run, one file each. */
function saveAll(runs: Run[]): void {
  for (const run of runs) {
    const curves = run.curves;
    if (!curves) continue;
    const columns = curves.names.map((name) => curves.column(name)!);
    const rows = Array.from({ length: curves.rows }, (_, i) =>
      columns.map((column) => (Number.isFinite(column[i]) ? String(+column[i].toPrecision(7)) : '')).join(','),
    );
    download(
      `${fileName(run.info.name, 'curves')}.csv`,
      new Blob([`${curves.names.join(',')}\n${rows.join('\n')}\n`], { type: 'text/csv' }),
    );
  }
}
