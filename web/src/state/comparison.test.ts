import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { UNKNOWN_LIMIT } from '../protocol/messages';
import type { Limit } from '../protocol/topics';
import {
  byCost,
  type Comparison,
  type Course,
  causesOf,
  causesText,
  compare,
  headlineOf,
  signed,
  stretches,
  whyOf,
} from './comparison';
import { cornersOf } from './corners';
import type { LapChannel } from './lap_samples';

/** The headline as one text. */
function headlineText(of: Comparison): string {
  const { verb, amount, to, rest } = headlineOf(of);
  return `${of.a.name}${verb}${amount}${to}${of.b.name}${rest}`;
}

/** A closed road of straights of 300 m and half circles of 50 m radius to the left. */
function oval(): { x: number; y: number }[] {
  const points: { x: number; y: number }[] = [];
  const half = Math.PI * 50;
  for (let s = 0; s < 2 * (300 + half); s += 1) {
    const t = s % (300 + half);
    const [angle, x] = t < 300 ? [0, t - 150] : [(t - 300) / 50, 150];
    const [px, py] = [x + 50 * Math.sin(angle), -50 * Math.cos(angle)];
    const sign = s < 300 + half ? 1 : -1;
    points.push({ x: sign * px, y: sign * py });
  }
  return [...points, { x: -150, y: -50 }];
}
const LENGTH = 2 * (300 + 50 * Math.PI);
const BEND = 50 * Math.PI;

const POINTS = 1000;
/** A lap from its speeds, by distance from the line [m]. */
function lapOf(speed: (s: number) => number): { time: Float64Array; speed: Float64Array; total: number } {
  const spacing = LENGTH / POINTS;
  const [time, speeds] = [new Float64Array(POINTS), new Float64Array(POINTS)];
  let now = 0;
  for (let i = 0; i < POINTS; ++i) {
    [time[i], speeds[i]] = [now, speed(i * spacing)];
    now += spacing / speed((i + 0.5) * spacing);
  }
  return { time, speed: speeds, total: now };
}
function courseOf(name: string, speed: (s: number) => number, isStanding = false): Course {
  const { time, speed: speeds, total } = lapOf(speed);
  const channels: Partial<Record<LapChannel, Float64Array>> = { time_s: time, speed_mps: speeds };
  return { id: name, name, total, isStanding, channel: (which) => channels[which] ?? null };
}
const samples = { length: LENGTH, points: POINTS, s: (i: number) => (i * LENGTH) / POINTS };
function both(a: Course, b: Course, line = 0): Comparison {
  const found = compare(a, b, { samples, corners: cornersOf(oval()), line });
  if (!found) throw new Error('no comparison');
  return found;
}
/** 50 m/s on straights, `apex` in bends; braking from `braking` metres before one. */
const driven =
  (braking: number, apex: number) =>
  (s: number): number => {
    const t = s % (300 + BEND);
    if (t >= 300) return apex;
    return t > 300 - braking ? 50 - ((50 - apex) * (t - 300 + braking)) / braking : Math.min(50, apex + t);
  };

describe('corners', () => {
  it('are where the road bends, wherever its centre line begins', () => {
    const points = oval();
    for (const shift of [0, 100, 320, 400, 600]) {
      const open = points.slice(0, -1);
      const turned = [...open.slice(shift), ...open.slice(0, shift)];
      const corners = cornersOf([...turned, turned[0] ?? { x: 0, y: 0 }]);
      expect(corners).toHaveLength(2);
      for (const { from, to, turn } of corners) {
        expect((to - from + LENGTH) % LENGTH).toBeCloseTo(BEND, -1.3);
        expect(turn).toBeCloseTo(Math.PI, 0);
      }
    }
  });

  it('are found on every closed track that is shipped', () => {
    const folder = new URL('../../../data/tracks/', import.meta.url);
    const counts: Record<string, number> = {};
    for (const name of readdirSync(folder).filter((each) => each.endsWith('.csv'))) {
      const rows = readFileSync(new URL(name, folder), 'utf8').split('\n');
      const points = rows
        .map((row) => row.split(/[,;\s]+/).map(Number))
        .filter((row) => row.length >= 2 && Number.isFinite(row[0]) && Number.isFinite(row[1]))
        .map(([x = 0, y = 0]) => ({ x, y }));
      if (points.length < 10) continue;
      counts[name] = cornersOf([...points, points[0] ?? { x: 0, y: 0 }]).length;
    }
    for (const [name, count] of Object.entries(counts)) {
      expect(count, name).toBeGreaterThanOrEqual(1);
      expect(count, name).toBeLessThan(40);
    }
  });

  it('are none on a line that is too short', () => {
    expect(cornersOf([])).toEqual([]);
    expect(
      cornersOf([
        { x: 0, y: 0 },
        { x: 1, y: 0 },
      ]),
    ).toEqual([]);
  });
});

describe('a comparison', () => {
  it('adds up to the whole lap, by pieces and by corners', () => {
    const sum = (all: readonly { lost: number }[]): number => all.reduce((total, { lost }) => total + lost, 0);
    for (const line of [0, 140, 350, 700]) {
      const found = both(courseOf('lap 2', driven(80, 20)), courseOf('lap 3', driven(60, 22)), line);
      expect(sum(stretches(found, 25))).toBeCloseTo(found.total, 9);
      expect(sum(found.corners)).toBeCloseTo(found.total, 9);
      expect(found.corners.map(({ name }) => name)).toEqual(['T1', 'T2']);
    }
  });

  it('gives the reasons: early braking, a slow bend, another line', () => {
    const whyIn = (a: (s: number) => number, b: (s: number) => number): string => {
      const corner = both(courseOf('a', a), courseOf('b', b)).corners[0];
      return corner ? whyOf(corner) : '';
    };
    expect(whyIn(driven(90, 20), driven(60, 20))).toMatch(/^slows (29|30|31) m early$/);
    expect(whyIn(driven(60, 20), driven(90, 20))).toMatch(/^slows (29|30|31) m late$/);
    expect(whyIn(driven(60, 18), driven(60, 20))).toBe('4 mph slower');
    const lazy = (s: number): number => (s > 300 + BEND && s < 400 + BEND ? 20 : driven(60, 20)(s));
    expect(whyIn(lazy, driven(60, 20))).toBe('another line');
    expect(whyIn(lazy, lazy)).toBe('the same');
  });

  it('is not known where one of them has no course', () => {
    const unknown: Course = { ...courseOf('lap 9', driven(60, 20)), channel: () => null };
    expect(compare(unknown, courseOf('lap 3', driven(60, 20)), { samples, corners: [], line: 0 })).toBeNull();
  });

  it('ends where the shorter of both ends', () => {
    const long = courseOf('as it is', driven(60, 20));
    const times = long.channel('time_s')?.map((time, i) => (i < 300 ? 1.1 * time : NaN)) ?? null;
    const short: Course = { ...long, total: NaN, channel: (name) => (name === 'time_s' ? times : long.channel(name)) };
    expect(both(short, long).total).toBeCloseTo(0.1 * (long.channel('time_s')?.[299] ?? NaN));
  });
});

describe('the headline', () => {
  const limit = courseOf('the limit', driven(40, 26));
  const others = [
    limit,
    courseOf('lap 1', (s) => Math.min(5 + s / 4, driven(60, 20)(s)), true),
    courseOf('lap 2', driven(80, 20)),
    courseOf('lap 3', driven(60, 22)),
    courseOf('lap 2 of wet.mcap', driven(120, 14)),
    courseOf('lap 4 with latency 60', (s) => (s < 300 ? driven(60, 22)(s) : driven(90, 21)(s))),
  ];

  it('says what its table says, for every pair of A and B', () => {
    for (const a of others) {
      for (const b of others) {
        if (a === b) continue;
        const found = both(a, b);
        const [first] = byCost(found);
        const text = headlineText(found);
        const word = found.total > 0 ? 'lost' : 'won';
        expect(text.startsWith(a.name), text).toBe(true);
        expect(text).toContain(
          ` ${word} ${signed(found.total).slice(1)} s ${word === 'lost' ? 'to' : 'from'} ${b.name}; `,
        );
        expect(text).toContain(
          `${first?.name} ${word === 'lost' ? 'cost' : 'gave'} most, ${signed(first?.lost ?? NaN).slice(1)} s.`,
        );
        const sense = Math.sign(found.total);
        for (const { lost } of found.corners) expect(sense * lost).toBeLessThanOrEqual(sense * (first?.lost ?? NaN));
      }
    }
  });

  it('tells a lap from standstill, and laps that took as long', () => {
    const [, first, second] = others as [Course, Course, Course];
    expect(headlineText(both(first, limit))).toMatch(
      /^lap 1, from standstill, lost \d+\.\d\d s to the limit; T1 cost most/,
    );
    expect(headlineText(both(second, { ...second, id: 'b', name: 'lap 9' }))).toBe('lap 2 took as long as lap 9.');
  });
});

it('causes are shown one by one, as they do not add up', () => {
  const limit: Limit = {
    ...UNKNOWN_LIMIT,
    is_known: true,
    lap_time_s: 20,
    without: ['latency', 'grip reserve', 'guard', 'edge margin'],
    without_lap_times_s: Float64Array.of(26.279, 25.469, 25.979, NaN),
  };
  expect(causesText(causesOf(limit, 26.279))).toBe(
    'Without its grip reserve the best lap would be 0.81 s faster, without the guard 0.30 s. The delay costs nothing.',
  );
  expect(causesText(causesOf({ ...limit, without: [] }, 26.279))).toBe('');
});
