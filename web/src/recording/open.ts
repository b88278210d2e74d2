import { McapLog } from './mcap_log';
import type { Mode } from './mode';
import { BytesReadable, HttpReadable } from './readable';

/** Opened recordings, and where to start [s]. */
export interface Recordings {
  readonly logs: readonly McapLog[];
  readonly start: number;
}

function bytesOf(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Rejects with a reason if a recording cannot be read. */
export async function openRecordings(mode: Exclude<Mode, { name: 'live' }>): Promise<Recordings> {
  if (mode.name === 'replay') {
    return {
      logs: await Promise.all(mode.logs.map(({ name, url }) => McapLog.open(name, new HttpReadable(url)))),
      start: mode.start,
    };
  }
  const report = JSON.parse(mode.text) as { logs: { name: string; mcap_base64: string }[] };
  const logs = report.logs.map(({ name, mcap_base64 }) => McapLog.open(name, new BytesReadable(bytesOf(mcap_base64))));
  return { logs: await Promise.all(logs), start: 0 };
}

/** Recordings dropped on the page. */
export async function openFiles(files: readonly File[]): Promise<Recordings> {
  const logs = files.map(async (file) =>
    McapLog.open(file.name, new BytesReadable(new Uint8Array(await file.arrayBuffer()))),
  );
  return { logs: await Promise.all(logs), start: 0 };
}
