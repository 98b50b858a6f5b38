// SPDX-License-Identifier: Apache-2.0
// The page of one manifest: its parts, and the loop that keeps them at one time.
import { Clock } from './clock';
import { CurvesPanel } from './curves/panel';
import { Decoder } from './data/decoder';
import type { Manifest } from './data/format';
import { Run } from './data/run';
import { captionOf, compose, Recorder } from './scene/record';
import { download, fileName, h, iconButton } from './ui/dom';
import { comparisonSection, provenanceSection } from './ui/facts';
import { Keyboard } from './ui/keyboard';
import { MeasureLabel, Moment, ScaleLegend, Triad } from './ui/legend';
import { OrganPanel } from './ui/organs';
import { Theme } from './ui/theme';
import { clockText, numberText, words } from './ui/text';
import { Timeline } from './ui/timeline';
import { Toolbar } from './ui/toolbar';
import { verdictSection } from './ui/verdict';
import { Choices, Viewer } from './viewer';

const OUTCOMES: Record<string, string> = { born: 'born', not_born: 'not born', failed: 'failed' };

export class App {
  private decoder: Decoder;
  private runs: Run[];
  private clock: Clock;
  private viewer: Viewer | null = null;
  private timeline: Timeline;
  private curves: CurvesPanel | null = null;
  private toolbar: Toolbar | null = null;
  private organs: OrganPanel | null = null;
  private legend = new ScaleLegend();
  private triad = new Triad();
  private measureLabel = new MeasureLabel();
  private moment = new Moment();
  private status = h('div', { class: 'decode-status', role: 'status' });
  private notices = h('div', { class: 'notices', role: 'status' });
  private picture = h('div', { class: 'picture' });
  private stageSection = h('section', { class: 'stage', 'aria-label': 'Picture in three dimensions' });
  private theme: Theme;
  private keyboard: Keyboard;
  private recorder = new Recorder();
  private alive = true;
  private told = new Set<string>();

  constructor(
    private host: HTMLElement,
    private manifest: Manifest,
    private choices: Choices,
    private banner: HTMLElement | null = null,
  ) {
    this.decoder = new Decoder(manifest.blobs);
    this.runs = manifest.runs.map((info, index) => new Run(index, info, this.decoder));
    const shown = this.runs[0];
    this.clock = new Clock(Math.max(...this.runs.map((run) => run.info.duration_s)), shown.times);
    // Who follows a birth in progress sees its newest moment.
    this.clock.set(choices.follow ? this.clock.duration : choices.time);
    this.clock.onChange(() => (choices.time = this.clock.time));
    this.theme = new Theme(() => this.recolour());
    this.keyboard = new Keyboard({
      clock: this.clock,
      viewer: () => this.viewer,
      theme: () => this.theme.toggle(),
      organs: () => this.toggleOrgans(),
      screenshot: () => this.screenshot(),
      measure: (on) => this.measure(on),
    });
    this.timeline = new Timeline(shown, this.clock);
    document.title = `${manifest.title} · Carus report`;
  }

  async start(): Promise<void> {
    const { manifest, runs } = this;
    for (const run of runs) for (const note of run.info.notes) this.tell(note, run);
    for (const run of runs) {
      const said = (what: string) => run.info.notes.some((note) => note.includes(what));
      if (run.info.status === 'in_progress' && !said('in progress')) this.tell('This birth is still in progress: no summary yet.', run);
      if (run.info.status === 'failed') this.tell('This run has failed; what it reached is shown.', run);
    }
    const opened = await Promise.allSettled(runs.map((run) => run.openCurves()));
    opened.forEach(
      (result, k) => result.status === 'rejected' && this.tell(`The curves cannot be read: ${reason(result.reason)}`, runs[k]),
    );
    this.curves = new CurvesPanel(runs, this.clock);
    this.stageSection.append(this.picture, this.timeline.element);
    this.host.replaceChildren(
      this.head(),
      h(
        'main',
        {},
        this.banner,
        this.notices,
        verdictSection(runs),
        h('div', { class: 'columns-2' }, this.stageSection, this.curves.element),
        comparisonSection(manifest),
        provenanceSection(runs, manifest),
      ),
      this.keyboard.help,
    );
    await this.openPicture();
    let before = performance.now();
    const loop = (now: number) => {
      if (!this.alive) return;
      requestAnimationFrame(loop);
      const seconds = Math.min(0.25, (now - before) / 1000);
      before = now;
      this.tick(now, seconds);
    };
    requestAnimationFrame(loop);
  }

  private head(): HTMLElement {
    const first = this.runs[0].info;
    const outcome = first.summary && typeof first.summary.outcome === 'string' ? first.summary.outcome : first.status;
    return h(
      'header',
      { class: 'top' },
      h('span', { class: 'brand' }, 'Carus'),
      h('h1', {}, this.manifest.runs.map((run) => run.name).join(' · ')),
      h('span', { class: `badge ${outcome}` }, OUTCOMES[outcome] ?? words(outcome)),
      h('span', { class: 'spacer' }),
      this.theme.button,
      iconButton('help', 'Keyboard and help', () => this.keyboard.showHelp(), '?'),
    );
  }

  /** Says something once, above everything. */
  private tell(message: string, run?: Run): void {
    const text = run && this.runs.length > 1 ? `${run.info.name}: ${message}` : message;
    if (this.told.has(text)) return;
    this.told.add(text);
    this.notices.append(h('p', { class: 'notice' }, text));
  }

  private async openPicture(): Promise<void> {
    const run = this.runs.find((r) => r.info.mesh && r.info.frames);
    if (!run) {
      this.picture.append(
        h('p', { class: 'message' }, 'Nothing to show in three dimensions: the results folder has no frames that can be read.'),
      );
      this.finished();
      return;
    }
    this.picture.append(this.status);
    this.status.textContent = 'Decoding …';
    const unread = (error?: Error) => error && this.tell(`Some frames cannot be read: ${reason(error)}`);
    run.onChange = unread;
    try {
      await run.openMesh();
      // The last frame tells how far the picture must reach.
      await Promise.all([run.positions!.load(0), run.positions!.load(run.positions!.count - 1)]);
    } catch (error) {
      this.status.textContent = '';
      this.picture.append(h('p', { class: 'message' }, `The shapes cannot be read: ${reason(error)}`));
      this.finished();
      return;
    }
    try {
      this.viewer = new Viewer(this.picture, this.runs, this.clock, this.choices);
    } catch {
      this.picture.append(
        h(
          'p',
          { class: 'message' },
          'This browser shows no three-dimensional pictures (WebGL 2 is missing or switched off). The curves and tables work.',
        ),
      );
      this.status.textContent = '';
      this.finished();
      return;
    }
    const viewer = this.viewer;
    viewer.onError = unread;
    viewer.stage.canvas.tabIndex = 0;
    viewer.stage.canvas.setAttribute('role', 'img');
    viewer.stage.canvas.setAttribute(
      'aria-label',
      'The birth in three dimensions. A, D, W, S turn it; plus and minus come nearer; question mark lists all keys.',
    );
    viewer.show(run);
    this.toolbar = new Toolbar(viewer, this.runs, {
      organs: () => this.toggleOrgans(),
      screenshot: () => this.screenshot(),
      movie: () => void this.movie(),
      showRun: (index) => void this.showRun(index),
      ghostOf: (index) => void this.ghostOf(index),
      measure: (on) => this.measure(on),
    });
    this.stageSection.prepend(this.toolbar.element);
    this.picture.append(this.moment.element, this.legend.element, this.triad.element, this.measureLabel.element);
    viewer.stage.onDrawn = () => {
      this.triad.follow(viewer);
      this.measureLabel.follow(viewer);
    };
    viewer.onChange(() => {
      this.legend.follow(viewer.fieldShown);
      this.showDecoding();
    });
    viewer.onDecoded = () => this.showDecoding();
    this.legend.follow(viewer.fieldShown);
    this.recolour();
    this.showDecoding();
    const ghost = this.choices.ghost ?? this.manifest.ghost;
    if (ghost !== null && this.runs[ghost]) await this.ghostOf(ghost);
    this.finished();
  }

  private finished(): void {
    this.host.dataset.state = 'ready';
  }

  private showDecoding(): void {
    const positions = this.viewer?.body.run.positions;
    if (!positions) return;
    this.timeline.showDecoded();
    const all = positions.decoded === positions.count;
    this.host.dataset.decoded = all ? 'all' : String(positions.decoded);
  }

  private tick(now: number, seconds: number): void {
    this.clock.tick(seconds);
    const viewer = this.viewer;
    if (viewer) {
      viewer.tick(now, seconds);
      this.moment.follow(viewer.body.run.info, this.clock.time);
      const text = this.statusText(viewer);
      if (this.status.textContent !== text) this.status.textContent = text;
      if (this.recorder.recording) {
        this.recorder.frame((canvas) => this.composeInto(canvas, false));
        if (!this.clock.playing) void this.movie();
      }
    }
    this.timeline.follow();
    this.curves?.follow();
  }

  private statusText(viewer: Viewer): string {
    if (viewer.waiting) {
      const failed = viewer.body.run.failedAt(this.clock.time, this.choices.field);
      return failed ? 'The frames of this moment cannot be read' : 'Decoding …';
    }
    if (!viewer.measuring || viewer.measure.complete) return '';
    return viewer.measure.points.length ? 'Click the second point' : 'Click the first point';
  }

  private toggleOrgans(): void {
    if (!this.viewer) return;
    if (this.organs) {
      this.organs.element.remove();
      this.organs = null;
    } else {
      this.organs = new OrganPanel(this.viewer, () => this.toggleOrgans());
      this.picture.append(this.organs.element);
    }
  }

  private measure(on: boolean): void {
    this.viewer?.setMeasuring(on);
  }

  private async showRun(index: number): Promise<void> {
    const run = this.runs[index];
    const viewer = this.viewer;
    if (!run || !viewer) return;
    try {
      await run.openMesh();
      await run.positions!.load(0);
    } catch (error) {
      this.tell(`The shapes cannot be read: ${reason(error)}`, run);
      return;
    }
    this.clock.frames = run.times;
    viewer.show(run);
    if (this.organs) {
      this.toggleOrgans();
      this.toggleOrgans();
    }
    const before = this.timeline.element;
    this.timeline = new Timeline(run, this.clock);
    before.replaceWith(this.timeline.element);
    this.showDecoding();
  }

  private async ghostOf(index: number | null): Promise<void> {
    const run = index === null ? null : this.runs[index];
    try {
      await run?.openMesh();
      await run?.positions?.load(0);
      this.viewer?.setGhost(run);
    } catch (error) {
      this.tell(`The ghost's shapes cannot be read: ${reason(error)}`, run ?? undefined);
    }
  }

  private composeInto(canvas: HTMLCanvasElement, sharp: boolean): void {
    const style = getComputedStyle(this.picture);
    compose(canvas, this.viewer!, captionOf(this.viewer!.body.run.info.name, this.clock), style.backgroundColor, style.color, sharp);
  }

  private screenshot(): void {
    if (!this.viewer) return;
    const canvas = h('canvas');
    this.composeInto(canvas, true);
    const name = `${fileName(this.viewer.body.run.info.name, clockText(this.clock.time).replace(':', 'm'))}s.png`;
    canvas.toBlob((blob) => blob && download(name, blob), 'image/png');
  }

  /** Starts a movie from here (from the start if at the end), or stops it and hands it over. */
  private async movie(): Promise<void> {
    const viewer = this.viewer;
    if (!viewer) return;
    if (this.recorder.recording) {
      this.toolbar?.recording(false);
      this.clock.play(false);
      download(`${fileName(viewer.body.run.info.name, 'birth')}.webm`, await this.recorder.stop());
      return;
    }
    if (!Recorder.supported) {
      this.tell('This browser cannot record movies.');
      return;
    }
    try {
      this.clock.play(true);
      this.recorder.start(viewer, (canvas) => this.composeInto(canvas, false));
      this.toolbar?.recording(true);
    } catch (error) {
      this.tell(`No movie: ${reason(error)}`);
    }
  }

  private recolour(): void {
    this.curves?.recolour();
    if (!this.viewer) return;
    this.viewer.measure.setColour(getComputedStyle(this.picture).color);
    this.viewer.changed();
  }

  dispose(): void {
    this.alive = false;
    this.viewer?.dispose();
    this.curves?.dispose();
    this.keyboard.dispose();
    this.theme.dispose();
    this.decoder.close();
    delete this.host.dataset.state;
    delete this.host.dataset.decoded;
  }
}

export function reason(error: unknown): string {
  const text = error instanceof Error ? error.message : String(error);
  return text || 'damaged data';
}

/** How far a run in progress has come, in words. */
export function progressOf(manifest: Manifest): string {
  const run = manifest.runs[0];
  const frames = run.frames?.times_s.length ?? 0;
  return `${numberText(run.duration_s / 60)} min of labour, ${frames} frames`;
}
