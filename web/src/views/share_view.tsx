// Dialogs to share the run as a link, and to drive the run of a link.
import { plural } from '../lib/format';
import { valueInWords } from '../lib/scale';
import { store } from '../lib/store';
import { notice } from '../state/link';
import { mode } from '../state/mode';
import { canSet } from '../state/operate';
import {
  commandOf,
  driveShared,
  filesChosen,
  fixedChanges,
  linkTo,
  sharedNow,
  textsIn,
  wanted,
  wantedTexts,
} from '../state/share';
import { Copied, forgetCopied } from './copied';
import { Dialog } from './help_view';
import { ChangeOf } from './setting_row';

const isOpen = store.signal('page', false);

/** Opens the dialog with the link. */
export const openShare = (): void => {
  isOpen.value = true;
};

/** Reads a link to a run from the address, now and when another one is opened in this tab, and cleans the address. */
export function listenForLinks(): void {
  const read = (): void => {
    const texts = textsIn(location.hash);
    if (!texts) return;
    wantedTexts.value = texts;
    history.replaceState(null, '', `#${mode.value}`);
  };
  addEventListener('hashchange', read);
  read();
}

/** Dialog with a link to the current run and the command that starts it, or why it cannot be shared. */
function Offer() {
  const close = (): void => {
    isOpen.value = false;
    forgetCopied();
  };
  const shared = sharedNow.value;
  const files = filesChosen.value;
  const changes = shared.changes.size === 0 ? 'no changes' : plural(shared.changes.size, 'change');
  return (
    <Dialog isOpen={isOpen.value} title="Share this run" onClose={close}>
      {files.length > 0 ? (
        <p data-testid="share-problem">
          The {files.join(' and the ')} of this run {files.length === 1 ? 'is a file' : 'are files'} of this machine: a
          link can only name what the program brings along.
        </p>
      ) : (
        <>
          <p class="soft">
            {[...shared.choices].map(([key, value]) => `${key} ${valueInWords(value)}`).join(', ')}, {changes}. Whoever
            opens it with <code>chicane drive</code> running is asked once, and drives the same.
          </p>
          {fixedChanges.value.length > 0 && (
            <p class="soft" data-testid="share-fixed">
              Fixed when a run starts, and in the command only: {fixedChanges.value.join(', ')}.
            </p>
          )}
          <Copied id="share-link" label="Link" text={linkTo(shared, location.href.replace(/[?#].*/, ''))} />
          <Copied id="share-command" label="Command" text={commandOf(shared)} />
        </>
      )}
    </Dialog>
  );
}

/** Drives the run of the link. */
async function accept(): Promise<void> {
  const request = wanted.value;
  wantedTexts.value = null;
  if (!request) return;
  const refused = await driveShared(request.run);
  if (refused.length > 0) notice.value = `Not all that the link asks for is driven: ${refused.join('; ')}`;
}

/** Dialog that asks before the run of a link replaces the current one. */
function Question() {
  const decline = (): void => {
    wantedTexts.value = null;
  };
  const request = wanted.value;
  const isSame = request?.differences.length === 0;
  return (
    <Dialog
      isOpen={request !== null}
      title="Drive the run of this link?"
      close={isSame ? 'Close' : 'Keep this run'}
      onClose={decline}
      {...(isSame ? {} : { answer: { label: 'Drive it', act: accept, disabled: !canSet('track') } })}
    >
      {request && (
        <>
          {isSame ? (
            <p>It is what is driven now.</p>
          ) : (
            <>
              <p>The run that goes on ends, and this one begins from standstill:</p>
              <ul class="stack" data-testid="wanted">
                {request.differences.map((each) => (
                  <li key={each.key}>
                    <ChangeOf of={each} />
                  </li>
                ))}
              </ul>
            </>
          )}
          {request.unknown.length > 0 && (
            <p class="soft">Left out, since a link cannot set it here: {request.unknown.join(', ')}.</p>
          )}
        </>
      )}
    </Dialog>
  );
}

/** Both dialogs. */
export function ShareView() {
  return (
    <>
      <Offer />
      <Question />
    </>
  );
}
