import type { Stick } from './manual';

// A gamepad as the wheel: the left stick steers, the right trigger drives, the left one brakes, Start takes the wheel
// and hands it back. Browsers report a gamepad once one of its buttons was pressed.

const DEAD = 0.08; // share of the stick's way about its middle that counts as released; chosen
const [LEFT_TRIGGER, RIGHT_TRIGGER, START] = [6, 7, 9]; // of the standard mapping

/** The part of a gamepad that is read. */
type Pad = Pick<Gamepad, 'axes' | 'buttons' | 'mapping' | 'connected' | 'id'>;

/** The first connected gamepad with the standard mapping. */
export function firstGamepad(all: readonly (Pad | null)[]): Pad | null {
  return all.find((each) => each?.connected === true && each.mapping === 'standard') ?? null;
}

/** Gamepads of the browser; none where it offers none, or not to this page. */
export function gamepads(): readonly (Pad | null)[] {
  try {
    return navigator.getGamepads?.() ?? [];
  } catch {
    return [];
  }
}

/** Stick position of a gamepad; null while it is released. Beyond the dead middle proportional. */
export function stickOf(pad: Pad): Stick | null {
  const axis = pad.axes[0] ?? 0;
  const away = Math.max(0, Math.abs(axis) - DEAD) / (1 - DEAD);
  const steer = away === 0 ? 0 : -Math.sign(axis) * Math.min(1, away);
  const throttle = (pad.buttons[RIGHT_TRIGGER]?.value ?? 0) - (pad.buttons[LEFT_TRIGGER]?.value ?? 0);
  return steer === 0 && Math.abs(throttle) < 0.02 ? null : { steer, throttle };
}

/** Whether Start is pressed, which takes the wheel or hands it back. */
export const asksForWheel = (pad: Pad): boolean => pad.buttons[START]?.pressed ?? false;
