// SPDX-License-Identifier: Apache-2.0
// One plot: curves of all runs, contractions shaded, events and the paper's values marked, and the cursor of the page's time.
import uPlot from 'uplot';
import type { Clock } from '../clock';
import type { Mark, Plot } from '../data/format';
import type { Run } from '../data/run';
import { download, fileName, h, iconButton } from '../ui/dom';
import { clockText, numberText, withUnit, words } from '../ui/text';
import { align, linesOf, toCsv, valueAt, type Line } from './series';
import { chartColours, LINES, type ChartColours } from './theme';
import type { Window } from './window';

const HEIGHT = 178;
const FONT = '11px system-ui, sans-serif';
/** Marks that would squeeze the curves into less than 1/SQUEEZE of the height are named at the edge instead. */
const SQUEEZE = 3.5;
const READ_MS = 120;

export class Chart {
  readonly element: HTMLElement;
  private lines: Line[];
  private plotted: uPlot | null = null;
  private cursor = h('div', { class: 'time-cursor' });
  private values: HTMLElement[] = [];
  private stamp = h('span', { class: 'stamp' });
  private holder = h('div', { class: 'plot', tabindex: 0 });
  private colours: ChartColours = chartColours();
  private visible = false;
  private hovered: number | null = null;
  private shown = NaN;
  private shownAt = 0;

  constructor(
    readonly plot: Plot,
    private runs: Run[],
    private clock: Clock,
    private window: Window,
  ) {
    this.lines = linesOf(plot, runs);
    const legend = h('div', { class: 'legend' });
    this.lines.forEach((line, k) => {
      const value = h('b');
      this.values.push(value);
      const swatch = h('i', { class: 'swatch' });
      swatch.style.setProperty('--swatch', `var(--line-${this.colourIndex(line) + 1})`);
      if (this.dash(line)) swatch.classList.add('dashed');
      legend.append(h('span', { class: 'item', 'data-line': k }, swatch, line.label, ' ', value));
    });
    const name = `${plot.title}${plot.unit ? ` [${plot.unit}]` : ''}`;
    this.element = h(
      'article',
      { class: 'chart', 'data-plot': plot.id, 'aria-label': name },
      h(
        'header',
        {},
        h('h3', {}, plot.title),
        plot.figure && h('span', { class: 'figure', title: "The paper's figure" }, plot.figure),
        plot.unit && h('span', { class: 'unit' }, plot.unit),
        h('span', { class: 'spacer' }),
        this.stamp,
        h(
          'span',
          { class: 'tools' },
          iconButton('download', `Save as CSV: ${plot.title}`, () => this.saveCsv()),
          iconButton('image', `Save as PNG: ${plot.title}`, () => this.savePng()),
        ),
      ),
      legend,
      this.holder,
    );
    if (!this.lines.length) this.holder.append(h('p', { class: 'absent' }, 'Not in the curves of this run.'));
    this.holder.setAttribute('role', 'img');
    this.holder.setAttribute('aria-label', this.description());
    this.holder.addEventListener('keydown', (event) => {
      if (event.key === '+' || event.key === '=') this.window.zoom(0.5, this.clock.time / 60);
      else if (event.key === '-') this.window.zoom(2, this.clock.time / 60);
      else if (event.key === '0') this.window.reset();
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** In words, for those who do not see the curve. */
  private description(): string {
    const parts = this.lines.map((line) => {
      const numbers = Array.from(line.y).filter(Number.isFinite);
      const low = numbers.reduce((a, b) => Math.min(a, b), Infinity);
      const high = numbers.reduce((a, b) => Math.max(a, b), -Infinity);
      return numbers.length
        ? `${line.label} from ${numberText(low)} to ${withUnit(numberText(high), this.plot.unit)}`
        : `${line.label}: no values`;
    });
    return `${this.plot.title} over time. ${parts.join('; ')}. Arrow keys move the time, plus and minus zoom.`;
  }

  private colourIndex(line: Line): number {
    // One curve per run: the colour tells the run. Several: it tells the curve, and the dashes the run.
    const perRun = this.plot.columns.length === 1 && !line.reference;
    return (perRun ? line.run : line.column + (this.plot.columns.length === 1 ? this.runs.length - 1 : 0)) % LINES;
  }
  private dash(line: Line): number[] | undefined {
    if (line.reference) return [3, 3];
    if (line.run === 0 || this.plot.columns.length === 1) return undefined;
    return [
      [8, 4],
      [2, 3],
      [10, 3, 2, 3],
    ][(line.run - 1) % 3];
  }

  /** Made when it comes into sight for the first time. */
  private create(): void {
    if (this.plotted || !this.lines.length) return;
    const colours = () => this.colours;
    const axis = {
      stroke: () => colours().muted,
      font: FONT,
      grid: { stroke: () => colours().grid, width: 1 },
      ticks: { stroke: () => colours().grid, width: 1, size: 4 },
    };
    const options: uPlot.Options = {
      width: Math.max(80, this.holder.clientWidth),
      height: HEIGHT,
      padding: [9, 18, 0, 0],
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, points: { size: 6 } },
      scales: {
        x: { time: false, range: () => this.window.range() },
        y: { range: (_u, low, high) => this.ordinate(low, high) },
      },
      axes: [
        { ...axis, size: 24, gap: 2, values: (_u, ticks) => ticks.map((t) => `${+t.toFixed(3)} min`) },
        { ...axis, size: 46, gap: 4, values: (_u, ticks) => ticks.map((t) => numberText(t)) },
      ],
      series: [
        {},
        ...this.lines.map((line) => ({
          label: line.label,
          stroke: () => colours().lines[this.colourIndex(line)],
          width: line.reference ? 1.25 : 1.6,
          dash: this.dash(line),
          points: { show: false },
        })),
      ],
      hooks: {
        drawClear: [(u) => this.drawUnder(u)],
        draw: [(u) => this.drawOver(u)],
        setCursor: [(u) => this.hover(u)],
      },
    };
    this.plotted = new uPlot(options, align(this.lines), this.holder);
    this.plotted.over.append(this.cursor);
    this.followPointer(this.plotted);
    this.window.onChange(() => this.plotted?.setScale('x', { min: this.window.low, max: this.window.high }));
    this.placeCursor();
  }

  /** A click or a drag moves the time; with Shift it marks what to zoom into; Ctrl and the wheel zoom; a double click shows all. */
  private followPointer(u: uPlot): void {
    const over = u.over;
    let from: number | null = null;
    let selecting = false;
    const minutes = (event: PointerEvent | WheelEvent) => u.posToVal(event.clientX - over.getBoundingClientRect().left, 'x');
    over.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      selecting = event.shiftKey;
      from = minutes(event);
      if (!selecting) this.clock.set(60 * from);
    });
    over.addEventListener('pointermove', (event) => {
      if (from === null) return;
      const to = minutes(event);
      if (!selecting) this.clock.set(60 * to);
      else {
        const [a, b] = [u.valToPos(Math.min(from, to), 'x'), u.valToPos(Math.max(from, to), 'x')];
        u.setSelect({ left: a, width: b - a, top: 0, height: over.clientHeight }, false);
      }
    });
    const end = (event: PointerEvent) => {
      if (from !== null && selecting) {
        const to = minutes(event);
        u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
        if (Math.abs(to - from) > 0.02 * (this.window.high - this.window.low)) this.window.set(Math.min(from, to), Math.max(from, to));
      }
      from = null;
    };
    over.addEventListener('pointerup', end);
    over.addEventListener('pointercancel', end);
    over.addEventListener('dblclick', () => this.window.reset());
    over.addEventListener(
      'wheel',
      (event) => {
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        this.window.zoom(event.deltaY > 0 ? 1.25 : 0.8, minutes(event));
      },
      { passive: false },
    );
  }

  private ordinate(low: number | null, high: number | null): [number, number] {
    let [a, b] = [low ?? 0, high ?? 1];
    if (!(b - a > 1e-12)) [a, b] = [a - (Math.abs(a) * 0.05 || 0.5), b + (Math.abs(b) * 0.05 || 0.5)];
    const [low0, span] = [a, b - a];
    for (const mark of this.plot.marks)
      for (const at of edges(mark)) {
        const [a2, b2] = [Math.min(a, at), Math.max(b, at)];
        if (b2 - a2 <= SQUEEZE * span || (at >= low0 && at <= low0 + span)) [a, b] = [a2, b2];
      }
    const room = 0.07 * (b - a);
    return [a - room, b + room];
  }

  /** Contractions and bands, below the curves. */
  private drawUnder(u: uPlot): void {
    const { ctx, bbox } = u;
    const right = bbox.left + bbox.width;
    const x = (seconds: number) => Math.min(right, Math.max(bbox.left, u.valToPos(seconds / 60, 'x', true)));
    ctx.save();
    ctx.fillStyle = this.colours.shade;
    for (const c of this.runs[0].info.contractions) {
      const [a, b] = [x(c.start_s), x(c.end_s)];
      if (b > a) ctx.fillRect(a, bbox.top, b - a, bbox.height);
    }
    const bottom = bbox.top + bbox.height;
    const y = (value: number) => Math.min(bottom, Math.max(bbox.top, u.valToPos(value, 'y', true)));
    for (const mark of this.plot.marks) {
      if (mark.kind !== 'band') continue;
      const top = y(mark.high ?? Infinity);
      const base = y(mark.low ?? -Infinity);
      ctx.fillStyle = this.colours.band;
      ctx.fillRect(bbox.left, top, bbox.width, base - top);
    }
    ctx.restore();
  }

  /** Events, and the edges and names of bands and values. */
  private drawOver(u: uPlot): void {
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    const right = bbox.left + bbox.width;
    const bottom = bbox.top + bbox.height;
    ctx.save();
    ctx.font = `${10 * ratio}px system-ui, sans-serif`;
    ctx.lineWidth = ratio;
    let before = -Infinity;
    for (const event of this.runs[0].info.events) {
      if (event.event === 'contraction') continue;
      const x = u.valToPos(event.time_s / 60, 'x', true);
      if (x < bbox.left || x > right) continue;
      line(ctx, x, bbox.top, x, bottom, this.colours.event, [2 * ratio, 3 * ratio]);
      if (Math.abs(x - before) < 11 * ratio) continue;
      before = x;
      ctx.save();
      // Beside its line, on the left where there is no room on the right.
      ctx.translate(x + (x > right - 12 * ratio ? -3 : 10) * ratio, bbox.top + 3 * ratio);
      ctx.rotate(-Math.PI / 2);
      ctx.textAlign = 'right';
      ctx.fillStyle = this.colours.muted;
      ctx.fillText(words(event.event), 0, 0);
      ctx.restore();
    }
    ctx.textAlign = 'right';
    const y = (value: number) => u.valToPos(value, 'y', true);
    for (const mark of this.plot.marks)
      for (const value of edges(mark).filter((v) => y(v) >= bbox.top && y(v) <= bottom))
        line(ctx, bbox.left, y(value), right, y(value), this.colours.bandEdge, mark.kind === 'value' ? [5 * ratio, 3 * ratio] : []);
    const taken: number[] = [];
    for (const mark of this.plot.marks) {
      const ends = edges(mark).map(y);
      if (!ends.length) continue;
      const [top, base] = [Math.min(...ends), Math.max(...ends)];
      let label = mark.label;
      let at = mark.kind === 'value' && top - 12 * ratio > bbox.top ? top - 4 * ratio : top + 11 * ratio;
      if (top > bottom) [label, at] = [`↓ ${mark.label}`, bottom];
      else if (base < bbox.top) [label, at] = [`↑ ${mark.label}`, bbox.top];
      at = Math.min(bottom - 3 * ratio, Math.max(bbox.top + 10 * ratio, at));
      while (taken.some((other) => Math.abs(other - at) < 11 * ratio) && at < bottom - 14 * ratio) at += 12 * ratio;
      taken.push(at);
      ctx.fillStyle = this.colours.bandEdge;
      ctx.strokeStyle = this.colours.background;
      ctx.lineWidth = 3 * ratio;
      ctx.lineJoin = 'round';
      ctx.strokeText(label, right - 22 * ratio, at);
      ctx.fillText(label, right - 22 * ratio, at);
      ctx.lineWidth = ratio;
    }
    ctx.restore();
  }

  private hover(u: uPlot): void {
    const left = u.cursor.left ?? -1;
    this.hovered = left >= 0 ? u.posToVal(left, 'x') : null;
    this.showValues();
  }

  private showValues(): void {
    const minutes = this.hovered ?? this.clock.time / 60;
    const now = performance.now();
    // Nobody reads figures faster than that.
    if (minutes === this.shown || (this.clock.playing && now - this.shownAt < READ_MS)) return;
    this.shown = minutes;
    this.shownAt = now;
    this.stamp.textContent = this.hovered === null ? '' : `at ${clockText(60 * minutes)}`;
    this.lines.forEach((line, k) => (this.values[k].textContent = numberText(valueAt(line, minutes))));
  }

  private placeCursor(): void {
    if (!this.plotted) return;
    const x = this.plotted.valToPos(this.clock.time / 60, 'x');
    const inside = x >= -0.5 && x <= this.plotted.bbox.width / uPlot.pxRatio + 0.5;
    this.cursor.style.visibility = inside ? 'visible' : 'hidden';
    this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  /** Called for every picture; does nothing out of sight. */
  follow(): void {
    if (!this.visible) return;
    this.placeCursor();
    this.showValues();
  }

  setVisible(visible: boolean): void {
    this.visible = visible;
    if (!visible) return;
    this.create();
    this.follow();
  }

  resize(): void {
    const width = this.holder.clientWidth;
    if (this.plotted && width > 0 && Math.abs(width - this.plotted.width) > 1) {
      this.plotted.setSize({ width, height: HEIGHT });
      this.placeCursor();
    }
  }

  recolour(): void {
    this.colours = chartColours();
    this.plotted?.redraw(false, true);
  }

  moved(): void {
    this.placeCursor();
  }

  private saveCsv(): void {
    download(`${fileName(this.runs[0].info.name, this.plot.id)}.csv`, new Blob([toCsv(this.lines, this.plot.unit)], { type: 'text/csv' }));
  }

  /** Title, legend and plot, as on the page. */
  private savePng(): void {
    this.create();
    const u = this.plotted;
    if (!u) return;
    const ratio = uPlot.pxRatio;
    const source = u.ctx.canvas;
    const head = 44 * ratio;
    const canvas = h('canvas', { width: source.width, height: source.height + head });
    const ctx = canvas.getContext('2d')!;
    ctx.fillStyle = this.colours.background;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.fillStyle = this.colours.ink;
    ctx.font = `600 ${13 * ratio}px system-ui, sans-serif`;
    ctx.fillText(
      [this.plot.title, this.plot.unit && `[${this.plot.unit}]`, this.plot.figure && `(${this.plot.figure})`].filter(Boolean).join(' '),
      8 * ratio,
      17 * ratio,
    );
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    let x = 8 * ratio;
    for (const item of this.lines) {
      ctx.setLineDash((this.dash(item) ?? []).map((d) => d * ratio));
      ctx.strokeStyle = this.colours.lines[this.colourIndex(item)];
      ctx.lineWidth = 2 * ratio;
      ctx.beginPath();
      ctx.moveTo(x, 32 * ratio);
      ctx.lineTo(x + 16 * ratio, 32 * ratio);
      ctx.stroke();
      ctx.fillText(item.label, x + 21 * ratio, 36 * ratio);
      x += 34 * ratio + ctx.measureText(item.label).width;
    }
    ctx.drawImage(source, 0, head);
    canvas.toBlob((blob) => blob && download(`${fileName(this.runs[0].info.name, this.plot.id)}.png`, blob));
  }
}

const edges = (mark: Mark): number[] =>
  (mark.kind === 'band' ? [mark.low, mark.high] : [mark.value]).filter((v): v is number => typeof v === 'number' && Number.isFinite(v));

function line(ctx: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number, colour: string, dash: number[]): void {
  ctx.strokeStyle = colour;
  ctx.setLineDash(dash);
  ctx.beginPath();
  ctx.moveTo(x1, y1);
  ctx.lineTo(x2, y2);
  ctx.stroke();
  ctx.setLineDash([]);
}
