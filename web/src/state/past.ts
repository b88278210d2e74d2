// Frames from before the page was opened, until all of them have arrived.
import type { Frame } from '../protocol/topics';

/** Least time between two updates with frames of the past, except for the last one [ms]; chosen. */
const SHOWN_EVERY_MS = 1000;

/**
 * Frames of the run before the page was opened, which arrive behind the present ones, the newest first; and the frames
 * since then. Together they are all known frames of the run.
 */
export class Past {
  #before: Frame[] = []; // the newest first
  #since: Frame[] = [];
  #isExpected = false; // the past may still follow
  #shown = 0; // frames at the last update
  #shownAt = Number.NEGATIVE_INFINITY;

  /** A connection begins: the past of its run may follow. */
  expect(): void {
    this.#before = [];
    this.#since = [];
    this.#shown = 0;
    this.#shownAt = Number.NEGATIVE_INFINITY;
    this.#isExpected = true;
  }

  /** Drops all frames: the run has begun again, and those still to come belong to the run before. */
  drop(): void {
    this.#before = [];
    this.#since = [];
    this.#isExpected = false;
  }

  keepBefore(frame: Frame): void {
    if (this.#isExpected) this.#before.push(frame);
  }

  keepNew(frame: Frame): void {
    if (this.#isExpected) this.#since.push(frame);
  }

  /**
   * All frames so far by time, when they are due: when all are here (`left` is 0), or twice as many as at the last
   * update; null otherwise. Once all are here none is kept.
   */
  take(left: number, now: number): readonly Frame[] | null {
    if (!this.#isExpected || this.#before.length === 0) {
      if (left === 0) this.drop();
      return null;
    }
    const isTime = this.#before.length >= 2 * this.#shown && now - this.#shownAt >= SHOWN_EVERY_MS;
    if (left > 0 && !isTime) return null;
    this.#shown = this.#before.length;
    this.#shownAt = now;
    const first = this.#since[0]?.time_s ?? Number.POSITIVE_INFINITY;
    // The newest of before and the first of the present may be the same one.
    const all = [...this.#before.filter(({ time_s }) => time_s < first).reverse(), ...this.#since];
    if (left === 0) this.drop();
    return all;
  }
}
