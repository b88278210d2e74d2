import { beforeEach, expect, it } from 'vitest';
import { store } from '../lib/store';
import { Column } from './columns';
import { receive } from './demultiplexer';
import { live } from './live';
import { isFrozen, plotted, thaw, timeRange, toggleFrozen, windowSeconds, zoomed, zoomTo } from './plot_view';
import { frameWith } from './test_messages';

const see = (time: number): void => receive('/chicane/frame', frameWith({ time_s: time }), 0);

beforeEach(() => {
  store.reset('moment');
  live.frame = null;
  thaw();
  windowSeconds.value = 20;
  for (let time = 0; time <= 30; ++time) see(time);
});

it('follows the run', () => {
  expect(timeRange()).toEqual([10, 30]);
  windowSeconds.value = 10;
  expect(timeRange()).toEqual([20, 30]);
  see(31);
  expect(timeRange()).toEqual([21, 31]);
});

it('stands still while the run goes on', () => {
  toggleFrozen();
  see(31);
  expect(timeRange()).toEqual([10, 30]);
  expect(plotted().newest(Column.time_s)).toBe(30);
  expect(live.plots.newest(Column.time_s)).toBe(31);
  toggleFrozen();
  expect(timeRange()).toEqual([11, 31]);
});

it('zooms into a stretch of time, which stands still too', () => {
  zoomTo(12, 14);
  expect(isFrozen.value).toBe(true);
  see(60);
  expect(timeRange()).toEqual([12, 14]);
  thaw();
  expect(zoomed.value).toBeNull();
  expect(timeRange()).toEqual([40, 60]);
});

it('takes a click for no zoom', () => {
  zoomTo(12, 12.01);
  expect(isFrozen.value).toBe(false);
});
