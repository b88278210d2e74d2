// View of a table of results: links, code, shaded cells and confidence intervals.
import { areNumbers, type Cell, type MoreThanText, type Table } from './table';

const INTERVAL_WIDTH = 160; // [px]; chosen
const MOST_COLUMNS = 9; // of a grid that may stand beside another one; chosen

/** An interval with the value found in it as a dot, and the assumed value as a stroke. */
function Interval({ of: [low, high, value, assumed] }: { of: NonNullable<MoreThanText['interval']> }) {
  const [least, most] = [Math.min(low, assumed, value), Math.max(high, assumed, value)];
  const at = (place: number): number =>
    4 + (INTERVAL_WIDTH - 8) * (most > least ? (place - least) / (most - least) : 0.5);
  return (
    <svg viewBox={`0 0 ${INTERVAL_WIDTH} 14`} width={INTERVAL_WIDTH} height="14" aria-hidden="true">
      <path stroke="var(--edge)" stroke-width="4" d={`M${at(low)} 7H${at(high)}`} />
      <circle fill="var(--ink)" cx={at(value)} cy="7" r="3.5" />
      <path stroke="var(--other)" stroke-width="2" d={`M${at(assumed)} 1V13`} />
    </svg>
  );
}

/** Content of a cell. */
function Contents({ cell }: { cell: Cell }) {
  if (typeof cell === 'string') return <>{cell}</>;
  return (
    <>
      {cell.is_code ? <code>{cell.text}</code> : cell.text}
      {cell.link?.startsWith('http') && (
        <>
          {' '}
          <a href={cell.link}>open</a>
        </>
      )}
      {cell.remark && <small class="lost">{cell.remark}</small>}
      {cell.interval && <Interval of={cell.interval} />}
    </>
  );
}

/** Class and hint of a cell; document.css has the colours. */
function looks(cell: Cell | undefined, isNumber: boolean) {
  const more = typeof cell === 'object' ? cell : undefined;
  const kinds = [
    isNumber && 'number',
    more?.is_code && 'command',
    more?.is_marked && 'marked',
    more?.share !== undefined && 'shaded',
    more?.signed !== undefined && 'signed',
  ].filter(Boolean);
  const signed = more?.signed ?? 0;
  const mixed = `color-mix(in srgb, var(--won) ${100 * (more?.share ?? 0)}%, var(--lost))`;
  const style =
    more?.share === undefined
      ? { '--share': Math.abs(signed), '--tone': `var(--${signed < 0 ? 'won' : 'lost'})` }
      : { '--share': 0.7, '--tone': mixed };
  return { class: kinds.join(' '), title: more?.hint, ...(more ? { style } : {}) };
}

/** A table or a grid; the first column names the rows. */
export function TableView({ table, label }: { table: Table; label: string }) {
  const numbers = areNumbers(table);
  const title = table.title || label;
  return (
    <div class={table.part === 'table' || table.columns.length > MOST_COLUMNS ? 'wide' : ''}>
      {table.title !== '' && <h3>{table.title}</h3>}
      <div class="table-scroll" role="region" aria-label={`${title}: ${table.columns[0]}`} tabIndex={0}>
        <table class={table.part}>
          <thead>
            <tr>
              {table.columns.map((name, i) => (
                <th key={name} scope="col" class={i > 0 && numbers[i] ? 'number' : ''}>
                  {name}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {table.rows.map((row, r) => (
              <tr key={r}>
                <th scope="row" {...looks(row[0], false)}>
                  <Contents cell={row[0] ?? ''} />
                </th>
                {row.slice(1).map((cell, i) => (
                  <td key={table.columns[i + 1]} {...looks(cell, numbers[i + 1] ?? false)}>
                    <Contents cell={cell} />
                  </td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </div>
  );
}
