import { fixed } from '../lib/format';
import { inSpeedUnit, nextSpeedUnit, speedUnit } from '../lib/units';
import { alertsOf, circumstancesOf } from '../state/alerts';
import { lapSamples } from '../state/laps';
import { limit, limitTimeAt } from '../state/limit';
import { live } from '../state/live';
import { can } from '../state/operate';
import { run } from '../state/run';
import { aimOf, stateSentence } from '../state/sentence';
import { shown } from '../state/shown';

const canReset = (): boolean => run.value?.mode !== 'replay' && can('/reset');

function Speed() {
  const unit = speedUnit();
  const frame = shown.value;
  const aim = frame ? aimOf(frame, circumstancesOf(frame, live.plots, canReset())) : NaN;
  return (
    <p class="big">
      <span class="value" data-testid="speed">
        {fixed(inSpeedUnit(shown.value?.speed_mps ?? NaN), 0)}
      </span>
      <button
        type="button"
        class="unit"
        aria-label={`${unit.name}: change the unit of speeds`}
        aria-keyshortcuts="U"
        title="Next unit for speeds (U)"
        onClick={nextSpeedUnit}
      >
        {unit.name}
      </button>
      {Number.isFinite(aim) && (
        <span class="wanted">
          aims at <b>{fixed(inSpeedUnit(aim), 0)}</b>
        </span>
      )}
    </p>
  );
}

function Delta({ id, to, seconds }: { id: string; to: string; seconds: number }) {
  if (!Number.isFinite(seconds)) return null;
  const isSlower = seconds >= 0.005;
  return (
    <span class={isSlower ? 'delta slower' : 'delta faster'} title={`Time lost to ${to}, up to this place`}>
      <span data-testid={id}>
        {isSlower ? '+' : ''}
        {fixed(seconds, 2)}
      </span>{' '}
      to {to}
    </span>
  );
}

/** Time lost up to this place, against the best lap and against the fastest possible one. */
function Deltas() {
  const frame = shown.value;
  if (!frame) return null;
  const { best } = lapSamples;
  const toBest = best < 0 ? NaN : frame.lap_time_s - lapSamples.at(best, 'time_s', frame.s_m);
  const toLimit = limit.value
    ? frame.lap_time_s - limitTimeAt(limit.value, lapSamples.length, frame.s_m, frame.lap_time_s)
    : NaN;
  // The first lap begins from standstill: it is no measure.
  return (
    <p class="deltas">
      <Delta id="delta" to="best" seconds={toBest} />
      <Delta id="delta-limit" to="limit" seconds={frame.lap > 0 ? toLimit : NaN} />
    </p>
  );
}

/** The one sentence of this state: who drives, what is stuck, or why the car is not faster. */
function Why() {
  const frame = shown.value;
  if (!frame) return null;
  const { title, text, limiter } = stateSentence(frame, circumstancesOf(frame, live.plots, canReset()));
  return (
    <p class="why" data-testid="why">
      {limiter !== null && <span class="dot" style={{ background: `var(--limiter-${limiter})` }} aria-hidden="true" />}
      <b>{title}.</b> <span class="why-long">{text}</span>
    </p>
  );
}

/** On the picture: speed, time lost, why this speed. */
export function HudView() {
  return (
    <div class="hud">
      <Speed />
      <Deltas />
      <Why />
    </div>
  );
}

/** On the picture, when something matters: off the road, near an edge, sliding, faults, and who drives. */
export function AlertsView() {
  const frame = shown.value;
  const alerts = frame ? alertsOf(frame, live.plots, run.value?.fault_names ?? [], canReset()) : [];
  return (
    <div class="alerts" role="status" data-testid="alerts">
      {alerts.map(({ name, severity, text }) => (
        <p key={`${name} ${name === 'fault' ? text.split(',')[0] : ''}`} class={`alert ${severity}`}>
          {text}
        </p>
      ))}
    </div>
  );
}

/** The worst of what is told on the picture: colours its frame. */
export function dangerNow(): '' | 'danger-bad' | 'danger-warning' {
  const frame = shown.value;
  const alerts = frame ? alertsOf(frame, live.plots, []) : [];
  if (alerts.some(({ severity }) => severity === 'bad')) return 'danger-bad';
  return alerts.some(({ severity }) => severity === 'warning') ? 'danger-warning' : '';
}
