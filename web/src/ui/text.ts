// SPDX-License-Identifier: Apache-2.0
// Numbers and times as people read them.

/** Minutes and seconds: "12:05". */
export function clockText(seconds: number): string {
  const s = Math.max(0, Math.round(seconds));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')}`;
}

/** About four figures, a real minus sign, no trailing zeros. */
export function numberText(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  // What is left of sums that cancel.
  const size = Math.abs(value) < 1e-9 ? 0 : Math.abs(value);
  const digits = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 1 ? 2 : size >= 0.01 ? 3 : 4;
  let text = size !== 0 && size < 1e-4 ? value.toExponential(1) : (size && value).toFixed(digits);
  if (text.includes('.') && !text.includes('e')) text = text.replace(/\.?0+$/, '');
  if (text === '-0') text = '0';
  return text.replace(/-/g, '−');
}

export const withUnit = (text: string, unit: string): string => (unit ? `${text} ${unit}` : text);

/** "widest_at_spines" becomes "widest at spines". */
export const words = (name: string): string => name.replace(/_/g, ' ');
