import { effect } from '@preact/signals';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { addShortcuts } from '../lib/keys';
import { link } from '../state/link';
import { call, set } from '../state/operate';
import { run } from '../state/run';
import { entryOf, settingChanges, settings } from '../state/settings';
import { tab } from '../state/tab';
import {
  chooseTour,
  done,
  goOn,
  isStepDone,
  isTourOpen,
  leaveTour,
  openTour,
  skipped,
  step,
  stepNumber,
  TOURS,
  tour,
} from '../state/tour';
import type { Step, Tour } from '../state/tour_step';

/** Opens the tour at its step, on the panel of that step. */
function open(): void {
  openTour();
  showWhere();
}

function showWhere(): void {
  if (step.value) tab.value = step.value.tab;
}

/** The tour is about a run that can be changed. */
const isOffered = (): boolean => run.value !== null && run.value.mode !== 'replay' && settings.value.size > 0;

export function TourButton() {
  if (!isOffered() || isTourOpen.value) return null;
  const at = stepNumber.value;
  const count = tour.value?.steps.length ?? 0;
  const isBegun = at > 0 && at < count;
  return (
    <button
      type="button"
      class="tour-button"
      title="What there is to do, in a few minutes"
      aria-label={isBegun ? `Go on with the tour, step ${at + 1} of ${count}` : 'Tour'}
      onClick={open}
    >
      {isBegun ? `Tour ${at + 1}/${count}` : 'Tour'}
    </button>
  );
}

/** As it was before the tour: pace, settings, faults, and the car at the start. */
function putBack(): void {
  for (const { key, from } of settingChanges.value) if (entryOf(key)?.is_live) set(key, from);
  for (const [key, value] of settings.value) if (key.startsWith('fault.') && value === true) set(key, false);
  if (settings.value.get('manual.is_on') === true) set('manual.is_on', false);
  set('run.pace', 1);
  call('/reset');
}

function Heading({ text }: { text: string }) {
  const element = useRef<HTMLHeadingElement>(null);
  useLayoutEffect(() => element.current?.focus(), [text]);
  return (
    <h2 ref={element} tabIndex={-1}>
      {text}
    </h2>
  );
}

function Tasks({ of }: { of: Step }) {
  return (
    <ol class="tour-tasks">
      {of.tasks.map((task, i) => (
        <li key={task} class={done.value[i] ? 'done' : ''}>
          <span class="tick" aria-hidden="true">
            {done.value[i] ? '✓' : ''}
          </span>
          <span>
            {task}
            <span class="sr-only">{done.value[i] ? ': done' : ': to do'}</span>
          </span>
        </li>
      ))}
    </ol>
  );
}

/** What a screen reader is told when a task is done. */
function announcement({ tasks }: Step): string {
  const next = done.value.indexOf(false);
  if (next < 0) return 'All done: go on to the next step.';
  return next === 0 ? '' : `Done: ${tasks[next - 1]}. Next: ${tasks[next]}.`;
}

function StepCard({ of }: { of: Step }) {
  const isPossible = link.value !== 'live' || of.isPossible();
  const isThere = tab.value === of.tab;
  // What the step is about comes into sight with its panel, also where the reader had scrolled.
  useEffect(() => {
    if (isThere) document.querySelector(of.where)?.scrollIntoView({ block: 'nearest' });
  }, [of, isThere]);
  return (
    <>
      <p>{isPossible ? of.text : 'This run does not offer it.'}</p>
      {isPossible && <Tasks of={of} />}
      <div class="buttons">
        {isPossible && !isThere && (
          <button type="button" onClick={showWhere}>
            Show me where
          </button>
        )}
        {!isStepDone.value && (
          <button
            type="button"
            onClick={() => {
              goOn();
              showWhere();
            }}
          >
            Skip
          </button>
        )}
        <button
          type="button"
          class="primary"
          disabled={!isStepDone.value}
          onClick={() => {
            goOn();
            showWhere();
          }}
        >
          Next
        </button>
      </div>
      <p class="sr-only" role="status">
        {announcement(of)}
      </p>
    </>
  );
}

function ListCard() {
  return (
    <ul class="tour-list">
      {TOURS.map(({ name, title, steps }) => (
        <li key={name}>
          <button
            type="button"
            onClick={() => {
              chooseTour(name);
              showWhere();
            }}
          >
            {title} <span class="unit">{steps.length} steps</span>
          </button>
        </li>
      ))}
    </ul>
  );
}

function EndCard({ of }: { of: Tour }) {
  const names = skipped.value.map((name) => of.steps.find((each) => each.name === name)?.title ?? name);
  return (
    <>
      <p>
        {names.length === 0 ? of.end : `Left out: ${names.join(', ')}.`} Explain (3) tells why it drives as it does,
        Laps (5) compares laps, <kbd>?</kbd> lists all keys.
      </p>
      <div class="buttons">
        <button type="button" onClick={putBack}>
          Put everything back
        </button>
        <button type="button" onClick={() => chooseTour('')}>
          Tours
        </button>
        <button type="button" class="primary" onClick={leaveTour}>
          Close
        </button>
      </div>
    </>
  );
}

/** The tour, above the panel on which its steps are done. */
export function TourView() {
  if (!isTourOpen.value || !isOffered()) return null;
  const taken = tour.value;
  const now = step.value;
  const heading = now && taken ? `${stepNumber.value + 1} of ${taken.steps.length}: ${now.title}` : 'The tour is over';
  return (
    <section class="tour" aria-label="Tour" data-testid="tour">
      <header class="with-button">
        <Heading text={taken ? heading : 'Tours'} />
        {now && (
          <button type="button" class="small" title="Choose another tour" onClick={() => chooseTour('')}>
            Tours
          </button>
        )}
        <button
          type="button"
          class="icon small"
          aria-label="Leave the tour"
          title="Leave; the button Tour goes on"
          onClick={leaveTour}
        >
          ×
        </button>
      </header>
      {taken === null ? <ListCard /> : now ? <StepCard of={now} /> : <EndCard of={taken} />}
    </section>
  );
}

addShortcuts({
  keys: ['h'],
  label: 'H',
  does: 'The tour: begin, go on, leave',
  group: 'Panels',
  action: () => (isTourOpen.value ? leaveTour() : isOffered() && open()),
});

// What the step is about is marked by the style sheet.
effect(() => {
  const name = isTourOpen.value && isOffered() ? (step.value?.name ?? '') : '';
  document.documentElement.dataset.tour = name;
});
