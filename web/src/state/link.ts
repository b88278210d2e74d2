import { store } from '../lib/store';

/** The connection to the program; always live while a recording is shown. */
export type Link = 'connecting' | 'live' | 'lost';

/** State of the connection. */
export const link = store.signal<Link>('page', 'connecting');
/** How often the page has tried to connect since the connection was lost. */
export const attempt = store.signal('page', 0);
/** Names of the services that the server offers. */
export const services = store.signal<ReadonlySet<string>>('page', new Set());
/** The last sentence from the server; null once it was read. */
export const notice = store.signal<string | null>('page', null);

/** How old the newest frame was at most when it came [s]; 0 where the source does not say. */
export const ageAtArrival = store.signal('moment', 0);
/** Frames from before the page came that are still to come. */
export const pastLeft = store.signal('moment', 0);
