import type { Plot } from '../parts/plot';
import type { Table } from '../parts/table';

// What the program writes of its results: src/chicane/protocol/json.hpp.

export interface ReportDocument {
  readonly kind: 'sweep' | 'league' | 'identify' | 'import';
  readonly title: string;
  readonly sections: readonly Section[];
}

export interface Section {
  readonly title: string;
  readonly parts: readonly Part[];
}

export type Part = Prose | Table | Plot;

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
