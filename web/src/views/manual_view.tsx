// Driving by hand: listens to keys and gamepad, sends the stick, and draws the pad for a finger.
import { effect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { isTakenBy } from '../lib/keys';
import { clamp } from '../lib/math';
import { store } from '../lib/store';
import { asksForWheel, firstGamepad, gamepads, stickOf } from '../state/gamepad';
import { link } from '../state/link';
import { live } from '../state/live';
import { held, holdKey, ramp, releaseAll, stick } from '../state/manual';
import { canSet, set } from '../state/operate';
import { settings } from '../state/settings';
import { everyFrame } from '../state/ticker';

const RATE_HZ = 30; // of the stick; chosen
/** Time after which a still stick is sent again: the program ends driving by hand after a second without a message. */
const REMIND_MS = 250;

/** Whether a person drives. */
export const isManual = (): boolean => settings.value.get('manual.is_on') === true;

/** Takes the wheel, or hands it back. */
export function toggleManual(): void {
  if (!canSet('manual.is_on')) return;
  set('manual.is_on', !isManual());
}

/** Gives control back to the controller. */
export function handBack(): void {
  if (isManual()) set('manual.is_on', false);
}

/** Starts listening to the driving keys, until the page is closed. */
export function listenToDriver(): void {
  const onKey = (event: KeyboardEvent): void => {
    const isDown = event.type === 'keydown';
    if (isDown && (!isManual() || event.ctrlKey || event.metaKey || event.altKey)) return;
    const target = event.target as HTMLElement | null;
    if (isDown && isTakenBy(target, event.key.toLowerCase())) return;
    if (holdKey(event.key, isDown) && isDown) event.preventDefault();
  };
  addEventListener('keydown', onKey);
  addEventListener('keyup', onKey);
  // Releases of keys outside of the page are not reported.
  addEventListener('blur', releaseAll);
  document.addEventListener('visibilitychange', () => document.hidden && releaseAll());

  everyFrame(() => watchGamepad());

  let timer: ReturnType<typeof setInterval> | undefined;
  let [last, said] = [0, 0];
  const turn = (): void => {
    const now = performance.now();
    const pad = firstGamepad(gamepads());
    held.gamepad = pad && stickOf(pad);
    const next = ramp(stick.value, Math.min(0.1, (now - last) / 1000), live.frame?.speed_mps ?? 0);
    last = now;
    const before = stick.value;
    stick.value = next;
    const isReminder = now - said > REMIND_MS;
    if (isReminder) said = now;
    if (isReminder || next.steer !== before.steer) set('manual.steer', next.steer);
    if (isReminder || next.throttle !== before.throttle) set('manual.throttle', next.throttle);
  };
  effect(() => {
    const isOn = isManual() && link.value === 'live';
    if (isOn === (timer !== undefined)) return;
    releaseAll();
    if (isOn) {
      last = performance.now();
      said = 0;
      timer = setInterval(turn, 1000 / RATE_HZ);
    } else {
      clearInterval(timer);
      timer = undefined;
    }
  });
}

/** Whether a gamepad is connected, and its Start button was pressed. */
const gamepad = store.data('page', () => ({ isThere: false, wasStartPressed: false }));

/** Start takes the wheel and hands it back. */
function watchGamepad(): void {
  if (!gamepad.isThere) return;
  const pad = firstGamepad(gamepads());
  const isPressed = pad !== null && asksForWheel(pad);
  if (isPressed && !gamepad.wasStartPressed) toggleManual();
  gamepad.wasStartPressed = isPressed;
}

if (typeof window !== 'undefined') addEventListener('gamepadconnected', () => (gamepad.isThere = true));

/** A pad for finger or mouse: sideways steers, up is throttle, down is brake. */
export function Pad() {
  const element = useRef<HTMLDivElement>(null);
  const { steer, throttle } = stick.value;
  const move = (event: PointerEvent): void => {
    const box = element.current?.getBoundingClientRect();
    if (!box || !element.current?.hasPointerCapture(event.pointerId)) return;
    const share = (at: number, from: number, size: number): number => clamp((2 * (at - from)) / size - 1, -1, 1);
    held.pad = {
      steer: -share(event.clientX, box.left, box.width),
      throttle: -share(event.clientY, box.top, box.height),
    };
  };
  const end = (): void => {
    held.pad = null;
  };
  return (
    <div
      ref={element}
      class="pad"
      role="img"
      aria-label="Pad: sideways steers, up drives, down brakes"
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        move(event);
      }}
      onPointerMove={move}
      onPointerUp={end}
      onPointerCancel={end}
    >
      <span class="pad-stick" style={{ left: `${50 - 50 * steer}%`, top: `${50 - 50 * throttle}%` }} />
    </div>
  );
}
