import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { receive } from './demultiplexer';
import { attach } from './operate';
import { cursorTime } from './plot_view';
import { frameWith as frame } from './test_messages';
import { answer, ask, askedLog, chosenSettings, forgetAnswer, from, problem, question, span } from './what_if';

const answered = (state: object) => ({ ok: true, text: () => Promise.resolve(JSON.stringify(state)) });

beforeEach(() => {
  attach({ close: () => undefined, ask: () => Promise.resolve({ isTaken: true, message: '4' }) });
  chosenSettings.value = [{ key: 'latency_ms', value: 60 }];
});
afterEach(() => {
  forgetAnswer();
  [from.value, span.value, askedLog.value, cursorTime.value] = ['now', 'lap', null, null];
  vi.unstubAllGlobals();
});

describe('a question', () => {
  it('is about now, this lap, or the place of the cursor', () => {
    receive('/chicane/frame', frame({ time_s: 50, lap_time_s: 12 }), 0);
    expect(JSON.parse(question())).toEqual({ laps: 2, log: 0, settings: { latency_ms: 60 } });
    from.value = 'line';
    expect(JSON.parse(question())).toEqual({ at_s: 38, laps: 1, log: 0, settings: { latency_ms: 60 } });
    [from.value, span.value, cursorTime.value] = ['cursor', '10', 44];
    expect(JSON.parse(question())).toEqual({ at_s: 44, for_s: 10, log: 0, settings: { latency_ms: 60 } });
  });

  it('about a recording has its time line and number', () => {
    receive('/chicane/frame', frame({ time_s: 50, lap_time_s: 12 }), 0);
    const nobody = () => Promise.reject(new Error());
    askedLog.value = { which: () => 1, position: () => 150, ask: nobody };
    expect(JSON.parse(question())).toMatchObject({ at_s: 150, log: 1 });
    from.value = 'line';
    expect(JSON.parse(question())).toMatchObject({ at_s: 138 });
  });
});

describe('an answer', () => {
  const done = { id: 4, state: 'done', at_s: 1, was: {}, branch: {} };

  it('is waited for', async () => {
    const replies = [{ id: 4, state: 'computing', share: 0.5 }, done];
    vi.stubGlobal('fetch', () => Promise.resolve(answered(replies.shift() ?? {})));
    await ask();
    expect(answer.value?.at).toBe(1);
    expect(problem.value).toBe('');
  });

  it('that cannot be given is said, and so is that another question took its place', async () => {
    vi.stubGlobal('fetch', () => Promise.resolve(answered({ id: 4, state: 'failed', why: 'the run has not begun' })));
    await ask();
    expect(problem.value).toBe('the run has not begun');
    vi.stubGlobal('fetch', () => Promise.resolve(answered({ ...done, id: 5 })));
    await ask();
    expect(problem.value).toMatch(/another question/);
    attach({ close: () => undefined, ask: () => Promise.resolve({ isTaken: false, message: 'watch only' }) });
    await ask();
    expect(problem.value).toBe('watch only');
    expect(answer.value).toBeNull();
  });

  it('is forgotten when the run begins anew', async () => {
    vi.stubGlobal('fetch', () => Promise.resolve(answered(done)));
    receive('/chicane/frame', frame({ time_s: 60 }), 0);
    await ask();
    expect(answer.value).not.toBeNull();
    receive('/chicane/frame', frame({ time_s: 0 }), 0);
    expect(answer.value).toBeNull();
  });
});
