// SPDX-License-Identifier: Apache-2.0
// Reads the page's data, or says why it cannot; follows a birth that is still in progress.
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { App, progressOf, reason } from './app';
import { parseManifest, ReportError, type Manifest } from './data/format';
import { h } from './ui/dom';
import { Choices } from './viewer';

const host = document.getElementById('app')!;
const choices = new Choices();

function fail(message: string): void {
  host.dataset.state = 'failed';
  host.replaceChildren(h('main', {}, h('h1', {}, 'Carus report'), h('p', { class: 'message', role: 'alert' }, message)));
}

function read(): Manifest {
  const text = document.getElementById('carus-manifest')?.textContent;
  if (!text) throw new ReportError('This page holds no data. It is the empty viewer: carus report DIR writes a page with a birth in it.');
  return parseManifest(text);
}

/** Offers the new state of a birth in progress as soon as the server has one. */
class Live {
  private known: string;
  readonly banner = h('div', { class: 'live', role: 'status' });
  private latest: Manifest | null = null;
  private stopped = false;

  constructor(
    private manifest: Manifest,
    private show: (manifest: Manifest) => void,
  ) {
    this.known = progressOf(manifest);
    this.say(`In progress: ${this.known}.`);
    this.wait();
  }

  private say(text: string): void {
    this.banner.replaceChildren(h('span', { class: 'pulse' }), text);
    const follow = h('input', { type: 'checkbox' });
    follow.checked = choices.follow;
    follow.addEventListener('change', () => {
      choices.follow = follow.checked;
      if (this.latest && choices.follow) this.show(this.latest);
    });
    this.banner.append(h('label', { class: 'check' }, follow, 'show what is new by itself'));
    if (!this.latest) return;
    const latest = this.latest;
    if (choices.follow) this.show(latest);
    else this.banner.append(h('button', { type: 'button', class: 'primary', click: () => this.show(latest) }, 'Show it'));
  }

  stop(): void {
    this.stopped = true;
  }

  private wait(): void {
    const live = this.manifest.live!;
    if (!this.stopped) setTimeout(() => void this.ask(live.src), 1000 * Math.max(1, live.every_s));
  }

  private async ask(src: string): Promise<void> {
    if (this.stopped) return;
    try {
      const response = await fetch(src, { cache: 'no-store' });
      if (!response.ok) throw new ReportError(`the server answers ${response.status}`);
      const manifest = parseManifest(await response.text());
      const progress = progressOf(manifest);
      if (!manifest.live) {
        this.latest = manifest;
        this.say(`The run has ended: ${progress}.`);
        return;
      }
      if (progress !== this.known) {
        this.latest = manifest;
        this.say(`In progress: ${progress} by now (shown: ${this.known}).`);
      }
    } catch (error) {
      this.say(`The server does not answer (${reason(error)}; last tried at ${new Date().toISOString().slice(11, 19)} UTC).`);
    }
    this.wait();
  }
}

let app: App | null = null;
let live: Live | null = null;

async function show(manifest: Manifest): Promise<void> {
  const scrolled = window.scrollY;
  app?.dispose();
  live?.stop();
  live = manifest.live ? new Live(manifest, (next) => void show(next)) : null;
  app = new App(host, manifest, choices, live?.banner ?? null);
  await app.start();
  if (scrolled) window.scrollTo(0, scrolled);
}

try {
  show(read()).catch((error) => fail(`The report cannot be shown: ${reason(error)}`));
} catch (error) {
  fail(reason(error));
}
