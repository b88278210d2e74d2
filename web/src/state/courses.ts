import type { Lap, Limit } from '../protocol/topics';
import type { Course } from './comparison';
import type { LapSamples } from './lap_samples';
import { limitChannel } from './limit';
import { channelOnto, type OtherLap } from './other_laps';

// What can be compared, as courses at the points of the laps.

/** Speed at the line below which a lap began from standstill [m/s]; chosen. */
const STANDING_MPS = 3;

/** Whether a lap began from standstill; only a first lap can. */
function isStanding(lap: number, samples: LapSamples): boolean {
  const speed = lap === 1 ? samples.channel(0, 'speed_mps') : null;
  return (speed?.find(Number.isFinite) ?? Infinity) < STANDING_MPS;
}

/** A lap of the run. */
export const lapCourse = ({ lap, lap_time_s: total }: Lap, samples: LapSamples): Course => ({
  id: `lap ${lap}`,
  name: `lap ${lap}`,
  total,
  isStanding: isStanding(lap, samples),
  channel: (name) => samples.channel(lap - 1, name),
});

/** A lap of another recording, at the points of `onto`. */
export function recordedCourse(of: OtherLap, onto: LapSamples): Course {
  const { lap, recording, time, samples } = of;
  const name = `lap ${lap} of ${recording}`;
  return {
    id: name,
    name,
    total: time,
    isStanding: isStanding(lap, samples),
    channel: (which) => channelOnto(of, which, onto),
  };
}

/** The limit, at the points of `samples`. */
export const limitCourse = (of: Limit, samples: LapSamples): Course => ({
  id: 'limit',
  name: 'the limit',
  total: of.lap_time_s,
  isStanding: false,
  channel: (name) => limitChannel(of, samples, name),
});
