// SPDX-License-Identifier: Apache-2.0
// The list of organs: seen or not, colour, opacity; one by one and by groups.
import { groupOf, lookOf } from '../scene/palette';
import type { OrganEntry } from '../scene/body';
import type { Viewer } from '../viewer';
import { h } from './dom';

export class OrganPanel {
  readonly element: HTMLElement;
  private body = h('div', { class: 'organ-groups' });

  constructor(
    private viewer: Viewer,
    close: () => void,
  ) {
    this.element = h(
      'aside',
      { class: 'organs', 'aria-label': 'Organs' },
      h(
        'header',
        {},
        h('h3', {}, 'Organs'),
        h('span', { class: 'spacer' }),
        h('button', { type: 'button', class: 'quiet', click: () => this.reset() }, 'Reset'),
        h('button', { type: 'button', class: 'quiet', 'aria-label': 'Close the list of organs', click: close }, '×'),
      ),
      this.body,
    );
    this.fill();
  }

  private reset(): void {
    for (const { region, look } of this.viewer.body.entries) Object.assign(look, lookOf(region));
    this.fill();
    this.viewer.applyLooks();
  }

  fill(): void {
    const groups = new Map<string, OrganEntry[]>();
    for (const entry of this.viewer.body.entries) {
      const name = groupOf(entry.region);
      groups.set(name, [...(groups.get(name) ?? []), entry]);
    }
    this.body.replaceChildren(...[...groups].map(([name, entries]) => this.group(name, entries)));
  }

  private group(name: string, entries: OrganEntry[]): HTMLElement {
    const rows = entries.map((entry) => this.row(entry));
    const all = h('input', { type: 'checkbox' });
    const opacity = h('input', { type: 'range', min: 0, max: 1, step: 0.02, 'aria-label': `Opacity of all: ${name}` });
    const sync = () => {
      const seen = entries.filter((entry) => entry.look.visible).length;
      all.checked = seen > 0;
      all.indeterminate = seen > 0 && seen < entries.length;
      opacity.value = String(entries.reduce((sum, entry) => sum + entry.look.opacity, 0) / entries.length);
    };
    all.addEventListener('change', () => {
      entries.forEach((entry, i) => {
        entry.look.visible = all.checked;
        rows[i].sync();
      });
      this.viewer.applyLooks();
      sync();
    });
    opacity.addEventListener('input', () => {
      entries.forEach((entry, i) => {
        entry.look.opacity = Number(opacity.value);
        rows[i].sync();
      });
      this.viewer.applyLooks();
    });
    sync();
    const list = h('ul', {}, ...rows.map((row) => row.element));
    list.addEventListener('change', sync);
    list.addEventListener('input', sync);
    return h(
      'fieldset',
      {},
      h('legend', { class: 'hidden' }, name),
      h('div', { class: 'group-row' }, h('label', {}, all, h('b', {}, name)), opacity),
      list,
    );
  }

  private row(entry: OrganEntry): { element: HTMLElement; sync: () => void } {
    const { region, look } = entry;
    const seen = h('input', { type: 'checkbox', 'data-organ': region.name });
    const colour = h('input', { type: 'color', 'aria-label': `Colour: ${region.label}` });
    const opacity = h('input', {
      type: 'range',
      min: 0,
      max: 1,
      step: 0.02,
      'aria-label': `Opacity: ${region.label}`,
      'data-opacity': region.name,
    });
    const sync = () => {
      seen.checked = look.visible;
      colour.value = look.colour;
      opacity.value = String(look.opacity);
    };
    sync();
    seen.addEventListener('change', () => {
      look.visible = seen.checked;
      this.viewer.applyLooks();
    });
    colour.addEventListener('input', () => {
      look.colour = colour.value;
      this.viewer.applyLooks();
    });
    opacity.addEventListener('input', () => {
      look.opacity = Number(opacity.value);
      this.viewer.applyLooks();
    });
    return { element: h('li', {}, h('label', {}, seen, capital(region.label)), colour, opacity), sync };
  }
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);
