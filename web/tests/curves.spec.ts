// SPDX-License-Identifier: Apache-2.0
// Curves, and that they and the picture are of one time.
import { readFileSync } from 'node:fs';
import { expect, test, type Locator } from '@playwright/test';
import { DURATION, report } from './fixture';
import { changed, find, open, picture, pixels } from './page';

const readout = '.time-readout';
const middle = async (plot: Locator) => {
  const box = (await plot.boundingBox())!;
  return { x: box.width / 2, y: box.height / 2, width: box.width };
};

test('a click and a drag in a curve move the time everywhere', async ({ page }) => {
  await open(page, report());
  const before = await pixels(page, picture(page));
  const plot = page.locator('[data-plot=head_z] .u-over');
  const { x, y, width } = await middle(plot);
  await plot.click({ position: { x, y } });
  await expect(page.locator(readout)).toHaveText('5:00 / 10:00');
  expect(Math.abs(Number(await page.locator('.scrub').inputValue()) - DURATION / 2)).toBeLessThan(2);
  expect(changed(await pixels(page, picture(page)), before)).toBeGreaterThan(300);
  // Values at the cursor: -60 of the descent, -92 of the imposed line.
  await page.mouse.move(0, 0);
  const values = page.locator('[data-plot=head_z] .legend b');
  const [z, imposed] = (await values.allTextContents()).map((text) => parseFloat(text.replace('−', '-')));
  expect(Math.abs(z + 60)).toBeLessThan(0.5);
  expect(Math.abs(imposed + 92)).toBeLessThan(0.8);
  await plot.hover({ position: { x, y } });
  await page.mouse.down();
  const box = (await plot.boundingBox())!;
  await page.mouse.move(box.x + 0.75 * width, box.y + y, { steps: 4 });
  await page.mouse.up();
  await expect(page.locator(readout)).toHaveText('7:30 / 10:00');
  // The cursors of all curves stand at that place.
  for (const id of ['head_z', 'loads']) {
    const cursor = (await page.locator(`[data-plot=${id}] .time-cursor`).boundingBox())!;
    const over = (await page.locator(`[data-plot=${id}] .u-over`).boundingBox())!;
    expect(Math.abs((cursor.x + cursor.width / 2 - over.x) / over.width - 0.75)).toBeLessThan(0.02);
  }
});

test('curves zoom together: Shift and drag, buttons, keys, and back to all', async ({ page }) => {
  await open(page, report());
  const plot = page.locator('[data-plot=head_z] .u-over');
  const { x, y, width } = await middle(plot);
  const box = (await plot.boundingBox())!;
  await page.keyboard.down('Shift');
  await page.mouse.move(box.x + 0.2 * width, box.y + y);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.4 * width, box.y + y, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await expect(page.locator(readout)).toHaveText('0:00 / 10:00');
  // 2 to 4 min are in sight now: the middle is 3, in the other curve too.
  await page.locator('[data-plot=loads] .u-over').click({ position: { x, y } });
  await expect(page.locator(readout)).toHaveText('3:00 / 10:00');
  await plot.dblclick({ position: { x, y } });
  await plot.click({ position: { x, y } });
  await expect(page.locator(readout)).toHaveText('5:00 / 10:00');
  await page.getByRole('button', { name: 'Zoom in' }).click();
  await plot.click({ position: { x: 0.25 * width, y } });
  await expect(page.locator(readout)).toHaveText('3:45 / 10:00');
  await page.locator('[data-plot=head_z] .plot').focus();
  await page.keyboard.press('0');
  await plot.click({ position: { x: 0.25 * width, y } });
  await expect(page.locator(readout)).toHaveText('2:30 / 10:00');
});

test('contractions, bands and events are drawn', async ({ page }) => {
  await open(page, report());
  const plot = page.locator('[data-plot=head_z] .plot');
  await page.mouse.move(0, 0);
  const image = await pixels(page, plot);
  const over = (await page.locator('[data-plot=head_z] .u-over').boundingBox())!;
  const all = (await plot.boundingBox())!;
  const at = (minutes: number, mm: number, [low, high]: [number, number]) =>
    image.at(over.x - all.x + (over.width * minutes) / 10, over.y - all.y + over.height * ((high - mm) / (high - low)));
  // The ordinate goes from the lowest line to the highest with 7 % of room.
  const range: [number, number] = [-184 - 0.07 * 184, 0.07 * 184];
  const background = at(3.3, -10, range);
  const contraction = at(1.5, -130, range);
  const band = at(3.3, -90, range);
  expect(contraction[0] - contraction[1]).toBeGreaterThan(4);
  expect(background[0] - background[1]).toBeLessThan(3);
  expect(background[0] - band[0]).toBeGreaterThan(8);
  // Crowning at 5 min: a dotted line from top to bottom.
  const x = Math.round(over.x - all.x + over.width / 2);
  const dotted = find(image, (r, g, b) => Math.abs(r - 140) < 60 && Math.abs(r - b) < 60 && r < 215 && g < 215);
  expect(dotted.count).toBeGreaterThan(0);
  const column = Array.from({ length: Math.round(over.height) }, (_, k) =>
    Math.min(...[-1, 0, 1].map((d) => image.at(x + d, over.y - all.y + k)[0])),
  );
  expect(column.filter((r) => r < 215).length).toBeGreaterThan(0.25 * column.length);
  await expect(page.locator('[data-plot=absent]')).toContainText('Not in the curves of this run.');
});

test('curves are saved as CSV and PNG', async ({ page }) => {
  await open(page, report());
  const [csv] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save as CSV: Contraction and push' }).click(),
  ]);
  expect(csv.suggestedFilename()).toBe('cube_loads.csv');
  const lines = readFileSync((await csv.path())!, 'utf8')
    .trim()
    .split('\n');
  expect(lines.length).toBe(62);
  expect(lines[0]).toBe('time_s,contraction [mmHg],"push, ""with"" comma [mmHg]"');
  expect(lines[1]).toBe('0,10,');
  expect(lines[9]).toBe('80,50,80');
  const [png] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save as PNG: Head' }).click()]);
  expect(png.suggestedFilename()).toBe('cube_head_z.png');
  const bytes = readFileSync((await png.path())!);
  expect(bytes.subarray(1, 4).toString()).toBe('PNG');
  expect(bytes.length).toBeGreaterThan(3000);
  const [all] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'All as CSV' }).click()]);
  const whole = readFileSync((await all.path())!, 'utf8')
    .trim()
    .split('\n');
  expect(whole[0]).toBe('time_s,head_x_mm,head_y_mm,head_z_mm,pressure_contraction_mmhg,pressure_push_mmhg');
  expect(whole[61]).toBe('600,0,0,-120,10,');
});

test('several runs: curves overlaid, differences in a table', async ({ page }) => {
  await open(page, report({ name: 'first' }, { name: 'second', descent: 60 }));
  await expect(page.locator('[data-plot=head_z] .legend .item')).toHaveCount(3);
  await expect(page.locator('[data-plot=loads] .legend .item')).toHaveCount(4);
  await expect(page.locator('[data-plot=loads] .legend')).toContainText('second: contraction');
  const colours = await page
    .locator('[data-plot=head_z] .legend .swatch')
    .evaluateAll((swatches) => swatches.map((swatch) => getComputedStyle(swatch).borderTopColor));
  expect(new Set(colours).size).toBe(3);
  const rows = page.locator('.comparison tbody tr');
  await expect(rows.nth(0)).toHaveText('head displacement z [mm]12060−60 (−50 %)');
  await expect(rows.nth(1)).toHaveText('not there1––');
  await expect(page.locator('.verdict-table').first().locator('thead th')).toHaveText(['What', 'Expected', 'first', 'second']);
});
