import { confirm, pendingConfirmation } from '../state/operate';
import { Dialog } from './help_view';

/** Asks for confirmation of the first change that restarts the run. */
export function RestartView() {
  const request = pendingConfirmation.value;
  return (
    <Dialog
      isOpen={request !== null}
      title="Restart the run?"
      close="Keep driving"
      onClose={() => confirm(false)}
      answer={{ label: 'Restart', act: () => confirm(true) }}
    >
      <p>
        <code>{request?.key}</code> cannot change while the car drives. The run restarts from standstill; its laps and
        plots are cleared.
      </p>
      <p class="soft">You will not be asked again.</p>
    </Dialog>
  );
}
