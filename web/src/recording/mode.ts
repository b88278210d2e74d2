/**
 * What the page shows: a live run, or recordings served by `chicane replay`.
 */
export type Mode =
  | { readonly name: 'live' }
  | { readonly name: 'replay'; readonly logs: readonly ListedLog[]; readonly start: number };

export interface ListedLog {
  readonly name: string;
  readonly url: string;
}

const isRecord = (value: unknown): value is Record<string, unknown> => typeof value === 'object' && value !== null;
const isListed = (value: unknown): value is ListedLog =>
  isRecord(value) && typeof value.name === 'string' && typeof value.url === 'string';

/** Reads the server's mode.json; anything else means a live run. */
export function modeOf(answer: unknown): Mode {
  if (!isRecord(answer) || answer.mode !== 'replay') return { name: 'live' };
  const logs = Array.isArray(answer.logs) ? answer.logs.filter(isListed) : [];
  return { name: 'replay', logs, start: typeof answer.start_s === 'number' ? answer.start_s : 0 };
}

export async function findMode(): Promise<Mode> {
  if (__PAGE__ || location.protocol === 'file:') return { name: 'live' };
  const answer = await fetch('mode.json').catch(() => null);
  return answer?.ok ? modeOf(await answer.json().catch(() => null)) : { name: 'live' };
}
