import { effect } from '@preact/signals';
import { Connection, SUBPROTOCOLS } from '../protocol/connection';
import { readSchema, type SchemaEntry } from '../protocol/schema';
import type { AskAnswer } from '../protocol/source';
import { askedLog, forgetAnswer, loggedSchema } from '../state/what_if';
import { played, position } from './player';

// Questions to `chicane replay`, which drives another future of a recording.

/** One question on a connection of its own. */
function ask(question: string): Promise<AskAnswer> {
  return new Promise((resolve) => {
    const url = new URL('viewer', location.href);
    url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const end = (answer: AskAnswer): void => {
      connection.close();
      resolve(answer);
    };
    const connection: Connection = new Connection(() => new WebSocket(url, SUBPROTOCOLS), {
      open: () => undefined,
      lost: () => end({ isTaken: false, message: 'the program does not answer' }),
      message: () => undefined,
      services: (names) => {
        if (names.has('/what_if')) void connection.ask('/what_if', question).then(end);
      },
      settings: () => undefined,
      notice: () => undefined,
    });
  });
}

/** The settings of a recording; null where no other future of it can be driven. */
async function settingsOf(log: number): Promise<SchemaEntry[] | null> {
  const answer = await fetch(`log/${log}.settings.json`).catch(() => null);
  return answer?.ok ? readSchema(await answer.json().catch(() => null)) : null;
}

/** The page shows recordings of a program that answers questions about them. */
export function offerWhatIf(): void {
  effect(() => {
    const log = played.value;
    void settingsOf(log).then((found) => {
      if (log !== played.value) return;
      forgetAnswer();
      loggedSchema.value = found ?? [];
      askedLog.value = found && { which: () => log, position: () => position.value, ask };
    });
  });
}
