// The one drawing loop of the page.
import { store } from '../lib/store';

/** Work at a repaint; `now` as of performance.now() [ms]. */
type Task = (now: number) => void;

const tasks = new Set<Task>();
/** Whether a repaint is requested. */
const loop = store.data('page', () => ({ isRunning: false }));

/** Runs all tasks, and requests the next repaint as long as there are any. */
function turn(now: number): void {
  for (const task of tasks) task(now);
  if (tasks.size > 0) requestAnimationFrame(turn);
  else loop.isRunning = false;
}

/**
 * Calls `task` before each repaint, at most once in `interval` [ms]. Hidden pages do not repaint. Returns a function
 * that ends it.
 */
export function everyFrame(task: Task, interval = 0): () => void {
  let last = -Infinity;
  const paced: Task = (now) => {
    // Half a repaint of tolerance: 50 ms of a 60 Hz screen are three repaints, not four.
    if (now - last < interval - 8) return;
    last = now;
    task(now);
  };
  tasks.add(paced);
  if (!loop.isRunning) {
    loop.isRunning = true;
    requestAnimationFrame(turn);
  }
  return () => void tasks.delete(paced);
}
