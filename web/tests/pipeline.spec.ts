// SPDX-License-Identifier: Apache-2.0
// From the program to the pixels: 90 s of the coarse reference birth, computed, reported and served by carus.
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, test } from '@playwright/test';
import { VIEWER } from './fixture';
import { changed, find, goTo, open, picture, pixels, plain, skin } from './page';

const root = fileURLToPath(new URL('../..', import.meta.url));
const carus = join(root, 'build/release/bin/carus');

test.describe('carus run, report, serve', () => {
  test.skip(!existsSync(carus), 'build/release/bin/carus is not built');
  test.describe.configure({ mode: 'serial', timeout: 400_000 });
  const folder = mkdtempSync(join(tmpdir(), 'carus-pipeline-'));
  const out = join(folder, 'birth');

  test.beforeAll(() => {
    if (!existsSync(carus)) return;
    const settings = ['resolution=coarse', 'numerics.labour_duration=90 s', 'numerics.pseudo_duration=0.09375 s'];
    const run = ['run', join(root, 'scenarios/reference.yaml'), '--out', out, '--frames', '15', ...settings.flatMap((s) => ['--set', s])];
    execFileSync(carus, run, { stdio: 'pipe' });
    execFileSync(carus, ['report', out, '--viewer', VIEWER], { stdio: 'pipe' });
    execFileSync(carus, ['report', out, out, '--out', join(folder, 'two.html'), '--viewer', VIEWER], { stdio: 'pipe' });
  });
  test.afterAll(() => rmSync(folder, { recursive: true, force: true }));

  test('its report opens from disk: organs, cuts, colours, curves', async ({ page }) => {
    const file = join(out, 'report.html');
    expect(statSync(file).size).toBeLessThan(25e6);
    await open(page, `file://${file}`);
    await expect(page.locator('.notice')).toHaveCount(0);
    await expect(page.locator('.verdict-table tbody tr').first()).toBeVisible();
    // At the start the trail begins in the middle of the skull: shapes, landmarks and curves are of one frame.
    await page.locator('[data-cut=sagittal]').click();
    await page.waitForTimeout(700);
    const first = await pixels(page, picture(page));
    const skull = find(first, (r, g, b) => Math.abs(r - 192) < 4 && Math.abs(g - 201) < 4 && Math.abs(b - 214) < 4);
    const trail = find(first, (r, g, b) => r > 190 && g < 120 && b < 70);
    expect(skull.count).toBeGreaterThan(500);
    expect(Math.abs(trail.top + 6 - skull.y)).toBeLessThan(0.2 * (skull.bottom - skull.top));
    expect(trail.left).toBeGreaterThan(skull.left);
    expect(trail.left).toBeLessThan(skull.right);
    await page.locator('[data-cut=none]').click();
    await plain(page);
    const start = await pixels(page, picture(page));
    await page.keyboard.press('End');
    const end = await pixels(page, picture(page));
    expect(changed(start, end)).toBeGreaterThan(1000);
    // A sagittal cut shows the fetal body's own colour, filled.
    await page.locator('[data-cut=sagittal]').click();
    await page.waitForTimeout(700);
    const cut = await pixels(page, picture(page));
    const body = find(cut, (r, g, b) => Math.abs(r - 188) < 6 && Math.abs(g - 123) < 6 && Math.abs(b - 97) < 6);
    expect(body.count).toBeGreaterThan(2000);
    expect(find(start, skin).count).toBeGreaterThan(2000);
    for (const field of ['stretch', 'contact_pressure', 'pressure', 'displacement']) {
      await page.getByLabel('Colour by').selectOption(field);
      await expect(page.locator('.decode-status')).toBeHidden();
      const coloured = await pixels(page, picture(page));
      expect(changed(coloured, cut), field).toBeGreaterThan(2000);
    }
    const plots = page.locator('.chart');
    expect(await plots.count()).toBeGreaterThanOrEqual(14);
    for (const plot of await plots.all()) {
      await plot.scrollIntoViewIfNeeded();
      await expect(plot.locator('.u-over')).toBeVisible();
      await expect(plot.locator('.absent')).toHaveCount(0);
    }
    await goTo(page, 45);
    await expect(page.locator('.time-readout')).toHaveText(/^0:45/);
  });

  test('two runs in one page: curves overlaid, differences of nothing', async ({ page }) => {
    await open(page, `file://${join(folder, 'two.html')}`);
    await expect(page.getByLabel('Ghost')).toBeVisible();
    const differences = await page.locator('.comparison .difference').allTextContents();
    expect(differences.length).toBeGreaterThan(5);
    for (const text of differences) expect(text).toMatch(/^(0.*|–)$/);
    expect(await page.locator('[data-plot=head_z] .legend .item').count()).toBe(2);
  });

  test('carus serve shows the same, piece by piece', async ({ page }) => {
    const server = spawn(carus, ['serve', out, '--port', '0', '--viewer', VIEWER], { stdio: ['ignore', 'pipe', 'inherit'] });
    try {
      const address = await new Promise<string>((done, failed) => {
        server.stdout.on('data', (data: Buffer) => {
          const found = /http:\/\/\S+/.exec(String(data));
          if (found) done(found[0]);
        });
        server.on('exit', (code) => failed(new Error(`carus serve ended with ${code}`)));
      });
      await page.goto(address);
      await expect(page.locator('#app')).toHaveAttribute('data-decoded', 'all');
      await expect(page.locator('.notice')).toHaveCount(0);
      await plain(page);
      expect(find(await pixels(page, picture(page)), skin).count).toBeGreaterThan(2000);
    } finally {
      server.kill();
    }
  });
});
