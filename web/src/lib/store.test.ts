import { expect, it } from 'vitest';
import { beginSession, receive } from '../state/demultiplexer';
import { requests } from '../state/operate';
import { changeAt, frameWith, lapWith, planWith, runWith } from '../state/test_messages';
import { store } from './store';

it('one reset puts back all that belongs to a run', () => {
  beginSession(); // tests of other files may share the store
  const first = structuredClone(store.peek());
  receive('/chicane/run', runWith({ track_length_m: 1000, notices: ['assumed'], fault_names: ['ice'] }), 0);
  for (let i = 0; i < 50; ++i)
    receive(
      '/chicane/frame',
      frameWith({ time_s: i, s_m: 30 * i, lap_time_s: i, rung: i % 3, active_faults: i % 2 }),
      i,
    );
  receive('/chicane/plan', planWith(), 0);
  receive('/chicane/lap', lapWith(1, 30), 0);
  receive('/chicane/change', changeAt(3, 'latency_ms', '60'), 0);
  receive('/chicane/limit', { is_known: false, why_not: 'the road is open' } as never, 0);
  requests.receive(new Map([['latency_ms', 60]]));
  expect(store.peek()).not.toEqual(first);
  beginSession();
  expect(store.peek()).toEqual(first);
});

it('another moment leaves what belongs to the run', () => {
  const [moment, run, page] = (['moment', 'run', 'page'] as const).map((lasts) => store.signal(lasts, 0));
  const fields = store.data('moment', () => ({ list: [] as number[] }));
  const set = (): void => {
    for (const each of [moment, run, page]) if (each) each.value = 1;
    fields.list.push(1);
  };
  const now = (): unknown[] => [moment?.value, run?.value, page?.value, fields.list.length];
  set();
  store.reset('moment');
  expect(now()).toEqual([0, 1, 1, 0]);
  set();
  store.reset('run');
  expect(now()).toEqual([0, 0, 1, 0]);
});
