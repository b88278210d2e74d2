// The dashboard: connects the source of messages with the state, adds the keyboard shortcuts and renders the page.
import { computed, effect } from '@preact/signals';
import { render } from 'preact';
import { toggleScheme } from './lib/appearance';
import { addShortcuts, shortcutFor, ticks } from './lib/keys';
import { refusalInWords } from './lib/refusal';
import { store } from './lib/store';
import { nextSpeedUnit } from './lib/units';
import { WorkerLink } from './page/worker_link';
import { Connection, SUBPROTOCOLS, viewerUrl } from './protocol/connection';
import type { Socket } from './protocol/foxglove';
import { ReadingSocket } from './protocol/reading';
import { readSchema } from './protocol/schema';
import type { Source } from './protocol/source';
import { begin, timeline } from './recording/begin';
import { nextCamera } from './scene3d/view_state';
import { beginSession, receive, receivePastLeft } from './state/demultiplexer';
import { toggleLayer } from './state/layers';
import { ageAtArrival, attempt, link, notice, pastLeft, services } from './state/link';
import { followAddress, MODES, type Mode, mode } from './state/mode';
import { call, refreshOnNewChoice, requests } from './state/operate';
import { rememberRun } from './state/other_run';
import { toggleFrozen, toggleMark } from './state/plot_view';
import { answerBy, programPage } from './state/program_page';
import { run } from './state/run';
import { schema } from './state/settings';
import { programName } from './state/share';
import { refreshText } from './state/shown';
import { oneButton } from './state/stage_state';
import { everyFrame } from './state/ticker';
import { HeaderView, TITLES } from './views/header_view';
import { HelpView, openHelp } from './views/help_view';
import { handBack, listenToDriver, toggleManual } from './views/manual_view';
import { changePace, present } from './views/menu_view';
import { RestartView } from './views/restart_view';
import { listenForLinks, ShareView } from './views/share_view';
import { StageView } from './views/stage_view';
import { TourView } from './views/tour_view';
import { zoom } from './views/track_view';
import { focusSearch } from './views/try_view';

/** Session of the program that was connected last. */
const session = store.data('page', () => ({ name: null as string | null }));

/** Loads the descriptions of all settings. */
async function loadSchema(): Promise<void> {
  try {
    const answer = await programPage('schema.json');
    if (answer !== null) schema.value = readSchema(JSON.parse(answer));
  } catch {
    // The banner of the connection gives the reason.
  }
}

/** Loads the name by which the program was started; its command is shown after it has ended. */
async function loadProgramName(): Promise<void> {
  const name = await programPage('command.txt').catch(() => null);
  if (name) programName.value = name;
}

/** Takes the number of frames of the past that are still to come. */
function tellPastLeft(messages: number): void {
  pastLeft.value = messages;
  receivePastLeft(messages, performance.now());
}

/** Opens the connection to the program, or to the worker of a page that needs none. */
function opener(): () => Socket {
  const handlers = { age: (seconds: number) => (ageAtArrival.value = seconds), pastLeft: tellPastLeft };
  if (__PAGE__) {
    const worker = new WorkerLink((sentence) => (notice.value = sentence));
    answerBy((path) => worker.get(`/${path}`));
    return () => new ReadingSocket(worker.open(), handlers, { acknowledges: false });
  }
  // The frames of the last minutes follow the newest one; no more are sent than arrive in time.
  const url = viewerUrl('?past&paced');
  return () => new ReadingSocket(new WebSocket(url, SUBPROTOCOLS), handlers);
}

/** The program as the source of messages. */
function live(): Source {
  return new Connection(opener(), {
    open(name) {
      // The program sends its run from the beginning, whenever the page comes.
      const isOther = name !== session.name;
      beginSession(isOther);
      if (isOther && session.name !== null) rememberRun();
      session.name = name;
      link.value = 'live';
      attempt.value = 0;
    },
    lost(number) {
      link.value = 'lost';
      attempt.value = number;
    },
    message: (topic, message) => receive(topic, message, performance.now()),
    services: (names) => (services.value = names),
    settings(values, isAll) {
      requests.receive(values);
      if (isAll) void loadSchema();
    },
    notice: (sentence) => (notice.value = refusalInWords(sentence)),
  });
}

void begin(live);
refreshOnNewChoice();
const isDriven = computed(() => run.value?.mode === 'drive' && link.value === 'live');
effect(() => {
  if (!__PAGE__ && isDriven.value) void loadProgramName();
});
listenToDriver();
listenForLinks();
followAddress();

addShortcuts(
  'Run',
  {
    keys: [' '],
    label: 'Space',
    does: 'The button of the header: pause, resume, drive again',
    isPossible: () => oneButton.value?.isPossible === true,
    action: () => oneButton.value?.act(),
  },
  { keys: ['.'], label: '.', does: 'One control step while paused', action: () => call('/step') },
  { keys: ['r'], label: 'R', does: 'Back to the start of the run', action: () => call('/reset') },
  { keys: ['['], label: '[', does: 'Halve the pace', action: () => changePace(0.5) },
  { keys: [']'], label: ']', does: 'Double the pace', action: () => changePace(2) },
);
const hindsight = 'Show or hide the plan of a second ago and the path driven since';
addShortcuts(
  'Camera',
  { keys: ['c'], label: 'C', does: 'Next camera', action: nextCamera },
  { keys: ['+', '='], label: '+', does: 'Zoom in', action: () => zoom(0.8) },
  { keys: ['-'], label: '−', does: 'Zoom out', action: () => zoom(1.25) },
  { keys: ['l'], label: 'L', does: "Show or hide the limit's line", action: () => toggleLayer('racingLine') },
  { keys: ['o'], label: 'O', does: hindsight, action: () => toggleLayer('hindsight') },
);
function show(next: Mode): void {
  mode.value = next;
}
/** Shows Try, with the search focused. */
function search(): void {
  show('try');
  focusSearch();
}
const mark = 'Mark the moment under the cursor: plots show differences from it';
addShortcuts(
  'Page',
  { keys: ['t'], label: 'T', does: 'Light or dark', action: toggleScheme },
  { keys: ['u'], label: 'U', does: 'Next unit for speeds: mph, km/h, m/s', action: nextSpeedUnit },
  ...MODES.map((name, i) => {
    const key = String(i + 1);
    return { keys: [key], label: key, does: TITLES[name], action: () => show(name) };
  }),
  { keys: ['/'], label: '/', does: 'Search settings', action: search },
  { keys: ['p'], label: 'P', does: 'Hold the plots, or follow again', action: toggleFrozen },
  { keys: ['x'], label: 'X', does: mark, action: toggleMark },
  { keys: ['g'], label: 'G', does: 'The stage on the whole screen', action: present },
  { keys: ['?'], label: '?', does: 'This list', action: openHelp },
);
addShortcuts(
  'Driving by hand',
  { keys: ['m'], label: 'M', does: 'Take the wheel, or hand back to the controller', action: toggleManual },
  { keys: ['escape'], label: 'Esc', does: 'Hand back to the controller', action: handBack },
  { keys: [], label: '← → ↑ ↓', does: 'Steer, drive, brake', action: () => undefined },
);

addEventListener('keydown', (event) => {
  if (document.querySelector('dialog[open]')) return;
  if (event.key === 'Escape' && document.querySelector(':popover-open')) return; // closes that first
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (target && ticks(target, event.key)) target.click();
  const shortcut = shortcutFor(event, target);
  if (!shortcut) return;
  event.preventDefault();
  shortcut.action();
});
// A button that has the focus is pressed when Space is let go.
addEventListener('keyup', (event) => {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (event.key === ' ' && !document.querySelector('dialog[open]') && shortcutFor(event, target))
    event.preventDefault();
});

/** The whole page. */
function App() {
  const TimelineView = timeline.value;
  return (
    <>
      <HeaderView />
      {TimelineView && <TimelineView />}
      <TourView />
      <StageView />
      <HelpView />
      <RestartView />
      <ShareView />
    </>
  );
}

everyFrame((now) => refreshText(now), 100);
const root = document.getElementById('app');
if (root) render(<App />, root);
