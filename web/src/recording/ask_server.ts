import { effect } from '@preact/signals';
import { Connection, SUBPROTOCOLS, viewerUrl } from '../protocol/connection';
import { readSchema, type SchemaEntry } from '../protocol/schema';
import type { AskAnswer } from '../protocol/source';
import { askedLog, forgetAnswer, loggedSchema } from '../state/what_if';
import { played, position } from './player';

// Questions to `chicane replay`, which drives another future of a recording.

/** One question on a connection of its own. */
function ask(question: string): Promise<AskAnswer> {
  return new Promise((resolve) => {
    const end = (answer: AskAnswer): void => {
      connection.close();
      resolve(answer);
    };
    const connection: Connection = new Connection(() => new WebSocket(viewerUrl(), SUBPROTOCOLS), {
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

/** Offers questions about the recordings that the program serves, and loads the settings of the one that plays. */
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
