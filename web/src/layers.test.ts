import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';
import { expect, it } from 'vitest';

// Which folder may import which, as tools/layers.txt says for C++. An import of types alone is none: it leaves no trace
// in the page.

const ALLOWED: Readonly<Record<string, readonly string[]>> = {
  protocol: ['lib'],
  lib: ['protocol'],
  page: ['protocol', 'lib'],
  draw: ['lib', 'state'],
  state: ['protocol', 'lib', 'draw'],
  scene3d: ['draw', 'state', 'protocol', 'lib'],
  parts: ['state', 'draw', 'protocol', 'lib'],
  document: ['parts', 'state', 'protocol', 'lib'],
  recording: ['parts', 'scene3d', 'draw', 'state', 'protocol', 'lib', 'page'],
  views: ['parts', 'recording', 'scene3d', 'draw', 'state', 'protocol', 'lib', 'page'],
};

const root = new URL('.', import.meta.url).pathname;
const files = readdirSync(root, { recursive: true })
  .map(String)
  .filter((name) => /\.tsx?$/.test(name) && !/\.test\.tsx?$|\.d\.ts$/.test(name));

/** The files that each file imports, without types. */
const imports = new Map(
  files.map((name) => {
    const text = readFileSync(join(root, name), 'utf8');
    const found = [
      ...text.matchAll(/^(?:import|export)\s+(?!type\b)(?:\{([^}]*)\}|[^'"]*)?(?:\s*from\s*)?'(\.[^']*)'/gms),
    ];
    const paths = found
      .filter(
        ([, names]) => names === undefined || names.split(',').some((each) => each.trim() && !/^\s*type\b/.test(each)),
      )
      .map(([, , path]) => normalize(join(dirname(name), path ?? '')));
    const known = paths.flatMap((path) => [`${path}.ts`, `${path}.tsx`].filter((each) => files.includes(each)));
    return [name, known] as const;
  }),
);
const folderOf = (name: string): string => dirname(name);

it('imports go from a folder to those below it', () => {
  const wrong: string[] = [];
  for (const [name, targets] of imports)
    for (const target of targets) {
      const [from, to] = [folderOf(name), folderOf(target)];
      if (from === '.' || from === to || ALLOWED[from]?.includes(to)) continue;
      wrong.push(`${name} imports ${target}`);
    }
  expect(wrong).toEqual([]);
});

it('all state that outlives a view is in the store', () => {
  const wrong = files.flatMap((name) => {
    const lines = readFileSync(join(root, name), 'utf8').split('\n');
    const isStore = ['lib/store.ts', 'lib/persisted.ts'].includes(name); // persisted.ts: what the browser keeps
    const isBeside = (line: string): boolean => /^(export )?(let|var) |^(export )?const \w+ = signal[(<]/.test(line);
    return isStore ? [] : lines.filter(isBeside).map((line) => `${name}: ${line}`);
  });
  expect(wrong).toEqual([]);
});

it('sees the imports', () => {
  expect(imports.get('state/shown.ts')).toContain('state/link.ts');
});
