// Columns of the history: one for each number of a frame, and the stacked terms of the cost.
import { FRAME_NUMBERS } from '../protocol/messages';
import type { Frame } from '../protocol/topics';

/** Most terms of a cost that are plotted, of which the last one takes the rest; chosen. */
export const COST_TERMS = 10;

/**
 * Index of the column for each number of a frame, under its name and in its unit; yes is 1, no is 0. Those of the cost
 * terms, each stacked on the one before, follow: costColumn().
 */
export const Column = Object.fromEntries(FRAME_NUMBERS.map((name, i) => [name, i])) as Readonly<
  Record<(typeof FRAME_NUMBERS)[number], number>
>;

export const COLUMN_COUNT = FRAME_NUMBERS.length + COST_TERMS;

/** Column of a term of the cost. */
export const costColumn = (term: number): number => FRAME_NUMBERS.length + Math.min(term, COST_TERMS - 1);

/** One row of the history for a frame. Written into `row`, which is returned. */
export function plotRow(frame: Frame, row: number[]): number[] {
  FRAME_NUMBERS.forEach((name, i) => {
    row[i] = Number(frame[name]);
  });
  stack(frame.cost_terms, row);
  return row;
}

/** Running sums: the top of each coloured layer. Terms below zero have no layer; without a plan there are none. */
function stack(terms: ArrayLike<number>, row: number[]): void {
  let sum = 0;
  const hasPlan = Array.from(terms).some((term) => Math.abs(term) > 0);
  const known = hasPlan ? Math.min(terms.length, COST_TERMS) : 0;
  for (let term = 0; term < Math.max(terms.length, COST_TERMS); ++term) {
    sum += Math.max(0, terms[term] ?? 0);
    row[costColumn(term)] = known === 0 ? NaN : sum;
  }
}
