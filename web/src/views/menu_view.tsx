// Menu of the page, behind the name of the program.
import type { ComponentChildren } from 'preact';
import { useRef } from 'preact/hooks';
import { scheme, toggleScheme } from '../lib/appearance';
import { download } from '../lib/download';
import { clamp } from '../lib/math';
import { nextSpeedUnit, speedUnit } from '../lib/units';
import { Button } from '../parts/controls';
import { services } from '../state/link';
import { mode } from '../state/mode';
import { call, can, canSet, set } from '../state/operate';
import { programPage } from '../state/program_page';
import { isPaused } from '../state/run';
import { settings } from '../state/settings';
import { openHelp } from './help_view';
import { isManual, toggleManual } from './manual_view';
import { openShare } from './share_view';
import { isTourOffered, openTourHere, tourLabel } from './tour_view';

const PACES = [0.25, 1, 4] as const; // chosen
/** Bounds of the pace: those of the program's run.pace. */
const [LEAST_PACE, MOST_PACE] = [0.05, 20];

/** Multiplies the pace of the run. */
export function changePace(factor: number): void {
  const pace = settings.value.get('run.pace');
  if (typeof pace !== 'number' || !canSet('run.pace')) return;
  set('run.pace', clamp(Number((pace * factor).toPrecision(3)), LEAST_PACE, MOST_PACE));
}

/** The stage on the whole screen, where the browser allows it; and back. */
export function present(): void {
  mode.value = 'watch';
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen?.().catch(() => undefined);
}

/** Saves the preset where no program answers its link. */
function savePreset(event: Event): void {
  if (!__PAGE__) return;
  event.preventDefault();
  void programPage('preset.yaml').then((text) => text !== null && download('my-preset.yaml', text));
}

/** The menu: what is seldom wanted. */
export function MenuView() {
  const box = useRef<HTMLDivElement>(null);
  const pace = settings.value.get('run.pace');
  const Item = (props: { act: () => void; name?: string; off?: boolean; children: ComponentChildren }) => (
    <Button
      class="row apart"
      disabled={props.off}
      aria-keyshortcuts={props.name}
      act={() => {
        box.current?.hidePopover();
        props.act();
      }}
    >
      <span>{props.children}</span> {props.name && <kbd>{props.name}</kbd>}
    </Button>
  );
  return (
    <>
      <button type="button" class="name" popovertarget="menu" title="Menu">
        <svg viewBox="0 0 20 20" width="20" aria-hidden="true">
          <path d="M5 18c0-6 10-5 10-10 0-3-3-4-3-6" fill="none" stroke="currentColor" stroke-width="2.6" />
        </svg>
        chicane<span class="sr-only">: menu</span>
      </button>
      <div class="menu sheet" id="menu" popover="auto" ref={box}>
        {services.value.has('/reset') && (
          <Item act={() => call('/reset')} name="R" off={!can('/reset')}>
            Start again
          </Item>
        )}
        {services.value.has('/step') && (
          <Item act={() => call('/step')} name="." off={!can('/step') || !isPaused.value}>
            One step
          </Item>
        )}
        {settings.value.has('manual.is_on') && (
          <Item act={toggleManual} name="M" off={!canSet('manual.is_on')}>
            {isManual() ? 'Hand back' : 'Take the wheel'}
          </Item>
        )}
        {pace !== undefined && (
          <div class="row apart">
            <span id="pace-label">Pace</span>
            <div class="row line" role="group" aria-labelledby="pace-label">
              {PACES.map((each) => (
                <Button
                  key={each}
                  aria-pressed={pace === each}
                  disabled={!canSet('run.pace')}
                  act={() => set('run.pace', each)}
                >
                  {each}×
                </Button>
              ))}
            </div>
          </div>
        )}
        <hr />
        {settings.value.has('track') && <Item act={openShare}>Share this run …</Item>}
        {settings.value.size > 0 && (
          <a
            class="row apart"
            style={{ color: 'inherit', textDecoration: 'none' }}
            href="preset.yaml"
            download="my-preset.yaml"
            onClick={savePreset}
          >
            Keep these settings as a preset
          </a>
        )}
        {isTourOffered() && (
          <Item act={openTourHere} name="H">
            {tourLabel()}
          </Item>
        )}
        <hr />
        <Item act={nextSpeedUnit} name="U">
          Speeds in {speedUnit().name}
        </Item>
        <Item act={toggleScheme} name="T">
          {scheme.value === 'dark' ? 'Light colours' : 'Dark colours'}
        </Item>
        <Item act={present} name="G">
          Present
        </Item>
        <Item act={openHelp} name="?">
          Keys and help
        </Item>
      </div>
    </>
  );
}
