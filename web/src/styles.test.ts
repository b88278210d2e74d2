import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { expect, it } from 'vitest';
import { toneOf } from './draw/theme';
import { TONES } from './parts/plot';

const root = new URL('.', import.meta.url).pathname;
const sheets = readdirSync(root, { recursive: true })
  .map(String)
  .filter((name) => name.endsWith('.css') && !name.endsWith('tokens.css'));

const COLOUR = /#[0-9a-f]{3,8}\b(?=[;, )])|\b(?:rgb|hsl|oklch)a?\(/gi;
const DISTANCE = /\b(?:gap|padding|margin)[a-z-]*:[^;{}]*?\b\d*\.?\d+(?:px|r?em)\b/g;
const SIZE = /\bfont(?:-size)?:[^;{}]*?\b\d*\.?\d+(?:px|r?em)\b/g;
/** What follows from the shape of a thing: half of its own size, a hairline, or units of its own drawing. */
const OWN_SHAPE = /\.start-mark|\.pad-stick|\[type="checkbox"\]/;

it('colours, distances and sizes of text come from tokens.css', () => {
  const found = sheets.flatMap((name) => {
    const text = readFileSync(join(root, name), 'utf8').replace(/\/\*.*?\*\//gs, '');
    const rules = text.split('}').filter((rule) => !OWN_SHAPE.test(rule));
    return rules.flatMap((rule) =>
      [COLOUR, DISTANCE, SIZE].flatMap((literal) => (rule.match(literal) ?? []).map((each) => `${name}: ${each}`)),
    );
  });
  expect(found).toEqual([]);
});

it('every token that is used is there', () => {
  const tokens = readFileSync(join(root, 'styles/tokens.css'), 'utf8');
  const own = /--(?:tone|share|least)\b/; // set by the element itself
  const missing = sheets.flatMap((name) =>
    [...readFileSync(join(root, name), 'utf8').matchAll(/var\((--[\w-]+)/g)]
      .map(([, token]) => token ?? '')
      .filter((token) => !own.test(token) && !tokens.includes(`${token}:`))
      .map((token) => `${name}: ${token}`),
  );
  expect(missing).toEqual([]);
  const ofCharts = [...Object.values(TONES), ...Array.from({ length: 10 }, (_, i) => toneOf(i).slice(6, -1))];
  expect(ofCharts.filter((token) => !tokens.includes(`--${token}:`))).toEqual([]);
});
