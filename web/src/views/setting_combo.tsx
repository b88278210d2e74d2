import { useRef, useState } from 'preact/hooks';
import type { SchemaEntry } from '../protocol/schema';
import { labelOf, settingMeant, settingsFound } from '../state/setting_search';

const MOST_SHOWN = 40;

/**
 * A search that chooses one of these settings: a combobox with a list. Enter chooses what is marked, or what the words
 * mean; where they mean several, it leads into the list. `onChosen` says why a choice is not taken, '' where it is.
 */
export function SettingCombo(props: {
  readonly label: string;
  readonly placeholder: string;
  readonly entries: readonly SchemaEntry[];
  readonly onChosen: (key: string) => string;
}) {
  const { label, placeholder, entries, onChosen } = props;
  const [words, setWords] = useState('');
  const [isOpen, setOpen] = useState(false);
  const [marked, setMarked] = useState(-1);
  const [said, say] = useState('');
  const list = useRef<HTMLDivElement>(null);
  const found = settingsFound(entries, words);
  const offered = found.slice(0, MOST_SHOWN);

  const choose = (key: string): void => {
    const refusal = onChosen(key);
    say(refusal);
    if (refusal !== '') return;
    setWords('');
    setOpen(false);
    setMarked(-1);
  };
  const mark = (to: number): void => {
    const next = offered.length === 0 ? -1 : (to + offered.length) % offered.length;
    setOpen(true);
    setMarked(next);
    list.current?.children[next]?.scrollIntoView({ block: 'nearest' });
  };
  const enter = (): void => {
    const meant = (marked >= 0 ? offered[marked] : null) ?? settingMeant(found, words);
    if (meant) choose(meant.key);
    else if (found.length > 0) mark(0);
    else say('No setting that a run can change is called so.');
  };
  const onKeyDown = (event: KeyboardEvent): void => {
    const act = {
      ArrowDown: () => mark(marked + 1),
      ArrowUp: () => mark(marked < 0 ? -1 : marked - 1),
      Enter: enter,
      Escape: () => setOpen(false),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  };
  return (
    <div class="combo">
      <input
        type="text"
        role="combobox"
        class="what-if-search"
        placeholder={placeholder}
        aria-label={label}
        aria-autocomplete="list"
        aria-expanded={isOpen}
        aria-controls="setting-choices"
        aria-activedescendant={isOpen && marked >= 0 ? `setting-choice-${marked}` : undefined}
        autocomplete="off"
        value={words}
        onInput={(event) => {
          const text = event.currentTarget.value;
          const named = entries.find(({ key }) => key === text);
          setWords(text);
          setOpen(text !== '');
          setMarked(-1);
          say('');
          if (named) choose(named.key);
        }}
        onClick={() => setOpen(true)}
        onBlur={() => setOpen(false)}
        onKeyDown={onKeyDown}
      />
      <div
        id="setting-choices"
        ref={list}
        role="listbox"
        aria-label="Settings that fit"
        hidden={!isOpen || found.length === 0}
      >
        {isOpen &&
          offered.map((entry, i) => (
            // biome-ignore lint/a11y/useKeyWithClickEvents: the keys are those of the combobox
            <div
              key={entry.key}
              id={`setting-choice-${i}`}
              role="option"
              tabIndex={-1}
              aria-selected={i === marked}
              // The search keeps the focus.
              onMouseDown={(event) => event.preventDefault()}
              onClick={() => choose(entry.key)}
            >
              <b>{labelOf(entry)}</b> <code>{entry.key}</code>
              <span class="soft">{entry.meaning}</span>
            </div>
          ))}
      </div>
      <p class="soft" role="status">
        {said !== ''
          ? said
          : isOpen && words !== ''
            ? `${found.length} ${found.length === 1 ? 'setting fits' : 'settings fit'}.`
            : ''}
      </p>
    </div>
  );
}
