// What solver and controller did: plots over time, limits of the speed, constraints, estimates, events.
import { hasBit } from '../lib/bits';
import { fixed } from '../lib/format';
import { LIMITERS, nameInWords } from '../lib/words';
import { Heads } from '../parts/controls';
import { Column } from '../state/columns';
import { shareOf } from '../state/explain';
import { learnedOf } from '../state/learned';
import { live } from '../state/live';
import { run } from '../state/run';
import { shown } from '../state/shown';
import { ControllerView } from './controller_view';
import { EventsView } from './events_view';
import { PlotsView } from './plots_view';

const WINDOW_S = 20; // over which shares are taken; chosen

/** A share as a bar and in figures. */
function Share({ share }: { share: number }) {
  return (
    <div class="row line">
      <i class="gauge grow other" aria-hidden="true">
        <u class="cover" style={{ transform: `scaleX(${share})` }} />
      </i>
      <span class="unit keep">{fixed(share * 100, 0)} %</span>
    </div>
  );
}

/** Shares of time in which each limit held the speed. */
function Limiters() {
  void shown.value;
  const rows = LIMITERS.map((short, i) => ({
    short,
    share: shareOf(live.plots, Column.speed_limiter, WINDOW_S, (value) => value === i),
  })).filter(({ share }) => share > 0.005);
  return (
    <section class="stack" aria-label="What limits the speed">
      <h2>What limited the speed, last {WINDOW_S} s</h2>
      <table>
        <tbody>
          {rows.map(({ short, share }) => (
            <tr key={short}>
              <th scope="row">{short}</th>
              <td>
                <Share share={share} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

/** The controller's constraints: active now, ahead, and in shares of time. */
function Constraints() {
  const names = run.value?.constraint_names ?? [];
  const frame = shown.value;
  if (names.length === 0) return null;
  return (
    <section class="stack" aria-label="Constraints">
      <h2>Constraints</h2>
      <table class="constraints">
        <Heads of={['at the limit', 'now', 'ahead', `of the last ${WINDOW_S} s`]} />
        <tbody>
          {names.map((name, i) => {
            const [isNow, isAhead] = [hasBit(frame?.active_now ?? 0, i), hasBit(frame?.active_ahead ?? 0, i)];
            return (
              <tr key={name}>
                <th scope="row" class={isNow ? 'lost' : ''}>
                  {nameInWords(name)}
                </th>
                <td>{isNow ? <b class="lost">now</b> : <span class="soft">–</span>}</td>
                <td>{isAhead ? <b class="lost">ahead</b> : <span class="soft">–</span>}</td>
                <td>
                  <Share share={shareOf(live.plots, Column.active_now, WINDOW_S, (set) => hasBit(set, i))} />
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </section>
  );
}

/** What the run has found out about its car; nothing where it does not learn. */
function LearnedCar() {
  const rows = shown.value ? learnedOf(shown.value) : [];
  if (rows.length === 0) return null;
  return (
    <section class="stack" aria-label="The car, as it answers">
      <h2>The car, as it answers</h2>
      <dl class="rows" data-testid="learned">
        {rows.map(({ label, text }) => (
          <div key={label}>
            <dt>{label}</dt>
            <dd>{text}</dd>
          </div>
        ))}
      </dl>
      <p class="soft">Estimated while driving, with two standard deviations.</p>
    </section>
  );
}

/** What solver and controller did, over time, and in words. */
export function EngineerView() {
  return (
    <section class="engineer-parts stack" aria-label="Engineer">
      <PlotsView />
      <div class="blocks columns">
        <Limiters />
        <Constraints />
        <ControllerView />
        <LearnedCar />
        <EventsView />
      </div>
    </section>
  );
}
