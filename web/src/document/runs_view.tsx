// View of the report of recordings: a verdict for each run, where the time is lost, all laps, and figures of the
// solver.
import { useState } from 'preact/hooks';
import { fixed } from '../lib/format';
import { capital } from '../lib/words';
import { CornerTable } from '../parts/corner_table';
import { Headline } from '../parts/headline';
import { LapPlots } from '../parts/lap_plots';
import { LapTable } from '../parts/lap_table';
import { LossMap } from '../parts/loss_map';
import { byCost, causesOf } from '../state/comparison';
import { bestOf } from '../state/lap_table';
import { compareIn, coursesOf, firstPair, leadOf, type ReportedRun, verdictOf } from './runs';

/** Sentence on the laps of a run, and what was unusual. */
function Verdict({ of, level }: { of: ReportedRun; level: 1 | 2 }) {
  const Heading = `h${level}` as const;
  const { text, time, behind } = verdictOf(of);
  return (
    <header>
      <Heading class="verdict" data-testid="verdict">
        {text}
        {time !== '' && <b class="keep">{time}</b>}
        {behind !== '' && (
          <>
            , <b class="lost keep">{behind}</b> more than <span class="other">the limit</span>
          </>
        )}
        {time !== '' && '.'}
      </Heading>
      <p class="lead">{leadOf(of)}</p>
    </header>
  );
}

/** What the gap to the limit was spent on, where the run was driven again without each. */
function Spent({ of: { limit, laps } }: { of: ReportedRun }) {
  const causes = limit ? causesOf(limit, bestOf(laps)?.lap_time_s ?? NaN) : [];
  if (causes.length === 0) return null;
  return (
    <>
      <h2>
        What it was spent on <small>how much faster the best lap is without each</small>
      </h2>
      <table class="spent" data-testid="spent">
        <tbody>
          {causes.map(({ name, faster }) => (
            <tr key={name}>
              <th scope="row">{capital(name)}</th>
              <td class="number">{faster < 0.005 ? 'nothing' : `${fixed(faster, 2)} s`}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

/** A against B, chosen in the heading among the laps of all runs on one road. */
function Where({ runs }: { runs: readonly ReportedRun[] }) {
  const [courses] = useState(() => coursesOf(runs));
  const [pair, choose] = useState(() => firstPair(runs, courses));
  const [at, move] = useState<number | null>(null);
  const [first] = runs;
  const both = first && pair && compareIn(first, ...pair);
  if (!both) return null;
  const here = at ?? byCost(both)[0]?.apex ?? 0;
  return (
    <section class="columns" aria-label="Where the time is lost">
      <Headline
        level={2}
        comparison={both}
        courses={courses}
        choose={(which, id) => {
          const chosen = courses.find((each) => each.id === id);
          if (chosen) choose(which === 0 ? [chosen, both.b] : [both.a, chosen]);
        }}
      />
      <div class="two columns">
        <LossMap comparison={both} at={here} />
        <div>
          <CornerTable comparison={both} at={here} pick={move} />
          <Spent of={first} />
        </div>
      </div>
      <LapPlots comparison={both} at={here} move={move} />
    </section>
  );
}

/** Figures of solver and guard, and the recorded settings. */
function Engineer({ of: { steps, interventions, gated, duration, settings } }: { of: ReportedRun }) {
  const facts = [
    ['Control step, median', `${fixed(steps?.p50_us ?? NaN, 0)} µs`],
    ['99 of 100', `${fixed(steps?.p99_us ?? NaN, 0)} µs`],
    ['Longest', `${fixed(steps?.longest_us ?? NaN, 0)} µs`],
    ['Iterations, mean', fixed(steps?.mean_iterations ?? NaN, 1)],
    ['Control steps', String(steps?.count ?? 0)],
    ['Driven', `${fixed(duration, 1)} s`],
    ['Commands changed by the guard, times', String(gated)],
    ['Another drove, times', String(interventions)],
  ] as const;
  return (
    <details>
      <summary>Engineer</summary>
      <dl class="columns" style={{ '--least': '160px' }}>
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt class="label">{name}</dt>
            <dd class="value">
              <b>{value}</b>
            </dd>
          </div>
        ))}
      </dl>
      {settings !== '' && (
        <>
          <h3>Recorded settings</h3>
          <pre tabIndex={0}>{settings}</pre>
        </>
      )}
    </details>
  );
}

/** Laps and figures of a run, and the command that shows it again. */
function Run({ of }: { of: ReportedRun }) {
  return (
    <section class="columns" aria-label={of.name}>
      <h2>All laps</h2>
      {of.laps.length > 0 ? <LapTable of={of.name} laps={of.laps} limit={of.limit} /> : <p>No lap was completed.</p>}
      <Engineer of={of} />
      <h2>See it again</h2>
      <p>
        <code>chicane replay {of.recording}</code>
      </p>
    </section>
  );
}

/** The report of recordings: one sentence for each run, where its time is lost, all laps. */
export function RunsView({ runs }: { runs: readonly ReportedRun[] }) {
  const [first, ...others] = runs;
  if (!first) return <p>The recordings hold no run.</p>;
  return (
    <main class="understand runs">
      <Verdict of={first} level={1} />
      {others.length > 0 && <p class="lead">{first.name}</p>}
      <Where runs={runs} />
      <Run of={first} />
      {others.map((run) => (
        <div key={run.name}>
          <Verdict of={run} level={2} />
          <p class="lead">{run.name}</p>
          <Run of={run} />
        </div>
      ))}
    </main>
  );
}
