import { effect, type Signal, signal } from '@preact/signals';

/** A signal kept in the browser's local storage; where that is not allowed, it lasts as long as the page. */
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
      // Storage is full or not allowed: the value lasts as long as the page.
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
