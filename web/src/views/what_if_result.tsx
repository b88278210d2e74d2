import { useEffect, useRef, useState } from 'preact/hooks';
import { CornerTable } from '../parts/corner_table';
import { LapPlots } from '../parts/lap_plots';
import { futures } from '../state/compared';
import { headlineText, toneOf } from '../state/comparison';
import { trustOf, verdictOf, type WhatIfAnswer } from '../state/what_if_answer';

/** Scrolls a part of the panel into sight, unless it is. */
function showInPanel(part: HTMLElement | null): void {
  const panel = part?.closest('.panel-body');
  if (!part || !panel) return;
  const [inside, frame] = [part.getBoundingClientRect(), panel.getBoundingClientRect()];
  if (inside.bottom > frame.bottom) panel.scrollTop += inside.top - frame.top;
  // On a very small window the page scrolls as a whole.
  if (part.getBoundingClientRect().bottom > innerHeight) part.scrollIntoView({ block: 'nearest' });
}

/** Both futures: what the change comes to, in two sentences, by corner, and along the road. */
export function WhatIfResult({ answer }: { answer: WhatIfAnswer }) {
  const both = futures.value;
  const verdict = useRef<HTMLParagraphElement>(null);
  useEffect(() => showInPanel(verdict.current), [answer]);
  const [at, move] = useState(0);
  const later = both ? -both.total : NaN;
  return (
    <section class="understand what-if-result" aria-label="What would be">
      <p class={`verdict ${toneOf(later)}`} ref={verdict} role="status" data-testid="what-if-verdict">
        {verdictOf(answer, later)}
      </p>
      {both && <p>{headlineText(both)}</p>}
      {answer.endReason !== '' && <p class="soft">The changed run ended: {answer.endReason}.</p>}
      {answer.standIn && <p class="soft">{trustOf(answer.standIn)}</p>}
      {!answer.isExact && (
        <p class="soft">
          The run did not come out the same when it was computed again: the first one is what this program computes.
        </p>
      )}
      {both && <CornerTable comparison={both} at={at} pick={move} />}
      {both && <LapPlots comparison={both} at={at} move={move} />}
    </section>
  );
}
