import { useComputed } from '@preact/signals';
import { rangeAboutZero } from '../draw/axis';
import { FUNCTION_NAMES } from '../lib/formula';
import { FRAME_NUMBERS } from '../protocol/messages';
import { formulaText, ownChannel, ownFormula } from '../state/own_channel';
import { type PlotSpec, TimePlot } from './time_plot';

const specOf = (text: string): PlotSpec => ({
  title: 'Your own',
  unit: text,
  decimals: 3,
  series: [{ column: -1, compute: ownChannel, label: text, colour: 0 }],
  range: (columns) => rangeAboutZero(columns, 1e-3),
});

/** A plot by the reader's formula, and the field for it. */
export function OwnPlot() {
  const read = ownFormula.value;
  const spec = useComputed(() => specOf(formulaText.value.trim()));
  const problem = read !== null && 'problem' in read ? read.problem : null;
  return (
    <>
      {read !== null && problem === null && <TimePlot key="own" spec={spec.value} />}
      <section class="block own-formula" aria-label="A plot of your own">
        <label>
          <span>Plot a formula</span>
          <input
            type="text"
            list="frame-numbers"
            spellcheck={false}
            autocomplete="off"
            placeholder="speed_mps * yaw_rate_radps"
            value={formulaText.value}
            aria-invalid={problem !== null}
            aria-describedby="formula-help"
            onChange={({ currentTarget }) => (formulaText.value = currentTarget.value)}
          />
        </label>
        <datalist id="frame-numbers">
          {FRAME_NUMBERS.map((name) => (
            <option key={name} value={name} />
          ))}
        </datalist>
        {problem !== null && <p role="alert">{problem}</p>}
        <p id="formula-help" class="soft">
          Numbers of a frame by name, + − * / ^, and {FUNCTION_NAMES.join(', ')}. The browser keeps it.
        </p>
      </section>
    </>
  );
}
