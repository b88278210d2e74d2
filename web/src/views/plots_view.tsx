// The plots over time: their toolbar, and what each of them shows.
import { useComputed } from '@preact/signals';
import { aboutZero, fromZero, rangeInSteps } from '../draw/axis';
import { fixed } from '../lib/format';
import { type SpeedUnit, speedUnit } from '../lib/units';
import { nameInWords } from '../lib/words';
import { Button } from '../parts/controls';
import { COST_TERMS, Column, costColumn } from '../state/columns';
import {
  cursorTime,
  isFrozen,
  markTime,
  thaw,
  toggleFrozen,
  toggleMark,
  WINDOWS_S,
  windowSeconds,
  zoomed,
} from '../state/plot_view';
import { run } from '../state/run';
import { drawStatusStrip } from './plot_bands';
import { type PlotSpec, TimePlot } from './time_plot';

/** Colours with the same meaning in all plots: applied ink, requested violet, sent ochre. */
const [APPLIED, ASKED, SENT, LIMIT] = [0, 1, 2, 4];

/** Factors from the units of a frame to those of the plots. */
const [DEGREES, PERCENT] = [180 / Math.PI, 100];

/** Plot of the speed in the user's unit. */
const speedSpec = ({ name, perMps, axisStep, axisLeast }: SpeedUnit): PlotSpec => ({
  title: 'Speed',
  unit: name,
  decimals: 1,
  series: [
    { column: Column.speed_limit_mps, label: 'limit', colour: LIMIT, factor: perMps },
    { column: Column.speed_reference_mps, label: 'ref.', colour: ASKED, isDashed: true, factor: perMps },
    { column: Column.speed_mps, label: 'driven', colour: APPLIED, factor: perMps },
  ],
  range: (columns) => rangeInSteps(columns.slice(1), axisStep, axisLeast),
});

/** A command as it was sent, asked for by the controller, and applied to the car. */
const commands = (sent: number, asked: number, applied: number, factor: number): PlotSpec['series'] => [
  { column: sent, label: 'sent', colour: SENT, factor },
  { column: asked, label: 'asked', colour: ASKED, isDashed: true, factor },
  { column: applied, label: 'applied', colour: APPLIED, factor },
];

/** Plots before and after that of the cost, whose layers depend on the run. */
const BEFORE_COST: readonly PlotSpec[] = [
  {
    title: 'Lateral error',
    unit: 'm, + left',
    decimals: 2,
    series: [{ column: Column.lateral_error_m, label: 'car', colour: APPLIED }],
    range: aboutZero(0.5),
  },
  {
    title: 'Heading error',
    unit: '°, + left',
    decimals: 1,
    series: [{ column: Column.heading_error_rad, label: 'car', colour: APPLIED, factor: DEGREES }],
    range: aboutZero(2),
  },
  {
    title: 'Steering',
    unit: '°, + left',
    decimals: 1,
    series: commands(Column.steer_sent_rad, Column.steer_asked_rad, Column.steer_applied_rad, DEGREES),
    range: aboutZero(2),
  },
  {
    title: 'Drive',
    unit: '%, − brakes',
    decimals: 0,
    series: commands(Column.throttle_sent, Column.throttle_asked, Column.throttle_applied, PERCENT),
    range: () => [-105, 105],
  },
  {
    title: 'Grip used',
    unit: '%, over 100 slides',
    decimals: 0,
    series: [
      { column: Column.front_tire_use, label: 'front', colour: APPLIED, factor: PERCENT },
      { column: Column.rear_tire_use, label: 'rear', colour: ASKED, factor: PERCENT },
    ],
    range: fromZero(110),
  },
];

const AFTER_COST: readonly PlotSpec[] = [
  {
    title: 'Iterations',
    unit: 'of each solve',
    decimals: 0,
    series: [{ column: Column.iterations, label: 'iterations', colour: APPLIED }],
    range: fromZero(5),
    under: drawStatusStrip,
  },
  {
    title: 'Control step',
    unit: 'ms',
    decimals: 2,
    series: [{ column: Column.step_time_us, label: 'taken', colour: APPLIED, factor: 1e-3 }],
    range: fromZero(0.5),
  },
];

/** Plot of the cost, stacked by its terms where the controller names them. */
function costSpec(names: readonly string[]): PlotSpec {
  const shownNames = names.length > COST_TERMS ? [...names.slice(0, COST_TERMS - 1), 'others'] : names;
  const layers = shownNames.map((name, term) => ({
    column: costColumn(term),
    label: nameInWords(name),
    colour: term,
    isFilled: true,
  }));
  return {
    title: 'Cost',
    unit: names.length > 0 ? 'of the plan, stacked' : 'of the plan',
    decimals: 1,
    series: names.length > 0 ? layers : [{ column: Column.cost, label: 'all', colour: APPLIED }],
    range: (columns) => fromZero(1e-3)(columns.slice(-1)),
  };
}

/** Hold, window of time, zoom and mark. */
function Toolbar() {
  return (
    <div class="row" role="group" aria-label="Plots">
      <Button
        aria-pressed={isFrozen.value}
        aria-keyshortcuts="P"
        title="Hold the plots while the run goes on (P)"
        act={toggleFrozen}
      >
        {isFrozen.value ? 'Follow' : 'Hold plots'}
      </Button>
      <div class="row line" role="group" aria-label="Time shown">
        {WINDOWS_S.map((seconds) => (
          <Button
            key={seconds}
            aria-pressed={windowSeconds.value === seconds && !zoomed.value}
            act={() => {
              zoomed.value = null;
              windowSeconds.value = seconds;
            }}
          >
            {seconds} s
          </Button>
        ))}
      </div>
      {zoomed.value && <Button act={thaw}>Reset zoom</Button>}
      {markTime.value === null ? (
        <span class="soft">Drag to zoom</span>
      ) : (
        <Button aria-keyshortcuts="X" act={toggleMark}>
          Remove the mark{cursorTime.value === null ? '' : `, Δt ${fixed(cursorTime.value - markTime.value, 2)} s`}
        </Button>
      )}
    </div>
  );
}

/** All plots over time. */
export function PlotsView() {
  const names = useComputed(() => run.value?.cost_term_names.join('\n') ?? '');
  const speed = useComputed(() => speedSpec(speedUnit()));
  const cost = useComputed(() => costSpec(names.value === '' ? [] : names.value.split('\n')));
  return (
    <div class="plots-view stack">
      <Toolbar />
      <div class="plots columns">
        {[speed.value, ...BEFORE_COST, cost.value, ...AFTER_COST].map((spec) => (
          <TimePlot key={spec.title} spec={spec} />
        ))}
      </div>
    </div>
  );
}
