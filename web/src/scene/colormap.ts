// SPDX-License-Identifier: Apache-2.0
// The one colour scale of the viewer. Lightness (Oklab L) rises evenly from dark blue-violet to light yellow, so that it reads the same
// with any colour vision and in grey; hue only helps.

type Lab = [number, number, number];

// Oklab a, b along the scale; L is linear in between the ends.
const LIGHTNESS = [0.32, 0.94];
const HUES: [number, number][] = [
  [0.055, -0.1],
  [0.015, -0.125],
  [-0.055, -0.07],
  [-0.095, 0.015],
  [-0.085, 0.11],
  [-0.025, 0.165],
];

function toSrgb([L, a, b]: Lab): [number, number, number] {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((c) => {
    const v = Math.min(1, Math.max(0, c));
    return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
  }) as [number, number, number];
}

/** sRGB, 0…1, at `t` in 0…1. */
export function colourAt(t: number): [number, number, number] {
  const u = Math.min(1, Math.max(0, t));
  const place = u * (HUES.length - 1);
  const k = Math.min(Math.floor(place), HUES.length - 2);
  const f = place - k;
  const pick = (i: number) => HUES[Math.min(HUES.length - 1, Math.max(0, i))];
  const [p, q, r, s] = [pick(k - 1), pick(k), pick(k + 1), pick(k + 2)];
  // Catmull-Rom through the hues.
  const ab = [0, 1].map(
    (i) =>
      0.5 *
      (2 * q[i] + (r[i] - p[i]) * f + (2 * p[i] - 5 * q[i] + 4 * r[i] - s[i]) * f ** 2 + (3 * q[i] - p[i] - 3 * r[i] + s[i]) * f ** 3),
  );
  return toSrgb([LIGHTNESS[0] + u * (LIGHTNESS[1] - LIGHTNESS[0]), ab[0], ab[1]]);
}

/** `n` colours as RGBA bytes. */
export function colourTable(n: number): Uint8Array<ArrayBuffer> {
  const table = new Uint8Array(4 * n);
  for (let i = 0; i < n; i++) {
    const colour = colourAt(i / (n - 1));
    for (let c = 0; c < 3; c++) table[4 * i + c] = Math.round(255 * colour[c]);
    table[4 * i + 3] = 255;
  }
  return table;
}

/** The scale as a CSS gradient, bottom to top or left to right. */
export function cssGradient(direction: string): string {
  const stops = Array.from(
    { length: 17 },
    (_, i) =>
      `rgb(${colourAt(i / 16)
        .map((c) => Math.round(255 * c))
        .join(' ')})`,
  );
  return `linear-gradient(${direction}, ${stops.join(', ')})`;
}
