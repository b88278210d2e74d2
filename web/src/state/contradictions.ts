import type { Sentence } from '../lib/words';
import { RUNG, SPEED_LIMITER } from '../protocol/messages';
import type { Frame } from '../protocol/topics';
import type { Alert } from './alerts';
import {
  aimOf,
  type Circumstances,
  pedalInWords,
  plannedOf,
  type StateSentence,
  solverInWords,
  stateSentence,
} from './sentence';

// What a reader of the page would call a contradiction. For tests: over made-up states, and over the frames of runs.

/** The page as its reader sees it in one state. */
export interface Screen {
  readonly sentence: StateSentence;
  readonly alerts: readonly Alert[];
  readonly solver: Sentence;
  /** Speeds that stand beside the one driven [m/s]; NaN: not shown. */
  readonly aim: number;
  readonly planned: number;
  readonly pedalAsked: string;
}

export function screenOf(
  frame: Frame,
  circumstances: Circumstances,
  alerts: readonly Alert[],
  fullBrake: number,
): Screen {
  return {
    sentence: stateSentence(frame, circumstances),
    alerts,
    solver: solverInWords(frame),
    aim: aimOf(frame, circumstances),
    planned: plannedOf(frame, circumstances),
    pedalAsked: pedalInWords(frame.throttle_sent, fullBrake),
  };
}

const MOST_WORDS = 14;
/** What the sentences of the page are built round; a new sentence with another verb adds it here. */
const VERBS = new Set(
  `are brakes brings can cannot changed contains contradict converged could did do does drives follows found frees give
  gives has have holds is makes may move moves must plans repeat returns should stands stopped stops take takes turn
  turns uses would`.split(/\s+/),
);
/** What may stand before a verb as its subject: no sentence of the page is an order. */
const SUBJECT = /^(a|an|the|it|this|position|measured speed|reset)\b/i;
/** Whether a text has a verb behind a subject. */
export const isSentence = (text: string): boolean => {
  const [, ...rest] = text.toLowerCase().match(/[a-z]+/g) ?? [];
  return SUBJECT.test(text) && rest.some((word) => VERBS.has(word));
};

const wordsIn = (text: string): number => text.split(/\s+/).filter((word) => word !== '').length;
const percentOf = (pedal: string): number => Number(/\d+/.exec(pedal)?.[0] ?? NaN);

/** What contradicts something else on this screen, in words; empty where nothing does. */
export function contradictionsOf(frame: Frame, screen: Screen): string[] {
  const { sentence, alerts, solver, aim, planned, pedalAsked } = screen;
  const has = (name: Alert['name']): boolean => alerts.some((alert) => alert.name === name);
  const isOthers = frame.is_manual || frame.rung !== RUNG.CONTROLLER;
  const found: string[] = [];
  const refuse = (isWrong: boolean, what: string): void => {
    if (isWrong) found.push(`${what}: ${sentence.title}. ${sentence.text} | ${pedalAsked} | ${solver.text}`);
  };
  refuse(sentence.title === '' || sentence.title.includes('undefined'), 'there is no sentence');
  refuse(/\b(unknown|undefined|NaN|null)\b/.test(`${sentence.title} ${sentence.text}`), 'a word of the program');
  // "Who drives: why" are two sentences.
  for (const text of [sentence.title, sentence.text, ...alerts.flatMap((alert) => alert.text.split(': '))])
    refuse(wordsIn(text) > MOST_WORDS, `more than ${MOST_WORDS} words`);
  // The title of a limit is its name; the others are the first half of the sentence.
  for (const text of [sentence.limiter === null ? sentence.title : '', sentence.text, solver.text])
    refuse(text !== '' && !isSentence(text), `no subject or no verb in "${text}"`);
  refuse(Number.isFinite(aim) && isOthers, 'an aim that nobody drives at');
  refuse(Number.isFinite(planned) && isOthers, 'a planned speed that nobody drives at');
  refuse(aim === 0 || planned === 0, 'a speed of 0 is aimed at');
  refuse(has('stuck') && sentence.limiter !== null, 'a car that stands is limited in its speed');
  refuse(has('stuck') && (Number.isFinite(aim) || Number.isFinite(planned)), 'a car that stands has an aim');
  refuse(isOthers && sentence.limiter !== null, 'the plan limits a car that it does not drive');
  refuse(sentence.severity === 'good' && has('driver'), 'all is well beside a driver that is none');
  refuse(has('road') && has('edge'), 'beyond the edge, and inside it');
  refuse(has('road') && /number that is not finite/.test(solver.text), 'off the road is called a wrong number');
  refuse(/brakes? fully/.test(sentence.title) && !/^brake (9\d|100) %$/.test(pedalAsked), 'brakes fully, and does not');
  refuse(/ brakes\b/.test(sentence.title) && pedalAsked.startsWith('drive'), 'brakes, and drives');
  refuse(
    sentence.limiter === SPEED_LIMITER.POWER && !(pedalAsked.startsWith('drive') && percentOf(pedalAsked) >= 99),
    'the drive gives no more, and is not asked to',
  );
  refuse(
    sentence.limiter === SPEED_LIMITER.PART_THROTTLE && pedalAsked === 'drive 100 %',
    'less than full throttle, and full throttle',
  );
  return found;
}
