import { GapCausesTable } from '../parts/gap_causes_table';
import { LossesTable, seconds } from '../parts/losses_table';
import { forgotten, LIMIT, lapName, pair, roadCorners, startLine, twoLaps } from '../state/compared';
import { KEPT_LAPS } from '../state/lap_samples';
import { lapSamples } from '../state/laps';
import { limit } from '../state/limit';
import { pastLeft } from '../state/link';
import { cursorPlace } from '../state/plot_view';
import { type CornerTime, cornerTimes } from '../state/time_won';

const nameOf = (lap: number): string => (lap === LIMIT ? 'the limit' : lapName(lap));

function showCorner(corner: CornerTime | null): void {
  const ofRun = pair.value.find((lap) => lap > 0);
  const place = (startLine() + (corner?.apex ?? 0)) % lapSamples.length;
  cursorPlace.value = corner && ofRun !== undefined ? { lap: ofRun - 1, place } : null;
}

/** Where lap A loses time to lap B, by mini-sectors and by corners with the cause. */
export function TimeWonView() {
  const laps = twoLaps.value;
  const [a, b] = pair.value;
  if (!laps) {
    const missing = forgotten.value;
    if (missing.length === 0 || pastLeft.value > 0) return null;
    return (
      <p class="empty" data-testid="time-won-missing">
        The page keeps the course of the newest {KEPT_LAPS} laps and of the best one, not of {missing.join(' and ')}.
      </p>
    );
  }
  const corners = cornerTimes(laps, roadCorners(), startLine());
  return (
    <section class="block time-won" aria-label="Where the time is won" data-testid="time-won">
      <h2>
        Where {nameOf(a)} loses time to {nameOf(b)} <span class="unit">{seconds(laps.total)} s</span>
      </h2>
      <LossesTable laps={laps} corners={corners} show={showCorner} />
      {b === LIMIT && limit.value && <GapCausesTable limit={limit.value} corners={corners} lost={laps.total} />}
    </section>
  );
}
