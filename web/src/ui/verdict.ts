// SPDX-License-Identifier: Apache-2.0
// The verdict: expected, source, obtained, inside or outside, as the program has judged it.
import type { Run } from '../data/run';
import type { VerdictRow } from '../data/format';
import { h, recall, remember } from './dom';
import { clockText, numberText, words } from './text';

const BANDS: Record<number, string> = {
  1: 'Birth',
  2: 'Head displacement',
  3: 'Uterus',
  4: 'Sacrum and coccyx',
  5: 'Moulding',
  6: 'Pressure and force',
  7: 'Stretch',
  8: 'Numerics',
  9: 'Published trends',
  10: 'Cardinal movements',
  11: 'Robustness',
};
const STATES: Record<string, [string, string]> = { inside: ['✓', 'inside'], outside: ['✗', 'outside'], not_asked: ['–', 'not asked'] };

const titleOf = (row: VerdictRow): string =>
  row.group === 'paper'
    ? "The paper's section 5"
    : row.number !== null && BANDS[row.number]
      ? `${row.number} · ${BANDS[row.number]}`
      : 'Bands';

export function verdictSection(runs: Run[]): HTMLElement {
  const first = (runs.find((run) => run.info.verdict.rows.length) ?? runs[0]).info;
  const groups = new Map<string, { title: string; key: string; rows: VerdictRow[] }>();
  for (const row of first.verdict.rows) {
    const key = `${row.group}|${row.number ?? ''}`;
    const group = groups.get(key) ?? { title: titleOf(row), key, rows: [] };
    group.rows.push(row);
    groups.set(key, group);
  }
  const { verdict } = first;
  const open = recall('verdict') !== 'closed';
  const details = h(
    'details',
    { class: 'verdict-tables', open, toggle: () => remember('verdict', details.open ? 'open' : 'closed') },
    h('summary', {}, 'Expected and obtained, row by row'),
    h(
      'div',
      { class: 'window', role: 'region', tabindex: 0, 'aria-label': 'Verdict, row by row' },
      h('div', { class: 'columns' }, ...[...groups.values()].map((group) => table(group, runs))),
    ),
  );
  return h(
    'section',
    { class: 'verdict', 'aria-labelledby': 'verdict-title' },
    h(
      'div',
      { class: 'verdict-head' },
      h(
        'h2',
        { id: 'verdict-title', class: verdict.rows.length ? (verdict.met ? 'met' : 'not-met') : 'none' },
        verdict.line || 'No verdict: there is no summary yet',
      ),
      verdict.rows.length ? meter(first.verdict.rows) : null,
    ),
    figures(runs),
    verdict.rows.length ? details : null,
  );
}

/** One tick per row: how much of it is inside, at a glance. */
function meter(rows: VerdictRow[]): HTMLElement {
  const count = (state: string) => rows.filter((row) => row.state === state).length;
  const label = `${count('inside')} inside, ${count('outside')} outside, ${count('not_asked')} not asked`;
  return h(
    'div',
    { class: 'meter', role: 'img', 'aria-label': label, title: label },
    ...rows.map((row) => h('i', { class: row.state, title: `${row.what}: ${row.obtained}` })),
  );
}

function table(group: { title: string; key: string; rows: VerdictRow[] }, runs: Run[]): HTMLElement {
  const obtained = (run: Run, row: VerdictRow): HTMLElement => {
    const same = run.info.verdict.rows.find((r) => r.group === row.group && r.number === row.number && r.what === row.what);
    if (!same) return h('td', { class: 'obtained' }, '–');
    const [sign, word] = STATES[same.state] ?? ['?', words(String(same.state))];
    return h(
      'td',
      { class: `obtained ${same.state}` },
      h('span', { class: 'sign', role: 'img', 'aria-label': word, title: word }, sign),
      ' ',
      same.obtained || '–',
    );
  };
  const names = runs.length > 1 ? runs.map((run) => run.info.name) : ['Obtained'];
  return h(
    'table',
    { class: 'verdict-table' },
    h('caption', {}, group.title),
    h(
      'thead',
      { class: runs.length > 1 ? '' : 'hidden' },
      h(
        'tr',
        {},
        h('th', { scope: 'col' }, 'What'),
        h('th', { scope: 'col' }, 'Expected'),
        ...names.map((name) => h('th', { scope: 'col' }, name)),
      ),
    ),
    h(
      'tbody',
      {},
      ...group.rows.map((row) =>
        h(
          'tr',
          { class: row.state },
          h('th', { scope: 'row' }, row.what),
          h('td', {}, row.expected, ' ', h('small', {}, row.source)),
          ...runs.map((run) => obtained(run, row)),
        ),
      ),
    ),
  );
}

/** The birth in a line of figures. */
function figures(runs: Run[]): HTMLElement | null {
  const summary = runs[0].info.summary;
  if (!summary) return null;
  const number = (value: unknown) => (typeof value === 'number' && Number.isFinite(value) ? value : null);
  const inner = (name: string, key: string) => {
    const value = summary[name];
    return typeof value === 'object' && value !== null ? number((value as Record<string, unknown>)[key]) : null;
  };
  const items: [string, string, string][] = [];
  const add = (label: string, value: number | null, unit: string, text: (value: number) => string = numberText) => {
    if (value !== null) items.push([label, text(value), unit]);
  };
  add('Birth after', number(summary.birth_time_s), 'min', clockText);
  add('Contractions', number(summary.contractions), '');
  add('Head, Z', inner('head_displacement_mm', 'z'), 'mm');
  add('Head, Y', inner('head_displacement_mm', 'y'), 'mm');
  add('Mean speed', inner('head_speed_mm_s', 'mean'), 'mm/s');
  const [start, end] = [inner('uterus_length_mm', 'start'), inner('uterus_length_mm', 'end')];
  if (start !== null && end !== null) items.push(['Uterus', `${start.toFixed(0)} → ${end.toFixed(0)}`, 'mm']);
  add('Greatest force', inner('expulsive_force_n', 'max'), 'N');
  if (!items.length) return null;
  return h(
    'dl',
    { class: 'figures' },
    ...items.map(([label, value, unit]) => h('div', {}, h('dt', {}, label), h('dd', {}, value, unit && h('small', {}, ` ${unit}`)))),
  );
}
