import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';

const WIDTH_PX = 320; // of the box, as in the style sheet
const ROOM_PX = 180; // below the name: with less the box is above it; chosen

/** Places a box below its name, or above it, inside the window. */
function place(box: HTMLElement, name: Element | null): void {
  const at = name?.getBoundingClientRect();
  if (!at) return;
  const isAbove = innerHeight - at.bottom < ROOM_PX;
  Object.assign(box.style, {
    left: `${Math.max(8, Math.min(at.left, innerWidth - WIDTH_PX - 8))}px`,
    top: isAbove ? 'auto' : `${at.bottom + 4}px`,
    bottom: isAbove ? `${innerHeight - at.top + 4}px` : 'auto',
  });
}

/** A name that says what it means when it is pressed: by mouse, touch and keyboard, and to screen readers. */
export function Meaning({ of, children }: { of: ComponentChildren; children: ComponentChildren }) {
  const id = `meaning-${useId()}`;
  return (
    <>
      <button type="button" class="meaning" data-meaning={id} popovertarget={id}>
        {of}
        <span class="sr-only">: what it means</span>
      </button>
      <span
        id={id}
        class="meaning-box sheet"
        popover="auto"
        role="note"
        onBeforeToggle={(event) => place(event.currentTarget, document.querySelector(`[data-meaning="${id}"]`))}
      >
        {children}
      </span>
    </>
  );
}
