import { type Fields, fields, list, number, text } from '../lib/json';

/**
 * What the page shows: a live run, or recordings served by `chicane replay`.
 */
export type Mode = { readonly name: 'live' } | ServedLogs;

/** Recordings that the program serves, and the time to begin at [s]. */
export interface ServedLogs {
  readonly name: 'replay';
  readonly logs: readonly { readonly name: string; readonly url: string }[];
  readonly start: number;
}

/** Reads the server's mode.json; anything else means a live run. */
export function modeOf(answer: unknown): Mode {
  const { mode, logs, start_s } = fields(answer);
  if (mode !== 'replay') return { name: 'live' };
  const isListed = ({ name, url }: Fields): boolean => typeof name === 'string' && typeof url === 'string';
  const listed = list(logs).map(fields).filter(isListed);
  return {
    name: 'replay',
    logs: listed.map(({ name, url }) => ({ name: text(name), url: text(url) })),
    start: number(start_s, 0),
  };
}

/** Asks the server what it shows. */
export async function findMode(): Promise<Mode> {
  if (__PAGE__ || location.protocol === 'file:') return { name: 'live' };
  const answer = await fetch('mode.json').catch(() => null);
  return answer?.ok ? modeOf(await answer.json().catch(() => null)) : { name: 'live' };
}
