import { expect, it } from 'vitest';
import { carShape } from './car';

const size = {
  front_axle_m: 1.2,
  rear_axle_m: 1.6,
  track_width_m: 2,
  tire_width_m: 0.25,
  body_length_m: 4.4,
  body_width_m: 2,
};

it('is as long as the car and holds all axles', () => {
  const shape = carShape(size, 0);
  expect(shape.front - shape.rear).toBeCloseTo(4.4, 12);
  for (const wheel of shape.wheels) {
    expect(wheel.angle).toBeCloseTo(0, 12);
    expect(wheel.x).toBeGreaterThan(shape.rear);
    expect(wheel.x).toBeLessThan(shape.front);
  }
});

it('turns all wheels around one point', () => {
  const steer = 0.3;
  const radius = 2.8 / Math.tan(steer); // of the middle of the rear axle
  const [left, right] = carShape(size, steer).wheels;
  expect(Math.tan(left?.angle ?? NaN)).toBeCloseTo(2.8 / (radius - 1), 12);
  expect(Math.tan(right?.angle ?? NaN)).toBeCloseTo(2.8 / (radius + 1), 12);
  expect(left?.angle).toBeGreaterThan(right?.angle ?? NaN); // to the left, the left one is the inner one
});

it('mirrors with the steering', () => {
  const [left, right] = carShape(size, 0.2).wheels;
  const [mirroredLeft, mirroredRight] = carShape(size, -0.2).wheels;
  expect(mirroredRight?.angle).toBeCloseTo(-(left?.angle ?? NaN), 12);
  expect(mirroredLeft?.angle).toBeCloseTo(-(right?.angle ?? NaN), 12);
});

it('stands straight when the steering is unknown', () => {
  expect(carShape(size, NaN).wheels[0]?.angle).toBe(0);
});

it('has wheels in the size of a model car', () => {
  const model = carShape({ ...size, body_length_m: 0.45, tire_width_m: 0.05 }, 0);
  expect(model.wheelLength).toBeCloseTo(0.068, 9);
  expect(model.wheelWidth).toBeCloseTo(0.05, 9);
  expect(carShape({ ...size, body_length_m: 4.3 }, 0).wheelLength).toBe(0.68);
});
