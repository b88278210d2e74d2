import { describe, expect, it } from 'vitest';
import {
  REASON,
  REASON_WORDS,
  RUNG,
  RUNG_WORDS,
  SPEED_LIMITER,
  SPEED_LIMITER_WORDS,
  STATUS,
  STATUS_WORDS,
} from '../protocol/messages';
import type { Frame } from '../protocol/topics';
import { alertsOf } from './alerts';
import { COLUMN_COUNT, plotRow } from './columns';
import { contradictionsOf, isSentence, screenOf } from './contradictions';
import { History } from './history';
import { pedalInWords, solverInWords, stateSentence } from './sentence';
import { frameWith } from './test_messages';

const FULL_BRAKE = 0.04; // of the original simulator's car

const histories = new Map<string, History>();

/** Four seconds of the same motion at the same place. */
function historyOf(frame: Frame): History {
  const key = `${frame.speed_mps} ${frame.edge_distance_m}`;
  const known = histories.get(key);
  if (known) return known;
  const history = new History(COLUMN_COUNT, 200);
  for (let i = 0; i <= 100; ++i)
    history.push(plotRow({ ...frame, time_s: frame.time_s - 4 + 0.04 * i }, new Array<number>(COLUMN_COUNT)));
  histories.set(key, history);
  return history;
}

/** The pedal that a state has by its meaning. */
function throttleOf(rung: number, limiter: number): number {
  if (rung === RUNG.BRAKE) return -FULL_BRAKE;
  if (rung !== RUNG.CONTROLLER) return -0.3 * FULL_BRAKE;
  if (limiter === SPEED_LIMITER.POWER) return 1;
  return limiter === SPEED_LIMITER.BRAKING ? -0.8 * FULL_BRAKE : 0.4;
}

/** Every source of the command × reason × limit of the speed × person × road × motion × solver × fault. */
function* states(): Generator<Frame> {
  for (const rung of Object.values(RUNG))
    for (const guard_reason of Object.values(REASON))
      for (const speed_limiter of Object.values(SPEED_LIMITER))
        for (let bits = 0; bits < 16; ++bits) {
          const [isManual, isOff] = [(bits & 1) > 0, (bits & 2) > 0];
          const [stands, hasFault] = [(bits & 4) > 0, (bits & 8) > 0];
          // A command that is sent is one of the controller only where the solver gave one.
          const solve_status = rung === RUNG.CONTROLLER ? STATUS.OPTIMAL : isOff ? STATUS.NOT_FINITE : STATUS.STALLED;
          yield frameWith({
            time_s: 100,
            rung,
            guard_reason,
            speed_limiter,
            solve_status,
            is_manual: isManual,
            is_off_track: isOff,
            edge_distance_m: isOff ? -1.5 : 0.2,
            speed_mps: stands ? 0 : 46,
            speed_limit_mps: rung === RUNG.CONTROLLER ? 44 : 0,
            speed_reference_mps: rung === RUNG.CONTROLLER ? 44 : 0,
            throttle_sent: throttleOf(rung, speed_limiter),
            active_faults: hasFault ? 1 : 0,
          });
        }
}

describe('the page', () => {
  it('contradicts itself in no state', () => {
    let count = 0;
    const found = new Set<string>();
    for (const frame of states())
      for (const canReset of [true, false]) {
        const history = historyOf(frame);
        const alerts = alertsOf(frame, history, ['dead_controller'], canReset);
        const isStuck = alerts.some(({ name }) => name === 'stuck');
        const screen = screenOf(frame, { isStuck, canReset }, alerts, FULL_BRAKE);
        for (const each of contradictionsOf(frame, screen)) found.add(each);
        ++count;
      }
    expect(count).toBeGreaterThan(20_000);
    expect([...found]).toEqual([]);
  });

  it('has a subject and a verb in every sentence of the tables', () => {
    const tables = [RUNG_WORDS, REASON_WORDS, STATUS_WORDS, SPEED_LIMITER_WORDS];
    const all = tables.flatMap((table) => Object.values(table).map((row) => row?.text ?? ''));
    expect(all.length).toBeGreaterThan(35);
    expect(all.filter((text) => !isSentence(text))).toEqual([]);
  });

  it('takes no heap of words for a sentence', () => {
    expect(
      ['The drive gives no more.', 'Position, yaw or speed has not been measured.'].filter(isSentence).length,
    ).toBe(2);
    expect(['Not known', 'Off the road', 'The last lap', 'Changed the command', ''].filter(isSentence)).toEqual([]);
  });

  it('would find what it looks for', () => {
    const circumstances = { isStuck: false, canReset: true };
    const frame = frameWith({ rung: RUNG.BRAKE, throttle_sent: 0.3 });
    const screen = screenOf(frame, circumstances, [], FULL_BRAKE);
    expect(contradictionsOf(frame, screen)[0]).toContain('brakes, and drives');
    expect(contradictionsOf(frame, { ...screen, aim: 12 }).join()).toContain('an aim that nobody drives at');
    const stuck = [{ name: 'stuck', severity: 'bad', text: 'The car stands' }] as const;
    const driving = frameWith({ throttle_sent: 1, speed_limiter: SPEED_LIMITER.POWER });
    expect(contradictionsOf(driving, screenOf(driving, circumstances, stuck, 1)).join()).toContain('a car that stands');
  });

  it('says what the guard does while the controller drives', () => {
    const titles = {
      [REASON.WEAK_BRAKES]: ['The guard makes up for what it found', 'The brakes give less than they are asked for.'],
      [REASON.TOO_FAST_FOR_SILENCE]: [
        'The guard holds the car back',
        'A receiver left alone could not stop the car on the road.',
      ],
      [REASON.STUCK]: ['The car stands and should drive', 'The car stands although its road goes on.'],
    };
    for (const [reason, [title, text]] of Object.entries(titles)) {
      const frame = frameWith({ guard_reason: Number(reason) });
      expect(stateSentence(frame, { isStuck: false, canReset: true })).toEqual({
        severity: 'warning',
        title,
        text,
        limiter: null,
      });
    }
  });

  it('tells the brake as a share of full braking', () => {
    expect(pedalInWords(-0.02, 0.04)).toBe('brake 50 %');
    expect(pedalInWords(-1, 0.04)).toBe('brake 100 %');
    expect(pedalInWords(-0.3, 1)).toBe('brake 30 %');
    expect(pedalInWords(-0.3, NaN), 'of an older program').toBe('brake 30 %');
    expect(pedalInWords(0.4, 0.04)).toBe('drive 40 %');
    expect(pedalInWords(NaN, 0.04)).toBe('–');
  });

  it('calls being off the road no wrong number', () => {
    const off = frameWith({ is_off_track: true, rung: RUNG.RETURN_TO_ROAD, solve_status: STATUS.NOT_FINITE });
    expect(solverInWords(off).text).toBe('The controller has no plan off the road');
    expect(solverInWords({ ...off, is_off_track: false, rung: RUNG.BRAKE }).severity).toBe('bad');
  });
});
