import { signal as makeSignal, type Signal } from '@preact/signals';

// All state of the page that outlives a view. Each file declares its part here, and says for how long it holds; one
// reset() puts back what has ended. layers.test.ts refuses state beside it.

/**
 * 'moment': gathered up to this moment of the run; ends when the run begins again, or a recording jumps.
 * 'run': ends when another run, or another recording, is shown.
 * 'page': stays.
 */
export type Lasts = 'moment' | 'run' | 'page';

interface Part {
  readonly lasts: Lasts;
  reset(): void;
  peek(): unknown;
}

const parts: Part[] = [];

export const store = {
  /** A signal, and what it is at first. */
  signal<T>(lasts: Lasts, first: T): Signal<T> {
    const made = makeSignal<T>(first);
    const reset = (): void => {
      made.value = first;
    };
    parts.push({ lasts, reset, peek: () => made.peek() });
    return made;
  },

  /** Plain fields, and what they are at first. */
  data<T extends object>(lasts: Lasts, first: () => T): T {
    const made = first();
    parts.push({ lasts, reset: () => void Object.assign(made, first()), peek: () => ({ ...made }) });
    return made;
  },

  /** Further work at that moment, in memory that is kept. */
  onReset(lasts: Lasts, reset: () => void): void {
    parts.push({ lasts, reset, peek: () => null });
  },

  /** Another moment of the run follows, or another run. */
  reset(what: 'moment' | 'run'): void {
    for (const part of parts) if (part.lasts === 'moment' || part.lasts === what) part.reset();
  },

  /** What the parts hold that end with a run. For tests. */
  peek: (): unknown[] => parts.filter(({ lasts }) => lasts !== 'page').map((part) => part.peek()),
};
