// Time line of a recording: position, landmarks, and the choice of recording and run.
import { lapTime } from '../lib/format';
import { reasonOf } from '../lib/words';
import { Button, Select } from '../parts/controls';
import { notice } from '../state/link';
import { attach } from '../state/operate';
import type { Landmark } from './log_source';
import { beside, duration, landmarks, logs, play, played, player, position, searched, showBeside } from './player';

/** Jumps to a time [s]. */
const seek = (time: number): void =>
  void player.value?.seek(time).catch((error: unknown) => (notice.value = reasonOf(error)));

/** The next landmark in a direction, from a time [s]. */
export function neighbour(all: readonly Landmark[], time: number, direction: 1 | -1): Landmark | null {
  const margin = 0.05; // skips the landmark at the present position [s]; chosen
  const onward =
    direction > 0 ? all.filter((each) => each.time > time + margin) : all.filter((each) => each.time < time - margin);
  return (direction > 0 ? onward[0] : onward.at(-1)) ?? null;
}

/** Plays another recording from the same position. */
export async function choose(which: number): Promise<void> {
  try {
    attach(await play({ logs: logs.value, start: position.value }, which, position.value));
  } catch (error) {
    notice.value = reasonOf(error);
  }
}

/** To the next landmark in a direction. */
function Jump({ direction }: { direction: 1 | -1 }) {
  const label = direction > 0 ? 'Next landmark' : 'Previous landmark';
  const next = neighbour(landmarks.value, position.value, direction);
  return (
    <Button class="icon" aria-label={label} title={label} disabled={!next} act={() => next && seek(next.time)}>
      <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
        <path d={direction > 0 ? 'M3 3l7 5-7 5zM11 3h2v10h-2z' : 'M13 3L6 8l7 5zM5 3H3v10h2z'} fill="currentColor" />
      </svg>
    </Button>
  );
}

/** Landmarks above the slider. */
function Marks() {
  const length = duration.value;
  return (
    <div class="timeline-marks" aria-hidden="true">
      {landmarks.value.map(({ time, kind, label }) => (
        <i
          key={`${kind}${time}${label}`}
          class={kind === 'lap' ? 'won' : 'lost'}
          style={{ left: `${(100 * time) / length}%` }}
          title={`${lapTime(time)}: ${label}`}
        />
      ))}
    </div>
  );
}

/** Position in the recording; absent in a live run. */
export function TimelineView() {
  const source = player.value;
  if (!source) return null;
  const length = duration.value;
  const names = logs.value.map((log, i) => ({ value: i, label: log.name }));
  return (
    <section class="timeline row" aria-label="Time line of the recording">
      <Jump direction={-1} />
      <div class="grow">
        <Marks />
        <input
          type="range"
          min={0}
          max={length}
          step={0.01}
          value={position.value}
          aria-label="Position in the recording"
          aria-valuetext={`${lapTime(position.value)} of ${lapTime(length)}`}
          onInput={(event) => seek(event.currentTarget.valueAsNumber)}
        />
      </div>
      <Jump direction={1} />
      <output class="timeline-time">
        {lapTime(position.value)} <span>/ {lapTime(length)}</span>
      </output>
      {logs.value.length > 1 ? (
        <Select label="Recording shown" value={played.value} choices={names} choose={(which) => void choose(which)} />
      ) : (
        <span class="timeline-name soft cut">{source.log.name}</span>
      )}
      {logs.value.length > 2 && (
        <Select
          label="Recording shown beside it"
          value={beside.value}
          choices={[
            { value: -1, label: 'none beside it' },
            ...names
              .filter(({ value }) => value !== played.value)
              .map(({ value, label }) => ({ value, label: `beside: ${label}` })),
          ]}
          choose={(which) => void showBeside(which)}
        />
      )}
      {source.starts.length > 1 && (
        <Select
          label="Run of the recording"
          value={source.runAt(position.value)}
          choices={source.starts.map((_, i) => ({ value: i, label: `run ${i + 1} of ${source.starts.length}` }))}
          choose={(which) => seek(source.starts[which] ?? 0)}
        />
      )}
      {searched.value < 1 && <progress max={1} value={searched.value} aria-label="Looking for landmarks" />}
    </section>
  );
}
