import { describe, expect, it } from 'vitest';
import { frameWith } from '../state/test_messages';
import { interpolate, isJump, type Motion, motionOf, Playout } from './motion';

/** A car on a circle of 50 m at 20 m/s, to the left. */
function circling(time: number): Motion {
  const [radius, speed] = [50, 20];
  const angle = (speed / radius) * time;
  const at = { x_m: radius * Math.cos(angle), y_m: radius * Math.sin(angle), yaw_rad: angle + Math.PI / 2 };
  const velocity = { vx_mps: speed, vy_mps: 0, yaw_rate_radps: speed / radius, speed_mps: speed };
  return motionOf(frameWith({ time_s: time, lap_time_s: time, ...at, ...velocity }));
}
const far = (a: { x: number; y: number }, b: { x: number; y: number }): number => Math.hypot(a.x - b.x, a.y - b.y);

describe('interpolation', () => {
  it('follows an arc between two frames to a millimetre', () => {
    const [a, b] = [circling(1), circling(1.05)];
    for (const time of [1, 1.01, 1.025, 1.04, 1.05]) {
      const motion = interpolate(a, b, time);
      expect(far(motion, circling(time))).toBeLessThan(1e-3);
      expect(motion.yaw).toBeCloseTo(circling(time).yaw, 5);
    }
  });

  it('turns the short way past half a turn', () => {
    const [a, b] = [circling(1), circling(1.1)];
    const [from, to] = [
      { ...a, yaw: Math.PI - 0.02, yawRate: NaN },
      { ...b, yaw: -Math.PI + 0.02, yawRate: NaN },
    ];
    expect(interpolate(from, to, 1.05).yaw).toBeCloseTo(Math.PI, 9);
  });

  it('counts the lap time on across the line', () => {
    const [a, b] = [
      { ...circling(1), lapTime: 29.98 },
      { ...circling(1.05), lapTime: 0.02 },
    ];
    expect(interpolate(a, b, 1.04).lapTime).toBeCloseTo(0.01, 9);
  });

  it('extrapolates with what is known when side speed and yaw rate are not', () => {
    const blind = (time: number): Motion => ({ ...circling(time), vy: NaN, yawRate: NaN });
    expect(far(interpolate(blind(1), blind(1.05), 1.025), circling(1.025))).toBeLessThan(0.01);
  });

  it('tells a drive from a jump', () => {
    expect(isJump(circling(1), circling(1.05))).toBe(false);
    expect(isJump(circling(1), { ...circling(1.05), x: 500 })).toBe(true);
    expect(isJump(circling(1), circling(0))).toBe(true);
  });
});

describe('playout', () => {
  /** Frames every 50 ms that arrive up to `jitter` ms late, at `pace`; pictures every 16 ms. Returns every picture. */
  function play(jitter: number, pace = 1, seconds = 4): { now: number; motion: Motion; newest: number }[] {
    const playout = new Playout();
    const pictures: { now: number; motion: Motion; newest: number }[] = [];
    let sent = 0;
    let newest = 0;
    for (let now = 0; now < seconds * 1000; now += 16) {
      while (sent * 50 + ((sent * 7919) % 11) * (jitter / 10) <= now) {
        newest = (sent * 50 * pace) / 1000;
        playout.push(circling(newest), now);
        ++sent;
      }
      const motion = playout.advance(now, false);
      if (motion) pictures.push({ now, motion, newest });
    }
    return pictures.filter(({ now }) => now > 1000);
  }

  it('moves evenly at each repaint though frames come with jitter', () => {
    const pictures = play(20);
    for (let i = 1; i < pictures.length; ++i) {
      const step = (pictures[i]?.motion.time ?? 0) - (pictures[i - 1]?.motion.time ?? 0);
      expect(step).toBeGreaterThan(0.01);
      expect(step).toBeLessThan(0.022); // 16 ms, and a little to catch up
    }
  });

  it('shows what is no more than 100 ms old, and stays on the road that was driven', () => {
    for (const { now, motion } of play(20)) {
      expect(now / 1000 - motion.time).toBeLessThan(0.1);
      expect(far(motion, circling(motion.time))).toBeLessThan(0.05);
    }
  });

  it('keeps the pace of slow motion and of fast forward', () => {
    for (const pace of [0.1, 5]) {
      const pictures = play(0, pace);
      const [first, last] = [pictures[0], pictures.at(-1)];
      const rate =
        ((last?.motion.time ?? 0) - (first?.motion.time ?? 0)) / (((last?.now ?? 0) - (first?.now ?? 0)) / 1000);
      expect(rate).toBeGreaterThan(0.97 * pace);
      expect(rate).toBeLessThan(1.03 * pace);
      for (const { now, motion } of pictures)
        expect(((now / 1000) * pace - motion.time) / pace).toBeLessThan(0.1 + 1e-6);
    }
  });

  it('shows the newest frame as it is while the run is held', () => {
    const playout = new Playout();
    for (let i = 0; i < 10; ++i) playout.push(circling(i * 0.05), i * 50);
    for (let now = 460; now < 900; now += 16) playout.advance(now, true);
    expect(playout.advance(910, true)).toEqual(circling(0.45));
    playout.push(circling(0.5), 920); // one step
    for (let now = 921; now < 1100; now += 16) playout.advance(now, true);
    expect(playout.advance(1100, true)).toEqual(circling(0.5));
  });

  it('jumps with a reset instead of driving there', () => {
    const playout = new Playout();
    for (let i = 0; i < 10; ++i) playout.push(circling(10 + i * 0.05), i * 50);
    playout.advance(455, false);
    const { jumps } = playout;
    playout.push(circling(0), 500);
    expect(playout.jumps).toBe(jumps + 1);
    expect(far(playout.advance(501, false) as Motion, circling(0))).toBeLessThan(0.05);
  });

  it('does not run away when frames stop coming', () => {
    const playout = new Playout();
    for (let i = 0; i < 10; ++i) playout.push(circling(i * 0.05), i * 50);
    let motion: Motion | null = null;
    for (let now = 460; now < 5000; now += 16) motion = playout.advance(now, false);
    expect(motion?.time).toBeLessThan(0.45 + 0.13);
  });

  it('has nothing to show before the first frame', () => {
    expect(new Playout().advance(0, false)).toBeNull();
  });
});
