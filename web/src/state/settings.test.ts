import { beforeEach, describe, expect, it } from 'vitest';
import { readSchema } from '../protocol/schema';
import type { SetAnswer, Setting } from '../protocol/source';
import { refusals, SettingRequests, schema, settingChanges, settings, startSettings } from './settings';

/** A server that answers when told to. */
function server() {
  const asked: { key: string; value: Setting; answer: (answer: SetAnswer) => Promise<void> }[] = [];
  const requests = new SettingRequests(
    (key, value) =>
      new Promise((resolve) =>
        asked.push({
          key,
          value,
          answer: async (answer) => {
            resolve(answer);
            await new Promise((next) => setTimeout(next));
          },
        }),
      ),
  );
  return { requests, asked };
}

beforeEach(() => {
  settings.value = new Map<string, Setting>([
    ['latency_ms', 100],
    ['run.pace', 1],
  ]);
  schema.value = readSchema([
    { key: 'latency_ms', kind: 'number', start: 100 },
    { key: 'run.pace', kind: 'number' },
  ]);
  refusals.value = new Map();
});

describe('requests', () => {
  it('snap back when refused, with the sentence until the next success', async () => {
    const { requests, asked } = server();
    void requests.set('latency_ms', 900);
    await asked[0]?.answer({ value: 100, sentence: 'latency_ms: got 900' });
    expect(settings.value.get('latency_ms')).toBe(100);
    expect(refusals.value.get('latency_ms')).toBe('latency_ms: got 900');
    void requests.set('latency_ms', 90);
    await asked[1]?.answer({ value: 90, sentence: null });
    expect(refusals.value.size).toBe(0);
  });

  it('show at once and never queue: of what comes while one is on its way only the newest follows', async () => {
    const { requests, asked } = server();
    for (const value of [110, 120, 130, 140]) void requests.set('latency_ms', value);
    expect(asked).toHaveLength(1);
    requests.receive(new Map([['latency_ms', 110]])); // told to all viewers meanwhile
    expect(settings.value.get('latency_ms')).toBe(140);
    await asked[0]?.answer({ value: 110, sentence: null });
    expect(asked.map(({ value }) => value)).toEqual([110, 140]);
    expect(settings.value.get('latency_ms')).toBe(140);
    await asked[1]?.answer({ value: 140, sentence: null });
    expect(settings.value.get('latency_ms')).toBe(140);
  });

  it('keep what is shown when the connection is lost', async () => {
    const { requests, asked } = server();
    void requests.set('latency_ms', 150);
    await asked[0]?.answer({ value: null, sentence: 'the connection was lost' });
    expect(refusals.value.get('latency_ms')).toMatch(/lost/);
  });

  it('take what others have set', () => {
    const { requests } = server();
    requests.receive(new Map([['latency_ms', 50]]));
    expect(settings.value.get('latency_ms')).toBe(50);
  });
});

describe('changes', () => {
  it('list what differs from the start, without the controls of the page', () => {
    settings.value = new Map<string, Setting>([
      ['latency_ms', 150],
      ['run.pace', 4],
    ]);
    expect(settingChanges.value).toEqual([{ key: 'latency_ms', from: 100, to: 150 }]);
    settings.value = startSettings.value;
    expect(settingChanges.value).toEqual([]);
  });
});

describe('the schema', () => {
  it('is read with care', () => {
    const values = { minimum: 0, maximum: 1, choices: [], default: 0.5, start: 0.25 };
    const named = { key: 'a.b', group: 'a', kind: 'number', unit: 'm', meaning: 'x' };
    const good = { ...named, is_live: true, is_fixed: true, ...values };
    expect(readSchema([good, null, 7, { key: 'x' }, { ...good, kind: 'matrix' }])).toEqual([good]);
    const unknown = { unit: '', minimum: null, maximum: null, choices: [], default: null, start: null, meaning: '' };
    const least = { key: 'a.b', kind: 'bool' };
    expect(readSchema([least])).toEqual([{ ...least, group: 'a', is_live: true, is_fixed: false, ...unknown }]);
    expect(readSchema({})).toEqual([]);
  });
});
