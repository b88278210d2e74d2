import type { Frame } from '../protocol/topics';

export type Mood = 'good' | 'warning' | 'bad' | 'unknown';

export interface Sentence {
  readonly mood: Mood;
  readonly text: string;
}

/** Who chose the command, by controller::Rung. */
export function rungInWords(rung: number): Sentence {
  switch (rung) {
    case 0:
      return { mood: 'good', text: 'The controller drives' };
    case 1:
      return { mood: 'warning', text: 'No new answer: following the last plan' };
    case 2:
      return { mood: 'bad', text: 'No answer: wheel held, gentle braking' };
    case 3:
      return { mood: 'bad', text: 'No answer: wheel held, full braking' };
    default:
      return { mood: 'bad', text: `Unknown rung ${rung}` };
  }
}

/** How the solve ended, by solver::SolveStatus. */
export function statusInWords(status: number): Sentence {
  switch (status) {
    case 0:
      return { mood: 'good', text: 'Optimal' };
    case 1:
      return { mood: 'warning', text: 'Good enough when time was up' };
    case -1:
      return { mood: 'bad', text: 'Stalled before an answer' };
    case -2:
      return { mood: 'bad', text: 'No way inside the limits' };
    case -3:
      return { mood: 'bad', text: 'Not a number in the problem' };
    default:
      return { mood: 'bad', text: `Unknown status ${status}` };
  }
}

export const gateInWords = (isGated: boolean): Sentence =>
  isGated ? { mood: 'warning', text: 'Had to change the command' } : { mood: 'good', text: 'Passed the command unchanged' };

/** Where the car is on the road. With an external simulator nobody judges, and the distance is unknown. */
export function roadInWords(frame: Pick<Frame, 'is_off_track' | 'edge_distance_m' | 'off_track_events'>): Sentence {
  if (Number.isNaN(frame.edge_distance_m)) return { mood: 'unknown', text: 'Nobody judges: external simulator' };
  if (frame.is_off_track) return { mood: 'bad', text: 'Off the road' };
  const events = frame.off_track_events;
  if (events > 0) return { mood: 'warning', text: `On the road, was off it ${events === 1 ? 'once' : `${events} times`}` };
  return { mood: 'good', text: 'On the road, never off it' };
}

/** How much road the controller knows: from its memory, or only what it is told. */
export function sightInWords(hasMap: boolean, metres: number): Sentence {
  const sight = metres > 0 ? `${Math.round(metres)} m` : 'no road';
  return { mood: 'good', text: hasMap ? `Knows the lap, uses ${sight}` : `Sees ${sight} ahead` };
}
