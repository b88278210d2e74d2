import type { MeshBuilder, Vector } from './mesh';
import { ACCENT, CARBON, LAMP, LIGHT, METAL, type Measures, type Parts, SOOT, WHITE } from './parts';

// A model car with its computer, as F1TENTH builds it: chassis, battery, a plate on posts with computer and laser
// scanner, aerials, and a bumper of foam. Drawn in the units of a car of 4.5 m, as the others.

/** Adds an upright drum about (x, 0). */
function drum(mesh: MeshBuilder, x: number, low: number, high: number, radius: number, colour = SOOT): void {
  const SIDES = 16;
  const at = (i: number, z: number): Vector => {
    const angle = (2 * Math.PI * (i + 0.5)) / SIDES;
    return [x + radius * Math.cos(angle), radius * Math.sin(angle), z];
  };
  for (let i = 0; i < SIDES; ++i) {
    mesh.quad(at(i, low), at(i + 1, low), at(i + 1, high), at(i, high), colour);
    mesh.triangle([x, 0, high], at(i, high), at(i + 1, high), colour);
    mesh.triangle([x, 0, low], at(i + 1, low), at(i, low), colour);
  }
}

/** Adds the body of a model car; returns the place of its scanner as that of the driver's eyes. */
export function addModelCar(
  { paint, dark, lamps, headlamps }: Parts,
  { k, nose, tail, inner, halfWidth, at }: Measures,
): { eye: Vector; steeringWheel: Vector } {
  const wide = Math.min(0.42 * k, inner);
  const box = (mesh: MeshBuilder, from: number, to: number, half: number, low: number, high: number, colour = CARBON) =>
    mesh.box([from, -half, low * k], [to, half, high * k], colour);
  box(dark, tail + 0.16 * k, nose - 0.1 * k, wide, 0.24, 0.32);
  box(dark, nose - 0.16 * k, nose, 0.8 * halfWidth, 0.18, 0.42, SOOT); // foam
  box(paint, at(0.16), at(0.56), 0.66 * wide, 0.32, 0.56, ACCENT); // battery
  box(dark, at(0.62), at(0.8), 0.5 * wide, 0.32, 0.6, SOOT); // motor control
  const [back, ahead, plate] = [at(-0.06), at(0.98), 0.76];
  box(paint, back, ahead, wide, plate, plate + 0.05, WHITE);
  for (const side of [-1, 1]) {
    for (const x of [back + 0.08 * k, at(0.46), ahead - 0.08 * k])
      dark.rod([x, side * 0.9 * wide, 0.32 * k], [x, side * 0.9 * wide, plate * k], 0.05 * k, METAL);
    const y = side * 0.8 * wide;
    dark.rod([back + 0.06 * k, y, 0.81 * k], [back - 0.06 * k, y, 1.5 * k], 0.03 * k, SOOT); // aerials
    const [a, b] = [side * 0.5 * wide, side * 0.95 * wide];
    lamps.box([tail + 0.13 * k, a, 0.25 * k], [tail + 0.17 * k, b, 0.32 * k], LAMP);
    headlamps.box([ahead - 0.01 * k, a, plate * k], [ahead + 0.02 * k, b, (plate + 0.05) * k], LIGHT);
  }
  // The computer with its fins, and the scanner in front of it.
  box(dark, at(0.08), at(0.5), 0.7 * wide, 0.81, 0.94, CARBON);
  for (let i = 0; i < 7; ++i) box(dark, at(0.1 + 0.055 * i), at(0.125 + 0.055 * i), 0.62 * wide, 0.94, 1.02, METAL);
  const scanner = at(0.78);
  drum(dark, scanner, 0.81 * k, 0.93 * k, 0.24 * k);
  drum(dark, scanner, 0.95 * k, 1.16 * k, 0.22 * k, CARBON);
  drum(dark, scanner, 0.93 * k, 0.95 * k, 0.2 * k, ACCENT);
  return { eye: [scanner, 0, 1.24 * k], steeringWheel: [scanner, 0, 0.7 * k] };
}
