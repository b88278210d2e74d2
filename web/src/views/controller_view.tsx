// State of controller, solver, gate and road, in words.
import { plural, UNKNOWN } from '../lib/format';
import { gateInWords, roadInWords, type Sentence, sightInWords, worstInWords } from '../lib/words';
import { Sign } from '../parts/controls';
import type { Frame } from '../protocol/topics';
import { run } from '../state/run';
import { solverInWords } from '../state/sentence';
import { shown } from '../state/shown';
import { situation, situationInWords } from '../state/situation';

/** A label with a sentence. */
function Row({ label, sentence, id }: { label: string; sentence: Sentence | null; id: string }) {
  return (
    <div>
      <dt>{label}</dt>
      <dd data-testid={id}>
        {sentence && <Sign of={sentence.severity} />}
        {sentence?.text ?? UNKNOWN}
      </dd>
    </div>
  );
}

/** The constraint that is violated most, in words. */
function constraints(solved: Frame): Sentence {
  const worst = worstInWords(solved, run.value?.constraint_names ?? []);
  return worst ? { severity: 'warning', text: worst } : { severity: 'good', text: 'All constraints hold' };
}

/** How the solve ended, in words. */
function solver(solved: Frame): Sentence {
  const { severity, text } = solverInWords(solved);
  return { severity, text: solved.iterations > 0 ? `${text}, ${plural(solved.iterations, 'iteration')}` : text };
}

/** How accurate the solution is. */
function accuracy({ stationarity, violation }: Frame): string {
  const exact = violation === 0 ? 'exact' : `to ${violation.toExponential(1)}`;
  return [
    Number.isFinite(stationarity) ? `optimal to ${stationarity.toExponential(1)}` : '',
    Number.isFinite(violation) ? `constraints ${exact}` : '',
  ]
    .filter(Boolean)
    .join(' · ');
}

/** State of controller, solver, gate and road in words. */
export function ControllerView() {
  const frame = shown.value;
  // Controllers such as PID have no solver.
  const solved = frame && (frame.iterations > 0 || /mpc$/.test(run.value?.controller ?? '')) ? frame : null;
  return (
    <section class="stack" aria-label="Controller">
      <h2>{run.value?.controller ?? 'Controller'}</h2>
      <dl class="rows">
        <Row id="rung" label="Driving" sentence={situation.value && situationInWords(situation.value)} />
        <Row id="status" label="Solver" sentence={solved && solver(solved)} />
        <Row id="constraints" label="Constraints" sentence={solved && constraints(solved)} />
        <Row id="gate" label="Gate" sentence={frame && gateInWords(frame)} />
        <Row id="road" label="Road" sentence={frame && roadInWords(frame)} />
        <Row id="sight" label="Sight" sentence={frame && sightInWords(frame.has_map, frame.sight_m)} />
      </dl>
      {solved && <p class="soft">{accuracy(solved)}</p>}
    </section>
  );
}
