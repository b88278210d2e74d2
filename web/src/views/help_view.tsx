// Modal dialogs, and the one that lists the keys.
import { useLayoutEffect, useRef } from 'preact/hooks';
import { allShortcuts, GROUPS } from '../lib/keys';
import { store } from '../lib/store';
import { Button } from '../parts/controls';

const isHelpOpen = store.signal('page', false);
export const openHelp = (): void => {
  isHelpOpen.value = true;
};

/** Properties of a dialog. */
interface DialogOptions {
  readonly isOpen: boolean;
  readonly title: string;
  readonly onClose: () => void;
  readonly close?: string; // what the button that closes it says
  /** A button that does more than to close it. */
  readonly answer?: { readonly label: string; readonly act: () => unknown; readonly disabled?: boolean };
  readonly children: preact.ComponentChildren;
}

/** A modal dialog, with the browser's handling of focus and Escape. */
export function Dialog({ isOpen, title, onClose, close = 'Close', answer, children }: DialogOptions) {
  const element = useRef<HTMLDialogElement>(null);
  // In the same turn as the page: keys that are pressed before its next picture would still be the dialog's.
  useLayoutEffect(() => {
    const dialog = element.current;
    if (!dialog) return;
    if (isOpen && !dialog.open) dialog.showModal();
    if (!isOpen && dialog.open) dialog.close();
  }, [isOpen]);
  return (
    // biome-ignore lint/a11y/useKeyWithClickEvents: the browser closes a dialog on Escape
    <dialog
      class="sheet"
      ref={element}
      aria-label={title}
      onClose={onClose}
      onClick={(event) => event.target === element.current && onClose()}
    >
      {isOpen && (
        <div class="stack">
          <h2 class="value">{title}</h2>
          {children}
          <div class="row end">
            <Button class={answer ? '' : 'primary'} act={onClose}>
              {close}
            </Button>
            {answer && (
              <Button class="primary" disabled={answer.disabled} act={answer.act}>
                {answer.label}
              </Button>
            )}
          </div>
        </div>
      )}
    </dialog>
  );
}

/** Dialog of all keys, and of how other viewers connect. */
export function HelpView() {
  const close = (): void => {
    isHelpOpen.value = false;
  };
  return (
    <Dialog isOpen={isHelpOpen.value} title="Keys" onClose={close}>
      <div class="columns" style={{ '--least': '250px' }}>
        {GROUPS.map((group) => (
          <section key={group} aria-label={group}>
            <h3>{group}</h3>
            <dl class="rows">
              {allShortcuts()
                .filter((each) => each.group === group)
                .map(({ label, does }) => (
                  <div key={label}>
                    <dt>
                      {label.split(' ').map((key) => (
                        <kbd key={key}>{key}</kbd>
                      ))}
                    </dt>
                    <dd>{does}</dd>
                  </div>
                ))}
            </dl>
          </section>
        ))}
      </div>
      <p class="soft">On plots: drag to zoom, double-click to come back. On the map: the wheel zooms.</p>
      {__PAGE__ ? (
        <p class="soft">This page needs no program and no network: simulator and controller run in a worker of it.</p>
      ) : (
        <p class="soft">
          The data comes over the Foxglove WebSocket protocol. Other viewers connect to <code>{location.host}</code>:
          Foxglove, Lichtblick, your own scripts.
        </p>
      )}
    </Dialog>
  );
}
