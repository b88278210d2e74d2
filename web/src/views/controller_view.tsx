import { plural, UNKNOWN } from '../lib/format';
import { gateInWords, roadInWords, type Sentence, sightInWords, statusInWords } from '../lib/words';
import { run } from '../state/run';
import { shown } from '../state/shown';
import { situation, situationInWords } from '../state/situation';

function Row({ label, sentence, id }: { label: string; sentence: Sentence | null; id: string }) {
  return (
    <div class="row">
      <dt>{label}</dt>
      <dd data-testid={id}>
        {sentence ? <span class={`severity ${sentence.severity}`} aria-hidden="true" /> : null}
        {sentence?.text ?? UNKNOWN}
      </dd>
    </div>
  );
}

/** State of controller, solver, gate and road in words. */
export function ControllerView() {
  const frame = shown.value;
  const solve = frame ? statusInWords(frame.solve_status) : null;
  const turns = frame && frame.iterations > 0 ? `, ${plural(frame.iterations, 'iteration')}` : '';
  return (
    <section class="block" aria-label="Controller">
      <h2>{run.value?.controller ?? 'Controller'}</h2>
      <dl class="rows">
        <Row id="rung" label="Driving" sentence={situation.value && situationInWords(situation.value)} />
        <Row id="status" label="Solver" sentence={solve ? { ...solve, text: solve.text + turns } : null} />
        <Row id="gate" label="Gate" sentence={frame ? gateInWords(frame) : null} />
        <Row id="road" label="Road" sentence={frame ? roadInWords(frame) : null} />
        <Row id="sight" label="Sight" sentence={frame ? sightInWords(frame.has_map, frame.sight_m) : null} />
      </dl>
    </section>
  );
}
