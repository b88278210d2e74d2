/** Counts durations in logarithmic bins: fixed memory, quantiles to within a bin (a factor of 10^(1/20), 12 %). */
export class Histogram {
  static readonly binsPerDecade = 20;
  readonly low: number;
  readonly counts: Float64Array;
  #total = 0;
  #max = NaN;

  /** Bins from `low` over a number of decades; values outside count in the first or last bin. */
  constructor(low: number, decades: number) {
    this.low = low;
    this.counts = new Float64Array(decades * Histogram.binsPerDecade);
  }

  get total(): number {
    return this.#total;
  }

  /** The largest value counted, exact; NaN without any. */
  get max(): number {
    return this.#max;
  }

  push(value: number): void {
    if (!(value >= 0)) return;
    const bin = value <= this.low ? 0 : Math.floor(Math.log10(value / this.low) * Histogram.binsPerDecade + 1e-9);
    const at = Math.min(bin, this.counts.length - 1);
    this.counts[at] = (this.counts[at] ?? 0) + 1;
    ++this.#total;
    if (!(value <= this.#max)) this.#max = value;
  }

  clear(): void {
    this.counts.fill(0);
    this.#total = 0;
    this.#max = NaN;
  }

  /** The lower edge of a bin. */
  edge(bin: number): number {
    return this.low * 10 ** (bin / Histogram.binsPerDecade);
  }

  /** The quantile at `share`, interpolated inside its bin; NaN when empty. */
  quantile(share: number): number {
    if (this.#total === 0) return NaN;
    const wanted = share * this.#total;
    let below = 0;
    for (let bin = 0; bin < this.counts.length; ++bin) {
      const count = this.counts[bin] ?? 0;
      if (count > 0 && below + count >= wanted) {
        const inside = Math.max(0, wanted - below) / count;
        return Math.min(this.low * 10 ** ((bin + inside) / Histogram.binsPerDecade), this.#max);
      }
      below += count;
    }
    return this.#max;
  }

  /** Indices of the first non-empty bin and one past the last; null when all are empty. */
  get span(): [number, number] | null {
    const first = this.counts.findIndex((count) => count > 0);
    if (first < 0) return null;
    let last = this.counts.length;
    while (this.counts[last - 1] === 0) --last;
    return [first, last];
  }
}
