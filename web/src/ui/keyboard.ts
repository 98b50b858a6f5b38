// SPDX-License-Identifier: Apache-2.0
// The whole page by keyboard: one table, which is also the help.
import { SPEEDS, type Clock } from '../clock';
import type { ViewName } from '../scene/stage';
import { AXES, type Axis, type Viewer } from '../viewer';
import { h } from './dom';

interface Key {
  keys: string[];
  shown: string;
  what: string;
  press: (event: KeyboardEvent) => void;
}

export interface KeyTargets {
  clock: Clock;
  viewer: () => Viewer | null;
  theme(): void;
  organs(): void;
  screenshot(): void;
  measure(on: boolean): void;
}

const VIEW_KEYS: ViewName[] = ['oblique', 'front', 'right', 'left', 'back', 'vulva', 'above'];

export class Keyboard {
  readonly help: HTMLDialogElement;
  private table: Key[];
  private listener = (event: KeyboardEvent) => this.handle(event);

  constructor(private targets: KeyTargets) {
    const { clock } = targets;
    const viewer = (act: (v: Viewer) => void) => () => {
      const v = targets.viewer();
      if (v) act(v);
    };
    const speed = (n: number) => () => {
      const k = SPEEDS.indexOf(clock.speed) + n;
      if (SPEEDS[k]) clock.setSpeed(SPEEDS[k]);
    };
    const nextCut = (v: Viewer) => {
      const order: (Axis | null)[] = [null, ...(Object.keys(AXES) as Axis[])];
      v.setCut(order[(order.indexOf(v.choices.cut?.axis ?? null) + 1) % order.length]);
    };
    const moveCut = (n: number) =>
      viewer((v) => {
        const cut = v.choices.cut;
        if (!cut) return;
        const [low, high] = v.range(cut.axis);
        v.changeCut({ at_mm: Math.min(high, Math.max(low, cut.at_mm + n)) });
      });
    this.table = [
      { keys: [' '], shown: 'Space', what: 'play or pause', press: () => clock.play(!clock.playing) },
      { keys: ['ArrowLeft'], shown: '←', what: 'a frame back (Shift: ten)', press: (e) => clock.step(e.shiftKey ? -10 : -1) },
      { keys: ['ArrowRight'], shown: '→', what: 'a frame on (Shift: ten)', press: (e) => clock.step(e.shiftKey ? 10 : 1) },
      { keys: ['Home'], shown: 'Home', what: 'to the start', press: () => clock.set(0) },
      { keys: ['End'], shown: 'End', what: 'to the end', press: () => clock.set(clock.duration) },
      { keys: ['['], shown: '[', what: 'slower', press: speed(-1) },
      { keys: [']'], shown: ']', what: 'faster', press: speed(1) },
      ...VIEW_KEYS.map((name, k) => ({
        keys: [String(k + 1)],
        shown: k ? '' : '1 … 7',
        what: k ? '' : 'views',
        press: viewer((v) => v.stage.look(name)),
      })),
      {
        keys: ['a', 'd'],
        shown: 'A D',
        what: 'turn the picture left, right',
        press: (e) => viewer((v) => v.stage.orbit(e.key === 'a' ? -0.1 : 0.1, 0))(),
      },
      {
        keys: ['w', 's'],
        shown: 'W S',
        what: 'turn it up, down',
        press: (e) => viewer((v) => v.stage.orbit(0, e.key === 'w' ? -0.1 : 0.1))(),
      },
      {
        keys: ['+', '=', '-'],
        shown: '+ −',
        what: 'nearer, farther (on a curve: zoom; 0: all)',
        press: (e) => viewer((v) => v.stage.orbit(0, 0, e.key === '-' ? 1.1 : 0.9))(),
      },
      { keys: ['c'], shown: 'C', what: 'cut: coronal, sagittal, axial, off', press: viewer(nextCut) },
      { keys: [','], shown: ', .', what: 'move the cut by 2 mm', press: moveCut(-2) },
      { keys: ['.'], shown: '', what: '', press: moveCut(2) },
      { keys: ['o'], shown: 'O', what: 'list of organs', press: () => targets.organs() },
      {
        keys: ['m'],
        shown: 'M',
        what: 'measure: click two points, or Enter picks in the middle',
        press: viewer((v) => targets.measure(!v.measuring)),
      },
      { keys: ['p'], shown: 'P', what: 'save the picture', press: () => targets.screenshot() },
      { keys: ['t'], shown: 'T', what: 'dark or light', press: () => targets.theme() },
      { keys: ['?', 'h'], shown: '?', what: 'this list', press: () => this.showHelp() },
    ];
    this.help = h(
      'dialog',
      { class: 'help', 'aria-labelledby': 'help-title' },
      h('h2', { id: 'help-title' }, 'Keyboard'),
      h('dl', {}, ...this.table.filter((key) => key.shown).flatMap((key) => [h('dt', {}, h('kbd', {}, key.shown)), h('dd', {}, key.what)])),
      h('p', {}, 'Mouse: drag to turn, right button to shift, wheel to come nearer.'),
      h('form', { method: 'dialog' }, h('button', { class: 'primary' }, 'Close')),
    );
    window.addEventListener('keydown', this.listener);
  }

  showHelp(): void {
    if (!this.help.open) this.help.showModal();
  }

  private handle(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || this.help.open) return;
    const target = event.target as HTMLElement;
    const timeSlider = target.classList.contains('scrub');
    // Widgets keep the keys that they use themselves.
    if (target.closest('select, textarea, pre, .scrolls')) return;
    if (target instanceof HTMLInputElement && !timeSlider && (target.type !== 'checkbox' || event.key === ' ')) return;
    if (event.key === ' ' && target.closest('button, summary, a')) return;
    const viewer = this.targets.viewer();
    if (event.key === 'Enter' && viewer?.measuring && target === viewer.stage.canvas) {
      viewer.pickAt(0.5, 0.5);
      event.preventDefault();
      return;
    }
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = this.table.find((k) => k.keys.includes(name));
    if (!key) return;
    event.preventDefault();
    key.press(event);
  }

  dispose(): void {
    window.removeEventListener('keydown', this.listener);
    this.help.remove();
  }
}
