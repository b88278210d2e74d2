import { hasBit } from '../lib/bits';
import { fixed } from '../lib/format';
import { rungInWords, type Sentence } from '../lib/words';
import type { Frame } from '../protocol/topics';
import { Column } from './columns';
import { faultInWords } from './event_log';
import { rowsSince } from './explain';
import { secondsLeft } from './faults';
import type { History } from './history';

/** What is near its limit is told at least this long, so that words can be read [s]. */
const HELD_S = 0.7;
/** Nearer to the edge than this is close [m]. */
export const CLOSE_TO_EDGE_M = 0.3;
/** From farther off the road than this no controller of ours comes back [m]. */
const FAR_OFF_M = 30;

/** An alert for the picture, with a name that stays while its numbers change. */
export interface Alert extends Sentence {
  readonly name: 'road' | 'edge' | 'grip' | 'driver' | 'fault' | 'person';
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
  if (!frame.is_off_track && edge < CLOSE_TO_EDGE_M)
    alerts.push({ name: 'edge', severity: 'warning', text: `${fixed(Math.max(0, edge), 2)} m to the edge` });
  if (use > 1)
    alerts.push({ name: 'grip', severity: 'warning', text: `Sliding: ${fixed(use * 100, 0)} % of the grip` });
  if (frame.is_manual) alerts.push({ name: 'person', severity: 'unknown', text: 'A person drives' });
  return alerts;
}
