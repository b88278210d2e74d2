import { describe, expect, it } from 'vitest';
import { frameWith } from '../state/test_messages';
import { type Motion, motionOf } from './motion';
import { RibbonRing, ribbonIndices, writeRibbon } from './ribbon';
import { markStrength, TyreMarks } from './tyre_marks';

describe('a ring of bands', () => {
  it('joins pairs of one track, and not those of another or across a lift', () => {
    const ring = new RibbonRing(10, 2);
    ring.push(0, 0, 1, 0, -1, 1);
    expect(ring.written).toBe(0);
    ring.push(1, 0, 5, 0, 4, 1);
    ring.push(0, 2, 1, 2, -1, 0.5);
    expect(ring.written).toBe(1);
    expect([...ring.positions.slice(0, 12)]).toEqual([0, 1, 0, 0, -1, 0, 2, -1, 0, 2, 1, 0]);
    expect([3, 7, 11, 15].map((i) => ring.colours[i])).toEqual([255, 255, 128, 128]);
    ring.lift(0);
    ring.push(0, 9, 1, 9, -1, 1);
    expect(ring.written).toBe(1);
  });

  it('stays as large as it is, and lets the oldest go', () => {
    const ring = new RibbonRing(4, 1);
    const { buffer } = ring.positions;
    for (let x = 0; x <= 6; ++x) ring.push(0, x, 1, x, -1, 1);
    expect(ring.written).toBe(6);
    expect(ring.positions.buffer).toBe(buffer);
    const starts = [0, 1, 2, 3].map((slot) => ring.positions[12 * slot]);
    expect(starts).toEqual([4, 5, 2, 3]);
    ring.clear();
    expect(ring.written).toBe(0);
    expect(Math.max(...ring.positions)).toBe(0);
  });
});

describe('a band along a line', () => {
  it('has its corners half its width to each side, and faces up', () => {
    const positions = new Float32Array(18);
    writeRibbon([0, 1, 2], [0, 0, 0], 3, 0.5, positions);
    expect([...positions]).toEqual([0, 0.25, 0, 0, -0.25, 0, 1, 0.25, 0, 1, -0.25, 0, 2, 0.25, 0, 2, -0.25, 0]);
    expect([...ribbonIndices(3)]).toEqual([0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4]);
    expect(ribbonIndices(0).length).toBe(0);
  });

  it('is finite where points repeat', () => {
    const positions = new Float32Array(12);
    writeRibbon([3, 3], [4, 4], 2, 0.5, positions);
    expect([...positions]).toEqual([3, 4, 0, 3, 4, 0, 3, 4, 0, 3, 4, 0]);
  });
});

describe('tyre marks', () => {
  const car = { front: 1.2, rear: 1.5, halfTrack: 0.8, tyreWidth: 0.25, spacing: 0.35 };
  const straight = { yaw_rad: 0, vx_mps: 20, vy_mps: 0, yaw_rate_radps: 0, speed_mps: 20, steer_applied_rad: 0 };
  const at = (x: number, rest: Partial<Motion>): Motion => ({
    ...motionOf(frameWith({ ...straight, x_m: x, front_tire_use: 0.5, rear_tire_use: 0.5 })),
    ...rest,
  });

  it('are drawn by the axle that uses more than its grip', () => {
    const marks = new TyreMarks();
    for (let x = 0; x < 5; ++x) marks.push(at(x, {}), car);
    expect(marks.ring.written).toBe(0);
    for (let x = 5; x < 10; ++x) marks.push(at(x, { rearUse: 1.2 }), car);
    expect(marks.ring.written).toBe(8); // two wheels, four pieces each
    expect(marks.ring.positions[0]).toBeCloseTo(5 - 1.5, 5);
    expect(marks.ring.positions[1]).toBeCloseTo(0.8 + 0.125, 5);
  });

  it('leave a gap where the car was put somewhere else', () => {
    const marks = new TyreMarks();
    marks.push(at(0, { rearUse: 1.2 }), car);
    marks.lift();
    marks.push(at(100, { rearUse: 1.2 }), car);
    expect(marks.ring.written).toBe(0);
  });

  it('are judged by slip angle where grip is unknown', () => {
    expect(markStrength(NaN, 0.05)).toBe(0);
    expect(markStrength(NaN, -0.3)).toBeGreaterThan(0.5);
    expect(markStrength(NaN, NaN)).toBe(0);
    expect(markStrength(1, 0.5)).toBe(0);
    expect(markStrength(1.01, 0)).toBeGreaterThan(0.2);
    const marks = new TyreMarks();
    for (let x = 0; x < 3; ++x) marks.push(at(x, { frontUse: NaN, rearUse: NaN, vy: -6 }), car);
    expect(marks.ring.written).toBe(8);
  });
});
