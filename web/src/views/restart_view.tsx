import { Button } from '../parts/controls';
import { confirm, pendingConfirmation } from '../state/operate';
import { Dialog } from './help_view';

/** Asks for confirmation of the first change that restarts the run. */
export function RestartView() {
  const request = pendingConfirmation.value;
  return (
    <Dialog isOpen={request !== null} title="Restart the run?" onClose={() => confirm(false)}>
      <p>
        <code>{request?.key}</code> cannot change while the car drives. The run restarts from standstill; its laps and
        plots are cleared.
      </p>
      <p class="soft">You will not be asked again.</p>
      <div class="row end">
        <Button act={() => confirm(false)}>Keep driving</Button>
        <Button class="primary" act={() => confirm(true)}>
          Restart
        </Button>
      </div>
    </Dialog>
  );
}
