// SPDX-License-Identifier: Apache-2.0
// Dark or light: the system's wish until a person says otherwise.
import { h, icon, recall, remember } from './dom';

const dark = window.matchMedia('(prefers-color-scheme: dark)');

export const isDark = (): boolean => document.documentElement.dataset.theme === 'dark';

export class Theme {
  readonly button: HTMLButtonElement;
  private listener = () => this.apply();

  constructor(private changed: () => void) {
    this.button = h('button', { type: 'button', class: 'icon-button', click: () => this.toggle() });
    dark.addEventListener('change', this.listener);
    this.apply();
  }

  toggle(): void {
    remember('theme', isDark() ? 'light' : 'dark');
    document.documentElement.dataset.chosen = isDark() ? 'light' : 'dark';
    this.apply();
  }

  private apply(): void {
    const chosen = document.documentElement.dataset.chosen ?? recall('theme');
    const theme = chosen === 'dark' || chosen === 'light' ? chosen : dark.matches ? 'dark' : 'light';
    document.documentElement.dataset.theme = theme;
    this.button.replaceChildren(icon(theme === 'dark' ? 'sun' : 'moon'));
    this.button.title = `${theme === 'dark' ? 'Light' : 'Dark'} (T)`;
    this.button.setAttribute('aria-label', theme === 'dark' ? 'Light colours' : 'Dark colours');
    this.changed();
  }

  dispose(): void {
    dark.removeEventListener('change', this.listener);
  }
}
