import { signal } from '@preact/signals';

/** The connection to the program; always live while a recording is shown. */
export type Link = 'connecting' | 'live' | 'lost';

export const link = signal<Link>('connecting');
/** How often the page has tried to connect since the connection was lost. */
export const attempt = signal(0);
/** What the server can be asked to do. */
export const services = signal<ReadonlySet<string>>(new Set());
/** The last sentence from the server; null once it was read. */
export const notice = signal<string | null>(null);

/** How old the newest frame was at most when it came [s]; 0 where the source does not say. */
export const ageAtArrival = signal(0);
/** Frames from before the page came that are still to come. */
export const pastLeft = signal(0);
