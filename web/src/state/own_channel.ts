import { computed } from '@preact/signals';
import { type Understood, understand } from '../lib/formula';
import { persisted } from '../lib/persisted';
import { FRAME_NUMBERS } from '../protocol/messages';
import { Column } from './columns';
import type { History } from './history';

/** The formula of the reader's own plot, in names of numbers of a frame; empty: none. Kept by the browser. */
export const formulaText = persisted<string>('plots.formula', '');

/** What it means; null: there is none. */
export const ownFormula = computed<Understood | null>(() =>
  formulaText.value.trim() === '' ? null : understand(formulaText.value, FRAME_NUMBERS),
);

/** The formula over rows of a history. */
export function ownChannel(history: History, first: number, end: number): Float64Array {
  const read = ownFormula.value;
  if (read === null || !('formula' in read)) return new Float64Array(0);
  const { names, value } = read.formula;
  const columns = names.map((name) =>
    history.column(Column[name as keyof typeof Column]).subarray(Math.max(0, first), end),
  );
  const rows = history.column(Column.time_s).subarray(Math.max(0, first), end).length;
  const numbers = new Array<number>(names.length);
  return Float64Array.from({ length: rows }, (_, row) => {
    columns.forEach((column, i) => {
      numbers[i] = column[row] ?? NaN;
    });
    return value(numbers);
  });
}
