import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, describe, expect, it } from 'vitest';
import { UNKNOWN_SITUATION } from '../protocol/messages';
import type { Frame, TopicName } from '../protocol/topics';
import { beginSession, receive } from '../state/demultiplexer';
import { events } from '../state/event_log';
import { whyNoLimit } from '../state/limit';
import { live } from '../state/live';
import { run } from '../state/run';
import { pedalInWords } from '../state/sentence';
import { refreshText } from '../state/shown';
import { showSituation, situation } from '../state/situation';
import { McapLog } from './mcap_log';
import { BytesReadable } from './readable';

// Recorded runs of the program, as the page shows each of their frames. CHICANE is the program's path; with
// CHICANE_SLOW_TESTS all presets drive all cars with all faults.

const { CHICANE: program, CHICANE_SLOW_TESTS: isWhole } = process.env;
const folder = mkdtempSync(join(tmpdir(), `chicane-contradictions-${process.pid}-`));
afterAll(() => rmSync(folder, { recursive: true }));

const TOPICS: readonly TopicName[] = [
  '/chicane/run',
  '/chicane/frame',
  '/chicane/situation',
  '/chicane/limit',
  '/chicane/change',
];

/** One of so many frames is looked at: what is shown stays for longer than that. */
const LOOKS_AT = 3;
const LIMIT_S = 21; // a car that a fault stops stands for more than ten seconds

type Words = readonly string[];
const namesOf = (shelf: string): string[] =>
  execFileSync(program ?? '', ['list', shelf], { encoding: 'utf8' })
    .split('\n')
    .flatMap((line) => /^([a-z][\w-]*) {2,}/.exec(line)?.[1] ?? []);

/** Runs that differ in what the page has to say of them. */
function runsOf(): Words[] {
  const some: Words[] = [
    ['--fault', 'dead_controller@6+6'],
    ['--fault', 'steering_stuck@6+8', '--set', 'guard.mode=off'], // off the road
    ['--preset', 'race', '--fault', 'steering_stuck@6+4'],
    ['--car', 'f1tenth', '--fault', 'gps_noise@6*2'],
    ['--manual'],
  ];
  if (!isWhole) return some;
  const [presets, cars, faults] = ['presets', 'cars', 'faults'].map(namesOf) as [string[], string[], string[]];
  const faulty = (preset: string, car: string): Words[] =>
    faults.map((fault) => ['--preset', preset, '--car', car, '--fault', `${fault}@5`]);
  return [...some, ...presets.flatMap((preset) => cars.flatMap((car) => faulty(preset, car)))];
}

const file = join(folder, 'run.mcap');

function drive(words: Words): void {
  rmSync(file, { force: true });
  const all = ['drive', '--fast', '--track', 'oval', '--set', `time_limit_s=${LIMIT_S}`, ...words, '--record', file];
  try {
    execFileSync(program ?? '', all, { stdio: ['ignore', 'ignore', 'pipe'] });
  } catch (error) {
    const { status, stderr } = error as { status: number; stderr: Buffer };
    if (status !== 1) throw new Error(`${all.join(' ')}: ${stderr}`); // 1: the car left the road
  }
}

/** Nobody takes the wheel that a person should have; ended like by Ctrl-C. */
function driveByNobody(): void {
  rmSync(file, { force: true });
  const all = ['drive', '--manual', '--pace', '20', '--port', '0', '--record', file];
  spawnSync(program ?? '', all, { stdio: 'ignore', timeout: 2500, killSignal: 'SIGINT' });
}

/** What a reader would say of the sentence beside the bars; null: nothing. */
function against(sentence: string, pedal: string): string | null {
  if (sentence === '' || /undefined|NaN/.test(sentence)) return 'there is no sentence';
  if (sentence.split(' ').length > 6) return 'more than six words';
  const percent = Number(/\d+/.exec(pedal)?.[0] ?? NaN);
  if (sentence.startsWith('Brakes') && !/give/.test(sentence) && pedal.startsWith('drive')) return 'brakes, and drives';
  if (sentence.startsWith('Full throttle') && !(pedal.startsWith('drive') && percent >= 98)) return 'not full throttle';
  if (sentence.startsWith('Part throttle') && !(pedal.startsWith('drive') && percent < 99)) return 'not part throttle';
  return sentence.startsWith('Rolls') && percent > 5 ? 'does not roll' : null;
}

/** Messages of a recording in the order of time; `look` is called at each frame, when its situation is known. */
async function play(look: (frame: Frame) => void): Promise<void> {
  const log = await McapLog.open(file, new BytesReadable(new Uint8Array(readFileSync(file))));
  beginSession();
  for await (const { topic, time, message } of log.messages(TOPICS, 0, log.duration)) {
    receive(topic, message, 1000 * time);
    if (topic === '/chicane/situation' && live.frame) look(live.frame);
  }
}

describe.skipIf(program === undefined)('recorded runs', () => {
  it('are raised without contradictions', { timeout: 1_800_000 }, async () => {
    const found = new Map<string, string>();
    const states = new Set<string>();
    let [runs, frames, known, onsets] = [0, 0, 0, 0]; // events that a person must know of, and alarms for them
    const refuse = (text: string, words: Words): void => void (found.has(text) || found.set(text, words.join(' ')));
    for (const words of runsOf()) {
      ++runs;
      if (words[0] === '--manual') driveByNobody();
      else drive(words);
      let [since, wasAlarm, mine, raised] = [0, false, 0, 0];
      await play((frame) => {
        ++frames;
        showSituation(frame);
        const now = situation.value ?? UNKNOWN_SITUATION;
        if (now.severity === 'alarm' && !wasAlarm) ++raised;
        wasAlarm = now.severity === 'alarm';
        mine = now.alarms;
        const isLong = frame.time_s - now.stands_since_s > 10 && now.driver !== 'person';
        if (isLong && !now.ends_it.includes('M takes the wheel'))
          refuse(`stands without a key: ${now.sentence}`, words);
        if (++since % LOOKS_AT !== 0) return;
        refreshText(0);
        const { sentence = '', severity = '', ends_it: end = '' } = situation.value ?? {};
        const pedal = pedalInWords(frame.throttle_applied, run.value?.brake_throttle_limit ?? NaN);
        const wrong = against(sentence, pedal);
        if (wrong) refuse(`${wrong}: ${sentence} | ${pedal}`, words);
        if (severity === 'alarm' && !/takes the wheel/.test(end)) refuse(`nothing ends: ${sentence}`, words);
        states.add([words.join(' '), sentence, pedal].join('|'));
      });
      known += mine;
      onsets += raised;
      if (raised > mine) refuse(`${raised} alarms of ${mine} events`, words);
      if (whyNoLimit.value.includes('--')) refuse(`an option is named: ${whyNoLimit.value}`, words);
      for (const { text } of events.value)
        if (/\bgot\b.*\bexpected\b|\bNaN (?!measurement)|undefined/.test(text))
          refuse(`an event is raised raw: ${text}`, words);
    }
    const counted = `${found.size} contradictions; ${onsets} alarms of ${known} events`;
    console.log(`${states.size} states in ${frames} frames of ${runs} runs, ${counted}`);
    expect(Object.fromEntries(found)).toEqual({});
    expect(states.size).toBeGreaterThan(20 * runs);
  });
});
