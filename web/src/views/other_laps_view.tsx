import { lapTime } from '../lib/format';
import { store } from '../lib/store';
import { lapSamples, sampledLaps } from '../state/laps';
import { isSameRoad, type OtherLap, otherLaps, removeOtherLaps } from '../state/other_laps';
import { Picks } from './lap_picks';

/** Why a recording could not be added; empty without a reason. */
const problem = store.signal('page', '');
const isReading = store.signal('page', false);

async function add(files: readonly File[]): Promise<void> {
  [problem.value, isReading.value] = ['', true];
  try {
    await (await import('../recording/add_laps')).addLapsOf(files);
  } catch (error) {
    problem.value = error instanceof Error ? error.message : String(error);
  }
  isReading.value = false;
}

function Recording({ laps, pair }: { laps: readonly OtherLap[]; pair: readonly [number, number] }) {
  const name = laps[0]?.recording ?? '';
  return (
    <>
      {laps.map(({ number, lap, time }, i) => (
        <tr key={number}>
          {i === 0 && (
            <th scope="rowgroup" rowSpan={laps.length}>
              {name}{' '}
              <button type="button" aria-label={`Remove the laps of ${name}`} onClick={() => removeOtherLaps(name)}>
                ×
              </button>
            </th>
          )}
          <th scope="row">lap {lap}</th>
          <td class="time">{lapTime(time, 3)}</td>
          <td>
            <Picks lap={number} pair={pair} name={`lap ${lap} of ${name}`} />
          </td>
        </tr>
      ))}
    </>
  );
}

/** Laps of other recordings on this road, and how to add some. */
export function OtherLapsView({ pair }: { pair: readonly [number, number] }) {
  void sampledLaps.value; // the length of the road is known with the first lap
  const all = otherLaps.value.filter(({ samples }) => isSameRoad(samples, lapSamples));
  const names = [...new Set(all.map(({ recording }) => recording))];
  return (
    <section class="block other-laps" aria-label="Laps of other recordings">
      <label class="button">
        <input
          type="file"
          class="sr-only"
          accept=".mcap"
          multiple
          aria-label="Add laps of a recording"
          onChange={({ currentTarget }) => {
            void add([...(currentTarget.files ?? [])]);
            currentTarget.value = '';
          }}
        />
        {isReading.value ? 'Reading …' : 'Add laps of a recording …'}
      </label>
      {problem.value !== '' && (
        <p class="bad" role="alert">
          {problem.value}
        </p>
      )}
      {names.length > 0 && (
        <div class="table-scroll" tabIndex={0} role="region" aria-label="Laps of other recordings, table">
          <table>
            <thead>
              <tr>
                {['From', 'Lap', 'Time', 'Compare'].map((head) => (
                  <th key={head} scope="col">
                    {head}
                  </th>
                ))}
              </tr>
            </thead>
            {names.map((name) => (
              <tbody key={name}>
                <Recording laps={all.filter(({ recording }) => recording === name)} pair={pair} />
              </tbody>
            ))}
          </table>
        </div>
      )}
    </section>
  );
}
