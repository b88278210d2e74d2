import { store } from '../lib/store';
import {
  applyLayout,
  besideChosen,
  deleteLayout,
  FIRST_LAYOUT,
  hasInstruments,
  layouts,
  layoutText,
  linkToLayout,
  moved,
  PLOTS,
  type Plot,
  panels,
  plots,
  saveLayout,
  setBeside,
  setPanels,
  setPlots,
} from '../state/layout';
import { TABS, type Tab } from '../state/tab';
import { Copied } from './copied';
import { Dialog } from './help_view';

const isOpen = store.signal('page', false);

export const openLayout = (): void => {
  isOpen.value = true;
};

const PLOT_TITLES: Readonly<Record<Plot, string>> = {
  speed: 'Speed',
  lateral: 'Lateral error',
  heading: 'Heading error',
  steering: 'Steering',
  drive: 'Drive',
  grip: 'Grip used',
  accelerations: 'Accelerations',
  cost: 'Cost',
  iterations: 'Iterations',
  step: 'Control step',
  histogram: 'Step times',
  own: 'A formula of your own',
};

interface ListOptions<T extends string> {
  readonly legend: string;
  readonly all: readonly T[];
  readonly shown: readonly T[];
  readonly titleOf: (name: T) => string;
  readonly set: (names: readonly T[]) => void;
}

/** What is shown, in its order, then what is hidden. */
function ShownList<T extends string>({ legend, all, shown, titleOf, set }: ListOptions<T>) {
  const hidden = all.filter((name) => !shown.includes(name));
  return (
    <fieldset class="layout-list">
      <legend>{legend}</legend>
      <ul>
        {[...shown, ...hidden].map((name) => {
          const [title, isShown] = [titleOf(name), shown.includes(name)];
          return (
            <li key={name}>
              <label>
                <input
                  type="checkbox"
                  checked={isShown}
                  onChange={() => set(isShown ? shown.filter((each) => each !== name) : [...shown, name])}
                />
                {title}
              </label>
              {([-1, 1] as const).map((by) => (
                <button
                  key={by}
                  type="button"
                  class="icon"
                  disabled={!isShown || shown[by < 0 ? 0 : shown.length - 1] === name}
                  aria-label={`Move ${title} ${by < 0 ? 'up' : 'down'}`}
                  onClick={() => set(moved(shown, name, by))}
                >
                  {by < 0 ? '↑' : '↓'}
                </button>
              ))}
            </li>
          );
        })}
      </ul>
    </fieldset>
  );
}

function Stored() {
  const save = (event: SubmitEvent): void => {
    event.preventDefault();
    const form = event.currentTarget as HTMLFormElement;
    const name = String(new FormData(form).get('name') ?? '').trim();
    if (name === '') return;
    saveLayout(name);
    form.reset();
  };
  return (
    <section aria-label="Stored layouts">
      <form class="layout-save" onSubmit={save}>
        <label>
          Name <input type="text" name="name" required maxLength={60} autocomplete="off" />
        </label>
        <button type="submit">Save</button>
      </form>
      <ul class="layout-stored">
        {[...layouts.value].map(([name, text]) => (
          <li key={name}>
            <span>{name}</span>
            <button type="button" aria-label={`Use the layout ${name}`} onClick={() => applyLayout(text)}>
              Use
            </button>
            <button type="button" aria-label={`Delete the layout ${name}`} onClick={() => deleteLayout(name)}>
              Delete
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

/** Which panels and plots are shown, in which order; layouts stored by name, and a link to this one. */
export function LayoutView({ titleOf }: { titleOf: (name: Tab) => string }) {
  const close = (): void => {
    isOpen.value = false;
  };
  return (
    <Dialog isOpen={isOpen.value} title="Layout" onClose={close}>
      <div class="dialog-scroll">
        <div class="layout-lists">
          <ShownList legend="Panels" all={TABS} shown={panels.value} titleOf={titleOf} set={setPanels} />
          <ShownList
            legend="Plots"
            all={PLOTS}
            shown={plots.value}
            titleOf={(name) => PLOT_TITLES[name]}
            set={setPlots}
          />
        </div>
        <label>
          Second panel{' '}
          <select
            value={besideChosen.value}
            onChange={({ currentTarget }) => setBeside(currentTarget.value as Tab | '')}
          >
            <option value="">none</option>
            {TABS.map((name) => (
              <option key={name} value={name}>
                {titleOf(name)}
              </option>
            ))}
          </select>
        </label>
        <label>
          <input
            type="checkbox"
            checked={hasInstruments.value}
            onChange={() => (hasInstruments.value = !hasInstruments.value)}
          />{' '}
          Instruments with the picture
        </label>
        <Stored />
        <Copied
          id="layout-link"
          label="Link"
          text={linkToLayout(layoutText.value, location.href.replace(/[?#].*/, ''))}
        />
      </div>
      <div class="buttons end">
        <button type="button" onClick={() => applyLayout(FIRST_LAYOUT)}>
          As at first
        </button>
        <button type="button" class="primary" onClick={close}>
          Close
        </button>
      </div>
    </Dialog>
  );
}
