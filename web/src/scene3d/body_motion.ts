// Roll and pitch of the car body in the 3D picture.

/** Roll and pitch of the body at 1 g, and its suspension; chosen for the picture, not taken from the plant. */
const ROLL_PER_G = 0.062; // [rad]
const PITCH_PER_G = 0.038; // [rad]
const FREQUENCY = 2 * Math.PI * 1.7; // [rad/s]
const DAMPING = 0.5;
const GRAVITY = 9.81; // [m/s²]
const STEP_S = 1 / 240; // of the integration: stable for any rate of pictures
const MOST_G = 1.6; // acceleration beyond which the body leans no further; chosen

/** One axis of the body's motion: a spring and damper with the acceleration's angle as equilibrium. */
class Lean {
  angle = 0;
  #rate = 0;

  step(aim: number, dt: number): void {
    this.#rate += (FREQUENCY * FREQUENCY * (aim - this.angle) - 2 * DAMPING * FREQUENCY * this.#rate) * dt;
    this.angle += this.#rate * dt;
  }

  rest(): void {
    this.angle = 0;
    this.#rate = 0;
  }
}

/** Roll (right side down positive) and pitch (nose down positive) of the body on its suspension [rad]. */
export class BodyMotion {
  readonly #roll = new Lean();
  readonly #pitch = new Lean();

  get roll(): number {
    return this.#roll.angle;
  }

  get pitch(): number {
    return this.#pitch.angle;
  }

  /** Advances by `seconds` of the run, with the accelerations forward and to the left [m/s²]. */
  advance(seconds: number, ax: number, ay: number): void {
    const share = (a: number): number => Math.max(-MOST_G, Math.min(MOST_G, Number.isFinite(a) ? a / GRAVITY : 0));
    // A bend to the left pushes the body to the right; braking pushes its nose down.
    const [roll, pitch] = [ROLL_PER_G * share(ay), -PITCH_PER_G * share(ax)];
    for (let left = Math.min(seconds, 0.25); left > 1e-9; left -= STEP_S) {
      const dt = Math.min(left, STEP_S);
      this.#roll.step(roll, dt);
      this.#pitch.step(pitch, dt);
    }
  }

  rest(): void {
    this.#roll.rest();
    this.#pitch.rest();
  }
}
