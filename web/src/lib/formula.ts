// Formulas of named numbers: + − * / ^, parentheses and the functions below.

/** A formula that was understood. */
export interface Formula {
  /** The numbers it needs, each once. */
  readonly names: readonly string[];
  /** Its value, given the numbers in the order of `names`. */
  readonly value: (numbers: readonly number[]) => number;
}

/** A formula, or what is wrong with it in one sentence. */
export type Understood = { readonly formula: Formula } | { readonly problem: string };

const FUNCTIONS: Readonly<Record<string, { readonly arity: number; readonly of: (...x: number[]) => number }>> = {
  abs: { arity: 1, of: Math.abs },
  sqrt: { arity: 1, of: Math.sqrt },
  sin: { arity: 1, of: Math.sin },
  cos: { arity: 1, of: Math.cos },
  tan: { arity: 1, of: Math.tan },
  atan2: { arity: 2, of: Math.atan2 },
  hypot: { arity: 2, of: Math.hypot },
  min: { arity: 2, of: Math.min },
  max: { arity: 2, of: Math.max },
};
export const FUNCTION_NAMES = Object.keys(FUNCTIONS);

type Value = (numbers: readonly number[]) => number;

const TOKEN = /\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(.))/y;
const MOST_NESTING = 50;

/** Raised inside this file only: understand() gives its message. */
class Problem extends Error {}

class Reader {
  readonly #words: { readonly text: string; readonly at: number; readonly kind: 'number' | 'name' | 'sign' }[] = [];
  readonly #known: readonly string[];
  readonly names: string[] = [];
  #next = 0;
  #depth = 0;

  constructor(text: string, known: readonly string[]) {
    this.#known = known;
    const whole = text.trimEnd();
    TOKEN.lastIndex = 0;
    while (TOKEN.lastIndex < whole.length) {
      const found = TOKEN.exec(whole);
      if (!found) break;
      const [, number, name, sign = ''] = found;
      const read = number ?? name ?? sign;
      const kind = number !== undefined ? 'number' : name !== undefined ? 'name' : 'sign';
      this.#words.push({ text: read, at: TOKEN.lastIndex - read.length + 1, kind });
    }
  }

  whole(): Value {
    const value = this.#sum();
    if (this.#next < this.#words.length) this.#fail('an operator');
    return value;
  }

  #fail(expected: string): never {
    const word = this.#words[this.#next];
    throw new Problem(
      word
        ? `Character ${word.at}: got "${word.text}", expected ${expected}.`
        : `The formula ends where ${expected} is expected.`,
    );
  }

  #takes(...signs: string[]): string | null {
    const word = this.#words[this.#next];
    if (word?.kind !== 'sign' || !signs.includes(word.text)) return null;
    ++this.#next;
    return word.text;
  }

  #sum(): Value {
    if (++this.#depth > MOST_NESTING) throw new Problem(`The formula is nested more than ${MOST_NESTING} deep.`);
    let left = this.#product();
    for (let sign = this.#takes('+', '-', '−'); sign; sign = this.#takes('+', '-', '−')) {
      const [a, b] = [left, this.#product()];
      left = sign === '+' ? (x) => a(x) + b(x) : (x) => a(x) - b(x);
    }
    --this.#depth;
    return left;
  }

  #product(): Value {
    let left = this.#signed();
    for (let sign = this.#takes('*', '·', '/'); sign; sign = this.#takes('*', '·', '/')) {
      const [a, b] = [left, this.#signed()];
      left = sign === '/' ? (x) => a(x) / b(x) : (x) => a(x) * b(x);
    }
    return left;
  }

  /** A sign binds less than a power: -x^2 is -(x^2). */
  #signed(): Value {
    let isNegative = false;
    while (this.#takes('-', '−')) isNegative = !isNegative;
    const value = this.#power();
    return isNegative ? (x) => -value(x) : value;
  }

  #power(): Value {
    const base = this.#primary();
    if (!this.#takes('^')) return base;
    if (++this.#depth > MOST_NESTING) throw new Problem(`The formula is nested more than ${MOST_NESTING} deep.`);
    const exponent = this.#signed();
    --this.#depth;
    return (x) => base(x) ** exponent(x);
  }

  #primary(): Value {
    const word = this.#words[this.#next];
    if (this.#takes('(')) {
      const value = this.#sum();
      if (!this.#takes(')')) this.#fail('")"');
      return value;
    }
    if (word?.kind === 'number') {
      ++this.#next;
      const value = Number(word.text);
      return () => value;
    }
    if (word?.kind !== 'name') this.#fail('a number, a name or "("');
    return Object.hasOwn(FUNCTIONS, word.text) ? this.#call(word.text) : this.#named(word.text);
  }

  #named(name: string): Value {
    if (!this.#known.includes(name)) throw new Problem(unknown(name, [...this.#known, ...FUNCTION_NAMES]));
    ++this.#next;
    if (!this.names.includes(name)) this.names.push(name);
    const index = this.names.indexOf(name);
    return (numbers) => numbers[index] ?? NaN;
  }

  #call(name: string): Value {
    ++this.#next;
    const { arity, of } = FUNCTIONS[name] as (typeof FUNCTIONS)[string];
    if (!this.#takes('(')) this.#fail(`"(" after ${name}`);
    const given = [this.#sum()];
    while (given.length < arity) {
      if (!this.#takes(',')) this.#fail(`"," and another number for ${name}`);
      given.push(this.#sum());
    }
    if (!this.#takes(')')) this.#fail(`")" after what ${name} takes`);
    return (numbers) => of(...given.map((each) => each(numbers)));
  }
}

function unknown(name: string, known: readonly string[]): string {
  const near = known
    .map((each) => ({ each, distance: editDistance(name, each) }))
    .sort((a, b) => a.distance - b.distance)[0];
  const starts = known.find((each) => each.startsWith(name));
  const meant = near && near.distance <= Math.max(2, name.length / 3) ? near.each : starts;
  return `Nothing is called "${name}"${meant ? `: did you mean ${meant}?` : '.'}`;
}

function editDistance(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, i) => i);
  for (let i = 1; i <= a.length; ++i) {
    const next = [i];
    for (let j = 1; j <= b.length; ++j) {
      const change = (row[j - 1] ?? 0) + (a[i - 1] === b[j - 1] ? 0 : 1);
      next.push(Math.min(change, (row[j] ?? 0) + 1, (next[j - 1] ?? 0) + 1));
    }
    row = next;
  }
  return row[b.length] ?? 0;
}

/** Reads a formula of the numbers that are `known` by name. */
export function understand(text: string, known: readonly string[]): Understood {
  try {
    const reader = new Reader(text, known);
    const value = reader.whole();
    return { formula: { names: reader.names, value } };
  } catch (error) {
    if (error instanceof Problem) return { problem: error.message };
    throw error;
  }
}
