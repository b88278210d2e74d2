import { duration, fixed, lapTime, side, UNKNOWN } from '../lib/format';
import { clamp, degrees } from '../lib/math';
import { bestLap, laps } from '../state/laps';
import { run } from '../state/run';
import { brakeShare, pedalInWords } from '../state/sentence';
import { shown } from '../state/shown';
import { Meaning } from './meaning';

function Lap() {
  const frame = shown.value;
  // The table has the same times, and the lap that ended the run: after it there is no frame.
  const last = laps.value.at(-1)?.lap_time_s ?? frame?.last_lap_time_s ?? NaN;
  return (
    <div class="lap">
      <p class="label">
        Lap <b data-testid="lap">{frame && Number.isFinite(frame.lap_time_s) ? frame.lap + 1 : UNKNOWN}</b>
      </p>
      <p class="clock value" data-testid="lap-time">
        {lapTime(frame?.lap_time_s ?? NaN)}
      </p>
      <p class="beside">
        <span>
          last <b>{last > 0 ? lapTime(last, 3) : UNKNOWN}</b>
        </span>
        <span>
          best <b>{lapTime(bestLap.value, 3)}</b>
        </span>
      </p>
    </div>
  );
}

function Reading({
  label,
  value,
  unit,
  note = '',
  severity = '',
  id,
}: {
  label: string;
  value: string;
  unit: string;
  note?: string;
  severity?: string;
  id: string;
}) {
  return (
    <div class="number">
      <p class="label">{label}</p>
      <p>
        <span class={`value ${severity}`} data-testid={id}>
          {value}
        </span>
        <span class="unit">{unit}</span>
        <span class="note">{note}</span>
      </p>
    </div>
  );
}

const BAR_MEANING =
  'Filled: what acts on the car now. Marked: what the controller asks for, which acts after the delay. ' +
  'The pedal goes from full braking on the left to full throttle on the right.';

/**
 * A bar that grows from its middle: steering to its side; throttle to the right, brake to the left.
 */
function Bar({
  label,
  share,
  marker,
  text,
  id,
}: {
  label: string;
  share: number;
  marker?: number;
  text: string;
  id: string;
}) {
  const at = (value: number): number => 50 + 50 * clamp(Number.isFinite(value) ? value : 0, -1, 1);
  const [from, to] = [Math.min(50, at(share)), Math.max(50, at(share))];
  return (
    <div class="bar-row">
      <span class="label">
        <Meaning of={label}>{BAR_MEANING}</Meaning>
      </span>
      <div class="bar" aria-hidden="true">
        {/* Moved by transforms, which need no layout in each repaint. */}
        <span class="fill" style={{ transform: `translateX(${from}%) scaleX(${(to - from) / 100})` }} />
        {marker !== undefined && <span class="marker" style={{ transform: `translateX(${at(marker)}%)` }} />}
      </div>
      <span class="bar-text" data-testid={id}>
        {text}
      </span>
    </div>
  );
}

/** Between full braking, −1, and full throttle, 1. */
const pedalShare = (throttle: number, fullBrake: number): number =>
  throttle < 0 ? -brakeShare(throttle, fullBrake) : throttle;

function Controls() {
  const frame = shown.value;
  const limit = run.value?.steer_limit_rad ?? NaN;
  const steer = frame?.steer_applied_rad ?? NaN;
  const name = side(degrees(steer) / 10);
  const fullBrake = run.value?.brake_throttle_limit ?? NaN;
  return (
    <div class="bars">
      {/* Left is positive in the data and on the left on the screen. */}
      <Bar
        id="wheels"
        label="Wheels"
        share={-steer / limit}
        marker={-(frame?.steer_asked_rad ?? NaN) / limit}
        text={`${fixed(Math.abs(degrees(steer)), 1)}° ${name}`}
      />
      <Bar
        id="pedal"
        label="Pedal"
        share={pedalShare(frame?.throttle_applied ?? NaN, fullBrake)}
        marker={pedalShare(frame?.throttle_asked ?? NaN, fullBrake)}
        text={pedalInWords(frame?.throttle_applied ?? NaN, fullBrake)}
      />
    </div>
  );
}

/** The strip below the picture: lap, controls and key numbers. */
export function InstrumentsView() {
  const frame = shown.value;
  const error = frame?.lateral_error_m ?? NaN;
  const edge = frame?.edge_distance_m ?? NaN;
  const step = duration(frame?.step_time_us ?? NaN);
  return (
    <section class="panel instruments" aria-label="Numbers">
      <Lap />
      <Controls />
      <div class="numbers">
        <Reading
          id="lateral-error"
          label="Lateral error"
          value={fixed(Math.abs(error), 2)}
          unit="m"
          note={side(error)}
        />
        <Reading
          id="edge-distance"
          label="To the edge"
          value={fixed(edge, 2)}
          unit="m"
          note={edge < 0 ? 'off' : ''}
          severity={edge < 0 ? 'bad' : ''}
        />
        <Reading id="step-time" label="Control step" value={step.value} unit={step.unit} />
        <Reading id="delay" label="Delay expected" value={fixed((frame?.delay_s ?? NaN) * 1000, 0)} unit="ms" />
      </div>
    </section>
  );
}
