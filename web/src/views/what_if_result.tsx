import { useEffect, useMemo, useRef } from 'preact/hooks';
import { rangeAboutZero, rangeInSteps } from '../draw/axis';
import { fixed, lapTime, UNKNOWN } from '../lib/format';
import { inSpeedUnit, type SpeedUnit, speedUnit } from '../lib/units';
import {
  atDistance,
  finalGap,
  gapAt,
  placesOf,
  stretchesOf,
  type TraceColumn,
  trustOf,
  verdictOf,
  type WhatIfAnswer,
} from '../state/what_if_answer';
import { type DistanceCurves, DistancePlot } from './distance_plot';

/** Colours of the two futures among the series of plots. */
const [WAS, BRANCH] = [0, 1] as const;

interface RowSpec {
  readonly name: string;
  readonly was: number;
  readonly branch: number;
  readonly decimals: number;
  /** Whether more is better (1), worse (−1), or neither (0). */
  readonly sense: -1 | 0 | 1;
  readonly write?: (value: number) => string;
}

function rowsOf(answer: WhatIfAnswer, unit: SpeedUnit): RowSpec[] {
  const { was, branch } = answer;
  const ends = (was.lapTimes.length > branch.lapTimes.length ? was : branch).passages.filter(
    ({ sector }) => sector === 3,
  );
  const laps = Array.from({ length: Math.max(was.lapTimes.length, branch.lapTimes.length) }, (_, i) => ({
    name: `Lap ${ends[i]?.lap ?? i + 1}`,
    was: was.lapTimes[i] ?? NaN,
    branch: branch.lapTimes[i] ?? NaN,
    decimals: 3,
    sense: -1 as const,
    write: (value: number) => lapTime(value, 3),
  }));
  return [
    ...stretchesOf(answer).map(({ lap, sector, isWhole, ...times }) => ({
      name: isWhole ? `Lap ${lap}, sector ${sector} [s]` : `To the end of sector ${sector} [s]`,
      ...times,
      decimals: 3,
      sense: -1 as const,
    })),
    ...laps,
    { name: 'Least distance to the edge [m]', was: was.leastEdge, branch: branch.leastEdge, decimals: 2, sense: 1 },
    { name: 'Largest lateral error [m]', was: was.largestError, branch: branch.largestError, decimals: 2, sense: -1 },
    {
      name: `Mean speed [${unit.name}]`,
      was: inSpeedUnit(was.meanSpeed),
      branch: inSpeedUnit(branch.meanSpeed),
      decimals: 1,
      sense: 1,
    },
    {
      name: `Top speed [${unit.name}]`,
      was: inSpeedUnit(was.topSpeed),
      branch: inSpeedUnit(branch.topSpeed),
      decimals: 1,
      sense: 0,
    },
    {
      name: 'Steps changed by the guard',
      was: was.interventions,
      branch: branch.interventions,
      decimals: 0,
      sense: -1,
    },
    { name: 'Off the road, times', was: was.offTrack, branch: branch.offTrack, decimals: 0, sense: -1 },
  ];
}

function Row({ name, was, branch, decimals, sense, write }: RowSpec) {
  const difference = branch - was;
  const isSame = !(Math.abs(difference) >= 0.5 * 10 ** -decimals);
  const severity = isSame || sense === 0 ? '' : difference * sense > 0 ? 'better' : 'worse';
  const text = write ?? ((value: number) => fixed(value, decimals));
  return (
    <tr>
      <th scope="row">{name}</th>
      <td>{text(was)}</td>
      <td>{text(branch)}</td>
      <td class={severity}>
        {Number.isFinite(difference)
          ? isSame
            ? '='
            : `${difference > 0 ? '+' : ''}${fixed(difference, decimals)}`
          : UNKNOWN}
        {severity !== '' && <span class="sr-only"> {severity}</span>}
      </td>
    </tr>
  );
}

/** "As driven", or what it is where not all of it has been driven. */
export function nameOfFirst({ at, knownUntil, was }: WhatIfAnswer): string {
  return knownUntil >= at + was.duration - 0.1 ? 'As driven' : 'As it is';
}

function curvesOf(answer: WhatIfAnswer, unit: SpeedUnit): DistanceCurves[] {
  const places = placesOf(answer);
  const both = (name: TraceColumn, factor = 1) =>
    ([answer.was, answer.branch] as const).map(({ trace }, i) => ({
      label: i === 0 ? nameOfFirst(answer).toLowerCase() : 'what if',
      colour: i === 0 ? WAS : BRANCH,
      values: places.map((place) => atDistance(trace, name, place) * factor),
    }));
  const gap = { label: '+ what if is behind', colour: 3, values: places.map((place) => gapAt(answer, place)) };
  return [
    {
      title: 'Speed',
      unit: unit.name,
      decimals: 1,
      places,
      curves: both('speed_mps', unit.perMps),
      range: (columns) => rangeInSteps(columns, unit.axisStep, unit.axisLeast),
    },
    {
      title: 'Time gap',
      unit: 's',
      decimals: 3,
      places,
      curves: [gap],
      range: (columns) => rangeAboutZero(columns, 0.1),
    },
    {
      title: 'Lateral error',
      unit: 'm, + left',
      decimals: 2,
      places,
      curves: both('lateral_error_m'),
      range: (columns) => rangeAboutZero(columns, 0.5),
    },
    {
      title: 'Pedal',
      unit: '%, − brakes',
      decimals: 0,
      places,
      curves: both('throttle', 100),
      range: (columns) => rangeAboutZero(columns, 105),
    },
  ];
}

/** Scrolls a part of the panel into sight, unless it is. */
function showInPanel(part: HTMLElement | null): void {
  const panel = part?.closest('.panel-body');
  if (!part || !panel) return;
  const [inside, frame] = [part.getBoundingClientRect(), panel.getBoundingClientRect()];
  if (inside.bottom > frame.bottom) panel.scrollTop += inside.top - frame.top;
  // On a very small window the page scrolls as a whole.
  if (part.getBoundingClientRect().bottom > innerHeight) part.scrollIntoView({ block: 'nearest' });
}

/** Both futures: what the change comes to, in a sentence, a table, and along the road. */
export function WhatIfResult({ answer }: { answer: WhatIfAnswer }) {
  const unit = speedUnit();
  const curves = useMemo(() => curvesOf(answer, unit), [answer, unit]);
  const first = nameOfFirst(answer);
  const gap = finalGap(answer);
  const verdict = useRef<HTMLParagraphElement>(null);
  useEffect(() => showInPanel(verdict.current), [answer]);
  return (
    <section class="what-if-result" aria-label="What would be">
      <p
        class={`verdict ${gap < -0.005 ? 'better' : gap > 0.005 ? 'worse' : ''}`}
        ref={verdict}
        role="status"
        data-testid="what-if-verdict"
      >
        {verdictOf(answer)}
      </p>
      {answer.endReason !== '' && <p class="soft">The changed run ended: {answer.endReason}.</p>}
      {answer.standIn && <p class="soft">{trustOf(answer.standIn)}</p>}
      {!answer.isExact && (
        <p class="soft">
          The run did not come out the same when it was computed again: the first column is what this program computes.
        </p>
      )}
      <div class="table-scroll what-if-table" tabIndex={0} role="region" aria-label="Both futures in numbers">
        <table data-testid="what-if-table">
          <thead>
            <tr>
              <th scope="col">From {lapTime(answer.at)} on</th>
              <th scope="col">
                <span class="stroke" style={{ borderColor: `var(--series-${WAS + 1})` }} /> {first}
              </th>
              <th scope="col">
                <span class="stroke" style={{ borderColor: `var(--series-${BRANCH + 1})` }} /> What if
              </th>
              <th scope="col">Difference</th>
            </tr>
          </thead>
          <tbody>
            {rowsOf(answer, unit).map((row) => (
              <Row key={row.name} {...row} />
            ))}
          </tbody>
        </table>
      </div>
      <div class="what-if-plots">
        {curves.map((each) => (
          <DistancePlot key={`${each.title} ${each.unit}`} of={each} />
        ))}
      </div>
    </section>
  );
}
