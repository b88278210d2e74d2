/** A keyboard shortcut. The help lists all of them, so that every key that works is documented. */
export interface Shortcut {
  /** Values of KeyboardEvent.key, letters in lower case. */
  readonly keys: readonly string[];
  /** The key as the help shows it. */
  readonly label: string;
  readonly does: string;
  readonly group: 'Run' | 'Camera' | 'Panels' | 'Driving by hand';
  action(): void;
}

const shortcuts: Shortcut[] = [];

/** Adds shortcuts; returns a function that removes them. */
export function addShortcuts(...more: readonly Shortcut[]): () => void {
  shortcuts.push(...more);
  return () => {
    for (const each of more) shortcuts.splice(shortcuts.indexOf(each), 1);
  };
}

export const allShortcuts = (): readonly Shortcut[] => shortcuts;

/** The properties of a focused element that decide whether it handles a key. */
export interface KeyTarget {
  readonly tagName?: string;
  readonly type?: string;
  readonly isContentEditable?: boolean;
  getAttribute?(name: string): string | null;
}

const ON_SLIDER = new Set(['arrowleft', 'arrowright', 'arrowup', 'arrowdown', 'home', 'end', 'pageup', 'pagedown']);
const ON_BUTTON = new Set([' ', 'enter']);

/** Whether the focused element handles this key itself, so that no shortcut applies. */
export function isTakenBy(target: KeyTarget | null, key: string): boolean {
  const tag = target?.tagName?.toLowerCase();
  if (key === 'escape' || !tag || !target) return false;
  if (target.isContentEditable || tag === 'textarea' || tag === 'select') return true;
  if (target.getAttribute?.('role') === 'separator' || target.getAttribute?.('role') === 'tab')
    return ON_SLIDER.has(key) || ON_BUTTON.has(key);
  if (tag === 'input') {
    if (target.type === 'range') return ON_SLIDER.has(key);
    if (target.type === 'checkbox' || target.type === 'radio') return ON_BUTTON.has(key) || ON_SLIDER.has(key);
    return true;
  }
  return (tag === 'button' || tag === 'a' || tag === 'summary') && ON_BUTTON.has(key);
}

/** The shortcut of a key press; null when there is none or the focused element handles the key itself. */
export function shortcutFor(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'altKey' | 'repeat'>,
  target: KeyTarget | null,
): Shortcut | null {
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || isTakenBy(target, key)) return null;
  return shortcuts.filter(({ keys }) => keys.includes(key)).at(-1) ?? null;
}
