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
  /** Value at the start of the run; null for controls of the run, and for older programs. */
  readonly start: number | boolean | string | null;
  readonly meaning: string;
  /** Of a switch for a fault; else absent. */
  readonly fault?: FaultEntry;
  /** Whether a change applies at the next control step; otherwise it restarts the run. */
  readonly is_live: boolean;
  /** Whether only whoever starts the run sets it; futures that only predict may vary it. */
  readonly is_fixed: boolean;
}

/** Default duration and strength of a fault, and the range of its strength; no meaning: it has no strength. */
export interface FaultEntry {
  readonly group: string;
  readonly duration_s: number;
  readonly strength: number;
  readonly weakest: number;
  readonly strongest: number;
  readonly strength_meaning: string;
}

function readFault(value: unknown): FaultEntry | undefined {
  if (typeof value !== 'object' || value === null) return undefined;
  const { group, duration_s, strength, weakest, strongest, strength_meaning } = value as Record<string, unknown>;
  return {
    group: typeof group === 'string' ? group : '',
    duration_s: numberOr(duration_s) ?? 1,
    strength: numberOr(strength) ?? 1,
    weakest: numberOr(weakest) ?? 1,
    strongest: numberOr(strongest) ?? 1,
    strength_meaning: typeof strength_meaning === 'string' ? strength_meaning : '',
  };
}

const KINDS: readonly string[] = ['number', 'integer', 'bool', 'choice', 'text'] satisfies SchemaEntry['kind'][];

const numberOr = (value: unknown): number | null =>
  typeof value === 'number' && Number.isFinite(value) ? value : null;

const settingOr = (value: unknown): number | boolean | string | null =>
  typeof value === 'number' || typeof value === 'boolean' || typeof value === 'string' ? value : null;

/** Reads the well-formed entries of a parsed /schema.json: the page may be older or newer than the server. */
export function readSchema(json: unknown): SchemaEntry[] {
  if (!Array.isArray(json)) return [];
  return json.flatMap((each: Partial<Record<keyof SchemaEntry, unknown>> | null) => {
    if (typeof each?.key !== 'string' || typeof each.kind !== 'string' || !KINDS.includes(each.kind)) return [];
    const fault = readFault(each.fault);
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
        default: settingOr(each.default),
        start: settingOr(each.start),
        meaning: typeof each.meaning === 'string' ? each.meaning : '',
        is_live: each.is_live !== false,
        is_fixed: each.is_fixed === true,
        ...(fault ? { fault } : {}),
      },
    ];
  });
}
