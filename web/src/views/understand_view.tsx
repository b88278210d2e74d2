// Mode Understand: two laps compared on the map, by corner and in plots, with one cursor; a switch adds solver and
// guard.
import { download, fileName } from '../lib/download';
import { lapTime } from '../lib/format';
import { addShortcuts } from '../lib/keys';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import { reasonOf } from '../lib/words';
import { Button, Refusal } from '../parts/controls';
import { CornerTable } from '../parts/corner_table';
import { Headline } from '../parts/headline';
import { LapPlots } from '../parts/lap_plots';
import { LapTable } from '../parts/lap_table';
import { LossMap } from '../parts/loss_map';
import { chosen, comparison, courses, cursorAlong, moveCursor, pair } from '../state/compared';
import { type Comparison, causesOf, causesText } from '../state/comparison';
import { differences } from '../state/lap_setup';
import { lapSamplesCsv, lapsCsv } from '../state/lap_table';
import { bestLap, lapSamples, laps, sampledLaps } from '../state/laps';
import { limit, whyNoLimit } from '../state/limit';
import { pastLeft } from '../state/link';
import { run } from '../state/run';
import { startSettings } from '../state/settings';
import { EngineerView } from './engineer_view';

/** Whether what solver and controller did is shown. */
export const isEngineer = persisted<boolean>('engineer', false);

addShortcuts('Page', {
  keys: ['e'],
  label: 'E',
  does: 'Show or hide what solver and controller did',
  action: () => (isEngineer.value = !isEngineer.value),
});

/** Why a recording could not be added; empty without a reason. */
const problem = store.signal('page', '');

/** Reads recordings to compare with. */
async function addRecordings(files: readonly File[]): Promise<void> {
  problem.value = '';
  try {
    await (await import('../recording/add_laps')).addLapsOf(files);
  } catch (error) {
    problem.value = reasonOf(error);
  }
}

/** Switch that shows what solver and controller did. */
function EngineerSwitch() {
  return (
    <label class="row line soft" title="Plan, solver, guard and estimates (E)">
      <input
        type="checkbox"
        role="switch"
        aria-checked={isEngineer.value}
        checked={isEngineer.value}
        onChange={({ currentTarget }) => (isEngineer.value = currentTarget.checked)}
      />
      Engineer
    </label>
  );
}

/** What is missing for a comparison, as a sentence. */
function waitingFor(): string {
  void sampledLaps.value; // rendered again when laps are sampled
  if (!run.value) return 'Waiting for a run.';
  if (!run.value.is_closed) return 'This road is open: it has no laps to compare.';
  if (pastLeft.value > 0) return 'Reading the laps that were driven.';
  const [a] = pair.value;
  if (!a && laps.value.length === 0)
    return Number.isFinite(bestLap.value)
      ? `The best lap took ${lapTime(bestLap.value, 3)}; this run reports no details of its laps.`
      : 'The first lap is being driven.';
  if (!a) return 'Reading the laps that were driven.';
  const why = whyNoLimit.value === '' ? 'the limit is not known' : whyNoLimit.value;
  return `There is nothing to compare ${a.name} with yet: ${why}.`;
}

/** What differed between the two laps, where both are of this run. */
function Differences({ both }: { both: Comparison }) {
  const [a, b] = [both.a, both.b].map(({ id }) => laps.value.find(({ lap }) => `lap ${lap}` === id));
  const found = a && b ? differences(a, b, startSettings.value) : [];
  if (found.length === 0) return null;
  return (
    <p data-testid="lap-difference">
      What differed, {both.a.name} | {both.b.name}:{' '}
      {found.map(({ what, a: one, b: other }, i) => (
        <span key={what}>
          {i > 0 && ', '}
          <code>{what}</code> <b>{one}</b> | <b>{other}</b>
        </span>
      ))}
    </p>
  );
}

/** What the gap to the limit was spent on, why there is no limit, and what differed between two laps. */
function Causes({ both }: { both: Comparison }) {
  const isToLimit = both.b.id === 'limit';
  const text = limit.value && isToLimit ? causesText(causesOf(limit.value, bestLap.value)) : '';
  return (
    <div class="causes stack label">
      {text !== '' && <p data-testid="causes">{text}</p>}
      {text === '' && isToLimit && (
        <p>
          <code>chicane drive --limit --explain</code> says what the time was spent on.
        </p>
      )}
      {!limit.value && whyNoLimit.value !== '' && <p data-testid="no-limit">No limit: {whyNoLimit.value}.</p>}
      <Differences both={both} />
    </div>
  );
}

/** Collapsed table of all laps, with downloads as CSV and recordings to compare with. */
function AllLaps({ both }: { both: Comparison | null }) {
  const parts = [run.value?.track ?? '', run.value?.controller ?? ''];
  const lap = Number(/^lap (\d+)$/.exec(both?.a.id ?? '')?.[1] ?? NaN);
  return (
    <details class="all-laps">
      <summary>All laps</summary>
      {laps.value.length > 0 && (
        <LapTable
          laps={laps.value}
          limit={limit.value}
          start={startSettings.value}
          pick={(number) => (chosen.value = [`lap ${number}`, chosen.value[1]])}
        />
      )}
      <div class="row">
        <Button
          disabled={laps.value.length === 0}
          act={() => download(fileName([...parts, 'laps'], 'csv'), lapsCsv(laps.value, limit.value), 'text/csv')}
        >
          Table as CSV
        </Button>
        <Button
          disabled={!lapSamples.laps.includes(lap - 1)}
          title="Time, speed, error and commands of A along the track"
          act={() =>
            download(fileName([...parts, `lap-${lap}`], 'csv'), lapSamplesCsv(lapSamples, lap - 1), 'text/csv')
          }
        >
          This lap as CSV
        </Button>
        <label class="button">
          <input
            type="file"
            class="sr-only"
            accept=".mcap"
            multiple
            aria-label="Compare with a recording"
            onChange={({ currentTarget }) => {
              void addRecordings([...(currentTarget.files ?? [])]);
              currentTarget.value = '';
            }}
          />
          Compare with a recording …
        </label>
      </div>
      <Refusal text={problem.value} />
    </details>
  );
}

/** The mode Understand. */
export function UnderstandView() {
  const both = comparison.value;
  const at = cursorAlong.value;
  return (
    <section class={isEngineer.value ? 'understand with-engineer' : 'understand'} aria-label="Understand">
      <div class="headline row apart">
        {both ? (
          <Headline
            comparison={both}
            courses={courses.value}
            choose={(which, id) => (chosen.value = which === 0 ? [id, both.b.id] : [both.a.id, id])}
          />
        ) : (
          <h1 class="verdict grow" data-testid="headline">
            {waitingFor()}
          </h1>
        )}
        <EngineerSwitch />
      </div>
      {both && (
        <>
          <div class="where stack">
            <LossMap comparison={both} at={at} />
            <CornerTable comparison={both} at={at} pick={moveCursor} />
            <Causes both={both} />
          </div>
          <LapPlots comparison={both} isEngineer={isEngineer.value} at={at} move={moveCursor} />
        </>
      )}
      <AllLaps both={both} />
      {isEngineer.value && <EngineerView />}
    </section>
  );
}
