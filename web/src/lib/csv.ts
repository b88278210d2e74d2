/**
 * Comma-separated text: a header and a row for each record; numbers to nine digits, unknown values empty.
 */
export function csv(header: readonly string[], rows: Iterable<readonly (string | number | boolean)[]>): string {
  const lines = [header.map(cell).join(',')];
  for (const row of rows) lines.push(row.map(cell).join(','));
  return `${lines.join('\n')}\n`;
}

/** A value as text, quoted where it has to be. */
function cell(value: string | number | boolean): string {
  if (typeof value === 'number') return Number.isFinite(value) ? String(Number(value.toPrecision(9))) : '';
  const text = String(value);
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}
