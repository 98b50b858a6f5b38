// SPDX-License-Identifier: Apache-2.0
// Below the pictures: comparison, provenance, what was chosen, the scenario in full, the log.
import type { Fact, Manifest } from '../data/format';
import type { Run } from '../data/run';
import { download, fileName, h } from './dom';
import { numberText, withUnit } from './text';

export function comparisonSection(manifest: Manifest): HTMLElement | null {
  const comparison = manifest.comparison;
  if (!comparison || !Array.isArray(comparison.rows) || manifest.runs.length < 2) return null;
  const [first, ...others] = manifest.runs;
  const heads = [h('th', { scope: 'col' }, 'What'), h('th', { scope: 'col' }, first.name)];
  for (const run of others) heads.push(h('th', { scope: 'col' }, run.name), h('th', { scope: 'col' }, 'difference'));
  const rows = comparison.rows.map((row) => {
    const values = Array.isArray(row.values) ? row.values : [];
    const cells = [h('th', { scope: 'row' }, withUnit(row.what, row.unit && `[${row.unit}]`)), h('td', {}, numberText(values[0]))];
    others.forEach((_run, k) => {
      const [a, b] = [values[0], values[k + 1]];
      const both = typeof a === 'number' && typeof b === 'number';
      const difference = both ? b - a : null;
      const percent = both && a !== 0 ? ` (${difference! > 0 ? '+' : ''}${numberText((100 * difference!) / Math.abs(a))} %)` : '';
      const sign = difference !== null && difference > 0 ? '+' : '';
      cells.push(
        h('td', {}, numberText(b)),
        h('td', { class: 'difference' }, difference === null ? '–' : `${sign}${numberText(difference)}${percent}`),
      );
    });
    return h('tr', {}, ...cells);
  });
  return h(
    'section',
    { class: 'comparison', 'aria-labelledby': 'comparison-title' },
    h('h2', { id: 'comparison-title' }, 'Comparison'),
    h(
      'div',
      { class: 'scrolls', role: 'region', 'aria-label': 'Comparison', tabindex: 0 },
      h('table', {}, h('thead', {}, h('tr', {}, ...heads)), h('tbody', {}, ...rows)),
    ),
  );
}

const facts = (list: Fact[]) =>
  h(
    'dl',
    { class: 'facts' },
    ...list.map((fact) => h('div', {}, h('dt', {}, String(fact.what ?? '')), h('dd', {}, String(fact.value ?? '')))),
  );

function block(title: string, open: boolean, ...content: (Node | null)[]): HTMLElement {
  return h('details', { class: 'block', open }, h('summary', {}, h('h3', {}, title)), ...content);
}

const listing = (text: string, name: string, type: string) =>
  h(
    'div',
    { class: 'listing' },
    h('button', { type: 'button', class: 'quiet', click: () => download(name, new Blob([text], { type })) }, `Save ${name}`),
    h('pre', { tabindex: 0 }, text),
  );

export function provenanceSection(runs: Run[], manifest: Manifest): HTMLElement {
  const several = runs.length > 1;
  const blocks = runs.flatMap(({ info }) => {
    const of = several ? `: ${info.name}` : '';
    return [
      info.description ? h('p', { class: 'description' }, several ? `${info.name}: ${info.description}` : info.description) : null,
      block(`Provenance and numerics${of}`, !several, facts([{ what: 'folder', value: info.folder }, ...info.provenance])),
      info.declared.length ? block(`Declared${of}`, false, facts(info.declared)) : null,
      info.calibrated.length ? block(`Calibrated, and to what${of}`, false, facts(info.calibrated)) : null,
      block(
        `Scenario, in full${of}`,
        false,
        info.scenario
          ? listing(info.scenario, fileName(info.name, 'scenario.resolved.yaml'), 'application/yaml')
          : h('p', {}, 'Not in the results folder.'),
      ),
      info.summary
        ? block(
            `Summary${of}`,
            false,
            listing(JSON.stringify(info.summary, null, 2), fileName(info.name, 'summary.json'), 'application/json'),
          )
        : null,
      info.log ? block(`Log${of}`, false, listing(info.log, fileName(info.name, 'log.txt'), 'text/plain')) : null,
    ];
  });
  const { generator } = manifest;
  return h(
    'section',
    { class: 'provenance', 'aria-labelledby': 'provenance-title' },
    h('h2', { id: 'provenance-title' }, 'Where this comes from'),
    ...blocks,
    h(
      'p',
      { class: 'made' },
      `Made by carus ${generator.version} ${generator.commit && `(${generator.commit})`} ${manifest.created}`.trim(),
    ),
    h('p', { class: 'made' }, 'With three.js and uPlot, both under the MIT licence: their notices are at the end of this file.'),
  );
}
