// SPDX-License-Identifier: Apache-2.0
// The three-dimensional part, judged by its pixels.
import { readFileSync } from 'node:fs';
import { expect, test } from '@playwright/test';
import { colourAt } from '../src/scene/colormap';
import { DURATION, report } from './fixture';
import { changed, find, goTo, open, picture, pixels, plain, skin } from './page';

test('the fetus goes down as time goes on, and half way in the middle of a frame', async ({ page }) => {
  await open(page, report());
  await plain(page);
  const height: number[] = [];
  for (const time of [0, 0.5 * DURATION, 0.52 * DURATION, DURATION]) {
    await goTo(page, time);
    const seen = find(await pixels(page, picture(page)), skin);
    expect(seen.count).toBeGreaterThan(1500);
    height.push(seen.y);
  }
  const whole = height[3] - height[0];
  expect(whole).toBeGreaterThan(60);
  expect((height[1] - height[0]) / whole).toBeGreaterThan(0.46);
  expect((height[1] - height[0]) / whole).toBeLessThan(0.54);
  expect(height[2]).toBeGreaterThan(height[1]);
});

test('playing moves the picture and stops at the end', async ({ page }) => {
  await open(page, report());
  await page.getByLabel('Speed').selectOption('240');
  await page.getByRole('button', { name: 'Play' }).click();
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  await expect(page.locator('.time-readout')).toHaveText('10:00 / 10:00');
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
});

test('hiding an organ, its opacity and its colour change what is seen', async ({ page }) => {
  await open(page, report());
  await plain(page);
  const before = await pixels(page, picture(page));
  expect(find(before, skin).count).toBeGreaterThan(1500);
  await page.getByRole('button', { name: 'Organs', exact: true }).click();
  await page.locator('[data-organ=fetal_skin]').uncheck();
  const close = page.getByRole('button', { name: 'Close the list of organs' });
  await close.click();
  const hidden = await pixels(page, picture(page));
  expect(find(hidden, skin).count).toBeLessThan(20);
  await page.getByRole('button', { name: 'Organs', exact: true }).click();
  await page.locator('[data-organ=fetal_skin]').check();
  await page.getByLabel('Colour: Fetal skin').evaluate((input: HTMLInputElement) => {
    input.value = '#0040ff';
    input.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await close.click();
  const blue = (r: number, g: number, b: number) => b > 120 && b > 2 * r && b > g + 30;
  const solid = await pixels(page, picture(page));
  expect(find(solid, blue).count).toBeGreaterThan(1500);
  await page.getByRole('button', { name: 'Organs', exact: true }).click();
  await page.locator('[data-opacity=fetal_skin]').fill('0.2');
  await close.click();
  const glass = await pixels(page, picture(page));
  expect(find(glass, blue).count).toBeLessThan(0.2 * find(solid, blue).count);
  expect(changed(glass, hidden)).toBeGreaterThan(1000);
  await page.getByRole('button', { name: 'Organs', exact: true }).click();
  await page.getByRole('button', { name: 'Reset' }).click();
  await close.click();
  expect(changed(await pixels(page, picture(page)), before)).toBeLessThan(50);
});

test('a cut is filled with the colour of its organ, and follows its slider', async ({ page }) => {
  await open(page, report());
  await plain(page);
  await page.locator('[data-cut=coronal]').click();
  await page.waitForTimeout(600);
  // Caps are not shaded: 0.93 of the organ's linear colour, everywhere.
  const linear = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  const srgb = (c: number) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
  const cap = [0xe6, 0xb3, 0x92].map((c) => 255 * srgb(0.93 * linear(c / 255)));
  const isCap = (r: number, g: number, b: number) => Math.abs(r - cap[0]) < 3 && Math.abs(g - cap[1]) < 3 && Math.abs(b - cap[2]) < 3;
  const cut = find(await pixels(page, picture(page)), isCap);
  const [width, height] = [cut.right - cut.left + 1, cut.bottom - cut.top + 1];
  expect(width).toBeGreaterThan(40);
  expect(Math.abs(width / height - 1)).toBeLessThan(0.05);
  // A square without holes.
  expect(cut.count / (width * height)).toBeGreaterThan(0.93);
  await page.getByLabel('Place of the cut').fill('-28');
  expect(find(await pixels(page, picture(page)), isCap).count).toBeGreaterThan(0.7 * cut.count);
  await expect(page.locator('.cut-place')).toHaveText('28 mm back');
  await page.getByLabel('whole fetus').check();
  expect(find(await pixels(page, picture(page)), isCap).count).toBeLessThan(0.1 * cut.count);
  await page.locator('[data-cut=none]').click();
  await expect(page.getByLabel('Place of the cut')).toBeHidden();
});

test('every preset cuts along its own plane, and the other side on demand', async ({ page }) => {
  await open(page, report());
  await plain(page);
  const pictures = [];
  for (const preset of ['coronal', 'sagittal', 'axial']) {
    await page.locator(`[data-cut=${preset}]`).click();
    await expect(page.locator(`[data-cut=${preset}]`)).toHaveAttribute('aria-pressed', 'true');
    await page.waitForTimeout(600);
    pictures.push(await pixels(page, picture(page)));
  }
  await page.getByRole('button', { name: 'Other side of the cut' }).click();
  await page.waitForTimeout(600);
  pictures.push(await pixels(page, picture(page)));
  for (let i = 0; i < pictures.length; i++) for (let j = 0; j < i; j++) expect(changed(pictures[i], pictures[j])).toBeGreaterThan(500);
});

test('values are shown in the colours of a fixed scale with its unit', async ({ page }) => {
  await open(page, report());
  await plain(page);
  await page.locator('[data-cut=coronal]').click();
  await page.getByLabel('Colour by').selectOption('stretch');
  const legend = page.locator('.scale');
  await expect(legend).toContainText('Largest stretch');
  await expect(legend.locator('.ticks span')).toHaveText(['1', '1.63', '2.25', '2.88', '3.5']);
  // Half way the cube is stretched 2.25, the middle of the scale: a cut shows that very colour.
  for (const [time, place] of [
    [0.5 * DURATION, 0.5],
    [0.2 * DURATION, 0.2],
  ]) {
    await goTo(page, time);
    await page.waitForTimeout(600);
    const image = await pixels(page, picture(page));
    const [r, g, b] = colourAt(place).map((c) => 255 * c);
    const seen = find(image, (x, y, z) => Math.abs(x - r) < 6 && Math.abs(y - g) < 6 && Math.abs(z - b) < 6);
    expect(seen.count).toBeGreaterThan(1000);
  }
  await page.getByLabel('Colour by').selectOption('displacement');
  await expect(legend).toContainText('mm');
  await expect(legend.locator('.ticks span')).toHaveText(['0', '50', '100', '150', '200']);
  await page.getByLabel('Colour by').selectOption('');
  await expect(legend).toBeHidden();
});

test('saved views differ, and the trail and the axes are drawn and taken away', async ({ page }) => {
  await open(page, report());
  await goTo(page, DURATION);
  const pictures = [];
  for (const view of ['oblique', 'front', 'right', 'left', 'vulva', 'above']) {
    await page.locator(`[data-view=${view}]`).click();
    await page.waitForTimeout(600);
    pictures.push(await pixels(page, picture(page)));
  }
  for (let i = 0; i < pictures.length; i++) for (let j = 0; j < i; j++) expect(changed(pictures[i], pictures[j])).toBeGreaterThan(200);
  const red = (r: number, g: number, b: number) => r > 190 && g < 120 && b < 70;
  await page.locator('[data-view=front]').click();
  await page.waitForTimeout(600);
  const trail = find(await pixels(page, picture(page)), red);
  expect(trail.count).toBeGreaterThan(100);
  expect(trail.bottom - trail.top).toBeGreaterThan(60);
  await page.locator('[data-toggle=trail]').click();
  const without = await pixels(page, picture(page));
  expect(find(without, red).count).toBeLessThan(5);
  await page.locator('[data-toggle=axes]').click();
  expect(changed(await pixels(page, picture(page)), without)).toBeGreaterThan(60);
});

test('a measurement is right, and moves along with the material', async ({ page }) => {
  await open(page, report());
  await plain(page);
  const canvas = picture(page);
  const cube = find(await pixels(page, canvas), skin);
  await page.locator('[data-toggle=measure]').click();
  // From edge to edge of the cube, two pixels within: 60 mm.
  await canvas.click({ position: { x: cube.left + 2, y: cube.y } });
  await canvas.click({ position: { x: cube.right - 2, y: cube.y } });
  const label = page.locator('.measure-label');
  await expect(label).toHaveText(/^\d+\.\d mm$/);
  const width = parseFloat((await label.textContent())!);
  const expected = (60 * (cube.right - cube.left - 4)) / (cube.right - cube.left + 1);
  expect(Math.abs(width / expected - 1)).toBeLessThan(0.02);
  // The cube moves as one: its width does not change, but the label goes down with it.
  const before = (await label.boundingBox())!.y;
  await goTo(page, DURATION);
  await expect.poll(async () => (await label.boundingBox())!.y - before).toBeGreaterThan(40);
  expect(parseFloat((await label.textContent())!)).toBeCloseTo(width, 1);
  await page.locator('[data-toggle=measure]').click();
  await expect(label).toBeHidden();
});

test('a picture and a movie are saved', async ({ page }) => {
  await open(page, report());
  const [png] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: /Save the picture/ }).click()]);
  expect(png.suggestedFilename()).toBe('cube_0m00s.png');
  const bytes = readFileSync((await png.path())!);
  expect(bytes.subarray(1, 4).toString()).toBe('PNG');
  const box = (await picture(page).boundingBox())!;
  expect([bytes.readUInt32BE(16), bytes.readUInt32BE(20)]).toEqual([Math.round(box.width), Math.round(box.height)]);
  expect(bytes.length).toBeGreaterThan(5000);
  await page.getByLabel('Speed').selectOption('240');
  const [movie] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: /Record a movie/ }).click()]);
  expect(movie.suggestedFilename()).toBe('cube_birth.webm');
  const film = readFileSync((await movie.path())!);
  expect(film.subarray(0, 4).toString('hex')).toBe('1a45dfa3');
  expect(film.length).toBeGreaterThan(4000);
});

test('a second run is drawn as a ghost, at the same time', async ({ page }) => {
  await open(page, report({ name: 'fast' }, { name: 'slow', descent: 30 }));
  await plain(page);
  await goTo(page, DURATION);
  const blue = (r: number, g: number, b: number) => b > r + 12 && b > g + 4;
  const before = find(await pixels(page, picture(page)), blue).count;
  await page.getByLabel('Ghost').selectOption({ label: 'slow' });
  await expect.poll(async () => find(await pixels(page, picture(page)), blue).count - before).toBeGreaterThan(800);
  const ghost = find(await pixels(page, picture(page)), blue);
  const cube = find(await pixels(page, picture(page)), skin);
  expect(cube.y - ghost.y).toBeGreaterThan(30);
  await page.getByLabel('Run shown').selectOption({ label: 'slow' });
  await page.getByLabel('Ghost').selectOption('');
  await expect.poll(async () => cube.y - find(await pixels(page, picture(page)), skin).y).toBeGreaterThan(30);
});
