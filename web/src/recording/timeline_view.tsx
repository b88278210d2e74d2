import { lapTime } from '../lib/format';
import { reasonOf } from '../lib/words';
import { notice } from '../state/link';
import { attach } from '../state/operate';
import type { Landmark } from './log_source';
import { beside, duration, landmarks, logs, play, played, player, position, searched, showBeside } from './player';

const seek = (time: number): void =>
  void player.value?.seek(time).catch((error: unknown) => (notice.value = reasonOf(error)));

/** The next landmark in a direction, from a time [s]. */
export function neighbour(all: readonly Landmark[], time: number, direction: 1 | -1): Landmark | null {
  const margin = 0.05; // skips the landmark at the present position [s]
  const onward =
    direction > 0 ? all.filter((each) => each.time > time + margin) : all.filter((each) => each.time < time - margin);
  return (direction > 0 ? onward[0] : onward.at(-1)) ?? null;
}

function jump(direction: 1 | -1): void {
  const next = neighbour(landmarks.value, position.value, direction);
  if (next) seek(next.time);
}

export async function choose(which: number): Promise<void> {
  try {
    attach(await play({ logs: logs.value, start: position.value }, which, position.value));
  } catch (error) {
    notice.value = reasonOf(error);
  }
}

function Arrow({ direction }: { direction: 1 | -1 }) {
  return (
    <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
      <path d={direction > 0 ? 'M3 3l7 5-7 5zM11 3h2v10h-2z' : 'M13 3L6 8l7 5zM5 3H3v10h2z'} fill="currentColor" />
    </svg>
  );
}

function Marks() {
  const length = duration.value;
  return (
    <div class="timeline-marks" aria-hidden="true">
      {landmarks.value.map(({ time, kind, label }) => (
        <i
          key={`${kind}${time}${label}`}
          class={`is-${kind}`}
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
  return (
    <section class="timeline row" aria-label="Time line of the recording">
      <button
        type="button"
        class="icon"
        aria-label="Previous landmark"
        title="Previous landmark"
        disabled={!neighbour(landmarks.value, position.value, -1)}
        onClick={() => jump(-1)}
      >
        <Arrow direction={-1} />
      </button>
      <div class="timeline-track">
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
      <button
        type="button"
        class="icon"
        aria-label="Next landmark"
        title="Next landmark"
        disabled={!neighbour(landmarks.value, position.value, 1)}
        onClick={() => jump(1)}
      >
        <Arrow direction={1} />
      </button>
      <output class="timeline-time">
        {lapTime(position.value)} <span>/ {lapTime(length)}</span>
      </output>
      {logs.value.length > 1 ? (
        <select
          aria-label="Recording shown"
          value={played.value}
          onChange={(event) => void choose(Number(event.currentTarget.value))}
        >
          {logs.value.map((log, i) => (
            <option key={log.name} value={i}>
              {log.name}
            </option>
          ))}
        </select>
      ) : (
        <span class="timeline-name">{source.log.name}</span>
      )}
      {logs.value.length > 2 && (
        <select
          aria-label="Recording shown beside it"
          value={beside.value}
          onChange={(event) => void showBeside(Number(event.currentTarget.value))}
        >
          <option value={-1}>none beside it</option>
          {logs.value.map((log, i) =>
            i === played.value ? null : (
              <option key={log.name} value={i}>
                beside: {log.name}
              </option>
            ),
          )}
        </select>
      )}
      {source.starts.length > 1 && (
        <select
          aria-label="Run of the recording"
          value={source.runAt(position.value)}
          onChange={(event) => seek(source.starts[Number(event.currentTarget.value)] ?? 0)}
        >
          {source.starts.map((start, i) => (
            <option key={start} value={i}>
              run {i + 1} of {source.starts.length}
            </option>
          ))}
        </select>
      )}
      {searched.value < 1 && <progress max={1} value={searched.value} aria-label="Looking for landmarks" />}
    </section>
  );
}
