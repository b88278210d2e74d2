import { computed } from '@preact/signals';
import { clamp } from '../lib/math';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import { formulaText } from './own_channel';
import { TABS, type Tab, tab } from './tab';

// How the parts of the page are arranged: kept by the browser, stored by name, and written in links.

export const PLOTS = [
  'speed',
  'lateral',
  'heading',
  'steering',
  'drive',
  'grip',
  'accelerations',
  'cost',
  'iterations',
  'step',
  'histogram',
  'own',
] as const;
export type Plot = (typeof PLOTS)[number];

type Dock = 'right' | 'bottom';

/** Names of a fixed list, in an order of the reader's, and only those that are shown; as text with points between. */
function listOf<T extends string>(text: string, all: readonly T[]): readonly T[] {
  const names = text.split('.').filter((name): name is T => (all as readonly string[]).includes(name));
  return [...new Set(names)];
}

export const dock = persisted<Dock>('dock', 'right', (value) => value === 'right' || value === 'bottom');
export const shareRight = persisted<number>('dock.right', 0.34);
export const shareBottom = persisted<number>('dock.bottom', 0.44);
const panelText = persisted<string>('panels', TABS.join('.'));
const plotText = persisted<string>('plots.shown', PLOTS.join('.'));
const besideText = persisted<string>('beside', '');
export const hasInstruments = persisted<boolean>('instruments', true);

/** Where the window has room, the numbers stand on the picture, which is larger for it. */
const roomy = typeof matchMedia === 'undefined' ? null : matchMedia('(min-width: 1001px) and (min-height: 600px)');
export const isRoomy = store.signal('page', roomy?.matches ?? true);
roomy?.addEventListener('change', () => (isRoomy.value = roomy.matches));

/** The panels that have a tab, in their order; the one that is shown has one in any case. */
export const panels = computed<readonly Tab[]>(() => {
  const chosen = listOf(panelText.value, TABS);
  return chosen.includes(tab.value) ? chosen : [...chosen, tab.value];
});
/** The plots of the panel Plots, in their order. */
export const plots = computed<readonly Plot[]>(() => listOf(plotText.value, PLOTS));
/** A second panel beside the first; null: none, or it is the first one. */
export const beside = computed<Tab | null>(() => {
  const [second] = listOf(besideText.value, TABS);
  return second === undefined || second === tab.value ? null : second;
});
/** The panel that is to stand beside the first one; empty: none. */
export const besideChosen = computed<Tab | ''>(() => listOf(besideText.value, TABS)[0] ?? '');

/** Whether a panel is seen, as the first or the second one. */
export const isSeen = (name: Tab): boolean => tab.value === name || beside.value === name;

export function setPanels(names: readonly Tab[]): void {
  panelText.value = names.join('.');
}
export function setPlots(names: readonly Plot[]): void {
  plotText.value = names.join('.');
}
export function setBeside(name: Tab | ''): void {
  besideText.value = name;
}

/** The share of the window that the panel takes, where it is docked now. */
export const panelShare = computed<number>(() => (dock.value === 'right' ? shareRight.value : shareBottom.value));

export function setPanelShare(share: number): void {
  const limited = clamp(share, 0.2, 0.8);
  if (dock.value === 'right') shareRight.value = limited;
  else shareBottom.value = limited;
}

export function toggleDock(): void {
  dock.value = dock.value === 'right' ? 'bottom' : 'right';
}

/** The same list with one name moved by so many places. */
export function moved<T>(list: readonly T[], name: T, by: number): readonly T[] {
  const at = list.indexOf(name);
  const to = clamp(at + by, 0, list.length - 1);
  if (at < 0) return list;
  const rest = list.filter((each) => each !== name);
  return [...rest.slice(0, to), name, ...rest.slice(to)];
}

/** The arrangement as text, for storage and links: "dock=bottom&share=44&panels=plots.laps&…". */
export const layoutText = computed<string>(() => {
  const all = new URLSearchParams({
    dock: dock.value,
    share: String(Math.round(100 * panelShare.value)),
    tab: tab.value,
    panels: panelText.value,
    plots: plotText.value,
    beside: besideText.value,
    instruments: hasInstruments.value ? 'yes' : 'no',
    formula: formulaText.value,
  });
  return all.toString();
});

/** Arranges the page as a text says; what it does not name stays as it is, what this page does not have is left out. */
export function applyLayout(text: string): void {
  const all = new URLSearchParams(text);
  const side = all.get('dock');
  if (side === 'right' || side === 'bottom') dock.value = side;
  const share = Number(all.get('share') ?? NaN);
  if (Number.isFinite(share)) setPanelShare(share / 100);
  const shown = listOf(all.get('panels') ?? '', TABS);
  if (shown.length > 0) setPanels(shown);
  const [first] = listOf(all.get('tab') ?? '', TABS);
  if (first) tab.value = first;
  const plotted = all.get('plots');
  if (plotted !== null) setPlots(listOf(plotted, PLOTS));
  const second = all.get('beside');
  if (second !== null) setBeside(listOf(second, TABS)[0] ?? '');
  const instruments = all.get('instruments');
  if (instruments !== null) hasInstruments.value = instruments !== 'no';
  const formula = all.get('formula');
  if (formula !== null) formulaText.value = formula;
}

export const FIRST_LAYOUT = new URLSearchParams({
  dock: 'right',
  share: '36',
  panels: TABS.join('.'),
  plots: PLOTS.join('.'),
  beside: '',
  instruments: 'yes',
}).toString();

// ---- Stored by name

const stored = persisted<string>('layouts', '{}');

export const layouts = computed<ReadonlyMap<string, string>>(() => {
  try {
    const all = JSON.parse(stored.value) as Record<string, unknown>;
    return new Map(Object.entries(all).flatMap(([name, text]) => (typeof text === 'string' ? [[name, text]] : [])));
  } catch {
    return new Map();
  }
});

function keep(all: ReadonlyMap<string, string>): void {
  stored.value = JSON.stringify(Object.fromEntries(all));
}

/** Keeps the arrangement of now under a name. */
export const saveLayout = (name: string): void => keep(new Map(layouts.value).set(name, layoutText.value));

export const deleteLayout = (name: string): void => keep(new Map([...layouts.value].filter(([each]) => each !== name)));

// ---- In a link

const PREFIX = '#layout?';

/** A link that arranges the page of whoever opens it; `page`: its address. */
export const linkToLayout = (text: string, page: string): string => `${page}${PREFIX}${text}`;

/** The arrangement that an address holds; null: none. */
export const layoutIn = (hash: string): string | null => (hash.startsWith(PREFIX) ? hash.slice(PREFIX.length) : null);

/** Follows links to arrangements, now and when one is opened in this tab, and cleans the address. */
export function listenForLayouts(): void {
  const read = (): void => {
    const text = layoutIn(location.hash);
    if (text === null) return;
    applyLayout(text);
    history.replaceState(null, '', `#${tab.value}`);
  };
  addEventListener('hashchange', read);
  read();
}
