import { store } from '../lib/store';

/** What a program answers to GET of a path such as "schema.json"; null when it has no such page. */
export type GetPage = (path: string) => Promise<string | null>;

const byHttp: GetPage = async (path) => {
  const answer = await fetch(path, { cache: 'no-store' });
  return answer.ok ? answer.text() : null;
};
const asked = store.data('page', () => ({ answer: byHttp }));

/** From now on another one answers: the worker of a page that needs no program. */
export function answerBy(other: GetPage): void {
  asked.answer = other;
}

export const programPage: GetPage = (path) => asked.answer(path);
