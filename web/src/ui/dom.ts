// SPDX-License-Identifier: Apache-2.0
// Making elements. Text from a results folder only ever becomes a text node or a property, never markup.

type Attributes = Record<string, string | number | boolean | undefined | ((event: never) => void)>;
type Child = Node | string | null | undefined | false;

/** An element with attributes, listeners (functions, named after their event) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name, value as EventListener);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value !== undefined) element.setAttribute(name, String(value));
  }
  for (const child of children) if (child) element.append(child);
  return element;
}

const SVG = 'http://www.w3.org/2000/svg';

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | number> = {},
  ...children: Node[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

// Paths on a grid of 24.
const ICONS = {
  play: 'M8 5v14l11-7z',
  pause: 'M7 5h4v14H7zM13 5h4v14h-4z',
  back: 'M15.5 6v12l-8-6zM5.5 6h2v12h-2z',
  forward: 'M8.5 6v12l8-6zM16.500 6h2v12h-2z',
  start: 'M18 6v12l-8-6zM6 6h2.500v12H6z',
  camera: 'M9 5l-1.500 2H4v12h16V7h-3.500L15 5zM12 9a4 4 0 1 1 0 8 4 4 0 0 1 0-8z',
  film: 'M4 6h11v12H4zM16.500 10.500L21 7.500v9l-4.500-3z',
  ruler: 'M3 15.500L15.500 3 21 8.500 8.500 21zM7 13.500l2 2M10 10.500l3 3M13.500 7.500l2 2',
  layers: 'M12 4l9 5-9 5-9-5zM4.500 12.500L12 16.700l7.500-4.200 1.500.900-9 5-9-5z',
  sun: 'M12 8a4 4 0 1 1 0 8 4 4 0 0 1 0-8zM11 2h2v3h-2zM11 19h2v3h-2zM2 11h3v2H2zM19 11h3v2h-3zM4.200 5.600l1.400-1.400 2.100 2.100-1.400 1.400zM16.300 17.700l1.400-1.400 2.100 2.100-1.400 1.400zM4.200 18.400l2.100-2.100 1.400 1.400-2.100 2.100zM16.300 6.300l2.100-2.100 1.400 1.400-2.100 2.100z',
  moon: 'M20 14.500A8.500 8.500 0 0 1 9.500 4a8.500 8.500 0 1 0 10.500 10.500z',
  help: 'M12 3a9 9 0 1 1 0 18 9 9 0 0 1 0-18zm0 2a7 7 0 1 0 0 14 7 7 0 0 0 0-14zm-1 10h2v2h-2zm1-8a3 3 0 0 1 1.500 5.600c-.400.300-.500.500-.500 1.400h-2c0-1.600.400-2.300 1.300-2.900A1 1 0 1 0 11 10H9a3 3 0 0 1 3-3z',
  flip: 'M11 3h2v18h-2zM3 7l6 5-6 5zM21 7v10l-6-5z',
  download: 'M11 4h2v8h3l-4 4.500L8 12h3zM5 18h14v2H5z',
  image: 'M4 5h16v14H4zM6 7v8l3.500-3.500 3 3 2-2L18 16V7zM15.500 8.500a1.500 1.500 0 1 1 0 3 1.500 1.500 0 0 1 0-3z',
  plus: 'M11 5h2v6h6v2h-6v6h-2v-6H5v-2h6z',
  minus: 'M5 11h14v2H5z',
  reset: 'M4 4h6v2H6v4H4zM14 4h6v6h-2V6h-4zM4 14h2v4h4v2H4zM18 14h2v6h-6v-2h4z',
} as const;
export type IconName = keyof typeof ICONS;

export function icon(name: IconName): SVGSVGElement {
  const outline = name === 'ruler';
  return svg(
    'svg',
    { viewBox: '0 0 24 24', width: 18, height: 18, 'aria-hidden': 'true', class: outline ? 'icon outline' : 'icon' },
    svg('path', { d: ICONS[name], 'fill-rule': 'evenodd' }),
  );
}

export function iconButton(name: IconName, label: string, click: () => void, key?: string): HTMLButtonElement {
  const title = key ? `${label} (${key})` : label;
  return h('button', { type: 'button', class: 'icon-button', 'aria-label': label, title, click }, icon(name));
}

/** Hands a file to the person. */
export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = h('a', { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** A file name made from parts, without what file systems dislike. */
export function fileName(...parts: string[]): string {
  return parts
    .map((part) => part.replace(/[^\p{L}\p{N}._-]+/gu, '_'))
    .filter(Boolean)
    .join('_');
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`carus.${key}`, value);
  } catch {
    // Pages opened from disk may have no storage: nothing is lost but the habit.
  }
}
export function recall(key: string): string | null {
  try {
    return localStorage.getItem(`carus.${key}`);
  } catch {
    return null;
  }
}
