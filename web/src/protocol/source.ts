import type { TopicName, Topics } from './topics';

/** The value of a tunable, in the unit of its key. */
export type Setting = number | boolean | string;

export type ServiceName = '/pause' | '/step' | '/reset';

/** What a server made of a wish: the value in force, and when that is not what was wished for, a sentence. */
export interface SetAnswer {
  readonly value: Setting | null;
  readonly sentence: string | null;
}

/** What a source tells the page. */
export interface SourceEvents {
  /** Messages will come; `session` changes when another run has begun. */
  open(session: string): void;
  /** They have ended; the next attempt, the `attempt`-th in a row, begins in `delay` milliseconds. */
  lost(attempt: number, delay: number): void;
  message<T extends TopicName>(topic: T, message: Topics[T]): void;
  services(names: ReadonlySet<string>): void;
  /** Values of tunables: `isAll` after opening and after refresh(), otherwise those that have changed. */
  settings(values: ReadonlyMap<string, Setting>, isAll: boolean): void;
  /** A sentence for the operator. */
  notice(sentence: string): void;
}

/**
 * Where the page's messages come from: a server (Connection), or a recording. Who can only be watched leaves out what
 * cannot be done.
 */
export interface Source {
  close(): void;
  /** Tries at once instead of waiting for the next attempt. */
  retryNow?(): void;
  /** Resolves to null when done, to a sentence when not. */
  call?(name: ServiceName, data?: boolean): Promise<string | null>;
  set?(name: string, value: Setting): Promise<SetAnswer>;
  /** Asks for the values of all tunables again. */
  refresh?(): void;
}
