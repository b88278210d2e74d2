import type { Signal } from '@preact/signals';
import { speedGradient } from '../draw/speed_colour';
import { fixed } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { dimension, isSpared, obstacle, shows3d } from '../scene3d/view_state';
import { lossesNow } from '../state/compared';
import { type Layer, layers, toggleLayer } from '../state/layers';
import { limit } from '../state/limit';
import { tab } from '../state/tab';

function Swatch({ name, label, isMinor = false }: { name: string; label: string; isMinor?: boolean }) {
  return (
    <div class={isMinor ? 'legend-item minor' : 'legend-item'}>
      <span class={`swatch ${name}`} />
      <span>{label}</span>
    </div>
  );
}

/** A button that shows or hides a line. */
function Switch({ layer, label, title }: { layer: Layer; label: string; title: string }) {
  const isOn = layers[layer].value;
  return (
    <button type="button" class="legend-item" aria-pressed={isOn} title={title} onClick={() => toggleLayer(layer)}>
      <span class={`swatch ${layer}`} />
      <span>{label}</span>
    </button>
  );
}

/** Why there is no 3D picture, where one could be expected. */
function Note() {
  if (dimension.value === '3d' && obstacle.value !== null) {
    return (
      <p class="obstacle warning" role="status">
        {obstacle.value}
      </p>
    );
  }
  return isSpared.value ? <p class="obstacle">No graphics card here: 3D works, but slowly.</p> : null;
}

/** What the map or the stage draws. */
interface Drawn {
  readonly bar: Signal<{ metres: number; pixels: number }>;
  /** Of the colours of speed [m/s]. */
  readonly scaleTop: Signal<number>;
  readonly ghostLabel: Signal<string | null>;
}

/** Names of the lines and colours; those that can be switched are buttons. */
export function LegendView({ bar, scaleTop, ghostLabel }: Drawn) {
  const top = inSpeedUnit(scaleTop.value);
  const ghost = ghostLabel.value;
  return (
    <div class="legend">
      <Note />
      {!shows3d.value && (
        <div class="legend-item">
          <span class="scale-bar" style={{ width: `${bar.value.pixels}px` }} />
          <span>{bar.value.metres} m</span>
        </div>
      )}
      <Swatch name="reference" label="reference" isMinor />
      <Swatch name="trace" label="driven" isMinor />
      {limit.value && (
        <Switch layer="racingLine" label="racing line" title="The line of the fastest lap possible (L)" />
      )}
      <Switch
        layer="hindsight"
        label="plan 1 s ago"
        title="The plan of a second ago and the path driven since; the outline is the position it predicted for now (O)"
      />
      {!shows3d.value && tab.value === 'laps' && lossesNow.value && (
        <Switch
          layer="timeLost"
          label="time lost"
          title="Lap A: red where it loses time to lap B, green where it gains"
        />
      )}
      {ghost !== null && <Swatch name="ghost" label={ghost} />}
      {shows3d.value && <Swatch name="rubber" label="tyres sliding" isMinor />}
      {shows3d.value && <Swatch name="brake" label="braking begins" isMinor />}
      <div class="legend-item">
        <span>plan 0</span>
        <span class="gradient" style={{ background: speedGradient() }} />
        <span>
          {fixed(top, 0)} {speedUnit().name}
        </span>
      </div>
    </div>
  );
}
