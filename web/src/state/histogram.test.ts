import { describe, expect, it } from 'vitest';
import { Histogram } from './histogram';

const WITHIN_A_BIN = 10 ** (1 / Histogram.binsPerDecade);

describe('histogram', () => {
  it('knows quantiles to within a bin', () => {
    const histogram = new Histogram(1, 6);
    for (let i = 1; i <= 1000; ++i) histogram.push(i);
    for (const share of [0.5, 0.9, 0.99, 0.999]) {
      const ratio = histogram.quantile(share) / (share * 1000);
      expect(ratio).toBeGreaterThan(1 / WITHIN_A_BIN);
      expect(ratio).toBeLessThan(WITHIN_A_BIN);
    }
    expect(histogram.total).toBe(1000);
    expect(histogram.max).toBe(1000);
    expect(histogram.quantile(1)).toBe(1000);
  });

  it('is empty until something is counted, and again when cleared', () => {
    const histogram = new Histogram(1, 2);
    expect(histogram.quantile(0.5)).toBeNaN();
    expect(histogram.span).toBeNull();
    histogram.push(5);
    expect(histogram.span).toEqual([13, 14]);
    histogram.clear();
    expect(histogram.total).toBe(0);
    expect(histogram.max).toBeNaN();
    expect(histogram.span).toBeNull();
  });

  it('counts what is out of range at its ends, and not-a-number not at all', () => {
    const histogram = new Histogram(10, 1);
    for (const value of [0, 3, 1e9, NaN, -1]) histogram.push(value);
    expect(histogram.total).toBe(3);
    expect(histogram.counts[0]).toBe(2);
    expect(histogram.counts.at(-1)).toBe(1);
  });

  it('puts a value on a bin edge into the bin above it', () => {
    const histogram = new Histogram(1, 3);
    for (const bin of [1, 7, 20, 40]) {
      histogram.clear();
      histogram.push(histogram.edge(bin));
      expect(histogram.span).toEqual([bin, bin + 1]);
    }
  });
});
