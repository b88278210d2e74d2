import { expect, it } from 'vitest';
import { runWith } from '../state/test_messages';
import { fitInWords, identifiedOf, roadInWords } from './origin_view';

it('has a row for each identified parameter, and none without', () => {
  const run = runWith({
    identified_keys: ['mass_kg', 'friction'],
    identified_values: Float64Array.of(3.4, 0.9),
    identified_low: Float64Array.of(3.2, NaN),
    identified_high: Float64Array.of(3.6, NaN),
  });
  expect(identifiedOf(run)).toEqual([
    { key: 'mass_kg', value: 3.4, low: 3.2, high: 3.6 },
    { key: 'friction', value: 0.9, low: NaN, high: NaN },
  ]);
  expect(identifiedOf(runWith())).toEqual([]);
});

it('says what a road was read from, its size, and how near the line is to its points', () => {
  const fit = { track_points: 812, track_fit_rms_m: 0.0123, track_fit_max_m: 0.034 };
  const run = runWith({ track_kind: 'occupancy map', track_scale: 0.1, ...fit });
  expect(roadInWords(run)).toBe('Read from an occupancy map file, driven at 0.1 of its size.');
  expect(roadInWords(runWith({ track_kind: 'GPX', track_scale: 1 }))).toBe('Read from a GPX file.');
  expect(fitInWords(run)).toBe('812 points of the file, 0.012 m from the line (rms), 0.034 m at most');
});

it('is silent about what an older program does not tell', () => {
  expect(roadInWords(runWith())).toBe('');
  expect(fitInWords(runWith())).toBe('');
});
