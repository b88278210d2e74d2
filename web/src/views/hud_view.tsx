import { fixed } from '../lib/format';
import { inSpeedUnit, nextSpeedUnit, speedUnit } from '../lib/units';
import { faultsInWords } from '../state/faults';
import { lapSamples } from '../state/laps';
import { limit, limitTimeAt } from '../state/limit';
import { run } from '../state/run';
import { shown } from '../state/shown';
import { situation } from '../state/situation';
import { SentenceView, situationNow } from './sentence_view';

function Speed() {
  const unit = speedUnit();
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

function Why() {
  const now = situationNow();
  return now && <SentenceView of={now} />;
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

/** On the picture: the faults that are on. */
export function AlertsView() {
  const frame = shown.value;
  const faults = frame ? faultsInWords(frame, run.value?.fault_names ?? []) : [];
  return (
    <div class="alerts" role="status" data-testid="alerts">
      {faults.map((text) => (
        <p key={text.split(',')[0]} class="alert bad">
          {text}
        </p>
      ))}
    </div>
  );
}

/** Colours the frame of the picture. */
export const dangerNow = (): '' | 'danger-bad' => (situation.value?.severity === 'alarm' ? 'danger-bad' : '');
