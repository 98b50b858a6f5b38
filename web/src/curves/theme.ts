// SPDX-License-Identifier: Apache-2.0
// Colours of the curves, from the page's style sheet, so that they follow dark and light.

/** Colours of lines before they come again. */
export const LINES = 8;

export interface ChartColours {
  ink: string;
  muted: string;
  grid: string;
  shade: string;
  band: string;
  bandEdge: string;
  event: string;
  background: string;
  lines: string[];
}

export function chartColours(): ChartColours {
  const style = getComputedStyle(document.documentElement);
  const get = (name: string) => style.getPropertyValue(name).trim();
  return {
    ink: get('--ink'),
    muted: get('--muted'),
    grid: get('--grid'),
    shade: get('--contraction'),
    band: get('--band'),
    bandEdge: get('--band-edge'),
    event: get('--event'),
    background: get('--panel'),
    lines: Array.from({ length: LINES }, (_, k) => get(`--line-${k + 1}`)),
  };
}
