// What the files of car and road say of their origin.
import { fixed, plural } from '../lib/format';
import { tidy } from '../lib/scale';
import { nameInWords } from '../lib/words';
import { Heads } from '../parts/controls';
import type { Run } from '../protocol/topics';
import { run } from '../state/run';
import { labelOf } from '../state/setting_search';
import { entryOf } from '../state/settings';
import { Meaning } from './meaning';

/** A parameter of a car file that a log found; no interval where it was assumed. */
interface Identified {
  readonly key: string;
  readonly value: number;
  readonly low: number;
  readonly high: number;
}

/** Parameters that a log found or assumed. */
export const identifiedOf = (of: Run): Identified[] =>
  of.identified_keys.map((key, i) => ({
    key,
    value: of.identified_values[i] ?? NaN,
    low: of.identified_low[i] ?? NaN,
    high: of.identified_high[i] ?? NaN,
  }));

/** "812 points of the file, 0.012 m from the line (rms), 0.034 m at most"; empty where nothing is known. */
export function fitInWords({ track_points, track_fit_rms_m, track_fit_max_m }: Run): string {
  if (track_points === 0) return '';
  const [rms, most] = [fixed(track_fit_rms_m, 3), fixed(track_fit_max_m, 3)];
  return `${plural(track_points, 'point')} of the file, ${rms} m from the line (rms), ${most} m at most`;
}

/** Kind of the file that the road was read from, and the size at which it is driven. */
export function roadInWords({ track_kind, track_scale }: Run): string {
  const size = Math.abs(track_scale - 1) < 1e-9 ? '' : `, driven at ${tidy(track_scale)} of its size`;
  return track_kind === '' ? '' : `Read from ${/^[aeiou]/i.test(track_kind) ? 'an' : 'a'} ${track_kind} file${size}.`;
}

function label(of: string): string {
  const entry = entryOf(`vehicle.${of}`);
  return entry ? labelOf(entry) : nameInWords(of);
}

/** Name of a parameter with its meaning and unit. */
function Name({ of }: { of: string }) {
  const entry = entryOf(`vehicle.${of}`);
  if (!entry) return <>{label(of)}</>;
  return (
    <>
      <Meaning of={label(of)}>{entry.meaning}</Meaning> {entry.unit && <span class="unit">{entry.unit}</span>}
    </>
  );
}

/** Table of the parameters that a log found, and the names of those that were assumed. */
function Found({ values }: { values: readonly Identified[] }) {
  const found = values.filter(({ low, high }) => low <= high);
  const assumed = values.filter(({ low, high }) => !(low <= high));
  return (
    <>
      <table class="identified">
        <caption class="sr-only">Parameters that a log found</caption>
        <Heads of={['Found by the log', 'value', '95 % interval']} />
        <tbody>
          {found.map(({ key, value, low, high }) => (
            <tr key={key}>
              <th scope="row">
                <Name of={key} />
              </th>
              <td>{tidy(value)}</td>
              <td class="keep">
                {tidy(low)} to {tidy(high)}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {assumed.length > 0 && (
        <p class="soft">
          Assumed, because the log does not excite it: {assumed.map(({ key }) => label(key)).join(', ')}.
        </p>
      )}
    </>
  );
}

/** What the files of car and road say of themselves. */
export function OriginView() {
  const now = run.value;
  if (!now || (now.car_notes.length === 0 && now.track_kind === '')) return null;
  const identified = identifiedOf(now);
  return (
    <section class="stack origin" aria-label="Car and road" data-testid="origin">
      <h2>
        Car <span class="unit">{now.car}</span>
      </h2>
      {now.car_notes.map((note) => (
        <p key={note}>{note}</p>
      ))}
      {identified.length > 0 && <Found values={identified} />}
      {now.track_kind !== '' && (
        <>
          <h2>
            Road <span class="unit">{now.track}</span>
          </h2>
          <p>{roadInWords(now)}</p>
          {now.track_notes.map((note) => (
            <p key={note}>{note}</p>
          ))}
          <p>{fitInWords(now)}</p>
        </>
      )}
    </section>
  );
}
