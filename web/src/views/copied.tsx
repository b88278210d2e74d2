// A text with a button that copies it.
import { store } from '../lib/store';
import { Button } from '../parts/controls';

/** Copies a text; where browsers allow no clipboard (other machines without TLS), the text is selected. */
function copy(field: HTMLInputElement | null, said: (text: string) => void): void {
  if (!field) return;
  field.select();
  const done = navigator.clipboard?.writeText(field.value) ?? Promise.reject(new Error('no clipboard'));
  done.then(
    () => said('Copied'),
    () => said('Selected: Ctrl+C copies it'),
  );
}

/** Result of the last copy, and which field it is about. */
const said = store.signal<{ readonly id: string; readonly text: string } | null>('page', null);

/** A text in a field, with a button that copies it. */
export function Copied({ id, label, text }: { id: string; label: string; text: string }) {
  return (
    <div class="stack">
      <label for={id}>{label}</label>
      <div class="row apart">
        <input id={id} type="text" readOnly value={text} onFocus={(event) => event.currentTarget.select()} />
        <Button
          aria-label={`Copy the ${label.toLowerCase()}`}
          act={() =>
            copy(document.getElementById(id) as HTMLInputElement | null, (words) => (said.value = { id, text: words }))
          }
        >
          Copy
        </Button>
      </div>
      <p class="soft" role="status">
        {said.value?.id === id ? said.value.text : '\u00a0'}
      </p>
    </div>
  );
}

/** Clears the result of the last copy. */
export const forgetCopied = (): void => {
  said.value = null;
};
