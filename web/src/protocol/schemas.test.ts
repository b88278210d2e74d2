import { parse } from '@foxglove/rosmsg';
import { ros2humble, ros2jazzy } from '@foxglove/rosmsg-msgs-common';
import { describe, expect, it } from 'vitest';
import { topics } from './test_fixtures';

type Definitions = ReturnType<typeof parse>;

/** Name → fields, without what does not reach the wire (comments, default values). */
function fieldsOf(definitions: Definitions): Map<string, string[]> {
  const named = new Map<string, string[]>();
  for (const { name, definitions: fields } of definitions) {
    const lines = fields.map(
      (f) =>
        `${f.type}${f.isArray ? `[${f.arrayLength ?? ''}]` : ''} ${f.name}${f.isConstant ? `=${String(f.value)}` : ''}`,
    );
    named.set((name ?? '').replace('/msg/', '/'), lines);
  }
  return named;
}

describe.each([
  ['Humble', ros2humble],
  ['Jazzy', ros2jazzy],
])('schema texts against ROS 2 %s', (_release, known) => {
  const standard = fieldsOf(Object.values(known) as unknown as Definitions);

  it.each(topics.map(({ type, schema }) => [type, schema] as const))('%s', (type, schema) => {
    const ours = parse(schema, { ros2: true });
    // The first definition has no name of its own: it is the type itself.
    const named = fieldsOf(ours.map((each, i) => (i === 0 ? { ...each, name: type } : each)));
    let compared = 0;
    for (const [name, fields] of named) {
      if (!standard.has(name)) {
        expect(name).toMatch(/^(chicane_msgs|ackermann_msgs|foxglove_msgs)\//);
        continue;
      }
      expect(fields, name).toEqual(standard.get(name));
      ++compared;
    }
    expect(compared > 0 || type.startsWith('chicane_msgs')).toBe(true);
  });
});
