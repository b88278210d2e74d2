import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { BodyMotion } from './body_motion';
import { CAMERAS, CameraMan, DEFAULT_ORBIT, type Lens, orbited, type Subject, zoomedOrbit } from './cameras';
import { noiseTile } from './noise';
import { LEVELS, QualityGovernor, SOFTWARE_LEVEL } from './quality';
import { plantTrees } from './trees';

describe('the body', () => {
  const settle = (ax: number, ay: number): BodyMotion => {
    const body = new BodyMotion();
    for (let i = 0; i < 300; ++i) body.advance(1 / 60, ax, ay);
    return body;
  };

  it('leans out of bends and dives when braking', () => {
    expect(settle(0, 9.81).roll).toBeCloseTo(0.062, 3); // left bend: right side down
    expect(settle(0, -9.81).roll).toBeCloseTo(-0.062, 3);
    expect(settle(-9.81, 0).pitch).toBeCloseTo(0.038, 3); // nose down
    expect(settle(5, 0).pitch).toBeLessThan(0);
  });

  it('stays bounded for any input and frame rate', () => {
    const body = new BodyMotion();
    for (let i = 0; i < 200; ++i) body.advance(i % 7 === 0 ? 5 : 0.2, i % 2 ? 1e9 : -1e9, NaN);
    expect(Math.abs(body.pitch)).toBeLessThan(0.2);
    expect(body.roll).toBe(0);
    body.rest();
    expect(body.pitch).toBe(0);
  });
});

const LENS: Lens = { aspect: 1.6, plan: null, orbit: DEFAULT_ORBIT, isCut: false };

describe('cameras', () => {
  const car: Subject = { x: 100, y: 50, yaw: 0.6, speed: 30, length: 4.5, eye: [0, 0, 1] };

  it('keep the car in front of the lens', () => {
    for (const { value: view } of CAMERAS) {
      const shot = new CameraMan().shoot(view, car, LENS, 0.016);
      const look = shot.target.map((value, i) => value - (shot.position[i] ?? 0));
      const ahead = (look[0] as number) * Math.cos(car.yaw) + (look[1] as number) * Math.sin(car.yaw);
      expect([...shot.position, ...shot.target, shot.fieldOfView].every(Number.isFinite), view).toBe(true);
      expect(shot.position[2], view).toBeGreaterThan(0);
      if (view === 'chase' || view === 'cockpit') expect(ahead, view).toBeGreaterThan(0);
    }
  });

  it('follow a turn softly, at once when calm, and cut after a jump', () => {
    const turned = { ...car, yaw: 1.6 };
    const behind = (yaw: number): number => car.x - 1.62 * 4.5 * Math.cos(yaw);
    const man = new CameraMan();
    man.shoot('chase', car, LENS, 0.016);
    const soft = man.shoot('chase', turned, LENS, 0.016).position[0];
    expect(Math.abs(soft - behind(0.6))).toBeLessThan(1);
    const calm = man.shoot('chase', turned, { ...LENS, isCut: true }, 0.016);
    expect(calm.position[0]).toBeCloseTo(behind(1.6), 6);
    man.cut();
    expect(man.shoot('chase', car, LENS, 0.016).position[0]).toBeCloseTo(behind(0.6), 6);
  });

  it.each([0.46, 1.1, 2])('hold the whole plan from behind and from above, at once and gliding, width %f', (aspect) => {
    // A hairpin: two seconds that turn by more than half a circle.
    const bend = Array.from({ length: 41 }, (_, i) => ({ a: 0.6 + i / 11 }));
    const plan = { x: [car.x], y: [car.y] };
    for (const { a } of bend) {
      plan.x.push((plan.x.at(-1) ?? 0) + 1.2 * Math.cos(a));
      plan.y.push((plan.y.at(-1) ?? 0) + 1.2 * Math.sin(a));
    }
    for (const view of ['chase', 'top'] as const) {
      const man = new CameraMan();
      man.shoot(view, car, { ...LENS, aspect }, 0.016);
      for (let i = 0; i < 20; ++i) {
        const { position, target, up, fieldOfView } = man.shoot(view, car, { ...LENS, aspect, plan }, 0.016);
        const camera = new PerspectiveCamera((fieldOfView * 180) / Math.PI, aspect);
        camera.up.set(...up);
        camera.position.set(...position);
        camera.lookAt(...target);
        camera.updateMatrixWorld();
        for (const [k, x] of plan.x.entries()) {
          const point = new Vector3(x, plan.y[k], 0).project(camera);
          expect(Math.max(Math.abs(point.x), Math.abs(point.y)), `${view} ${i} ${k}`).toBeLessThan(0.97);
        }
      }
    }
  });

  it('never look from below the ground, nor from inside the car', () => {
    let orbit = DEFAULT_ORBIT;
    for (let i = 0; i < 100; ++i) orbit = zoomedOrbit(orbited(orbit, 0.5, -0.2), 0.7);
    expect(orbit.elevation).toBeGreaterThan(0);
    expect(orbit.zoom).toBe(0.3);
    for (let i = 0; i < 100; ++i) orbit = zoomedOrbit(orbited(orbit, 0.5, 0.2), 1.4);
    expect(orbit.elevation).toBeLessThan(Math.PI / 2);
    expect(orbit.zoom).toBe(6);
  });
});

describe('quality', () => {
  const feed = (governor: QualityGovernor, gap: number, pictures: number, cost = 1): void => {
    for (let i = 0; i < pictures; ++i) governor.picture(gap, cost);
  };

  it('goes down while pictures come late, and up again when they do not', () => {
    const governor = new QualityGovernor(false);
    feed(governor, 40, 120);
    expect(governor.level).toBe(3);
    feed(governor, 16.7, 40 * 200);
    expect(governor.level).toBe(0);
  });

  it('saves the page thread: a picture may take half of its time', () => {
    const governor = new QualityGovernor(false);
    feed(governor, 16.7, 40, 15);
    expect(governor.level).toBe(1);
  });

  it('ends at the cheapest, begins low where the processor draws, and stays there', () => {
    const governor = new QualityGovernor(true);
    expect(governor.level).toBe(SOFTWARE_LEVEL);
    feed(governor, 30, 40 * 100);
    expect(governor.level).toBe(SOFTWARE_LEVEL);
    feed(governor, 200, 40 * 100);
    expect(governor.level).toBe(LEVELS.length - 1);
  });

  it('does not judge by time in which the page was hidden', () => {
    const governor = new QualityGovernor(false);
    feed(governor, 5000, 400);
    feed(governor, NaN, 400);
    expect(governor.level).toBe(0);
  });
});

describe('the landscape', () => {
  it('has noise that fits edge to edge and keeps within its amplitude', () => {
    const tile = noiseTile(32, 0.2, [4, 8], 1);
    expect(Math.max(...tile.map((value) => Math.abs(value - 1)))).toBeLessThanOrEqual(0.2);
    for (let i = 0; i < 32; ++i) expect(Math.abs((tile[i * 32] ?? 0) - (tile[i * 32 + 31] ?? 0))).toBeLessThan(0.12);
    expect(noiseTile(32, 0.2, [4, 8], 1)).toEqual(tile);
  });

  it('plants no tree near a road, not even near another part of it', () => {
    const line = (half: number) =>
      Array.from({ length: 300 }, (_, i) => {
        const angle = (2 * Math.PI * i) / 300;
        const radius = 90 + 50 * Math.cos(2 * angle) + half;
        return { x: radius * Math.cos(angle), y: radius * Math.sin(angle) };
      });
    const lines = { left: line(-5), right: line(5), centre: line(0) };
    const trees = plantTrees(lines);
    expect(trees.length).toBeGreaterThan(100);
    for (const tree of trees) {
      const near = Math.min(
        ...[...lines.left, ...lines.right].map((point) => Math.hypot(point.x - tree.x, point.y - tree.y)),
      );
      expect(near).toBeGreaterThan(9);
    }
    expect(plantTrees(lines)).toEqual(trees);
  });
});
