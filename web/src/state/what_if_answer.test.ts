import { expect, it } from 'vitest';
import { compare } from './comparison';
import {
  type FutureGrid,
  futureCourses,
  readWhatIf,
  TRACE_COLUMNS,
  trustOf,
  verdictOf,
  type WhatIfAnswer,
} from './what_if_answer';

const NAMES = ['as it is', 'with latency 60'] as const;
/** A lap of 200 m, of which 100 m were driven at 20 m/s. */
const GRID: FutureGrid = {
  length: 200,
  points: 200,
  s: (point) => point,
  driven: (_lap, name) =>
    name === 'time_s' ? Float64Array.from({ length: 200 }, (_, i) => (i < 100 ? i / 20 : NaN)) : null,
};

/** A future at a steady speed from 100 m on, as the program tells it. */
function steady(speed: number, seconds: number, more: object = {}): object {
  const times = Array.from({ length: seconds + 1 }, (_, i) => 10 + i);
  const unmoved = Object.fromEntries(TRACE_COLUMNS.map((name) => [name, times.map(() => 0)]));
  const distance_m = times.map((time) => 100 + (time - 10) * speed);
  const trace = { ...unmoved, speed_mps: times.map(() => speed), time_s: times, distance_m };
  return { min_edge_distance_m: 1, interventions: 0, passages: [], trace, ...more };
}

function answerOf(was: object, branch: object): WhatIfAnswer {
  const message = { id: 3, state: 'done', at_s: 10, is_exact: true, end_reason: null, was, branch };
  const state = readWhatIf(message);
  if (state?.kind !== 'done') throw new Error('no answer');
  return state.answer;
}

it('says whose car drove where another program simulates the car, and how far it is to be trusted', () => {
  const message = (more: object) =>
    readWhatIf({ id: 1, state: 'done', at_s: 10, was: steady(10, 5), branch: steady(10, 5), ...more });
  const standIn = (more: object) => {
    const state = message(more);
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
  for (const none of [{ id: 0, state: 'none' }, 'nonsense']) expect(readWhatIf(none)).toBeNull();
  expect(readWhatIf({ id: 2, state: 'computing', share: 0.5 })).toEqual({ kind: 'computing', id: 2, share: 0.5 });
  expect(readWhatIf({ id: 2, state: 'failed', why: 'too long' })).toEqual({ kind: 'failed', id: 2, why: 'too long' });
  const answer = answerOf(steady(20, 5), steady(25, 5));
  expect(answer).toMatchObject({ at: 10, isExact: true, endReason: '' });
  expect(answer.branch.trace.speed_mps[0]).toBe(25);
});

it('of another program has numbers that are not known, and no failure', () => {
  const answer = answerOf({}, { trace: 7 });
  expect(answer.was.leastEdge).toBeNaN();
  expect(futureCourses(answer, GRID, NAMES)).toEqual([]);
});

it('compares both futures behind what was driven of the lap, up to its end or to the end of the shorter', () => {
  const whole = (seconds: number) => ({ passages: [{ lap: 3, sector: 3, time_s: seconds }] });
  const [was, branch] = futureCourses(answerOf(steady(20, 5, whole(5)), steady(25, 4, whole(4))), GRID, NAMES);
  if (!was || !branch) throw new Error('no futures');
  expect([was.name, branch.name]).toEqual(['lap 3 as it is', 'lap 3 with latency 60']);
  // 100 m were driven in 5 s; then 20 or 25 m/s to the end at 200 m.
  expect([was.total, branch.total].map((time) => time.toFixed(3))).toEqual(['10.000', '9.000']);
  expect(was.channel('time_s')?.[60]).toBeCloseTo(3);
  expect(branch.channel('time_s')?.[150]).toBeCloseTo(7);
  const found = compare(was, branch, { samples: GRID, corners: [], line: 0 });
  expect(found?.gap[90]).toBeCloseTo(0);
  expect(found?.gap[150]).toBeCloseTo(0.5);
  expect(found?.total).toBeCloseTo(1);
  const [first, second] = futureCourses(answerOf(steady(20, 5), steady(25, 2)), GRID, NAMES);
  const short = first && second && compare(first, second, { samples: GRID, corners: [], line: 0 });
  expect(short?.total).toBeCloseTo(0.5); // at 150 m
  expect(second?.channel('time_s')?.[151]).toBeNaN();
});

it('has a verdict in words', () => {
  expect(verdictOf(answerOf(steady(20, 5), steady(25, 5, { min_edge_distance_m: 0.8, interventions: 2 })), -1)).toBe(
    '1.00 s faster to the same place, with 0.20 m less room to the edge' +
      '; 2 more control steps were changed by the guard.',
  );
  expect(verdictOf(answerOf(steady(20, 5), steady(20, 5)), 0)).toBe(
    'As fast as before, with the same room to the edge.',
  );
  expect(verdictOf(answerOf(steady(20, 5), steady(16, 5, { min_edge_distance_m: -0.5 })), 1)).toBe(
    '1.00 s slower to the same place, 0.50 m off the road.',
  );
});
