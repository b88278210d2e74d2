import { hasBit } from '../lib/bits';
import { fixed, plural } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { gateInWords, LIMITERS, nameInWords, type Sentence, sightInWords, worstInWords } from '../lib/words';
import { Column } from '../state/columns';
import { bitSharesOf, rmsOf, sharesOf } from '../state/explain';
import { learnedOf } from '../state/learned';
import { live } from '../state/live';
import { cursorTime } from '../state/plot_view';
import { run } from '../state/run';
import { plannedOf, solverInWords } from '../state/sentence';
import { shown } from '../state/shown';
import { situation, situationInWords } from '../state/situation';
import { CanvasView } from './canvas_view';
import { EventsView } from './events_view';
import { paintLimiterStrip } from './limiter_strip';
import { paintPrediction, paintSparkline } from './prediction_paint';

const WINDOW_S = 20;

function Limiter() {
  const frame = shown.value;
  const sentence = situation.value && situationInWords(situation.value);
  const limiter = frame ? LIMITERS[frame.speed_limiter] : undefined;
  const planned = frame ? plannedOf(frame) : NaN;
  const shares = sharesOf(live.plots, Column.speed_limiter, LIMITERS.length, WINDOW_S);
  return (
    <section class="block limiter" aria-label="What limits the speed">
      <h2>What limits the speed</h2>
      <div class="limiter-now">
        <span
          class="limiter-colour"
          style={{ background: `var(--limiter-${frame?.speed_limiter ?? 0})` }}
          aria-hidden="true"
        />
        <div>
          <p class="headline" data-testid="limiter">
            {sentence?.text ?? 'Waiting for a run'}
          </p>
          <p class="soft">{limiter && `The plan: ${limiter.why}`}</p>
        </div>
        <p class="allowed">
          {Number.isFinite(planned) && (
            <>
              <b data-testid="speed-limit">{fixed(inSpeedUnit(planned), 0)}</b>{' '}
              <span class="unit">{speedUnit().name} planned, a delay ahead</span>
              <br />
            </>
          )}
          <b>{fixed(inSpeedUnit(frame?.speed_mps ?? NaN), 0)}</b> <span class="unit">{speedUnit().name} driven</span>
        </p>
      </div>
      <CanvasView
        label="What limited the speed in the last 20 seconds"
        paint={paintLimiterStrip(WINDOW_S)}
        version={() => `${live.plots.newest(Column.time_s)} ${cursorTime.value}`}
        interval={100}
        tall="22px"
      />
      <ul class="shares" aria-label="Shares of the last 20 seconds">
        {LIMITERS.map(({ short }, i) =>
          (shares[i] ?? 0) > 0.005 ? (
            <li key={short}>
              <span class="dot" style={{ background: `var(--limiter-${i})` }} aria-hidden="true" />
              {short} <b>{fixed((shares[i] ?? 0) * 100, 0)} %</b>
            </li>
          ) : null,
        )}
      </ul>
    </section>
  );
}

function Constraints() {
  const names = run.value?.constraint_names ?? [];
  const frame = shown.value;
  if (names.length === 0) return null;
  const shares = bitSharesOf(live.plots, Column.active_now, names.length, WINDOW_S);
  return (
    <section class="block" aria-label="Constraints">
      <h2>Constraints</h2>
      <table class="constraints">
        <thead>
          <tr>
            <th scope="col">at the limit</th>
            <th scope="col">now</th>
            <th scope="col">ahead</th>
            <th scope="col" class="wide">
              of the last {WINDOW_S} s
            </th>
          </tr>
        </thead>
        <tbody>
          {names.map((name, i) => {
            const [isNow, isAhead] = [hasBit(frame?.active_now ?? 0, i), hasBit(frame?.active_ahead ?? 0, i)];
            return (
              <tr key={name} class={isNow ? 'now' : isAhead ? 'ahead' : ''}>
                <th scope="row">{nameInWords(name)}</th>
                <td>{isNow ? <span class="active-mark now">now</span> : <span class="soft">–</span>}</td>
                <td>{isAhead ? <span class="active-mark">ahead</span> : <span class="soft">–</span>}</td>
                <td>
                  <div class="share">
                    <span class="share-bar" aria-hidden="true">
                      <span style={{ width: `${(shares[i] ?? 0) * 100}%` }} />
                    </span>
                    <span class="unit">{fixed((shares[i] ?? 0) * 100, 0)} %</span>
                  </div>
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </section>
  );
}

function Row({ label, sentence }: { label: string; sentence: Sentence | null }) {
  return (
    <div class="row">
      <dt>{label}</dt>
      <dd>
        {sentence ? <span class={`severity ${sentence.severity}`} aria-hidden="true" /> : null}
        {sentence?.text ?? '–'}
      </dd>
    </div>
  );
}

function Answer() {
  const frame = shown.value;
  // Controllers such as PID have no solver.
  const solved = frame && (frame.iterations > 0 || /mpc$/.test(run.value?.controller ?? '')) ? frame : null;
  const worst = solved ? worstInWords(solved, run.value?.constraint_names ?? []) : null;
  const solve = solved ? solverInWords(solved) : null;
  const [optimality, violation] = [solved?.stationarity ?? NaN, solved?.violation ?? NaN];
  const numbers = [
    solved && solved.iterations > 0 ? plural(solved.iterations, 'iteration') : '',
    Number.isFinite(optimality) ? `optimal to ${optimality.toExponential(1)}` : '',
    Number.isFinite(violation) ? `constraints ${violation === 0 ? 'exact' : `to ${violation.toExponential(1)}`}` : '',
  ];
  return (
    <section class="block" aria-label="Solution">
      <h2>Solution</h2>
      <dl class="rows">
        <Row label="Solver" sentence={solve} />
        <Row
          label="Constraints"
          sentence={
            solved
              ? worst
                ? { severity: 'warning', text: worst }
                : { severity: 'good', text: 'All constraints hold' }
              : null
          }
        />
        <Row label="Driving" sentence={situation.value && situationInWords(situation.value)} />
        <Row label="Gate" sentence={frame ? gateInWords(frame) : null} />
        <Row label="Sight" sentence={frame ? sightInWords(frame.has_map, frame.sight_m) : null} />
      </dl>
      <p class="soft">{numbers.filter(Boolean).join(' · ')}</p>
    </section>
  );
}

function Prediction() {
  const frame = shown.value;
  const error = frame?.prediction_error_m ?? NaN;
  return (
    <section class="block" aria-label="Prediction">
      <h2>Prediction and outcome</h2>
      <div class="prediction">
        <div>
          <p class="soft">The plan of one second ago and the path driven since, seen from the car at that time:</p>
          <CanvasView
            label="The plan of one second ago and the path driven since"
            paint={paintPrediction}
            version={() => live.plots.newest(Column.time_s)}
            tall="96px"
          />
        </div>
        <div>
          <p class="soft">
            Distance of the car from its predicted position, one delay and one step later:{' '}
            <b data-testid="prediction-error">{fixed(error * 100, 1)}</b> cm, RMS{' '}
            {fixed(rmsOf(live.plots, Column.prediction_error_m, WINDOW_S) * 100, 1)} cm
          </p>
          <CanvasView
            label="Prediction error in the last 20 seconds"
            paint={paintSparkline(Column.prediction_error_m, WINDOW_S)}
            version={() => live.plots.newest(Column.time_s)}
            interval={100}
            tall="56px"
          />
        </div>
      </div>
    </section>
  );
}

/** What the run has found out about its car; nothing where it does not learn. */
function LearnedCar() {
  const rows = shown.value ? learnedOf(shown.value) : [];
  if (rows.length === 0) return null;
  return (
    <section class="block" aria-label="The car, as it answers">
      <h2>The car, as it answers</h2>
      <dl data-testid="learned">
        {rows.map(({ label, text }) => (
          <div class="row" key={label}>
            <dt>{label}</dt>
            <dd>{text}</dd>
          </div>
        ))}
      </dl>
      <p class="soft">Estimated while driving, with two standard deviations.</p>
    </section>
  );
}

/** Why the car drives as it does: speed limits, constraints, solution, prediction, the learned car, events. */
export function ExplainView() {
  return (
    <div class="blocks">
      <Limiter />
      <Constraints />
      <Answer />
      <Prediction />
      <LearnedCar />
      <EventsView />
    </div>
  );
}
