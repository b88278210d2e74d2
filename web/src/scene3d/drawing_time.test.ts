import { expect, it } from 'vitest';
import { DrawingTime, type Fences } from './drawing_time';

/** Draws until told that it is done. */
class Drawer {
  isDone = false;
  open = 0;
  flushed = 0;
  readonly SYNC_GPU_COMMANDS_COMPLETE = 1;
  readonly SYNC_STATUS = 2;
  readonly SIGNALED = 3;
  fenceSync = (): WebGLSync => {
    ++this.open;
    return {} as WebGLSync;
  };
  deleteSync = (): void => void --this.open;
  getSyncParameter = (): number => (this.isDone ? this.SIGNALED : 0);
  flush = (): void => void ++this.flushed;
}

const pair = (): [Drawer, DrawingTime] => {
  const drawer = new Drawer();
  return [drawer, new DrawingTime(drawer as unknown as Fences)];
};

it('is free at first', () => {
  const [, time] = pair();
  expect(time.isDrawn(0)).toBe(false);
  expect(time.isFree(0)).toBe(true);
});

it('waits for the last picture, and then half as long again', () => {
  const [drawer, time] = pair();
  time.begin(100);
  expect(drawer.flushed).toBe(1);
  expect([time.isDrawn(150), time.isFree(150)]).toEqual([false, false]);
  drawer.isDone = true;
  expect([time.isDrawn(160), time.isFree(160)]).toEqual([true, false]);
  expect([time.isDrawn(180), time.isFree(180)]).toEqual([false, false]);
  expect(time.isFree(190)).toBe(true);
  expect(drawer.open).toBe(0);
});

it('does not rest for long, however long a picture took', () => {
  const [drawer, time] = pair();
  time.begin(0);
  drawer.isDone = true;
  expect([time.isDrawn(8000), time.isFree(8000)]).toEqual([true, false]);
  expect(time.isFree(8250)).toBe(true);
});
