import { describe, expect, it } from 'vitest';
import { gateInWords, roadInWords, rungInWords, sightInWords, statusInWords } from './words';

describe('words', () => {
  it('gets graver with each rung', () => {
    expect([0, 1, 2, 3].map((rung) => rungInWords(rung).mood)).toEqual(['good', 'warning', 'bad', 'bad']);
    expect(rungInWords(9).text).toContain('9');
  });

  it('calls no unusable answer good', () => {
    expect([0, 1, -1, -2, -3, 7].map((status) => statusInWords(status).mood)).toEqual(['good', 'warning', 'bad', 'bad', 'bad', 'bad']);
  });

  it('tells of the gate', () => {
    expect(gateInWords(false).mood).toBe('good');
    expect(gateInWords(true).mood).toBe('warning');
  });

  it('tells what road is known', () => {
    expect(sightInWords(false, 139.6).text).toBe('Sees 140 m ahead');
    expect(sightInWords(true, 300).text).toBe('Knows the lap, uses 300 m');
    expect(sightInWords(false, NaN).text).toBe('Sees no road ahead');
  });

  it('tells of the road', () => {
    const frame = { is_off_track: false, edge_distance_m: 1, off_track_events: 0 };
    expect(roadInWords(frame).mood).toBe('good');
    expect(roadInWords({ ...frame, off_track_events: 1 }).text).toContain('once');
    expect(roadInWords({ ...frame, off_track_events: 2 }).text).toContain('2 times');
    expect(roadInWords({ ...frame, is_off_track: true }).mood).toBe('bad');
    expect(roadInWords({ ...frame, edge_distance_m: NaN }).mood).toBe('unknown');
  });
});
