import { answer, asking } from '../state/operate';
import { Dialog } from './help_view';

/** Asked once: what is chosen now starts the run anew. */
export function AnewView() {
  const wish = asking.value;
  return (
    <Dialog isOpen={wish !== null} title="Restart the run?" onClose={() => answer(false)}>
      <p>
        <code>{wish?.key}</code> cannot change while the car drives. The run restarts from standstill; its laps and
        plots are cleared.
      </p>
      <p class="soft">You will not be asked again.</p>
      <div class="buttons end">
        <button type="button" onClick={() => answer(false)}>
          Keep driving
        </button>
        <button type="button" class="primary" onClick={() => answer(true)}>
          Restart
        </button>
      </div>
    </Dialog>
  );
}
