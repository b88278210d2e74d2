// Pages that the program answers with, beside its messages.
import { store } from '../lib/store';

/** What a program answers to GET of a path such as "schema.json"; null when it has no such page. */
export type GetPage = (path: string) => Promise<string | null>;

/** Asks the server of the page. */
const byHttp: GetPage = async (path) => {
  const answer = await fetch(path, { cache: 'no-store' });
  return answer.ok ? answer.text() : null;
};
const asked = store.data('page', () => ({ answer: byHttp }));

/** Lets `other` answer from now on: the worker of a page that needs no program. */
export function answerBy(other: GetPage): void {
  asked.answer = other;
}

/** Asks the program for a page. */
export const programPage: GetPage = (path) => asked.answer(path);

/** Waits before the program is asked again. */
export const pause = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));
