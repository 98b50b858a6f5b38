// SPDX-License-Identifier: Apache-2.0
// Anatomical colours and how translucent each organ is to begin with: the abdomen is glass, so that one sees the fetus.
import type { Region } from '../data/format';

export interface Look {
  colour: string;
  opacity: number;
  visible: boolean;
}

const LOOKS: Record<string, [string, number]> = {
  fetal_skin: ['#e6b392', 1],
  skull: ['#c7d0dd', 1],
  fetal_body: ['#c27f64', 1],
  neck: ['#d69a7c', 1],
  uterine_fundus: ['#b0455c', 0.34],
  uterine_body: ['#c4586c', 0.34],
  lower_segment: ['#cf6f80', 0.34],
  vaginal_canal: ['#d98a92', 0.34],
  levator_ani: ['#8f3a2f', 1],
  perineal_body: ['#b0603f', 1],
  abdomen: ['#d9b27c', 0.14],
  sacrum: ['#e2d6b8', 1],
  coccyx: ['#d3bf93', 1],
  innominate_left: ['#ebe2ca', 1],
  innominate_right: ['#ebe2ca', 1],
};
const BY_KIND: Record<string, [string, number]> = {
  bone: ['#e8dec4', 1],
  fetus: ['#e0ab8c', 1],
  uterus: ['#c4586c', 0.34],
  soft: ['#b58a5e', 0.5],
};

export function lookOf(region: Region): Look {
  const [colour, opacity] = LOOKS[region.name] ?? BY_KIND[region.kind] ?? ['#9aa4b0', 1];
  return { colour, opacity, visible: true };
}

/** The group that an organ is listed under. */
export function groupOf(region: Region): string {
  if (region.kind === 'fetus') return 'Fetus';
  if (region.kind === 'bone') return 'Bones';
  if (region.name === 'levator_ani' || region.name === 'perineal_body') return 'Pelvic floor';
  if (region.kind === 'uterus') return 'Uterus and canal';
  return 'Soft tissue';
}

/** Translucent organs are drawn from the inside out. */
export function drawingOrder(region: Region): number {
  return ['Fetus', 'Bones', 'Pelvic floor', 'Uterus and canal', 'Soft tissue'].indexOf(groupOf(region));
}
