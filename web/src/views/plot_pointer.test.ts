import { beforeEach, expect, it, vi } from 'vitest';
import { type Chart, chartOn, ROOM } from '../draw/chart';
import { store } from '../lib/store';
import { receive } from '../state/demultiplexer';
import { cursorTime, markTime, thaw, windowSeconds, zoomed } from '../state/plot_view';
import { frameWith } from '../state/test_messages';
import { PlotPointer } from './plot_pointer';

const see = (time: number): void => receive('/chicane/frame', frameWith({ time_s: time }), 0);
/** Ten pixels to a second. */
const chartFrom = (from: number): Chart =>
  chartOn(
    {} as CanvasRenderingContext2D,
    { width: 200 + ROOM.left + ROOM.right, height: 90 },
    [from, from + 20],
    [0, 1],
  );

const select = vi.fn();
let pointer: PlotPointer;

beforeEach(() => {
  store.reset('moment');
  thaw();
  windowSeconds.value = 20;
  for (let time = 0; time <= 30; ++time) see(time);
  select.mockClear();
  pointer = new PlotPointer(() => 400, select);
  pointer.chart = chartFrom(10);
});

it('the cursor is at the nearest sample', () => {
  pointer.move(54);
  expect(cursorTime.value).toBe(15);
  pointer.move(56);
  expect(cursorTime.value).toBe(16);
  pointer.leave();
  expect(cursorTime.value).toBeNull();
});

it('a click marks its own place, whatever the cursor was before, and before anything is drawn', () => {
  cursorTime.value = 29;
  pointer.press(50, 0);
  pointer.release(50);
  expect(markTime.value).toBe(15);
});

it('other buttons neither mark nor zoom', () => {
  pointer.press(50, 2);
  pointer.move(150);
  pointer.release(150);
  expect([markTime.value, zoomed.value]).toEqual([null, null]);
  expect(select).not.toHaveBeenCalled();
});

it('a drag zooms to what it passed over, and no farther than the plot reaches', () => {
  pointer.press(50, 0);
  pointer.move(100);
  expect(select).toHaveBeenLastCalledWith([50, 100]);
  pointer.release(900);
  expect(zoomed.value).toEqual([15, 30]);
  expect(select).toHaveBeenLastCalledWith(null);
  thaw();
  pointer.press(50, 0);
  pointer.release(-40);
  expect(zoomed.value).toEqual([10, 15]);
});

it('a drag that the browser takes away does nothing', () => {
  pointer.press(50, 0);
  pointer.move(100);
  pointer.cancel();
  pointer.release(100);
  expect([markTime.value, zoomed.value]).toEqual([null, null]);
});

it('the cursor follows a pointer that rests while the plot moves on', () => {
  pointer.move(100);
  expect(cursorTime.value).toBe(20);
  pointer.chart = chartFrom(14);
  pointer.follow();
  expect(cursorTime.value).toBe(24);
  pointer.leave();
  pointer.follow();
  expect(cursorTime.value).toBeNull();
});

it('a click before the first picture of a plot counts, too', () => {
  pointer.chart = null;
  pointer.press(100, 0);
  pointer.release(100);
  expect(markTime.value).toBe(15);
  expect(zoomed.value).toBeNull();
});

it('without measurements there is no cursor', () => {
  store.reset('moment');
  pointer.move(100);
  expect(cursorTime.value).toBeNull();
});
