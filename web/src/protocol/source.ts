// Interface between the page and the source of its messages: a running program or a recording.
import type { TopicName, Topics } from './topics';

/** The value of a setting, in the unit of its key. */
export type Setting = number | boolean | string;

/** Whether a setting can have the value. */
export const isSetting = (value: unknown): value is Setting => ['number', 'boolean', 'string'].includes(typeof value);

/** Services that this page calls. */
export type ServiceName = '/pause' | '/step' | '/reset' | '/what_if' | '/rival';

/** The server's answer to a question in words. */
export interface AskAnswer {
  readonly isTaken: boolean;
  /** Why it was not taken; of '/what_if' and '/rival' that were taken, the number of the question. */
  readonly message: string;
}

/** The server's answer to a request: the value in force and, if it is not the one requested, the reason. */
export interface SetAnswer {
  readonly value: Setting | null;
  readonly sentence: string | null;
}

/** What a source reports to the page. */
export interface SourceEvents {
  /** Messages follow; `session` changes when another run has begun. */
  open(session: string): void;
  /** The connection is lost; reconnection attempt number `attempt` begins in `delay` milliseconds. */
  lost(attempt: number, delay: number): void;
  message<T extends TopicName>(topic: T, message: Topics[T]): void;
  services(names: ReadonlySet<string>): void;
  /** Values of settings: all of them (`isAll`) after opening and after refresh(), otherwise those that changed. */
  settings(values: ReadonlyMap<string, Setting>, isAll: boolean): void;
  /** A sentence for the operator. */
  notice(sentence: string): void;
}

/**
 * Where the page's messages come from: a server (Connection) or a recording (LogSource). Functions that a source does
 * not support are absent.
 */
export interface Source {
  close(): void;
  /** Reconnects now instead of waiting for the next attempt. */
  retryNow?(): void;
  /** Resolves to null on success, to the reason on failure. */
  call?(name: ServiceName, data?: boolean): Promise<string | null>;
  ask?(name: ServiceName, question: string): Promise<AskAnswer>;
  set?(name: string, value: Setting): Promise<SetAnswer>;
  /** Requests the values of all settings again. */
  refresh?(): void;
}
