// View of the tour: the list of tours, the step with its tasks, and the end.
import { effect } from '@preact/signals';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { addShortcuts } from '../lib/keys';
import { Button } from '../parts/controls';
import { settingWords } from '../state/chosen_settings';
import { link } from '../state/link';
import { mode } from '../state/mode';
import { call, set } from '../state/operate';
import { run } from '../state/run';
import { entryOf, settingChanges, settings } from '../state/settings';
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

/** Opens the tour at its step, in the mode of that step. */
export function openTourHere(): void {
  openTour();
  showWhere();
}

/** Shows the mode of the step, with what the step searches for. */
function showWhere(): void {
  if (!step.value) return;
  mode.value = step.value.mode;
  settingWords.value = step.value.search ?? '';
}

/** Goes on to the next step, in its mode. */
function goOnThere(): void {
  goOn();
  showWhere();
}

/** Whether the tour is offered: for a run that can be changed. */
export const isTourOffered = (): boolean =>
  run.value !== null && run.value.mode !== 'replay' && settings.value.size > 0;

/** What the menu calls the tour. */
export function tourLabel(): string {
  const at = stepNumber.value;
  const count = tour.value?.steps.length ?? 0;
  if (isTourOpen.value) return 'Leave the tour';
  return at > 0 && at < count ? `Go on with the tour, step ${at + 1} of ${count}` : 'Tour';
}

/** Puts everything back as before the tour: settings, faults, driver, pace, and the car at the start. */
function putBack(): void {
  for (const { key, from } of settingChanges.value) if (entryOf(key)?.is_live) set(key, from);
  for (const [key, value] of settings.value) if (key.startsWith('fault.') && value === true) set(key, false);
  if (settings.value.get('manual.is_on') === true) set('manual.is_on', false);
  set('run.pace', 1);
  call('/reset');
}

/** Heading of the tour; focused when it changes. */
function Heading({ text }: { text: string }) {
  const element = useRef<HTMLHeadingElement>(null);
  useLayoutEffect(() => element.current?.focus(), [text]);
  return (
    <h2 ref={element} tabIndex={-1} style={{ outline: 'none' }}>
      {text}
    </h2>
  );
}

/** Tasks of the step, and which are done. */
function Tasks({ of }: { of: Step }) {
  return (
    <ol class="tour-tasks row">
      {of.tasks.map((task, i) => (
        <li key={task} class={done.value[i] ? 'done won' : ''}>
          <span aria-hidden="true">{done.value[i] ? '✓' : '○'}</span> {task}
          <span class="sr-only">{done.value[i] ? ': done' : ': to do'}</span>
        </li>
      ))}
    </ol>
  );
}

/** Sentence for screen readers when a task is done. */
function announcement({ tasks }: Step): string {
  const next = done.value.indexOf(false);
  if (next < 0) return 'All done: go on to the next step.';
  return next === 0 ? '' : `Done: ${tasks[next - 1]}. Next: ${tasks[next]}.`;
}

/** The step: text, tasks, and the way on. */
function StepCard({ of }: { of: Step }) {
  const isPossible = link.value !== 'live' || of.isPossible();
  const isThere = mode.value === of.mode;
  // What the step is about comes into sight with its panel, also where the reader had scrolled.
  useEffect(() => {
    if (isThere) document.querySelector(of.where)?.scrollIntoView({ block: 'nearest' });
  }, [of, isThere]);
  return (
    <>
      <p>{isPossible ? of.text : 'This run does not offer it.'}</p>
      {isPossible && <Tasks of={of} />}
      <div class="row">
        {isPossible && !isThere && <Button act={showWhere}>Show me where</Button>}
        {!isStepDone.value && <Button act={goOnThere}>Skip</Button>}
        <Button class="primary" disabled={!isStepDone.value} act={goOnThere}>
          Next
        </Button>
      </div>
      <p class="sr-only" role="status">
        {announcement(of)}
      </p>
    </>
  );
}

/** The list of tours. */
function ListCard() {
  return (
    <ul class="row">
      {TOURS.map(({ name, title, steps }) => (
        <li key={name}>
          <Button
            act={() => {
              chooseTour(name);
              showWhere();
            }}
          >
            {title}, {steps.length} steps
          </Button>
        </li>
      ))}
    </ul>
  );
}

/** The end of a tour. */
function EndCard({ of }: { of: Tour }) {
  const names = skipped.value.map((name) => of.steps.find((each) => each.name === name)?.title ?? name);
  return (
    <>
      <p>
        {names.length === 0 ? of.end : `Left out: ${names.join(', ')}.`} Understand (2) tells where the time goes,{' '}
        <kbd>?</kbd> lists all keys.
      </p>
      <div class="row">
        <Button act={putBack}>Put everything back</Button>
        <Button act={() => chooseTour('')}>Tours</Button>
        <Button class="primary" act={leaveTour}>
          Close
        </Button>
      </div>
    </>
  );
}

/** The tour, a row above the mode in which its steps are done. */
export function TourView() {
  if (!isTourOpen.value || !isTourOffered()) return null;
  const taken = tour.value;
  const now = step.value;
  const heading = now && taken ? `${stepNumber.value + 1} of ${taken.steps.length}: ${now.title}` : 'The tour is over';
  return (
    <section class="tour stack" aria-label="Tour" data-testid="tour">
      <header class="row apart">
        <Heading text={taken ? heading : 'Tours'} />
        {now && (
          <Button class="small" title="Choose another tour" act={() => chooseTour('')}>
            Tours
          </Button>
        )}
        <Button class="icon small" aria-label="Leave the tour" title="Leave; the menu goes on with it" act={leaveTour}>
          ×
        </Button>
      </header>
      {taken === null ? <ListCard /> : now ? <StepCard of={now} /> : <EndCard of={taken} />}
    </section>
  );
}

addShortcuts('Page', {
  keys: ['h'],
  label: 'H',
  does: 'The tour: begin, go on, leave',
  action: () => (isTourOpen.value ? leaveTour() : isTourOffered() && openTourHere()),
});

/** Style that marks what the step is about; a class would be lost when the element is drawn again. */
const marked = new CSSStyleSheet();
document.adoptedStyleSheets.push(marked);
effect(() => {
  const where = isTourOpen.value && isTourOffered() ? (step.value?.where ?? '') : '';
  marked.replaceSync(where === '' ? '' : `${where} { outline: 2px solid var(--act); outline-offset: 2px; }`);
});
