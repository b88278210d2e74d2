import { fixed } from '../lib/format';
import { shown } from '../state/shown';

/** A panel that shows a signal of its own. */
export function HalfPaceView() {
  return <p>half of the pace: {fixed(shown.value?.half_pace ?? NaN, 2)}</p>;
}
