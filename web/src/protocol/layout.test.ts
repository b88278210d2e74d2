import { readFileSync } from 'node:fs';
import { parse } from '@foxglove/rosmsg';
import { expect, it } from 'vitest';
import { topics } from './test_fixtures';

const layout = JSON.parse(readFileSync(new URL('../../../data/layouts/foxglove.json', import.meta.url), 'utf8')) as {
  configById: Record<string, { paths?: { value: string }[]; topics?: Record<string, unknown>; topicToRender?: string }>;
  layout: unknown;
};

const fieldsOf = (topic: string): string[] => {
  const schema = topics.find((each) => each.topic === topic)?.schema;
  if (schema === undefined) throw new Error(`the layout names ${topic}, which no server sends`);
  return parse(schema, { ros2: true })[0]?.definitions.map(({ name }) => name) ?? [];
};

const panels = Object.values(layout.configById);

it('plots fields that exist', () => {
  const paths = panels.flatMap((panel) => panel.paths ?? []).map(({ value }) => value.split('.') as [string, string]);
  expect(paths.length).toBeGreaterThan(0);
  for (const [topic, field] of paths) expect(fieldsOf(topic)).toContain(field);
});

it('draws topics that exist', () => {
  const drawn = panels.flatMap((panel) => [
    ...Object.keys(panel.topics ?? {}),
    ...(panel.topicToRender ? [panel.topicToRender] : []),
  ]);
  expect(drawn.length).toBeGreaterThan(4);
  for (const topic of drawn) expect(fieldsOf(topic).length).toBeGreaterThan(0);
});

it('shows each of its panels once', () => {
  const shown =
    JSON.stringify(layout.layout)
      .match(/"[A-Za-z0-9]+![a-z]+"/g)
      ?.map((name) => name.slice(1, -1)) ?? [];
  expect(shown.sort()).toEqual(Object.keys(layout.configById).sort());
});
