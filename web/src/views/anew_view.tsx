import { answer, asking } from '../state/operate';
import { Dialog } from './help_view';

/** Asked once: what is chosen now starts the run anew. */
export function AnewView() {
  const wish = asking.value;
  return (
    <Dialog isOpen={wish !== null} title="Start the run anew?" onClose={() => answer(false)}>
      <p>
        <code>{wish?.key}</code> cannot change while the car drives. The run starts anew from standstill; laps and plots
        so far are cleared.
      </p>
      <p class="soft">You will not be asked again.</p>
      <div class="buttons end">
        <button type="button" onClick={() => answer(false)}>
          Keep driving
        </button>
        <button type="button" class="primary" onClick={() => answer(true)}>
          Start anew
        </button>
      </div>
    </Dialog>
  );
}
