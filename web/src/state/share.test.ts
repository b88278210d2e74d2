import { beforeEach, describe, expect, it } from 'vitest';
import { readSchema } from '../protocol/schema';
import type { SetAnswer, Setting, Source } from '../protocol/source';
import { link, services } from './link';
import { attach, requests } from './operate';
import { refusals, schema, settings } from './settings';
import {
  commandAgain,
  commandOf,
  driveShared,
  filesChosen,
  fixedChanges,
  linkTo,
  programName,
  sharedNow,
  textsIn,
  wanted,
  wantedTexts,
} from './share';

const CHOSEN = { track: 'oval', car: 'udacity', preset: 'default', controller: 'tracking-mpc', seed: 1 };
const OTHERS = { latency_ms: 100, control_period_ms: 40, 'tracking_mpc.racing_line': false, 'run.pace': 1, laps: 5 };
const GIVEN: Record<string, Setting> = { ...CHOSEN, ...OTHERS, 'guard.mode': 'on', 'vehicle.friction': 1 };
const NAMES = { track: ['oval', 'lakeside'], car: ['udacity'], preset: ['default'] } as Record<string, string[]>;
const FIXED = { 'guard.mode': 'on', 'vehicle.friction': 1 };
const NOT_LIVE = [...Object.keys(CHOSEN), 'control_period_ms'];

const kindOf = (key: string, value: Setting): string =>
  key in NAMES ? 'text' : typeof value === 'boolean' ? 'bool' : typeof value === 'number' ? 'number' : 'choice';

/** A schema in which the run was started with `start`, and nothing differs from what the preset gives. */
function describeRun(start: Record<string, Setting>): void {
  schema.value = readSchema(
    Object.entries(start).map(([key, value]) => ({
      key,
      kind: kindOf(key, value),
      choices: NAMES[key] ?? [],
      default: key === 'laps' ? 3 : GIVEN[key],
      start: value,
      is_live: !NOT_LIVE.includes(key),
      is_fixed: key in FIXED,
    })),
  );
}

/** Drives the run that the link holds. */
const drive = (): Promise<string[]> => driveShared(wanted.value?.run ?? { choices: new Map(), changes: new Map() });

let asked: string[] = [];
/** A program that takes everything but `refused`, and begins a chosen run at once. */
function program(refused: readonly string[] = []): Source {
  return {
    close: () => undefined,
    set(key, value): Promise<SetAnswer> {
      asked.push(`${key} ${value}`);
      if (refused.includes(key))
        return Promise.resolve({ value: settings.value.get(key) ?? null, sentence: `${key}: refused` });
      if (NOT_LIVE.includes(key)) describeRun({ ...CHOSEN, ...OTHERS, ...Object.fromEntries(settings.value) });
      return Promise.resolve({ value, sentence: null });
    },
    call(name) {
      asked.push(name);
      return Promise.resolve(null);
    },
    refresh: () => undefined,
  };
}

beforeEach(() => {
  asked = [];
  describeRun({ ...CHOSEN, ...OTHERS });
  settings.value = new Map(Object.entries({ ...CHOSEN, ...OTHERS }));
  refusals.value = new Map();
  wantedTexts.value = null;
  link.value = 'live';
  services.value = new Set(['/reset']);
  attach(program());
});

describe('a link to a run', () => {
  it('holds the choices and what differs from what they give, and neither pace nor laps', async () => {
    await requests.set('latency_ms', 60);
    await requests.set('run.pace', 4);
    const text = linkTo(sharedNow.value, 'http://localhost:4567/');
    expect(text).toBe(
      'http://localhost:4567/#run?track=oval&car=udacity&preset=default&controller=tracking-mpc&seed=1&latency_ms=60',
    );
    expect(textsIn(new URL(text).hash)?.get('latency_ms')).toBe('60');
  });

  it('is also a command', async () => {
    await requests.set('latency_ms', 60);
    expect(commandOf(sharedNow.value)).toBe(
      'chicane drive --preset default --track oval --car udacity --set latency_ms=60',
    );
  });

  it('is driven again with as many laps, as fast, and on the same port', async () => {
    await requests.set('latency_ms', 60);
    const again = (laps: number, pace: number, port: number): string =>
      commandAgain(sharedNow.value, { laps, pace, port }).replace(/^.*latency_ms=60/, '');
    expect(again(2, 15, 4777)).toBe(' --laps 2 --pace 15 --port 4777');
    expect(again(0, 1, 4567)).toBe('');
    expect(again(0, NaN, 0)).toBe('');
    programName.value = './run.sh';
    expect(commandAgain(sharedNow.value, { laps: 2, pace: 1, port: 0 })).toMatch(/^\.\/run\.sh drive --.* --laps 2$/);
    programName.value = 'chicane';
  });

  it('cannot name a file', () => {
    settings.value = new Map([...settings.value, ['track', '/home/me/mine.csv']]);
    expect(filesChosen.value).toEqual(['track']);
  });

  it('tells what would be another than now, and leaves out what a link may not set', () => {
    wantedTexts.value = textsIn('#run?track=lakeside&latency_ms=60&run.pace=20&laps=1&nonsense=3');
    expect(wanted.value?.differences.map(({ key, from, to }) => `${key} ${from} ${to}`)).toEqual([
      'track oval lakeside',
      'latency_ms 100 60',
    ]);
    expect(wanted.value?.unknown).toEqual(['run.pace', 'laps', 'nonsense']);
  });

  it('sets back what it does not mention', async () => {
    await requests.set('latency_ms', 60);
    wantedTexts.value = textsIn('#run?track=oval');
    expect(wanted.value?.differences).toEqual([{ key: 'latency_ms', from: 60, to: 100 }]);
  });

  it('neither holds nor sets what is fixed when a run starts; the command holds it', async () => {
    describeRun({ ...CHOSEN, ...OTHERS, ...FIXED });
    settings.value = new Map(Object.entries({ ...CHOSEN, ...OTHERS, ...FIXED, 'guard.mode': 'off' }));
    expect(linkTo(sharedNow.value, '/')).not.toContain('guard');
    expect(fixedChanges.value).toEqual(['guard.mode']);
    expect(commandOf(sharedNow.value)).toContain('--set guard.mode=off');
    wantedTexts.value = textsIn('#run?track=oval&guard.mode=observe&vehicle.friction=2.5');
    expect(wanted.value?.unknown).toEqual(['guard.mode', 'vehicle.friction']);
    expect(await drive()).toEqual([]);
    expect(asked).toEqual(['/reset']);
  });

  it('is nothing else that an address can end with', () => {
    expect(textsIn('#laps')).toBeNull();
    expect(textsIn('')).toBeNull();
  });
});

describe('driving the run of a link', () => {
  it('chooses first, then sets what restarts, then the rest, and begins from the start', async () => {
    await requests.set('tracking_mpc.racing_line', true);
    asked = [];
    wantedTexts.value = textsIn('#run?latency_ms=60&control_period_ms=20&track=lakeside&car=udacity');
    expect(await drive()).toEqual([]);
    expect(asked).toEqual([
      'track lakeside',
      'control_period_ms 20',
      'latency_ms 60',
      'tracking_mpc.racing_line false',
      '/reset',
    ]);
  });

  it('stops at a choice that is refused, with the sentence', async () => {
    attach(program(['track']));
    wantedTexts.value = textsIn('#run?track=%2Fetc%2Fpasswd&latency_ms=60');
    expect(await drive()).toEqual(['track: refused']);
    expect(asked).toEqual(['track /etc/passwd']);
  });
});
