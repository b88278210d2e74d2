import { describe, expect, it } from 'vitest';
import {
  atDistance,
  finalGap,
  gapAt,
  placesOf,
  readWhatIf,
  stretchesOf,
  TRACE_COLUMNS,
  trustOf,
  verdictOf,
  type WhatIfAnswer,
} from './what_if_answer';

/** A future at a steady speed from 100 m on, as the program tells it. */
function steady(speed: number, seconds: number, more: object = {}): object {
  const times = Array.from({ length: seconds + 1 }, (_, i) => 10 + i);
  const trace = Object.fromEntries(TRACE_COLUMNS.map((name) => [name, times.map(() => 0)]));
  return {
    duration_s: seconds,
    lap_times_s: [],
    max_abs_lateral_error_m: 0.5,
    min_edge_distance_m: 1,
    mean_speed_mps: speed,
    top_speed_mps: speed,
    off_track_events: 0,
    interventions: 0,
    passages: [],
    trace: { ...trace, time_s: times, distance_m: times.map((time) => 100 + (time - 10) * speed) },
    ...more,
  };
}

function answerOf(was: object, branch: object): WhatIfAnswer {
  const told = { id: 3, state: 'done', at_s: 10, known_until_s: 15, is_exact: true, end_reason: null, was, branch };
  const state = readWhatIf(told);
  if (state?.kind !== 'done') throw new Error('no answer');
  return state.answer;
}

describe('an answer', () => {
  it('says whose car drove where another program simulates the car, and how far it is to be trusted', () => {
    const told = (more: object) =>
      readWhatIf({ id: 1, state: 'done', at_s: 10, was: steady(10, 5), branch: steady(10, 5), ...more });
    const standIn = (more: object) => {
      const state = told(more);
      return state?.kind === 'done' ? state.answer.standIn : undefined;
    };
    expect(standIn({})).toBeNull();
    const found = standIn({ stand_in: { plant: 'udacity', compared_s: 9.96, apart_m: 0.413 } });
    expect(found).toEqual({ plant: 'udacity', compared: 9.96, apart: 0.413 });
    expect(found && trustOf(found)).toMatch(
      /our own car \(udacity\).* Over the 10 s before, .* up to 0\.41 m from yours/,
    );
    expect(trustOf({ plant: 'udacity', compared: 0.4, apart: 0 })).toMatch(/too young/);
  });

  it('is read, and so is that there is none yet, or why there is none', () => {
    expect(readWhatIf({ id: 0, state: 'none' })).toBeNull();
    expect(readWhatIf('nonsense')).toBeNull();
    expect(readWhatIf({ id: 2, state: 'computing', share: 0.5 })).toEqual({ kind: 'computing', id: 2, share: 0.5 });
    expect(readWhatIf({ id: 2, state: 'failed', why: 'too long' })).toEqual({ kind: 'failed', id: 2, why: 'too long' });
    const answer = answerOf(steady(20, 5), steady(25, 5));
    expect(answer.at).toBe(10);
    expect(answer.isExact).toBe(true);
    expect(answer.endReason).toBe('');
    expect(answer.branch.meanSpeed).toBe(25);
  });

  it('of another program has numbers that are not known, and no failure', () => {
    const answer = answerOf({}, { trace: 7 });
    expect(answer.was.leastEdge).toBeNaN();
    expect(stretchesOf(answer)).toEqual([]);
    expect(finalGap(answer)).toBeNaN();
  });

  it('compares the futures at the same place, as far as both have come', () => {
    const answer = answerOf(steady(20, 5), steady(25, 5));
    expect(atDistance(answer.was.trace, 'time_s', 130)).toBeCloseTo(11.5, 12);
    expect(atDistance(answer.was.trace, 'time_s', 200)).toBe(15);
    expect(atDistance(answer.was.trace, 'time_s', 99)).toBeNaN();
    expect(atDistance(answer.was.trace, 'time_s', 201)).toBeNaN();
    expect(gapAt(answer, 200)).toBeCloseTo(-1, 12);
    expect(finalGap(answer)).toBeCloseTo(-1, 12);
    const places = placesOf(answer, 11);
    expect(places[0]).toBe(100);
    expect(places.at(-1)).toBe(225);
    expect(places).toHaveLength(11);
  });

  it('tells sectors by the time spent in them, unknown where one future did not come', () => {
    const passages = [
      { lap: 1, sector: 3, time_s: 2 },
      { lap: 2, sector: 1, time_s: 5 },
    ];
    const answer = answerOf(
      steady(20, 5, { passages }),
      steady(15, 5, { passages: [{ lap: 1, sector: 3, time_s: 2.5 }] }),
    );
    expect(stretchesOf(answer)).toEqual([
      { lap: 1, sector: 3, isWhole: false, was: 2, branch: 2.5 },
      { lap: 2, sector: 1, isWhole: true, was: 3, branch: NaN },
    ]);
  });

  it('has a verdict in words', () => {
    expect(verdictOf(answerOf(steady(20, 5), steady(25, 5, { min_edge_distance_m: 0.8, interventions: 2 })))).toBe(
      '1.00 s faster to the same place, with 0.20 m less room to the edge' +
        '; 2 more control steps were changed by the guard.',
    );
    expect(verdictOf(answerOf(steady(20, 5), steady(20, 5)))).toBe(
      'As fast as before, with the same room to the edge.',
    );
    expect(verdictOf(answerOf(steady(20, 5), steady(16, 5, { min_edge_distance_m: -0.5 })))).toBe(
      '1.00 s slower to the same place, 0.50 m off the road.',
    );
  });
});
