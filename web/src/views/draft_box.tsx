import { useState } from 'preact/hooks';

/**
 * A box that is typed into while the page is drawn again, many times a second: what is typed stays until the reader
 * leaves the box, and then the value in force is shown.
 */
export function DraftBox(props: {
  readonly class: string;
  readonly label: string;
  readonly value: string;
  readonly disabled?: boolean;
  /** When the text is reported: at each key, or once it is complete. */
  readonly when: 'typed' | 'complete';
  readonly onText: (text: string) => void;
}) {
  const { label, value, disabled, when, onText } = props;
  const [draft, setDraft] = useState<string | null>(null);
  const complete = (): void => {
    if (draft !== null && when === 'complete') onText(draft);
    setDraft(null);
  };
  return (
    <input
      class={props.class}
      type="text"
      inputMode={props.class === 'number-box' ? 'decimal' : 'text'}
      aria-label={label}
      disabled={disabled}
      value={draft ?? value}
      onInput={(event) => {
        setDraft(event.currentTarget.value);
        if (when === 'typed') onText(event.currentTarget.value);
      }}
      onBlur={complete}
      onKeyDown={(event) => {
        if (event.key === 'Enter') complete();
        if (event.key === 'Escape') setDraft(null);
      }}
    />
  );
}
