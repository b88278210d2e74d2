// Page of results (recordings, sweep, league, identification, import): draws the JSON that the program wrote into it.
import { render } from 'preact';
import { DocumentView } from './document/document_view';
import type { ReportDocument } from './document/model';
import { type RunsDocument, readRuns, verdictOf } from './document/runs';
import { RunsView } from './document/runs_view';
import { scheme } from './lib/appearance';

const root = document.getElementById('app');
const text = document.getElementById('chicane-report')?.textContent;
if (root && text) {
  const shown = JSON.parse(text) as ReportDocument | RunsDocument;
  if (shown.kind === 'runs') {
    const runs = readRuns(shown);
    const first = runs[0] && verdictOf(runs[0]);
    document.title = first ? `${first.text}${first.time} – chicane` : 'chicane report';
    render(<RunsView runs={runs} />, root);
  } else {
    document.title = shown.title;
    render(<DocumentView shown={shown} />, root);
  }
}

// Paper is light, and nothing can be opened on it.
const dress = (theme: 'light' | 'dark'): void => {
  document.documentElement.style.colorScheme = theme;
};
const opened = new Set<HTMLDetailsElement>();
addEventListener('beforeprint', () => {
  dress('light');
  for (const each of document.querySelectorAll<HTMLDetailsElement>('details:not([open])')) {
    each.open = true;
    opened.add(each);
  }
});
addEventListener('afterprint', () => {
  dress(scheme.value);
  for (const each of opened) each.open = false;
  opened.clear();
});
