// Strip below the picture: speed, pedals, lap, gap and one sentence; an alarm or the end of the run in their place.
import type { ComponentChildren } from 'preact';
import { fixed, lapTime, plural, side, UNKNOWN } from '../lib/format';
import { clamp, degrees } from '../lib/math';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { Button } from '../parts/controls';
import { signed, toneOf } from '../state/comparison';
import { bestOf } from '../state/lap_table';
import { lapSamples, laps } from '../state/laps';
import { gapToLimit, limit, limitTimeAt } from '../state/limit';
import { attempt, link } from '../state/link';
import { call, can, canSet } from '../state/operate';
import { canReplay, REPLAY_S, replayLeft, startReplay } from '../state/replay';
import { run } from '../state/run';
import { runEnd } from '../state/run_end';
import { brakeShare, pedalInWords } from '../state/sentence';
import { settings, startSettings } from '../state/settings';
import { commandAgain, sharedNow } from '../state/share';
import { shown } from '../state/shown';
import { oneButton } from '../state/stage_state';
import { HashView } from './hash_view';
import { isManual, Pad, toggleManual } from './manual_view';
import { SentenceView, situationNow } from './sentence_view';

/** The speed in the user's unit. */
function Speed() {
  return (
    <p class="speed row line">
      <b data-testid="speed">{fixed(inSpeedUnit(shown.value?.speed_mps ?? NaN), 0)}</b>
      <span class="unit label">{speedUnit().name}</span>
    </p>
  );
}

/** A bar that grows from its middle: steering to its side; the throttle to the right, the brake to the left. */
function Bar({ label, share, text, id }: { label: string; share: number; text: string; id: string }) {
  const at = 50 * clamp(Number.isFinite(share) ? share : 0, -1, 1);
  return (
    <div class="bar">
      <span class="label">{label}</span>
      <i class="gauge" aria-hidden="true">
        {/* Moved by transforms, which need no layout in each repaint. */}
        <u class="cover" style={{ transform: `translateX(${50 + Math.min(0, at)}%) scaleX(${Math.abs(at) / 100})` }} />
      </i>
      <span class="sr-only" data-testid={id}>
        {text}
      </span>
    </div>
  );
}

/** Steering and pedal as they act on the car. */
function Bars() {
  const frame = shown.value;
  const steer = frame?.steer_applied_rad ?? NaN;
  const throttle = frame?.throttle_applied ?? NaN;
  const fullBrake = run.value?.brake_throttle_limit ?? NaN;
  return (
    <div class="bars stack">
      {/* Left is positive in the data and on the left on the screen. */}
      <Bar
        id="wheels"
        label="steer"
        share={-steer / (run.value?.steer_limit_rad ?? NaN)}
        text={`${fixed(Math.abs(degrees(steer)), 1)}° ${side(degrees(steer) / 10)}`}
      />
      <Bar
        id="pedal"
        label="pedal"
        share={throttle < 0 ? -brakeShare(throttle, fullBrake) : throttle}
        text={pedalInWords(throttle, fullBrake)}
      />
    </div>
  );
}

/** A value with its label. */
function Cell({
  label,
  children,
  tone = '',
  id,
}: {
  label: ComponentChildren;
  children: string;
  tone?: string;
  id: string;
}) {
  return (
    <p class="cell">
      <span class="label">{label}</span>
      <b class={`value ${tone}`} data-testid={id}>
        {children}
      </b>
    </p>
  );
}

/** Number and clock of the lap. */
function Lap() {
  const frame = shown.value;
  const number = frame && Number.isFinite(frame.lap_time_s) ? frame.lap + 1 : UNKNOWN;
  return (
    <Cell
      id="lap-time"
      label={
        <>
          Lap <span data-testid="lap">{number}</span>
        </>
      }
    >
      {lapTime(frame?.lap_time_s ?? NaN)}
    </Cell>
  );
}

/** Time lost to the limit up to this place. The first lap begins from standstill: it is no measure. */
function Gap() {
  const frame = shown.value;
  if (!frame || !limit.value || frame.lap === 0) return <p class="cell" />;
  const gap = frame.lap_time_s - limitTimeAt(limit.value, lapSamples.length, frame.s_m, frame.lap_time_s);
  return (
    <Cell id="delta-limit" label="to the limit" tone={toneOf(gap)}>
      {Number.isFinite(gap) ? `${signed(gap)} s` : UNKNOWN}
    </Cell>
  );
}

/** A button with its key. */
function Key({ label, name, isPossible, act }: { label: string; name: string; isPossible: boolean; act: () => void }) {
  return (
    <Button disabled={!isPossible} aria-keyshortcuts={name} act={act}>
      {label} <kbd>{name}</kbd>
    </Button>
  );
}

const Wheel = () => <Key label="Take the wheel" name="M" isPossible={canSet('manual.is_on')} act={toggleManual} />;

/** The strip while the run goes on. */
function Driving() {
  const now = situationNow();
  const isAlarm = now?.kind === 'alarm';
  const isByHand = isManual();
  return (
    <section class={isAlarm ? 'strip alarm' : isByHand ? 'strip by-hand' : 'strip'} aria-label="Now">
      <Speed />
      {!isAlarm && <Bars />}
      {!isAlarm && <Lap />}
      {!isAlarm && <Gap />}
      {now ? (
        <SentenceView of={now} />
      ) : (
        <p class="true value">{run.value ? 'Waiting for the car.' : 'Waiting for a run.'}</p>
      )}
      {isAlarm && (
        <div class="keys row">
          <Wheel />
          <Key label="Start again" name="R" isPossible={can('/reset')} act={() => call('/reset')} />
        </div>
      )}
      {isByHand && (
        <div class="keys row">
          <Key label="Hand back" name="Esc" isPossible={true} act={toggleManual} />
        </div>
      )}
      {isByHand && <Pad />}
    </section>
  );
}

/** The strip while the connection is lost. */
function Lost() {
  return (
    <section class="strip alarm" aria-label="Now" data-testid="banner">
      <div class="true value">
        <p role="alert">
          <span data-testid="end-title">Connection lost</span>.
        </p>
        <small>
          The picture is the last one received. Reconnecting{attempt.value > 1 ? ` (attempt ${attempt.value})` : ''} …
        </small>
      </div>
      <div class="keys row">
        <Key label="Connect now" name="Space" isPossible={true} act={() => oneButton.value?.act()} />
      </div>
    </section>
  );
}

/** The command that drives the same again, where the program itself cannot. */
function Again() {
  const pace = settings.value.get('run.pace');
  const asked = Number(startSettings.value.get('laps')) || laps.value.length; // a page opened late has not seen all
  const command = commandAgain(sharedNow.value, {
    laps: runEnd.value?.kind === 'finished' ? asked : 0,
    pace: typeof pace === 'number' ? pace : NaN,
    port: Number(location.port),
  });
  return (
    <p class="again label row line">
      Again: <code class="cut">{command}</code>
      <Button class="plain" act={() => navigator.clipboard?.writeText(command)}>
        Copy
      </Button>
    </p>
  );
}

/** How the run ended, with which laps, and what can be done now. */
function Ended() {
  const end = runEnd.value;
  if (!end) return null;
  const all = laps.value;
  const best = bestOf(all);
  const gap = best ? gapToLimit(best, limit.value) : NaN;
  const unclean = all.filter(({ is_clean }) => !is_clean).length;
  const isOver = oneButton.value?.label !== 'Drive again' && run.value?.mode === 'drive';
  return (
    <section
      class={`strip ended${end.severity === 'bad' ? ' alarm' : ''}`}
      aria-label="End of the run"
      data-testid="end-card"
    >
      <div class="true value">
        <p role="status">
          <span data-testid="end-title">{end.title}</span>. {end.why}
        </p>
        {isOver && <Again />}
        {__PAGE__ && <HashView />}
      </div>
      <Cell id="end-laps" label="Laps">
        {String(all.length)}
      </Cell>
      <Cell id="end-best" label={best?.lap === 1 ? 'Best, from standstill' : `Best, lap ${best?.lap ?? UNKNOWN}`}>
        {lapTime(best?.lap_time_s ?? NaN, 3)}
      </Cell>
      {Number.isFinite(gap) && <Cell id="end-gap" label="Above the limit">{`${fixed(gap, 1)} %`}</Cell>}
      {unclean > 0 && (
        <Cell id="end-off" label="Off the road">
          {plural(unclean, 'lap')}
        </Cell>
      )}
      <div class="keys row">
        <Button disabled={!canReplay()} act={startReplay}>
          Replay the last {REPLAY_S} s
        </Button>
      </div>
    </section>
  );
}

/** The row below the picture: speed, pedals, lap, gap and one sentence; an alarm, or the end of the run, takes all. */
export function StripView() {
  if (link.value === 'lost' && (run.value?.end ?? '') === '') return <Lost />;
  if (runEnd.value && replayLeft.value === null) return <Ended />;
  return <Driving />;
}
