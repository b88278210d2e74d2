// The page below the header.
import { mode } from '../state/mode';
import { run } from '../state/run';
import { isStale } from '../state/stage_state';
import { StripView } from './strip_view';
import { TrackView } from './track_view';
import { TryView } from './try_view';
import { UnderstandView } from './understand_view';

/** The page below the header, in its mode. The picture stays the same one in Watch and in Try. */
export function StageView() {
  const now = mode.value;
  const name = run.value ? `${run.value.car} on ${run.value.track}` : 'no run yet';
  return (
    <main
      class={isStale.value ? 'stale' : ''}
      data-mode={now}
      {...(now === 'watch' ? {} : { tabIndex: 0 })} // it scrolls: keys have to reach it
    >
      {now === 'watch' && <h1 class="sr-only">Watch: {name}</h1>}
      <div class="stage" hidden={now === 'understand'}>
        <TrackView />
      </div>
      {now === 'watch' && <StripView />}
      {now === 'understand' && <UnderstandView />}
      {now === 'try' && <TryView />}
    </main>
  );
}
