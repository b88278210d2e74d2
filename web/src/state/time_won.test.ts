import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { cornersOf } from './corners';
import { cornerTimes, miniSectors, type TwoLaps } from './time_won';

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
function both(a: (s: number) => number, b: (s: number) => number): TwoLaps {
  const [one, other] = [lapOf(a), lapOf(b)];
  return {
    s: Float64Array.from({ length: POINTS }, (_, i) => (i * LENGTH) / POINTS),
    length: LENGTH,
    time: [one.time, other.time],
    speed: [one.speed, other.speed],
    total: one.total - other.total,
  };
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

describe('where the time is won', () => {
  it('adds up to the whole lap, by mini-sectors and by corners', () => {
    const laps = both(driven(80, 20), driven(60, 22));
    const pieces = miniSectors(laps);
    expect(pieces).toHaveLength(Math.round(LENGTH / 25));
    const sum = (all: readonly { lost: number }[]): number => all.reduce((total, { lost }) => total + lost, 0);
    expect(sum(pieces)).toBeCloseTo(laps.total, 9);
    for (const line of [0, 140, 350, 700]) {
      const corners = cornerTimes(laps, cornersOf(oval()), line);
      expect(sum(corners)).toBeCloseTo(laps.total, 9);
      expect(corners.map(({ number }) => number)).toEqual([1, 2]);
    }
  });

  it('names the cause: early braking, a slow apex, a slow way out', () => {
    const corners = cornersOf(oval());
    const first = (a: (s: number) => number, b: (s: number) => number) =>
      cornerTimes(both(a, b), corners, 0)[0]?.main.cause;
    expect(first(driven(90, 20), driven(60, 20))).toEqual({ kind: 'braking', metres: expect.closeTo(-30, -0.5) });
    expect(first(driven(60, 20), driven(90, 20))).toEqual({ kind: 'braking', metres: expect.closeTo(30, -0.5) });
    expect(first(driven(60, 18), driven(60, 20))).toEqual({ kind: 'apex', mps: expect.closeTo(-2, 1) });
    const lazy = (s: number): number => (s > 300 + BEND && s < 400 + BEND ? 20 : driven(60, 20)(s));
    expect(first(lazy, driven(60, 20))).toEqual({ kind: 'out' });
  });

  it('says nothing of a lap against itself', () => {
    const laps = both(driven(60, 20), driven(60, 20));
    expect(miniSectors(laps).every(({ lost }) => lost === 0)).toBe(true);
  });
});
