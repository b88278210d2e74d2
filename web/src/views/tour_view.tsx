import { effect } from '@preact/signals';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { addShortcuts } from '../lib/keys';
import { link } from '../state/link';
import { call, set } from '../state/operate';
import { run } from '../state/run';
import { entryOf, settingChanges, settings } from '../state/settings';
import { tab } from '../state/tab';
import {
  done,
  goOn,
  isStepDone,
  isTourOpen,
  leaveTour,
  openTour,
  STEPS,
  type Step,
  skipped,
  step,
  stepNumber,
} from '../state/tour';

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
  const isBegun = at > 0 && at < STEPS.length;
  return (
    <button
      type="button"
      class="tour-button"
      title="What there is to do, in three minutes"
      aria-label={isBegun ? `Go on with the tour, step ${at + 1} of ${STEPS.length}` : 'Tour'}
      onClick={open}
    >
      {isBegun ? `Tour ${at + 1}/${STEPS.length}` : 'Tour'}
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

function EndCard() {
  const names = skipped.value.map((name) => STEPS.find((each) => each.name === name)?.title ?? name);
  return (
    <>
      <p>
        {names.length === 0
          ? 'You have driven, slowed, blinded, broken, tuned and compared it.'
          : `Left out: ${names.join(', ')}.`}{' '}
        Explain (3) tells why it drives as it does, Laps (5) compares laps, <kbd>?</kbd> lists all keys.
      </p>
      <div class="buttons">
        <button type="button" onClick={putBack}>
          Put everything back
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
  const now = step.value;
  return (
    <section class="tour" aria-label="Tour" data-testid="tour">
      <header class="with-button">
        <Heading text={now ? `${stepNumber.value + 1} of ${STEPS.length}: ${now.title}` : 'The tour is over'} />
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
      {now ? <StepCard of={now} /> : <EndCard />}
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
