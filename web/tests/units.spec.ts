// SPDX-License-Identifier: Apache-2.0
// What needs no browser: the coding of integers, surfaces, the clock, the reading of curves and manifests.
import { expect, test } from '@playwright/test';
import { Clock } from '../src/clock';
import { toCsv, valueAt, type Line } from '../src/curves/series';
import { Window } from '../src/curves/window';
import { fromPlanes, runningSum, undoTimeDifferences } from '../src/data/codec';
import { parseManifest } from '../src/data/format';
import { groupByRegion, surfaceOf } from '../src/data/surface';
import { colourAt } from '../src/scene/colormap';
import { momentText } from '../src/ui/legend';
import { clockText, numberText } from '../src/ui/text';
import { Blobs, box, makeManifest, makeRun, timeDifferences, toPlanes } from './fixture';

test('integers come back from their byte planes', () => {
  const values = [0, -1, 1, 127, -128, 128, 255, -256, 65535, -65536, 8388607, -8388608, 2 ** 31 - 1, -(2 ** 31)];
  for (let n = 1; n <= values.length; n++) {
    const { bytes, planes } = toPlanes(values.slice(0, n));
    expect(Array.from(fromPlanes(bytes, n, planes))).toEqual(values.slice(0, n));
  }
  expect(toPlanes([127]).planes).toBe(1);
  expect(toPlanes([128]).planes).toBe(2);
  expect(() => fromPlanes(new Uint8Array(5), 3, 2)).toThrow(/5 bytes/);
});

test('differences in time are undone, in both orders, and nothing accumulates', () => {
  const base = [5, -7, 1000];
  const frames = Array.from({ length: 40 }, (_, k) => base.map((b, i) => b + Math.round(900 * Math.sin(0.3 * k + i))));
  for (const order of [1, 2]) {
    const values = Int32Array.from(timeDifferences(frames, order, base));
    undoTimeDifferences(values, 3, frames.length, order, Int32Array.from(base));
    expect(Array.from(values)).toEqual(frames.flat());
  }
  const sum = Int32Array.from([1, 10, 1, 10, 1, 10]);
  runningSum(sum, 2);
  expect(Array.from(sum)).toEqual([1, 10, 2, 20, 3, 30]);
});

test('the surface of a box is closed, turned outwards, and has its area', () => {
  const n = 3;
  const { nodes, tets } = box([0, 0, 0], [1, 2, 3], n, 0);
  expect(Math.min(...tets.map(([a, b, c, d]) => volume(nodes[a], nodes[b], nodes[c], nodes[d])))).toBeGreaterThan(0);
  const surface = surfaceOf(7, Uint32Array.from(tets.flat()), Uint32Array.from(tets.keys()));
  expect(surface.triangles.length / 3).toBe(6 * 2 * n * n);
  expect(surface.nodes.length).toBe((n + 1) ** 3 - (n - 1) ** 3);
  const edges = new Map<string, number>();
  let area = 0;
  let enclosed = 0;
  for (let f = 0; f < surface.triangles.length; f += 3) {
    const corner = [0, 1, 2].map((i) => surface.nodes[surface.triangles[f + i]]);
    corner.forEach((node, i) => {
      const next = corner[(i + 1) % 3];
      edges.set(`${node},${next}`, (edges.get(`${node},${next}`) ?? 0) + 1);
    });
    const [a, b, c] = corner.map((k) => nodes[k]);
    area += 0.5 * Math.hypot(...cross(minus(b, a), minus(c, a)));
    enclosed += volume([0, 0, 0], a, b, c);
  }
  // Every edge is gone through once in each direction.
  expect([...edges].filter(([edge, count]) => count !== 1 || edges.get(edge.split(',').reverse().join(',')) !== 1)).toEqual([]);
  expect(area).toBeCloseTo(22, 9);
  expect(enclosed).toBeCloseTo(6, 9);
});

test('tets are grouped by region, whatever the order of their labels', () => {
  const grouped = groupByRegion(Int32Array.from([4, 2, 4, 9, 2]));
  expect(Array.from(grouped.regions)).toEqual([2, 4, 9]);
  expect(Array.from(grouped.start)).toEqual([0, 2, 4, 5]);
  expect(Array.from(grouped.tets)).toEqual([1, 4, 0, 2, 3]);
});

test('the clock steps from frame to frame and stays within the run', () => {
  const clock = new Clock(100, [0, 10, 25, 100]);
  clock.step(1);
  expect(clock.time).toBe(10);
  clock.set(12);
  clock.step(1);
  expect(clock.time).toBe(25);
  clock.set(12);
  clock.step(-1);
  expect(clock.time).toBe(10);
  clock.step(-5);
  expect(clock.time).toBe(0);
  clock.step(100);
  expect(clock.time).toBe(100);
  clock.play(true);
  expect(clock.time).toBe(0);
  clock.setSpeed(30);
  clock.tick(0.5);
  expect(clock.time).toBe(15);
  clock.tick(100);
  expect([clock.time, clock.playing]).toEqual([100, false]);
  clock.set(-3);
  expect(clock.time).toBe(0);
});

test('curves: values between rows, none outside, CSV with quotes', () => {
  const line = (label: string, x: number[], y: number[]): Line => ({ label, run: 0, column: 0, reference: false, x, y });
  const a = line('a', [0, 1, 2], [0, 10, NaN]);
  expect(valueAt(a, 0.25)).toBeCloseTo(2.5, 12);
  expect(valueAt(a, 1)).toBe(10);
  expect(valueAt(a, 1.5)).toBeNaN();
  expect(valueAt(a, 3)).toBeNaN();
  expect(valueAt(line('empty', [], []), 0)).toBeNaN();
  const b = line('b, "quoted"', [0, 2], [1, 3]);
  expect(toCsv([a, b], 'mm')).toBe('time_s,a [mm],"b, ""quoted"" [mm]"\n0,0,1\n60,10,2\n120,,3\n');
});

test('zooming keeps the time that one looks at, and stays within the run', () => {
  const window = new Window(10);
  window.zoom(0.5, 2);
  expect(window.range()).toEqual([1, 6]);
  window.zoom(0.5, 0);
  expect(window.high - window.low).toBeCloseTo(2.5, 12);
  expect(window.low).toBeGreaterThanOrEqual(0);
  window.zoom(1e9, 5);
  expect(window.range()).toEqual([0, 10]);
});

test('the colour scale gets lighter from end to end', () => {
  const lightness = Array.from({ length: 64 }, (_, i) => {
    const [r, g, b] = colourAt(i / 63).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  });
  for (let i = 1; i < 64; i++) expect(lightness[i]).toBeGreaterThan(lightness[i - 1]);
  expect(lightness[63] / lightness[0]).toBeGreaterThan(10);
});

test('numbers and times are written as people read them', () => {
  expect([0, -4e-14, -0.00004, 184.496, -12.5, 0.0898, 1234.5, null, NaN].map(numberText)).toEqual([
    '0',
    '0',
    '−4.0e−5',
    '184.5',
    '−12.5',
    '0.09',
    '1235',
    '–',
    '–',
  ]);
  expect(clockText(2051.1)).toBe('34:11');
});

test('the moment is told in words', () => {
  const run = makeRun(new Blobs());
  expect([0, 60, 130, 310, 595].map((t) => momentText(run, t))).toEqual([
    'Before the first contraction',
    'Contraction 1',
    'Rest after contraction 1',
    'Contraction 2 · crowning',
    'Rest after contraction 3 · birth',
  ]);
  expect(momentText({ ...run, contractions: [], events: [] }, 5)).toBe('');
});

test('manifests: foreign and damaged ones are refused with a reason, missing parts completed', () => {
  expect(() => parseManifest('{"format":')).toThrow(/damaged or cut short/);
  expect(() => parseManifest('[]')).toThrow(/not a report/);
  expect(() => parseManifest('{"format":"carus-report-9","runs":[]}')).toThrow(/carus-report-9/);
  expect(() => parseManifest('{"format":"carus-report-1","runs":[]}')).toThrow(/no run/);
  const bare = parseManifest('{"format":"carus-report-1","runs":[{"name":"a","events":[{"event":"birth"}],"frames":{"times_s":[]}}]}')
    .runs[0];
  expect([bare.events, bare.frames, bare.mesh, bare.curves, bare.plots, bare.verdict.rows]).toEqual([[], null, null, null, [], []]);
  const blobs = new Blobs();
  const whole = makeManifest([makeRun(blobs)], blobs);
  expect(parseManifest(JSON.stringify(whole)).runs[0].frames?.times_s).toEqual(whole.runs[0].frames?.times_s);
});

type Point = number[];
const minus = (a: Point, b: Point) => a.map((x, i) => x - b[i]);
const cross = (a: Point, b: Point) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
function volume(a: Point, b: Point, c: Point, d: Point): number {
  const n = cross(minus(b, a), minus(c, a));
  return minus(d, a).reduce((sum, x, i) => sum + x * n[i], 0) / 6;
}
