import type { ComponentProps } from 'preact';
import type { Severity } from '../lib/words';

// Controls that are alike everywhere on the page.

/** A button. */
export function Button({ act, ...more }: { act: () => unknown } & Omit<ComponentProps<'button'>, 'type' | 'onClick'>) {
  return <button type="button" onClick={() => void act()} {...more} />;
}

/** An entry of a list. */
interface Choice<T> {
  readonly value: T;
  readonly label: string;
  readonly title?: string;
  readonly disabled?: boolean;
}

/** Properties of a list. */
interface SelectOptions<T> {
  readonly label: string; // for screen readers
  readonly value: T;
  readonly choices: readonly Choice<T>[];
  readonly choose: (value: T) => void;
  readonly class?: string;
  readonly title?: string;
  readonly keys?: string;
  readonly disabled?: boolean;
}

/** Choice of one of several, in the browser's own list. */
export function Select<T extends string | number>({ label, value, choices, choose, keys, ...more }: SelectOptions<T>) {
  const take = (index: number): void => {
    const chosen = choices[index];
    if (chosen) choose(chosen.value);
  };
  return (
    <select
      aria-label={label}
      aria-keyshortcuts={keys}
      value={value}
      onChange={({ currentTarget }) => take(currentTarget.selectedIndex)}
      {...more}
    >
      {choices.map(({ label: name, ...choice }) => (
        <option key={choice.value} selected={choice.value === value} {...choice}>
          {name}
        </option>
      ))}
    </select>
  );
}

/** Why something could not be done; nothing without a reason. */
export const Refusal = ({ text = '' }: { text?: string | undefined }) =>
  text === '' ? null : (
    <p class="wide lost" role="alert">
      {text}
    </p>
  );

/** The head of a table; `quiet`: for screen readers alone. */
export const Heads = ({ of, quiet = false }: { of: readonly string[]; quiet?: boolean }) => (
  <thead class={quiet ? 'sr-only' : ''}>
    <tr>
      {of.map((name) => (
        <th key={name} scope="col">
          {name}
        </th>
      ))}
    </tr>
  </thead>
);

const SIGNS = { good: ['won', '●'], warning: ['lost', '■'], bad: ['lost', '▲'], unknown: ['soft', '●'] } as const;

/** Sign of a severity, which stands before its words. */
export const Sign = ({ of }: { of: Severity }) => (
  <span class={`sign ${SIGNS[of][0]}`} data-sign={SIGNS[of][1]} aria-hidden="true" />
);
