import { capital, lastPart, nameInWords } from './words';

// What the program refuses, as a sentence. It says `key: got X, expected Y`, for files and terminals.

/** "key: got X, expected Y", also with the prefix of questions. */
const REFUSAL = /^(?:what if: )?([a-z][\w.-]*): got (.+?), expected (.+)$/s;
const NUMBER = /^a(?:n integer| number) in \[([^,\]]+), ([^\]]+)\](?: (.+))?$/;

/** The text without its quotation marks. */
const unquoted = (text: string): string => text.replace(/^"(.*)"$/s, '$1');

/** The last part of a key, without its unit: "speed limit" of `tracking_mpc.speed_limit_mps`. */
const settingInWords = (key: string): string =>
  capital(nameInWords(lastPart(key).replace(/_(mps2?|radps|rad|deg|ms|s|m|kg|n|hz)$/, '')));

/** "Speed limit cannot be 9999: choose 0.1 to 110 m/s." All other sentences stay as they are. */
export function refusalInWords(sentence: string): string {
  const [, key, got, expected] = REFUSAL.exec(sentence) ?? [];
  if (key === undefined || got === undefined || expected === undefined) return sentence;
  const [, low, high, unit] = NUMBER.exec(expected) ?? [];
  const choice = low === undefined ? `choose ${expected}` : `choose ${low} to ${high}${unit ? ` ${unit}` : ''}`;
  return `${settingInWords(key)} cannot be ${unquoted(got)}: ${choice}${/[.?]$/.test(choice) ? '' : '.'}`;
}
