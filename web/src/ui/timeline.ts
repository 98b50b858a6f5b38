// SPDX-License-Identifier: Apache-2.0
// Play, pause, step, speed and scrub, over a strip that shows contractions, events and what is decoded.
import { SPEEDS, type Clock } from '../clock';
import type { Run } from '../data/run';
import { h, icon, iconButton } from './dom';
import { clockText, words } from './text';

export class Timeline {
  readonly element: HTMLElement;
  private slider: HTMLInputElement;
  private strip = h('div', { class: 'strip', 'aria-hidden': 'true' });
  private decoded = h('div', { class: 'decoded-layer' });
  private readout = h('output', { class: 'time-readout' });
  private playButton: HTMLButtonElement;
  private playing: boolean | null = null;
  private shownTime = -1;

  constructor(
    private run: Run,
    private clock: Clock,
  ) {
    this.slider = h('input', {
      type: 'range',
      min: 0,
      max: clock.duration || 1,
      step: 'any',
      value: 0,
      class: 'scrub',
      'aria-label': 'Time of labour',
      input: () => clock.set(Number(this.slider.value)),
    });
    this.playButton = h('button', { type: 'button', class: 'icon-button play', click: () => clock.play(!clock.playing) });
    const speed = h('select', { 'aria-label': 'Speed', title: 'Seconds of labour in a second ([ and ])' });
    for (const s of SPEEDS) speed.append(h('option', { value: s }, `${s}×`));
    speed.value = String(clock.speed);
    speed.addEventListener('change', () => clock.setSpeed(Number(speed.value)));
    this.drawStrip();
    this.element = h(
      'div',
      { class: 'timeline', role: 'group', 'aria-label': 'Playback' },
      iconButton('start', 'To the start', () => clock.set(0), 'Home'),
      iconButton('back', 'A frame back', () => clock.step(-1), 'Left'),
      this.playButton,
      iconButton('forward', 'A frame on', () => clock.step(1), 'Right'),
      h('div', { class: 'scrubber' }, this.strip, this.decoded, this.slider),
      this.readout,
      speed,
    );
    clock.onChange(() => {
      if (speed.value !== String(clock.speed)) speed.value = String(clock.speed);
    });
    this.follow();
  }

  private percent(seconds: number): string {
    return `${(100 * Math.min(1, Math.max(0, seconds / (this.clock.duration || 1)))).toFixed(3)}%`;
  }

  private drawStrip(): void {
    for (const c of this.run.info.contractions) {
      const mark = h('i', { class: 'contraction' });
      mark.style.left = this.percent(c.start_s);
      mark.style.width = `calc(${this.percent(c.end_s)} - ${this.percent(c.start_s)})`;
      this.strip.append(mark);
    }
    for (const event of this.run.info.events) {
      if (event.event === 'contraction') continue;
      const mark = h('i', { class: 'event', title: `${words(event.event)}, ${clockText(event.time_s)}` });
      mark.style.left = this.percent(event.time_s);
      this.strip.append(mark);
    }
  }

  showDecoded(): void {
    this.decoded.replaceChildren(
      ...this.run.decodedSpans().map(([from, to]) => {
        const span = h('i');
        span.style.left = this.percent(from);
        span.style.width = `calc(${this.percent(to)} - ${this.percent(from)})`;
        return span;
      }),
    );
  }

  follow(): void {
    const { clock } = this;
    if (clock.playing !== this.playing) {
      this.playing = clock.playing;
      const label = clock.playing ? 'Pause' : 'Play';
      this.playButton.replaceChildren(icon(clock.playing ? 'pause' : 'play'));
      this.playButton.setAttribute('aria-label', label);
      this.playButton.title = `${label} (Space)`;
    }
    if (clock.time === this.shownTime) return;
    this.shownTime = clock.time;
    this.slider.value = String(clock.time);
    this.slider.style.setProperty('--done', this.percent(clock.time));
    const text = `${clockText(clock.time)} / ${clockText(clock.duration)}`;
    if (this.readout.textContent !== text) {
      this.readout.textContent = text;
      this.slider.setAttribute('aria-valuetext', `${clockText(clock.time)} of ${clockText(clock.duration)} minutes${this.inWords()}`);
    }
  }

  private inWords(): string {
    const n = this.run.info.contractions.findIndex((c) => this.clock.time >= c.start_s && this.clock.time <= c.end_s);
    return n >= 0 ? `, contraction ${n + 1}` : '';
  }
}
