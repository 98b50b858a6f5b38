// SPDX-License-Identifier: Apache-2.0
// The page around the picture: verdict, texts, keyboard, colours, and what is said when something is missing.
import { expect, test, type Page } from '@playwright/test';
import type { Manifest } from '../src/data/format';
import { Blobs, makeManifest, makeRun, MARKUP, onDisk, report, scripts, spliced } from './fixture';
import { goTo, open, picture, watch } from './page';

async function openAny(page: Page, url: string, state: string): Promise<void> {
  watch(page, url);
  await page.goto(url);
  await expect(page.locator('#app')).toHaveAttribute('data-state', state);
}

test('the verdict is at the top: expected, source, obtained, inside or outside', async ({ page }) => {
  await open(page, report());
  await expect(page).toHaveTitle('cube · Carus report');
  await expect(page.locator('.verdict h2')).toHaveText('1 of 3 inside');
  await expect(page.locator('.meter i')).toHaveCount(4);
  const rows = page.locator('.verdict-table tbody tr');
  await expect(rows).toHaveCount(4);
  await expect(rows.nth(0)).toHaveText('head displacement, Z184 mm paper✗ 120 mm');
  await expect(rows.nth(0).getByRole('img', { name: 'outside' })).toBeVisible();
  await expect(rows.nth(2).getByRole('img', { name: 'inside' })).toBeVisible();
  await expect(rows.nth(3).getByRole('img', { name: 'not asked' })).toBeVisible();
  const verdict = (await page.locator('.verdict').boundingBox())!;
  const stage = (await page.locator('.stage').boundingBox())!;
  expect(verdict.y + verdict.height).toBeLessThanOrEqual(stage.y);
  // Something of the picture is on the first screen.
  expect(stage.y).toBeLessThan(700);
});

test('texts of a results folder never become markup', async ({ page }) => {
  await open(page, report({ name: MARKUP }));
  expect(await page.evaluate(() => (window as unknown as { broken?: number }).broken)).toBeUndefined();
  await expect(page.locator('#app img, #app b:text-is("bold")')).toHaveCount(0);
  await expect(page.locator('h1')).toHaveText(MARKUP);
  await expect(page.locator('.notice')).toContainText(MARKUP);
  await page.getByText('Scenario, in full').click();
  await expect(page.locator('pre').first()).toContainText(MARKUP);
  await page.getByRole('button', { name: 'Organs', exact: true }).click();
  await expect(page.locator('.organs')).toContainText(MARKUP);
});

test('the scenario, provenance, declared and calibrated figures are there in full', async ({ page }) => {
  await open(page, report());
  await expect(page.locator('.provenance')).toContainText('0.0.0-test');
  for (const title of ['Declared', 'Calibrated, and to what', 'Scenario, in full', 'Summary', 'Log'])
    await page.locator('summary', { hasText: title }).click();
  await expect(page.locator('.facts')).toHaveText([/\/results\/cube/, /toy/, /to nothing/]);
  await expect(page.locator('pre')).toHaveText([/name: cube/, /"birth_time_s": 590/, 'log of cube']);
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save cube_scenario.resolved.yaml' }).click(),
  ]);
  expect(file.suggestedFilename()).toBe('cube_scenario.resolved.yaml');
});

test('everything can be done by keyboard', async ({ page }) => {
  await open(page, report());
  const time = page.locator('.time-readout');
  await page.keyboard.press('ArrowRight');
  await expect(time).toHaveText('0:50 / 10:00');
  await page.keyboard.press('Shift+ArrowRight');
  await expect(time).toHaveText('9:10 / 10:00');
  await page.keyboard.press('ArrowLeft');
  await expect(time).toHaveText('8:20 / 10:00');
  await page.keyboard.press('End');
  await expect(time).toHaveText('10:00 / 10:00');
  await page.keyboard.press('Home');
  await page.keyboard.press(' ');
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  await page.keyboard.press(' ');
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
  for (const preset of ['coronal', 'sagittal', 'axial', 'none']) {
    await page.keyboard.press('c');
    await expect(page.locator(`[data-cut=${preset}]`)).toHaveAttribute('aria-pressed', 'true');
  }
  await page.keyboard.press('o');
  await expect(page.locator('.organs')).toBeVisible();
  await page.keyboard.press('o');
  await expect(page.locator('.organs')).toHaveCount(0);
  const theme = await page.locator('html').getAttribute('data-theme');
  await page.keyboard.press('t');
  await expect(page.locator('html')).not.toHaveAttribute('data-theme', theme!);
  await goTo(page, 300);
  await page.keyboard.press('m');
  await picture(page).focus();
  await page.keyboard.press('Enter');
  await page.keyboard.press('d');
  await page.keyboard.press('Enter');
  await expect(page.locator('.measure-label')).toHaveText(/mm$/);
  await page.keyboard.press('?');
  await expect(page.getByRole('dialog', { name: 'Keyboard' })).toBeVisible();
  await page.keyboard.press('Escape');
  await expect(page.getByRole('dialog')).toHaveCount(0);
});

test('every control can be reached, shows its focus and has a name', async ({ page }) => {
  await open(page, report({ name: 'a' }, { name: 'b' }));
  await page.keyboard.press('o');
  await page.locator('[data-cut=coronal]').click();
  const nameless = await page.locator('button, input, select, [tabindex]').evaluateAll((controls) =>
    controls
      .filter((c) => !(c as HTMLElement).hidden)
      .filter(
        (c) =>
          !(
            c.getAttribute('aria-label') ||
            c.textContent?.trim() ||
            (c as HTMLInputElement).labels?.length ||
            c.classList.contains('scrolls')
          ),
      )
      .map((c) => c.outerHTML),
  );
  expect(nameless).toEqual([]);
  await page.locator('body').click({ position: { x: 2, y: 300 } });
  const reached = new Set<string>();
  for (let i = 0; i < 90; i++) {
    await page.keyboard.press('Tab');
    const seen = await page.evaluate(() => {
      const e = document.activeElement as HTMLElement;
      const style = getComputedStyle(e);
      return { what: e.className || e.tagName, outline: e === document.body || parseFloat(style.outlineWidth) >= 1.5 };
    });
    expect(seen.outline, seen.what).toBe(true);
    reached.add(seen.what);
  }
  for (const what of ['scrub', 'icon-button play', 'plot', 'window', 'toggle']) expect([...reached]).toContain(what);
});

test('dark and light: the wish of the system until someone chooses', async ({ page }) => {
  const url = report();
  await page.emulateMedia({ colorScheme: 'dark' });
  await open(page, url);
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g)!.map(Number)[0]);
  expect(await background()).toBeLessThan(60);
  await page.emulateMedia({ colorScheme: 'light' });
  await expect.poll(background).toBeGreaterThan(200);
  await page.getByRole('button', { name: 'Dark colours' }).click();
  expect(await background()).toBeLessThan(60);
});

test('a narrow screen holds everything without scrolling sideways', async ({ page }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await open(page, report());
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(360);
  const box = (await picture(page).boundingBox())!;
  expect(Math.min(box.width, box.height)).toBeGreaterThan(220);
});

test('the empty viewer, damaged, cut short and foreign data: a clear message each', async ({ page }) => {
  const blobs = new Blobs();
  const manifest = makeManifest([makeRun(blobs)], blobs);
  const cases: [string, RegExp][] = [
    [spliced('<!-- nothing -->'), /holds no data/],
    [spliced(scripts('{"format":"carus-report-1","runs":[{', blobs)), /damaged or cut short/],
    [spliced(scripts('{"format":"other"}', blobs)), /reads data of the format "carus-report-1"; the page holds "other"/],
    [spliced(scripts(JSON.stringify({ ...manifest, runs: [] }), blobs)), /holds no run/],
  ];
  for (const [html, message] of cases) {
    await page.goto(onDisk(html));
    await expect(page.getByRole('alert')).toHaveText(message);
  }
});

test('pieces of data that are missing or damaged are named; the rest is shown', async ({ page }) => {
  const blobs = new Blobs();
  const manifest = makeManifest([makeRun(blobs)], blobs);
  const second = manifest.runs[0].frames!.position.chunks[1].blob;
  blobs.data[second] = blobs.data[second].subarray(0, 20);
  blobs.data[manifest.runs[0].curves!.blob] = Buffer.alloc(0);
  await openAny(page, onDisk(spliced(scripts(manifest, blobs))), 'ready');
  await expect(page.locator('.notices')).toContainText('The curves cannot be read: The page is cut short');
  await expect(page.locator('.notices')).toContainText('Some frames cannot be read');
  await goTo(page, 590);
  await expect(page.locator('.stage')).toContainText('The frames of this moment cannot be read');
  await goTo(page, 100);
  await expect(page.locator('.decode-status')).toHaveText('');
  await expect(page.locator('.decode-status')).toBeHidden();
  await expect(page.locator('.verdict-table tbody tr')).toHaveCount(4);
});

test('a folder without frames, summary or curves still gives a page', async ({ page }) => {
  const blobs = new Blobs();
  const run = makeRun(blobs);
  const bare = {
    ...run,
    mesh: null,
    frames: null,
    curves: null,
    summary: null,
    plots: [],
    status: 'in_progress',
    verdict: { ...run.verdict, line: '', rows: [] },
  };
  await openAny(page, onDisk(spliced(scripts(makeManifest([bare], blobs), blobs))), 'ready');
  await expect(page.locator('.stage')).toContainText('no frames that can be read');
  await expect(page.locator('.notices')).toContainText('still in progress');
  await expect(page.locator('.verdict h2')).toHaveText('No verdict: there is no summary yet');
  await expect(page.locator('.curves')).toContainText('no curves to draw');
});

test('served: pieces are fetched when needed, and a birth in progress is followed', async ({ page }) => {
  const blobs = new Blobs();
  const manifest = makeManifest([makeRun(blobs)], blobs);
  manifest.blobs.forEach((blob, k) => (blob.src = `blob/${k}`));
  manifest.runs[0].status = 'in_progress';
  manifest.live = { src: 'manifest.json', every_s: 1 };
  const empty = new Blobs();
  let grown: Manifest = manifest;
  const asked: string[] = [];
  await page.route('http://carus.test/**', async (route) => {
    const path = new URL(route.request().url()).pathname;
    asked.push(path);
    if (path === '/') await route.fulfill({ contentType: 'text/html', body: spliced(scripts(manifest, empty)) });
    else if (path === '/manifest.json') await route.fulfill({ json: grown });
    else if (path.startsWith('/blob/'))
      await route.fulfill({ contentType: 'application/octet-stream', body: blobs.data[Number(path.slice(6))] });
    else await route.fulfill({ status: 404 });
  });
  await page.goto('http://carus.test/');
  await expect(page.locator('#app')).toHaveAttribute('data-decoded', 'all');
  // The field that is not shown has not been asked for.
  const field = manifest.runs[0].frames!.fields[1].chunks[1].blob;
  expect(asked).not.toContain(`/blob/${field}`);
  await page.getByLabel('Colour by').selectOption('stretch');
  await expect.poll(() => asked).toContain(`/blob/${field}`);
  await goTo(page, 300);
  await expect(page.locator('.live')).toContainText('In progress: 10 min of labour, 13 frames.');
  grown = { ...manifest, runs: [{ ...manifest.runs[0], duration_s: 660 }] };
  await expect(page.locator('.live')).toContainText('11 min of labour, 13 frames by now');
  await page.getByRole('button', { name: 'Show it' }).click();
  await expect(page.locator('#app')).toHaveAttribute('data-decoded', 'all');
  // Time and colours are those of before.
  await expect(page.locator('.time-readout')).toHaveText('5:00 / 11:00');
  await expect(page.getByLabel('Colour by')).toHaveValue('stretch');
  // Followed, it goes to the newest moment by itself, until the run has ended.
  await page.getByLabel('show what is new by itself').check();
  grown = { ...manifest, runs: [{ ...manifest.runs[0], duration_s: 720 }] };
  await expect(page.locator('.time-readout')).toHaveText('12:00 / 12:00');
  grown = { ...manifest, live: null, runs: [{ ...manifest.runs[0], status: 'finished', duration_s: 720 }] };
  await expect(page.locator('.live')).toHaveCount(0);
  await expect(page.locator('.notices')).not.toContainText('still in progress');
});
