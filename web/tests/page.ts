// SPDX-License-Identifier: Apache-2.0
// What the browser tests share: opening a report, reading pixels of the picture.
import { expect, type Locator, type Page } from '@playwright/test';

/** Opens a report and waits until all its frames are decoded. Fails on any error on the page and on any request beyond it. */
export async function open(page: Page, url: string): Promise<void> {
  watch(page, url);
  await page.goto(url);
  await expect(page.locator('#app')).toHaveAttribute('data-state', 'ready');
  await expect(page.locator('#app')).toHaveAttribute('data-decoded', 'all');
}

export function watch(page: Page, url: string): void {
  page.on('pageerror', (error) => {
    throw error;
  });
  page.on('request', (request) => {
    const target = request.url();
    if (target !== url && !/^(blob|data):/.test(target)) throw new Error(`the page asks for ${target}`);
  });
}

export interface Pixels {
  width: number;
  height: number;
  data: Uint8Array;
  at(x: number, y: number): [number, number, number];
}

/** What is on the screen (but the small axes in the corner) where `locator` is, once it has stood still. */
export async function pixels(page: Page, locator: Locator): Promise<Pixels> {
  await page.waitForTimeout(250);
  const png = await locator.screenshot({ animations: 'disabled', style: '.triad { visibility: hidden; }' });
  const { width, height, text } = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    const rgba = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    let out = '';
    for (let i = 0; i < rgba.length; i += 4) out += String.fromCharCode(rgba[i], rgba[i + 1], rgba[i + 2]);
    return { width: bitmap.width, height: bitmap.height, text: btoa(out) };
  }, png.toString('base64'));
  const data = new Uint8Array(Buffer.from(text, 'base64'));
  const at = (x: number, y: number): [number, number, number] => {
    const k = 3 * (Math.round(x) + width * Math.round(y));
    return [data[k], data[k + 1], data[k + 2]];
  };
  return { width, height, data, at };
}

/** Number and middle of the pixels that `test` accepts. */
export function find(
  image: Pixels,
  test: (r: number, g: number, b: number) => boolean,
): { count: number; x: number; y: number; left: number; right: number; top: number; bottom: number } {
  let count = 0;
  let [sx, sy] = [0, 0];
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let y = 0, k = 0; y < image.height; y++)
    for (let x = 0; x < image.width; x++, k += 3) {
      if (!test(image.data[k], image.data[k + 1], image.data[k + 2])) continue;
      count++;
      sx += x;
      sy += y;
      left = Math.min(left, x);
      right = Math.max(right, x);
      top = Math.min(top, y);
      bottom = Math.max(bottom, y);
    }
  return { count, x: sx / count, y: sy / count, left, right, top, bottom };
}

/** The fetal skin's orange, in light and shade. */
export const skin = (r: number, g: number, b: number) => r > 90 && r - b > 40 && r > g + 18 && g > b;
/** Pixels that differ from one picture to another. */
export function changed(a: Pixels, b: Pixels): number {
  let n = 0;
  for (let k = 0; k < Math.min(a.data.length, b.data.length); k += 3) {
    if (Math.abs(a.data[k] - b.data[k]) + Math.abs(a.data[k + 1] - b.data[k + 1]) + Math.abs(a.data[k + 2] - b.data[k + 2]) > 24) n++;
  }
  return n;
}

export const picture = (page: Page) => page.locator('.picture canvas');

/** The trail lies over the picture: off for the counting of pixels. */
export async function plain(page: Page): Promise<void> {
  await page.locator('[data-toggle=trail]').click();
  await page.locator('[data-view=front]').click();
  await page.waitForTimeout(500);
}

export async function goTo(page: Page, seconds: number): Promise<void> {
  await page.locator('.scrub').evaluate((element: HTMLInputElement, value) => {
    element.value = String(value);
    element.dispatchEvent(new Event('input'));
  }, seconds);
}
