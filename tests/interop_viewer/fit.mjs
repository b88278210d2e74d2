// SPDX-License-Identifier: MIT
// What does not fit on a page as it is shown now, in words: cut off, covered, or printed over one another.

/**
 * Runs in the page: [what is wrong]. Controls must lie in the window, unless they are in a part that scrolls, and must
 * be what a click on their middle reaches; no two texts may share a place; no text may be cut without an ellipsis.
 */
export function misfits() {
  const found = [];
  const named = (element) => {
    const text = (element.ariaLabel ?? element.textContent).trim().slice(0, 40);
    return `${element.tagName.toLowerCase()}.${element.className?.baseVal ?? element.className} "${text}"`;
  };
  const isShown = (element) => element.checkVisibility({ checkVisibilityCSS: true, checkOpacity: true });
  const dialog = document.querySelector('dialog[open]');
  const isInPlay = (element) =>
    isShown(element) && !element.closest('.sr-only') && (!dialog || dialog.contains(element));

  /** The part of a box that is not cut by what scrolls or hides it; null: none. */
  function uncut(element, box) {
    let { left, top, right, bottom } = box;
    for (let each = element; each && each !== document.body; each = each.parentElement) {
      const style = getComputedStyle(each);
      if (style.overflow !== 'visible') {
        const frame = each.getBoundingClientRect();
        left = Math.max(left, frame.left);
        right = Math.min(right, frame.right);
        top = Math.max(top, frame.top);
        bottom = Math.min(bottom, frame.bottom);
      }
      if (style.clipPath !== 'none') return null;
      if (style.position === 'fixed') break;
    }
    return right - left > 1 && bottom - top > 1 ? { left, top, right, bottom } : null;
  }
  /** Can be brought to light by scrolling its surroundings. */
  const scrolls = (element) => {
    for (let each = element.parentElement; each; each = each.parentElement) {
      const { overflowX, overflowY } = getComputedStyle(each);
      const canAcross = /auto|scroll/.test(overflowX) && each.scrollWidth > each.clientWidth + 1;
      const canDown = /auto|scroll/.test(overflowY) && each.scrollHeight > each.clientHeight + 1;
      if (canAcross || canDown) return true;
    }
    return document.documentElement.scrollHeight > innerHeight + 1; // a document scrolls as a whole
  };
  // Texts through which clicks pass are asked for, too.
  const touchable = document.createElement('style');
  touchable.textContent = '* { pointer-events: auto !important; }';
  const at = (x, y) => document.elementFromPoint(x, y);

  for (const control of document.querySelectorAll('button, input, select, a[href], summary')) {
    if (!isInPlay(control)) continue;
    const box = control.getBoundingClientRect();
    if (box.width === 0 || box.height === 0) continue;
    if (box.left < -1 || box.right > innerWidth + 1 || box.top < -1 || box.bottom > innerHeight + 1) {
      if (!scrolls(control)) found.push(`${named(control)} reaches beyond the window`);
      continue;
    }
    const part = uncut(control, box);
    if (!part) continue;
    const isCut = part.right - part.left < box.width - 1 || part.bottom - part.top < box.height - 1;
    if (isCut && !scrolls(control)) found.push(`${named(control)} is cut off`);
    const top = at((part.left + part.right) / 2, (part.top + part.bottom) / 2);
    const isReached =
      top &&
      (control.contains(top) || top.contains(control) || [...(control.labels ?? [])].some((l) => l.contains(top)));
    if (!isReached && !control.disabled) found.push(`${named(control)} is covered by ${top && named(top)}`);
  }

  document.head.append(touchable);
  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const parent = node.parentElement;
    if (node.data.trim() === '' || !isInPlay(parent) || parent.closest('svg, script, style, option, textarea'))
      continue;
    const style = getComputedStyle(parent);
    const isEllipsis = style.textOverflow === 'ellipsis';
    const isHidden = /hidden|clip/.test(style.overflowX);
    if (isHidden && !isEllipsis && parent.scrollWidth > parent.clientWidth + 1)
      found.push(`${named(parent)} is cut short`);
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) {
      const part = uncut(parent, box);
      if (!part || part.right < 0 || part.left > innerWidth || part.bottom < 0 || part.top > innerHeight) continue;
      const top = at((part.left + part.right) / 2, (part.top + part.bottom) / 2);
      const isOnTop = top && (top.contains(parent) || parent.contains(top));
      if (isOnTop) texts.push({ parent, ...part });
    }
  }
  touchable.remove();
  const TOUCH = 3; // line boxes of neighbours may share so much of their empty margins [px]
  for (const [i, a] of texts.entries()) {
    for (const b of texts.slice(i + 1)) {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > TOUCH && down > TOUCH && a.parent !== b.parent)
        found.push(`${named(a.parent)} is printed over ${named(b.parent)}`);
    }
  }
  return found;
}
