// Tables of results: their format, and which of their columns hold numbers.

/** A table, or a grid, whose cells are of one kind, as in a heat map. */
export interface Table {
  readonly part: 'table' | 'grid';
  readonly title: string;
  readonly columns: readonly string[];
  readonly rows: readonly (readonly Cell[])[];
}

/** A cell of a table. */
export type Cell = string | MoreThanText;

/** A cell with marks, colours, a link or an interval. */
export interface MoreThanText {
  readonly text: string;
  readonly hint?: string;
  readonly is_code?: boolean;
  readonly is_marked?: boolean;
  readonly link?: string;
  readonly remark?: string;
  readonly share?: number; // 0 bad, 1 good
  readonly signed?: number; // −1 to 1
  readonly interval?: readonly [low: number, high: number, value: number, assumed: number];
}

/** The text of a cell. */
export const textOf = (cell: Cell | undefined): string => (typeof cell === 'object' ? cell.text : (cell ?? ''));

const isNumber = (text: string): boolean => /^[-−+]?\d/.test(text);

/** For each column, whether most of its cells are numbers, which stand to the right. */
export const areNumbers = ({ columns, rows }: Table): boolean[] =>
  columns.map((_, i) => {
    const texts = rows.map((row) => textOf(row[i])).filter((text) => text !== '' && text !== '–');
    return 2 * texts.filter(isNumber).length > texts.length;
  });
