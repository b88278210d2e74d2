import { fixed } from '../lib/format';
import { inSpeedUnit, nextSpeedUnit, speedUnit } from '../lib/units';
import { driverInWords, limiterInWords } from '../lib/words';
import { RUNG } from '../protocol/messages';
import { alertsOf } from '../state/alerts';
import { lapSamples } from '../state/laps';
import { limit, limitTimeAt } from '../state/limit';
import { live } from '../state/live';
import { can } from '../state/operate';
import { run } from '../state/run';
import { shown } from '../state/shown';

function Speed() {
  const unit = speedUnit();
  const frame = shown.value;
  // The speed that the controller aims at means nothing while another drives.
  const aim = frame && !frame.is_manual && frame.rung === RUNG.CONTROLLER ? frame.speed_reference_mps : NaN;
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

/** The one sentence why the car is not faster. */
function Why() {
  const frame = shown.value;
  if (!frame) return null;
  // What limits the controller's plan is no reason for the speed of a car that something else drives.
  if (frame.is_manual || frame.rung !== RUNG.CONTROLLER) {
    const [who, more] = driverInWords(frame).text.split(': ');
    return (
      <p class="why" data-testid="why">
        <b>{who}</b>
        {more && <span class="why-long">: {more}</span>}.
      </p>
    );
  }
  const limiter = frame.speed_limiter;
  if (limiter === 0) return null;
  const { title, why } = limiterInWords(limiter);
  return (
    <p class="why" data-testid="why">
      <span class="dot" style={{ background: `var(--limiter-${limiter})` }} aria-hidden="true" />
      <b>{title}.</b> <span class="why-long">{why}</span>
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
  const canReset = run.value?.mode !== 'replay' && can('/reset');
  const alerts = frame ? alertsOf(frame, live.plots, run.value?.fault_names ?? [], canReset) : [];
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
