import { expect, it } from 'vitest';
import { REASON, RUNG, SPEED_LIMITER, STATUS } from '../protocol/messages';
import {
  gateInWords,
  LIMITERS,
  nameInWords,
  reasonInWords,
  roadInWords,
  rungInWords,
  sightInWords,
  statusInWords,
  worstInWords,
} from './words';

it('gets more severe with each rung', () => {
  expect([0, 1, 2, 3].map((rung) => rungInWords(rung).severity)).toEqual(['good', 'warning', 'bad', 'bad']);
  expect(rungInWords(9).text).toContain('9');
});

it('knows every rung, reason and status that is sent', () => {
  for (const rung of Object.values(RUNG)) expect(rungInWords(rung).text).not.toMatch(/unknown/i);
  for (const reason of Object.values(REASON)) expect(reasonInWords(reason)).not.toMatch(/unknown/i);
  for (const status of Object.values(STATUS)) expect(statusInWords(status).text).not.toMatch(/unknown/i);
  expect(statusInWords(2).text).toBe('The solver converged as far as rounding allows');
});

it('gives the reason for a rung that is not the controller, and for a controller that is held back', () => {
  const text = rungInWords(RUNG.GUARD_STOP, REASON.NO_ANSWER).text;
  expect(text).toBe('The guard stops the car on the known road: the controller has no answer');
  expect(rungInWords(RUNG.CONTROLLER, REASON.TOO_FAST_FOR_SILENCE).severity).toBe('warning');
  expect(rungInWords(RUNG.CONTROLLER, REASON.FROZEN).text).toBe('The controller drives');
  expect(rungInWords(RUNG.BRAKE, 99).text).toContain('99');
});

it('calls usable solutions good, and no others', () => {
  const severities = [0, 1, 2, -1, -2, -3, 7].map((status) => statusInWords(status).severity);
  expect(severities.join(' ')).toBe('good good good bad bad bad bad');
});

it('describes the gate', () => {
  expect(gateInWords({ rung: RUNG.CONTROLLER, is_gated: false }).severity).toBe('good');
  const others = [
    { rung: RUNG.CONTROLLER, is_gated: true },
    { rung: RUNG.GUARD_STOP, is_gated: false },
  ] as const;
  expect(others.map((each) => gateInWords(each).text)).toEqual(['Changed the command', 'Sent another command']);
});

it('describes how much road is known', () => {
  const texts = [139.6, NaN].map((ahead) => sightInWords(false, ahead).text);
  expect(texts).toEqual(['Sees 140 m ahead', 'Sees no road ahead']);
  expect(sightInWords(true, 300).text).toBe('Track known, uses 300 m of it');
});

it('describes the place on the road', () => {
  const frame = { is_off_track: false, edge_distance_m: 1, off_track_events: 0 };
  expect(roadInWords({ ...frame, off_track_events: 1 }).text).toContain('once');
  expect(roadInWords({ ...frame, off_track_events: 2 }).text).toContain('2 times');
  const severities = [{}, { is_off_track: true }, { edge_distance_m: NaN }].map(
    (change) => roadInWords({ ...frame, ...change }).severity,
  );
  expect(severities).toEqual(['good', 'bad', 'unknown']);
});

it('has words for whatever limits the speed', () => {
  expect(LIMITERS).toHaveLength(Object.keys(SPEED_LIMITER).length);
  expect(LIMITERS[SPEED_LIMITER.CURVATURE]).toBe('grip');
  expect(LIMITERS[SPEED_LIMITER.POWER]).toBe('power');
});

it('names the worst constraint only when one is violated', () => {
  const frame = { violation: 0.0213, worst_stage: 7, worst_constraint: 1 };
  expect(worstInWords(frame, ['steer_rate', 'left_edge'])).toBe('left edge exceeded by 0.021 at step 7 of the plan');
  for (const change of [{ violation: 0 }, { violation: NaN }, { worst_constraint: -1 }])
    expect(worstInWords({ ...frame, ...change }, [])).toBeNull();
  const names = ['front_slip', 'tracking_mpc', 'nan_measurement'].map(nameInWords);
  expect(names).toEqual(['front slip', 'tracking MPC', 'NaN measurement']);
});
