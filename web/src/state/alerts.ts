import { hasBit } from '../lib/bits';
import { fixed } from '../lib/format';
import { paintSize } from '../lib/paint_size';
import { rungInWords, type Sentence } from '../lib/words';
import { RUNG } from '../protocol/messages';
import type { Frame } from '../protocol/topics';
import { Column } from './columns';
import { faultInWords } from './event_log';
import { rowsSince } from './explain';
import { secondsLeft } from './faults';
import type { History } from './history';
import { run } from './run';
import { type Circumstances, helpOf } from './sentence';

/** What is near its limit is told at least this long, so that words can be read [s]. */
const HELD_S = 0.7;
const CLOSE_TO_EDGE_M = 0.3; // of a car in full size
/** Nearer to the edge than this is close [m]. */
export const closeToEdge = (): number => CLOSE_TO_EDGE_M * (run.value ? paintSize(run.value) : 1);
/** From farther off the road than this no controller of ours comes back [m]. */
const FAR_OFF_M = 30;

/** An alert for the picture, with a name that stays while its numbers change. */
export interface Alert extends Sentence {
  readonly name: 'stuck' | 'road' | 'edge' | 'grip' | 'driver' | 'fault' | 'person';
}

function extremeOf(history: History, column: number, pick: (a: number, b: number) => number): number {
  const values = history.column(column);
  let extreme = NaN;
  for (let i = rowsSince(history, HELD_S); i < values.length; ++i) {
    const value = values[i] ?? NaN;
    if (Number.isFinite(value)) extreme = Number.isNaN(extreme) ? value : pick(extreme, value);
  }
  return extreme;
}

/** A car that stands this long although it should drive is stuck [s]. */
const STUCK_S = 3;
/** Slower than this a car stands [m/s]. */
const STANDING_MPS = 0.5;

/** Whether the car has stood for the last seconds although the controller wants it to move. */
export function isStuck(frame: Frame, history: History): boolean {
  const from = rowsSince(history, STUCK_S);
  const [times, speeds] = [history.column(Column.time_s), history.column(Column.speed_mps)];
  const shouldMove =
    frame.rung === RUNG.RETURN_TO_ROAD || (frame.rung === RUNG.CONTROLLER && frame.speed_reference_mps > STANDING_MPS);
  if (frame.is_manual || !shouldMove || !(frame.time_s - (times[from] ?? NaN) >= 0.9 * STUCK_S)) return false;
  return speeds.subarray(from).every((speed) => speed < STANDING_MPS);
}

/** What decides, beside the frame itself, which sentence it has. */
export const circumstancesOf = (frame: Frame, history: History, canReset: boolean): Circumstances => ({
  isStuck: isStuck(frame, history),
  canReset,
});

function faultText(name: string, now: number): string {
  const left = secondsLeft(`fault.${name.replace(/^fault\./, '')}`, now);
  const rest = Number.isFinite(left) ? `, ${Math.ceil(left)} s left` : '';
  return `Fault: ${faultInWords(name)}${rest}`;
}

/**
 * What the reader of the picture must know now, the worst first. `history` holds the last frames; `canReset`: the car
 * can be put back to the start.
 */
export function alertsOf(frame: Frame, history: History, faultNames: readonly string[], canReset = false): Alert[] {
  const alerts: Alert[] = [];
  if (isStuck(frame, history)) {
    const help = helpOf(frame, { isStuck: true, canReset });
    alerts.push({ name: 'stuck', severity: 'bad', text: `The car stands and should drive${help && `: ${help}`}` });
  }
  const edge = extremeOf(history, Column.edge_distance_m, Math.min);
  const use = Math.max(
    extremeOf(history, Column.front_tire_use, Math.max) || 0,
    extremeOf(history, Column.rear_tire_use, Math.max) || 0,
  );
  if (frame.is_off_track) {
    const beyond = Math.max(0, -frame.edge_distance_m);
    const help = canReset && beyond > FAR_OFF_M ? ': Reset brings it back' : '';
    alerts.push({ name: 'road', severity: 'bad', text: `Off the road, ${fixed(beyond, 1)} m beyond the edge${help}` });
  }
  // A person's command is sent, whatever the controller's would be.
  if (frame.rung !== 0 && !frame.is_manual)
    alerts.push({ name: 'driver', ...rungInWords(frame.rung, frame.guard_reason) });
  for (let bit = 0; bit < 32; ++bit)
    if (hasBit(frame.active_faults, bit))
      alerts.push({ name: 'fault', severity: 'bad', text: faultText(faultNames[bit] ?? `#${bit + 1}`, frame.time_s) });
  if (!frame.is_off_track && edge < closeToEdge())
    alerts.push({ name: 'edge', severity: 'warning', text: `${fixed(Math.max(0, edge), 2)} m to the edge` });
  if (use > 1)
    alerts.push({ name: 'grip', severity: 'warning', text: `Sliding: ${fixed(use * 100, 0)} % of the grip` });
  if (frame.is_manual) alerts.push({ name: 'person', severity: 'unknown', text: 'A person drives' });
  return alerts;
}
