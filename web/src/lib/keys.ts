// Keyboard shortcuts: their registration, and which of them a key press belongs to.

/** The groups of the help, in their order. */
export const GROUPS = ['Run', 'Camera', 'Page', 'Driving by hand'] as const;
type Group = (typeof GROUPS)[number];

/** A keyboard shortcut. The help lists all of them, so that every key that works is documented. */
export interface Shortcut {
  /** Values of KeyboardEvent.key, letters in lower case. */
  readonly keys: readonly string[];
  /** The key as the help shows it. */
  readonly label: string;
  /** Its effect, as the help shows it. */
  readonly does: string;
  readonly group: Group;
  action(): void;
  /** False: the key is left to the element that has the focus. */
  isPossible?(): boolean;
}

const shortcuts: Shortcut[] = [];

/** Adds shortcuts; returns a function that removes them. */
export function addShortcuts(group: Group, ...more: readonly Omit<Shortcut, 'group'>[]): () => void {
  const added = more.map((each) => ({ ...each, group }));
  shortcuts.push(...added);
  return () => {
    for (const each of added) shortcuts.splice(shortcuts.indexOf(each), 1);
  };
}

/** All shortcuts that are registered. */
export const allShortcuts = (): readonly Shortcut[] => shortcuts;

/** The properties of a focused element that decide whether it handles a key. */
export interface KeyTarget {
  readonly tagName?: string;
  readonly type?: string;
  readonly isContentEditable?: boolean;
}

/** Keys that move a focused slider. */
const ON_SLIDER = new Set(['arrowleft', 'arrowright', 'arrowup', 'arrowdown', 'home', 'end', 'pageup', 'pagedown']);

/** Types of inputs that are ticked. */
const TICKED = new Set(['checkbox', 'radio']);

/**
 * Whether the focused element handles this key itself, so that no shortcut applies. Space pauses wherever nothing is
 * typed, whatever was clicked last: buttons answer to Enter.
 */
export function isTakenBy(target: KeyTarget | null, key: string): boolean {
  const tag = target?.tagName?.toLowerCase();
  if (key === 'escape' || !tag || !target) return false;
  if (target.isContentEditable || tag === 'textarea' || tag === 'select') return true;
  if (tag === 'input') {
    return target.type === 'range' || TICKED.has(target.type ?? '') ? ON_SLIDER.has(key) : true;
  }
  return (tag === 'button' || tag === 'a' || tag === 'summary') && key === 'enter';
}

/** Whether a key press ticks the focused box: Enter does, because Space pauses the run. */
export const ticks = (target: KeyTarget | null, key: string): boolean =>
  key.toLowerCase() === 'enter' && target?.tagName?.toLowerCase() === 'input' && TICKED.has(target.type ?? '');

/** The shortcut of a key press; null when there is none or the focused element handles the key itself. */
export function shortcutFor(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'altKey' | 'repeat'>,
  target: KeyTarget | null,
): Shortcut | null {
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || isTakenBy(target, key)) return null;
  const found = shortcuts.filter(({ keys }) => keys.includes(key)).at(-1);
  return found && (found.isPossible?.() ?? true) ? found : null;
}
