/** Offers a file for download. */
export function download(name: string, content: Blob | string, type = 'text/plain'): void {
  const blob = typeof content === 'string' ? new Blob([content], { type }) : content;
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A name for files of a run: "lakeside_tracking-mpc_laps.csv". */
export const fileName = (parts: readonly string[], ending: string): string =>
  `${parts
    .map((part) =>
      part
        .replace(/.*\//, '')
        .replace(/\.\w+$/, '')
        .replace(/[^\w-]+/g, '-'),
    )
    .filter((part) => part !== '')
    .join('_')}.${ending}`;
