import { signal as makeSignal, type Signal } from '@preact/signals';

// The store: all state of the page that outlives a view. Each file declares its part here, and for how long it holds;
// one reset() puts back what has ended. layers.test.ts refuses state outside of the store.

/**
 * 'moment': gathered up to this moment of the run; ends when the run begins again, or a recording jumps.
 * 'run': ends when another run, or another recording, is shown.
 * 'page': stays.
 */
export type Lasts = 'moment' | 'run' | 'page';

/** State that was declared, and how it is reset. */
interface Part {
  readonly lasts: Lasts;
  reset(): void;
  peek(): unknown;
}

const parts: Part[] = [];

export const store = {
  /** A signal with its initial value. */
  signal<T>(lasts: Lasts, first: T): Signal<T> {
    const made = makeSignal<T>(first);
    const reset = (): void => {
      made.value = first;
    };
    parts.push({ lasts, reset, peek: () => made.peek() });
    return made;
  },

  /** An object of plain fields with their initial values; `first` is called at each reset. */
  data<T extends object>(lasts: Lasts, first: () => T): T {
    const made = first();
    parts.push({ lasts, reset: () => void Object.assign(made, first()), peek: () => ({ ...made }) });
    return made;
  },

  /** Calls `reset` when state that lasts so long ends; for memory that is used again. */
  onReset(lasts: Lasts, reset: () => void): void {
    parts.push({ lasts, reset, peek: () => null });
  },

  /** Resets all state that ends with this moment, or with this run. */
  reset(what: 'moment' | 'run'): void {
    for (const part of parts) if (part.lasts === 'moment' || part.lasts === what) part.reset();
  },

  /** Values of all state that ends with a run; for tests. */
  peek: (): unknown[] => parts.filter(({ lasts }) => lasts !== 'page').map((part) => part.peek()),
};
