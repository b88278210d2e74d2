/**
 * Ring buffer of the newest rows of a table of numbers. Each column is written twice, one capacity apart, so that the
 * rows kept are always contiguous and reading copies nothing.
 */
export class History {
  readonly capacity: number;
  readonly #columns: Float64Array[];
  #count = 0;

  constructor(columns: number, capacity: number) {
    this.capacity = capacity;
    this.#columns = Array.from({ length: columns }, () => new Float64Array(2 * capacity));
  }

  /** Rows kept. */
  get length(): number {
    return Math.min(this.#count, this.capacity);
  }

  push(row: readonly number[]): void {
    const at = this.#count % this.capacity;
    this.#columns.forEach((column, i) => {
      column[at] = column[at + this.capacity] = row[i] ?? NaN;
    });
    ++this.#count;
  }

  /** Copies another history of the same shape without allocating. */
  copyFrom(other: History): void {
    this.#columns.forEach((column, i) => column.set(other.#columns[i] ?? []));
    this.#count = other.#count;
  }

  clear(): void {
    this.#count = 0;
  }

  /** A column, oldest value first: a view, valid until the next push. */
  column(index: number): Float64Array {
    const start = this.#count > this.capacity ? this.#count % this.capacity : 0;
    const column = this.#columns[index];
    if (!column) throw new RangeError(`history has no column ${index}`);
    return column.subarray(start, start + this.length);
  }

  /** The newest value of a column; NaN when empty. */
  newest(index: number): number {
    return this.length === 0 ? NaN : (this.column(index)[this.length - 1] ?? NaN);
  }
}
