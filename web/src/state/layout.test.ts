import { beforeEach, describe, expect, it } from 'vitest';
import {
  applyLayout,
  beside,
  deleteLayout,
  dock,
  FIRST_LAYOUT,
  hasInstruments,
  layoutIn,
  layouts,
  layoutText,
  linkToLayout,
  moved,
  PLOTS,
  panelShare,
  panels,
  plots,
  saveLayout,
  setBeside,
  setPanels,
  setPlots,
} from './layout';
import { formulaText } from './own_channel';
import { TABS, tab } from './tab';

beforeEach(() => {
  applyLayout(FIRST_LAYOUT);
  tab.value = 'plots';
});

describe('the arrangement of the page', () => {
  it('is at first all panels and all plots', () => {
    expect(panels.value).toEqual(TABS);
    expect(plots.value).toEqual(PLOTS);
    expect(beside.value).toBeNull();
  });

  it('comes back from its text and from a link', () => {
    setPanels(['laps', 'plots']);
    setPlots(['own', 'speed']);
    setBeside('laps');
    [dock.value, hasInstruments.value, formulaText.value] = ['bottom', false, 'speed_mps + 1 & 2'];
    const text = layoutText.value;
    const link = linkToLayout(text, 'http://localhost:4567/');
    applyLayout(FIRST_LAYOUT);
    expect(layoutText.value).not.toBe(text);
    applyLayout(layoutIn(new URL(link).hash) ?? '');
    expect(layoutText.value).toBe(text);
    expect([panels.value, plots.value, beside.value]).toEqual([['laps', 'plots'], ['own', 'speed'], 'laps']);
    expect([dock.value, hasInstruments.value, formulaText.value]).toEqual(['bottom', false, 'speed_mps + 1 & 2']);
  });

  it('takes nothing from a text but what the page has', () => {
    applyLayout('dock=left&share=NaN&panels=cockpit&plots=speed.speed.altitude&beside=cockpit&tab=nowhere');
    expect(dock.value).toBe('right');
    expect(panelShare.value).toBeCloseTo(0.36);
    expect(panels.value).toEqual(TABS);
    expect(plots.value).toEqual(['speed']);
    expect(beside.value).toBeNull();
    applyLayout('share=3000');
    expect(panelShare.value).toBe(0.8);
    expect(layoutIn('#laps')).toBeNull();
  });

  it('keeps a tab for the panel that is shown, and shows none twice', () => {
    setPanels(['laps']);
    setBeside('tune');
    tab.value = 'tune';
    expect(panels.value).toEqual(['laps', 'tune']);
    expect(beside.value).toBeNull();
    tab.value = 'laps';
    expect(panels.value).toEqual(['laps']);
    expect(beside.value).toBe('tune');
  });

  it('is stored by name', () => {
    setPlots(['speed']);
    saveLayout('only speed');
    setPlots(['cost']);
    applyLayout(layouts.value.get('only speed') ?? '');
    expect(plots.value).toEqual(['speed']);
    deleteLayout('only speed');
    expect(layouts.value.size).toBe(0);
  });

  it('moves what is listed, not beyond its ends', () => {
    expect(moved(['a', 'b', 'c'], 'a', 1)).toEqual(['b', 'a', 'c']);
    expect(moved(['a', 'b', 'c'], 'c', 1)).toEqual(['a', 'b', 'c']);
    expect(moved(['a', 'b', 'c'], 'c', -2)).toEqual(['c', 'a', 'b']);
    expect(moved(['a'], 'x', 1)).toEqual(['a']);
  });
});
