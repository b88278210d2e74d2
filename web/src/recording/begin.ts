// Chooses the source of messages: the live run, the recordings that the program serves, or files dropped on the page.
import type { FunctionComponent } from 'preact';
import { store } from '../lib/store';
import { reasonOf } from '../lib/words';
import type { Source } from '../protocol/source';
import { notice } from '../state/link';
import { attach } from '../state/operate';
import { askedLog } from '../state/what_if';
import { findMode } from './mode';

/** The view of recordings; its code is loaded with the first one. */
export const timeline = store.signal<FunctionComponent | null>('page', null);

/** The source that is shown. */
const current = store.data('page', () => ({ source: null as Source | null }));

/** Shows another source in place of the last one. */
function take(source: Source): void {
  current.source?.close();
  current.source = source;
  attach(source);
}

/** Shows the recordings that the page was opened for, otherwise the live run; and recordings dropped on the page. */
export async function begin(live: () => Source): Promise<void> {
  addEventListener('dragover', (event) => {
    if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
  });
  addEventListener('drop', (event) => {
    const files = [...(event.dataTransfer?.files ?? [])].filter((file) => file.name.endsWith('.mcap'));
    if (files.length === 0) return;
    event.preventDefault();
    askedLog.value = null; // the program knows nothing of these
    show((player) => player.playFirst(files)).catch((error: unknown) => (notice.value = reasonOf(error)));
  });
  const mode = await findMode();
  if (mode.name === 'live') return take(live());
  await show((player) => player.playFirst(mode)).catch((error: unknown) => (notice.value = reasonOf(error)));
  (await import('./ask_server')).offerWhatIf();
}

/** Shows recordings; their code is loaded first. */
async function show(open: (player: typeof import('./player')) => Promise<Source>): Promise<void> {
  const [player, view] = await Promise.all([import('./player'), import('./timeline_view')]);
  take(await open(player));
  timeline.value = view.TimelineView;
}
