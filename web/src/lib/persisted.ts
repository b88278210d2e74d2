import { effect, type Signal, signal } from '@preact/signals';

/** A signal that outlives the page, in the browser's own storage; where that is refused, it just starts anew. */
export function persisted<T extends string | number | boolean>(
  name: string,
  initial: T,
  isValid: (value: unknown) => boolean = (value) => typeof value === typeof initial,
): Signal<T> {
  const state = signal<T>(read(name, initial, isValid));
  effect(() => {
    const { value } = state;
    try {
      localStorage.setItem(`chicane.${name}`, JSON.stringify(value));
    } catch {
      // Storage is full or forbidden: the choice lasts as long as the page.
    }
  });
  return state;
}

function read<T>(name: string, initial: T, isValid: (value: unknown) => boolean): T {
  try {
    const value: unknown = JSON.parse(localStorage.getItem(`chicane.${name}`) ?? 'null');
    return isValid(value) ? (value as T) : initial;
  } catch {
    return initial;
  }
}
