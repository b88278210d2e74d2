import { expect, it } from 'vitest';
import { refusalInWords } from './refusal';

it('says in a sentence what was refused and what is possible', () => {
  const cases = {
    'tracking_mpc.speed_limit_mps: got 9999, expected a number in [0.1, 110] m/s':
      'Speed limit cannot be 9999: choose 0.1 to 110 m/s.',
    'latency_ms: got 900, expected a number in [0, 500] ms': 'Latency cannot be 900: choose 0 to 500 ms.',
    'what if: tracking_mpc.horizon_steps: got 1.5, expected an integer in [4, 80]':
      'Horizon steps cannot be 1.5: choose 4 to 80.',
    'run.pace: got 100, expected 0.05 to 20': 'Pace cannot be 100: choose 0.05 to 20.',
    'track: got "ovel", expected one of lakeside, oval; did you mean oval?':
      'Track cannot be ovel: choose one of lakeside, oval; did you mean oval?',
  };
  for (const [message, sentence] of Object.entries(cases)) expect(refusalInWords(message)).toBe(sentence);
});

it('leaves sentences alone', () => {
  for (const sentence of ['The run is over.', 'latency_ms cannot be changed here', 'No answer: the program has ended'])
    expect(refusalInWords(sentence)).toBe(sentence);
});
