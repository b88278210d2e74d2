// Format of a page of results; written by src/chicane/protocol/json.hpp.
import type { Plot } from '../parts/plot';
import type { Table } from '../parts/table';

/** A page of results. */
export interface ReportDocument {
  readonly kind: 'sweep' | 'league' | 'identify' | 'import';
  readonly title: string;
  readonly sections: readonly Section[];
}

/** A part of the page with a title of its own, or none. */
export interface Section {
  readonly title: string;
  readonly parts: readonly Part[];
}

export type Part = Prose | Table | Plot;

/** A paragraph. */
export interface Prose {
  readonly part: 'text';
  readonly text: string;
}

/** Words between backticks are code. */
export const wordsOf = (text: string): { words: string; isCode: boolean }[] =>
  text
    .split('`')
    .map((words, i) => ({ words, isCode: i % 2 === 1 }))
    .filter(({ words }) => words !== '');
