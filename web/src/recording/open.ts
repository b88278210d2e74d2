// Opens recordings that a program serves, or that were dropped on the page.
import { McapLog } from './mcap_log';
import type { ServedLogs } from './mode';
import { BytesReadable, HttpReadable } from './readable';

/** Opened recordings, and where to start [s]. */
export interface Recordings {
  readonly logs: readonly McapLog[];
  readonly start: number;
}

/** Rejects with a reason if a recording cannot be read. */
export const openRecordings = async ({ logs, start }: ServedLogs): Promise<Recordings> => ({
  logs: await Promise.all(logs.map(({ name, url }) => McapLog.open(name, new HttpReadable(url)))),
  start,
});

/** Recordings dropped on the page. */
export async function openFiles(files: readonly File[]): Promise<Recordings> {
  const logs = files.map(async (file) =>
    McapLog.open(file.name, new BytesReadable(new Uint8Array(await file.arrayBuffer()))),
  );
  return { logs: await Promise.all(logs), start: 0 };
}
