import { expect, it } from 'vitest';
import { modeOf } from './mode';

it('reads the recordings of a replay, and where to begin', () => {
  const mode = modeOf({
    mode: 'replay',
    logs: [{ name: 'run.mcap', url: '/log/0.mcap' }, { name: 'no url' }],
    start_s: 12,
  });
  expect(mode).toEqual({ name: 'replay', logs: [{ name: 'run.mcap', url: '/log/0.mcap' }], start: 12 });
});

it('takes anything else for a live run', () => {
  for (const answer of [null, 'replay', {}, { mode: 'live' }, []]) expect(modeOf(answer)).toEqual({ name: 'live' });
});
