import { chosen, overlaid, toggleOverlaid } from '../state/compared';

/** What a lap is compared as: lap A, lap B, or one more that is drawn. */
export function Picks({ lap, pair, name }: { lap: number; pair: readonly [number, number]; name: string }) {
  const pick = (which: 0 | 1): void => {
    chosen.value = which === 0 ? [lap, chosen.value[1]] : [chosen.value[0], lap];
  };
  return (
    <div class="picks">
      {([0, 1] as const).map((which) => (
        <label key={which} title={`Compare as lap ${which === 0 ? 'A' : 'B'}`}>
          <input
            type="radio"
            name={`compare-${which}`}
            aria-label={`Compare ${name} as ${which === 0 ? 'A' : 'B'}`}
            checked={pair[which] === lap}
            onChange={() => pick(which)}
          />
          {which === 0 ? 'A' : 'B'}
        </label>
      ))}
      <label title="Draw beside laps A and B">
        <input
          type="checkbox"
          aria-label={`Draw ${name} too`}
          checked={overlaid.value.includes(lap)}
          onChange={() => toggleOverlaid(lap)}
        />
        +
      </label>
    </div>
  );
}
