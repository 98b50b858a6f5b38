// SPDX-License-Identifier: Apache-2.0
// The controls of the picture: views, colour, cut, what is drawn besides, pictures and movies.
import type { Run } from '../data/run';
import { VIEWS, type ViewName } from '../scene/stage';
import { AXES, type Axis, type Viewer } from '../viewer';
import { h, iconButton } from './dom';

export interface ToolbarActions {
  organs(): void;
  screenshot(): void;
  movie(): void;
  showRun(index: number): void;
  ghostOf(index: number | null): void;
  measure(on: boolean): void;
}

const SHORT: [ViewName, string][] = [
  ['oblique', 'Oblique'],
  ['front', 'Front'],
  ['right', 'Right'],
  ['left', 'Left'],
  ['back', 'Back'],
  ['vulva', 'Vulva'],
  ['above', 'Above'],
];

export class Toolbar {
  readonly element: HTMLElement;
  private cut: Record<Axis | 'none', HTMLButtonElement>;
  private position = h('input', { type: 'range', step: 1, 'aria-label': 'Place of the cut' });
  private place = h('output', { class: 'cut-place' });
  private cutDetails: HTMLElement;
  private whole = h('input', { type: 'checkbox' });
  private colour = h('select', { 'aria-label': 'Colour by' });
  private toggles: { button: HTMLButtonElement; on: () => boolean; can: () => boolean }[] = [];
  private movie: HTMLButtonElement;
  private ghost: HTMLSelectElement | null = null;

  constructor(
    private viewer: Viewer,
    runs: Run[],
    private actions: ToolbarActions,
  ) {
    const views = SHORT.map(([name, label], k) =>
      h(
        'button',
        { type: 'button', 'data-view': name, title: `${VIEWS[name].label} (${k + 1})`, click: () => viewer.stage.look(name) },
        label,
      ),
    );
    this.cut = { none: this.cutButton('none', 'Off', null) } as typeof this.cut;
    for (const axis of Object.keys(AXES) as Axis[]) this.cut[axis] = this.cutButton(axis, AXES[axis].label, axis);
    this.position.addEventListener('input', () => viewer.changeCut({ at_mm: Number(this.position.value) }));
    this.whole.addEventListener('change', () => viewer.changeCut({ wholeFetus: this.whole.checked }));
    this.cutDetails = h(
      'span',
      { class: 'cut-details' },
      this.position,
      this.place,
      iconButton('flip', 'Other side of the cut', () => {
        viewer.changeCut({ flipped: !viewer.choices.cut?.flipped });
        viewer.faceCut();
      }),
      h('label', { class: 'check' }, this.whole, 'whole fetus'),
    );
    this.colour.addEventListener('change', () => viewer.setField(this.colour.value));
    this.movie = iconButton('film', 'Record a movie (WebM)', () => actions.movie());
    const { choices } = viewer;
    this.element = h(
      'div',
      { class: 'toolbar', role: 'toolbar', 'aria-label': 'Picture' },
      h(
        'div',
        { class: 'row' },
        h('span', { class: 'segment', role: 'group', 'aria-label': 'View' }, ...views),
        h('span', { class: 'spacer' }),
        this.tools(),
      ),
      h(
        'div',
        { class: 'row' },
        h('label', { class: 'labelled' }, 'Colour', this.colour),
        h(
          'span',
          { class: 'labelled' },
          'Cut',
          h('span', { class: 'segment', role: 'group', 'aria-label': 'Cut' }, ...Object.values(this.cut)),
        ),
        this.cutDetails,
      ),
      runs.length > 1 ? this.runsRow(runs) : null,
    );
    this.addToggle(
      'trail',
      () => choices.trail,
      () => viewer.hasTrail,
    );
    this.addToggle(
      'axes',
      () => choices.axes,
      () => viewer.hasTrail,
    );
    this.addToggle(
      'measure',
      () => viewer.measuring,
      () => true,
    );
    viewer.onChange(() => this.follow());
    this.follow();
  }

  private cutButton(name: string, label: string, axis: Axis | null): HTMLButtonElement {
    return h('button', { type: 'button', 'data-cut': name, click: () => this.viewer.setCut(axis) }, label);
  }

  private tools(): HTMLElement {
    const { viewer, actions } = this;
    const toggle = (name: string, label: string, title: string, flip: () => void) =>
      h('button', { type: 'button', class: 'toggle', 'data-toggle': name, title, 'aria-pressed': 'false', click: flip }, label);
    return h(
      'span',
      { class: 'tools' },
      toggle('trail', 'Trail', "The head's path", () => {
        viewer.choices.trail = !viewer.choices.trail;
        viewer.changed();
      }),
      toggle('axes', 'Axes', "The head's axes: they turn with it", () => {
        viewer.choices.axes = !viewer.choices.axes;
        viewer.changed();
      }),
      toggle('measure', 'Measure', 'Click two points (M)', () => actions.measure(!viewer.measuring)),
      iconButton('layers', 'Organs', () => actions.organs(), 'O'),
      iconButton('camera', 'Save the picture (PNG)', () => actions.screenshot(), 'P'),
      this.movie,
    );
  }

  private addToggle(name: string, on: () => boolean, can: () => boolean): void {
    const button = this.element.querySelector<HTMLButtonElement>(`[data-toggle="${name}"]`)!;
    this.toggles.push({ button, on, can });
  }

  private runsRow(runs: Run[]): HTMLElement {
    const shown = h('select', { 'aria-label': 'Run shown' });
    const ghost = h('select', { 'aria-label': 'Ghost' }, h('option', { value: '' }, 'none'));
    for (const run of runs) {
      const can = run.info.mesh !== null && run.info.frames !== null;
      shown.append(h('option', { value: run.index, disabled: !can }, run.info.name));
      ghost.append(h('option', { value: run.index, disabled: !can }, run.info.name));
    }
    shown.value = String(this.viewer.body.run.index);
    shown.addEventListener('change', () => this.actions.showRun(Number(shown.value)));
    ghost.addEventListener('change', () => this.actions.ghostOf(ghost.value === '' ? null : Number(ghost.value)));
    this.ghost = ghost;
    return h(
      'div',
      { class: 'row' },
      h('label', { class: 'labelled' }, 'Run', shown),
      h('label', { class: 'labelled' }, h('i', { class: 'ghost-swatch' }), 'Ghost', ghost),
    );
  }

  recording(on: boolean): void {
    this.movie.classList.toggle('recording', on);
    this.movie.setAttribute('aria-pressed', String(on));
    this.movie.title = on ? 'Stop and save the movie' : 'Record a movie (WebM)';
    this.movie.setAttribute('aria-label', this.movie.title);
  }

  /** Shows what is chosen now. */
  follow(): void {
    const { viewer } = this;
    const { cut } = viewer.choices;
    for (const [name, button] of Object.entries(this.cut)) button.setAttribute('aria-pressed', String((cut?.axis ?? 'none') === name));
    this.cutDetails.hidden = !cut;
    if (cut) {
      const [low, high] = viewer.range(cut.axis);
      this.position.min = String(low);
      this.position.max = String(high);
      this.position.value = String(cut.at_mm);
      this.whole.checked = cut.wholeFetus;
      const axis = AXES[cut.axis];
      const text = `${Math.abs(cut.at_mm).toFixed(0)} mm ${cut.at_mm === 0 ? '' : cut.at_mm > 0 ? axis.high : axis.low}`.trim();
      this.place.textContent = text;
      this.position.setAttribute('aria-valuetext', text);
    }
    const fields = viewer.body.run.info.frames?.fields ?? [];
    if (this.colour.options.length !== fields.length + 1)
      this.colour.replaceChildren(
        h('option', { value: '' }, 'Anatomy'),
        ...fields.map((f) => h('option', { value: f.name }, f.unit ? `${f.label} [${f.unit}]` : f.label)),
      );
    this.colour.value = viewer.choices.field;
    if (this.ghost) this.ghost.value = viewer.choices.ghost === null ? '' : String(viewer.choices.ghost);
    for (const { button, on, can } of this.toggles) {
      button.setAttribute('aria-pressed', String(on()));
      button.disabled = !can();
    }
  }
}
