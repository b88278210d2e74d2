import type { ComponentType } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { store } from '../lib/store';
import { dock, isRoomy, panelShare, setPanelShare, toggleDock } from '../state/layout';
import { link } from '../state/link';
import { isStageAlone } from '../state/presentation';
import { TABS, type Tab, tab } from '../state/tab';
import { DriveView } from './drive_view';
import { EndView } from './end_view';
import { FaultsView } from './faults_view';
import { InstrumentsView } from './instruments_view';
import { TourView } from './tour_view';
import { TrackView } from './track_view';
import { TuneView } from './tune_view';
import { UnderstandView } from './understand_view';
import { WhatIfView } from './what_if_view';

/** A panel is a view of its own, one row here, and its name in TABS. */
const PANELS = [
  { name: 'drive', title: 'Drive', View: DriveView },
  { name: 'tune', title: 'Tune', View: TuneView },
  { name: 'laps', title: 'Understand', View: UnderstandView },
  { name: 'faults', title: 'Faults', View: FaultsView },
  { name: 'whatif', title: 'What if', View: WhatIfView },
] as const satisfies readonly { name: Tab; title: string; View: ComponentType }[];

export const titleOf = (name: Tab): string => PANELS.find((each) => each.name === name)?.title ?? name;

/** Whether only the panel is shown, without picture and instruments. */
export const isPanelAlone = store.signal('page', false);

/** The bar between picture and panel, moved by dragging or with the arrow keys. */
function Splitter() {
  const isVertical = dock.value === 'right';
  const share = panelShare.value;
  const drag = (event: PointerEvent): void => {
    const bar = event.currentTarget as HTMLElement;
    const box = bar.parentElement?.getBoundingClientRect();
    if (!box || !bar.hasPointerCapture(event.pointerId)) return;
    setPanelShare(isVertical ? (box.right - event.clientX) / box.width : (box.bottom - event.clientY) / box.height);
  };
  const key = (event: KeyboardEvent): void => {
    const step = { ArrowLeft: 0.02, ArrowUp: 0.02, ArrowRight: -0.02, ArrowDown: -0.02 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    setPanelShare(share + step);
  };
  return (
    <div
      class="splitter"
      role="separator"
      tabIndex={0}
      aria-label="Size of the panel"
      aria-orientation={isVertical ? 'vertical' : 'horizontal'}
      aria-valuenow={Math.round(share * 100)}
      aria-valuemin={20}
      aria-valuemax={80}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onKeyDown={key}
    />
  );
}

function Tabs() {
  const key = (event: KeyboardEvent): void => {
    const at = TABS.indexOf(tab.value);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: TABS.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    tab.value = TABS[(to + TABS.length) % TABS.length] as Tab;
    document.getElementById(`tab-${tab.value}`)?.focus();
  };
  return (
    <div class="tab-row">
      <div class="tabs" role="tablist" aria-label="Panels" onKeyDown={key}>
        {TABS.map((name) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls="panel"
            tabIndex={tab.value === name ? 0 : -1}
            title={`${titleOf(name)} (${TABS.indexOf(name) + 1})`}
            onClick={() => (tab.value = name)}
          >
            {titleOf(name)}
          </button>
        ))}
      </div>
      <button
        type="button"
        class="icon dock-button"
        aria-label={dock.value === 'right' ? 'Put the panel below' : 'Put the panel on the right'}
        title="Panel below or on the right (D)"
        onClick={toggleDock}
      >
        <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
          <rect x="1.5" y="2.5" width="13" height="11" rx="1.5" fill="none" stroke="currentColor" />
          {dock.value === 'right' ? (
            <path d="M2 9.5h12v3.5H2z" fill="currentColor" />
          ) : (
            <path d="M9.5 3h4.5v10H9.5z" fill="currentColor" />
          )}
        </svg>
      </button>
      <button
        type="button"
        class="icon"
        aria-pressed={isPanelAlone.value}
        aria-label="Panel only"
        title="Panel only, without the picture (F)"
        onClick={() => (isPanelAlone.value = !isPanelAlone.value)}
      >
        <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
          <path
            d={
              isPanelAlone.value
                ? 'M6.5 2v4.5H2M9.5 2v4.5H14M6.5 14V9.5H2M9.5 14V9.5H14'
                : 'M2 6.5V2h4.5M14 6.5V2H9.5M2 9.5V14h4.5M14 9.5V14H9.5'
            }
            fill="none"
            stroke="currentColor"
            stroke-width="1.5"
          />
        </svg>
      </button>
    </div>
  );
}

/** Each panel keeps how far it was scrolled. */
function useScrollOf(name: Tab) {
  const body = useRef<HTMLDivElement>(null);
  const places = useRef(new Map<Tab, number>());
  useLayoutEffect(() => {
    const element = body.current;
    if (!element) return undefined;
    element.scrollTop = places.current.get(name) ?? 0;
    const note = (): void => void places.current.set(name, element.scrollTop);
    element.addEventListener('scroll', note, { passive: true });
    return () => element.removeEventListener('scroll', note);
  }, [name]);
  return body;
}

export function WorkbenchView() {
  const body = useScrollOf(tab.value);
  const View: ComponentType = PANELS[TABS.indexOf(tab.value)]?.View ?? UnderstandView;
  const classes = [
    'workbench',
    `dock-${dock.value}`,
    isPanelAlone.value ? 'panel-alone' : '',
    isStageAlone.value ? 'stage-alone' : '',
    link.value === 'lost' ? 'stale' : '',
  ];
  const hasStage = isStageAlone.value || !isPanelAlone.value;
  return (
    <main class={classes.filter(Boolean).join(' ')} style={{ '--panel-share': String(panelShare.value) }}>
      <EndView />
      {hasStage && (
        <div class="stage">
          <TrackView />
          {!isRoomy.value && <InstrumentsView />}
        </div>
      )}
      {!isPanelAlone.value && !isStageAlone.value && <Splitter />}
      <div class="panel side" hidden={isStageAlone.value}>
        <TourView />
        <Tabs />
        <div class="panel-bodies">
          <div
            class={`panel-body show-${tab.value}`}
            ref={body}
            id="panel"
            role="tabpanel"
            aria-labelledby={`tab-${tab.value}`}
            tabIndex={0}
          >
            <View key={tab.value} />
          </div>
        </div>
      </div>
    </main>
  );
}
