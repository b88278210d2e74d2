/** One setting as /schema.json describes it; its source is the table of src/chicane/protocol/schema.hpp. */
export interface SchemaEntry {
  readonly key: string;
  readonly group: string;
  /** Name of the controller whose option it is: "pure-pursuit"; empty where it is no controller's. */
  readonly controller?: string;
  readonly kind: 'number' | 'integer' | 'bool' | 'choice' | 'text';
  readonly unit: string;
  readonly minimum: number | null;
  readonly maximum: number | null;
  readonly choices: readonly string[];
  readonly default: number | boolean | string | null;
  readonly meaning: string;
  /** Whether a change applies at the next control step; otherwise it restarts the run. */
  readonly is_live: boolean;
}

const KINDS: readonly string[] = ['number', 'integer', 'bool', 'choice', 'text'] satisfies SchemaEntry['kind'][];

const numberOr = (value: unknown): number | null =>
  typeof value === 'number' && Number.isFinite(value) ? value : null;

/** Reads the well-formed entries of a parsed /schema.json: the page may be older or newer than the server. */
export function readSchema(json: unknown): SchemaEntry[] {
  if (!Array.isArray(json)) return [];
  return json.flatMap((each: Partial<Record<keyof SchemaEntry, unknown>> | null) => {
    if (typeof each?.key !== 'string' || typeof each.kind !== 'string' || !KINDS.includes(each.kind)) return [];
    const value = each.default;
    return [
      {
        key: each.key,
        group: typeof each.group === 'string' && each.group !== '' ? each.group : (each.key.split('.')[0] ?? ''),
        controller: typeof each.controller === 'string' ? each.controller : '',
        kind: each.kind as SchemaEntry['kind'],
        unit: typeof each.unit === 'string' ? each.unit : '',
        minimum: numberOr(each.minimum),
        maximum: numberOr(each.maximum),
        choices: Array.isArray(each.choices) ? each.choices.filter((choice) => typeof choice === 'string') : [],
        default: typeof value === 'number' || typeof value === 'boolean' || typeof value === 'string' ? value : null,
        meaning: typeof each.meaning === 'string' ? each.meaning : '',
        is_live: each.is_live !== false,
      },
    ];
  });
}
