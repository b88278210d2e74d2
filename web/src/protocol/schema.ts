import { fields, list, number, text } from '../lib/json';
import { isSetting, type Setting } from './source';

/** One setting as /schema.json describes it; its source is the table of src/chicane/protocol/schema.hpp. */
export interface SchemaEntry {
  readonly key: string;
  readonly group: string;
  readonly kind: 'number' | 'integer' | 'bool' | 'choice' | 'text';
  readonly unit: string;
  readonly minimum: number | null;
  readonly maximum: number | null;
  readonly choices: readonly string[];
  readonly default: Setting | null;
  /** Value at the start of the run; null for controls of the run, and for older programs. */
  readonly start: Setting | null;
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

/** Reads the description of a fault; undefined where there is none. */
function readFault(value: unknown): FaultEntry | undefined {
  if (typeof value !== 'object' || value === null) return undefined;
  const all = fields(value);
  return {
    group: text(all.group),
    duration_s: number(all.duration_s, 1),
    strength: number(all.strength, 1),
    weakest: number(all.weakest, 1),
    strongest: number(all.strongest, 1),
    strength_meaning: text(all.strength_meaning),
  };
}

const KINDS: readonly SchemaEntry['kind'][] = ['number', 'integer', 'bool', 'choice', 'text'];

/** A finite number, else null. */
const numberOr = (value: unknown): number | null => (Number.isFinite(value) ? (value as number) : null);

/** A value that a setting can have, else null. */
const settingOr = (value: unknown): Setting | null => (isSetting(value) ? value : null);

/** Reads the well-formed entries of a parsed /schema.json. */
export const readSchema = (json: unknown): SchemaEntry[] =>
  list(json)
    .map(fields)
    .flatMap((each) => {
      const [key, kind, fault] = [text(each.key), KINDS.find((name) => name === each.kind), readFault(each.fault)];
      if (typeof each.key !== 'string' || !kind) return [];
      return {
        key,
        group: text(each.group) || (key.split('.')[0] ?? ''),
        kind,
        unit: text(each.unit),
        minimum: numberOr(each.minimum),
        maximum: numberOr(each.maximum),
        choices: list(each.choices).filter((choice) => typeof choice === 'string'),
        default: settingOr(each.default),
        start: settingOr(each.start),
        meaning: text(each.meaning),
        is_live: each.is_live !== false,
        is_fixed: each.is_fixed === true,
        ...(fault ? { fault } : {}),
      };
    });
