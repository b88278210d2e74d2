// Heading of a comparison: a sentence in which A and B can be chosen.
import { lapTime } from '../lib/format';
import { capital } from '../lib/words';
import { type Comparison, type Course, headlineOf } from '../state/comparison';
import { Select } from './controls';

interface WordOptions {
  readonly label: string;
  readonly name: string;
  readonly course: Course;
  readonly courses: readonly Course[];
  readonly choose: (id: string) => void;
}

/** A word of the sentence that can be chosen: a native select lies on it. */
function Word({ label, name, course, courses, choose }: WordOptions) {
  return (
    <span class={label === 'B' ? 'chosen other' : 'chosen'}>
      <span aria-hidden="true">{name}</span>
      <Select
        class="cover"
        label={label}
        value={course.id}
        choose={choose}
        choices={courses.map(({ id, name: each, total }) => ({
          value: id,
          label: Number.isFinite(total) ? `${capital(each)}, ${lapTime(total, 3)}` : capital(each),
        }))}
      />
    </span>
  );
}

interface Options {
  readonly comparison: Comparison;
  readonly courses: readonly Course[];
  readonly choose: (which: 0 | 1, id: string) => void;
  /** Of the heading; 1 without it. */
  readonly level?: 1 | 2;
}

/** "Lap 3 lost 3.45 s to the limit; T4 cost most, 1.08 s.": A and B can be chosen. */
export function Headline({ comparison, courses, choose, level = 1 }: Options) {
  const Heading = `h${level}` as const;
  const { a, b } = comparison;
  const { verb, amount, tone, to, rest } = headlineOf(comparison);
  return (
    <Heading class="verdict grow" data-testid="headline">
      <Word
        label="A"
        name={capital(a.name)}
        course={a}
        courses={courses.filter(({ id }) => id !== b.id && id !== 'limit')}
        choose={(id) => choose(0, id)}
      />
      {verb}
      {amount !== '' && <b class={`keep ${tone}`}>{amount}</b>}
      {to}
      <Word
        label="B"
        name={b.name}
        course={b}
        courses={courses.filter(({ id }) => id !== a.id)}
        choose={(id) => choose(1, id)}
      />
      {rest}
    </Heading>
  );
}
