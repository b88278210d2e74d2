import { render } from 'preact';
import { DocumentView } from './document/document_view';
import type { ReportDocument } from './document/model';
import { scheme } from './lib/appearance';

// The page of a sweep, a league, an identification or an import: what the program wrote into it, drawn.

const root = document.getElementById('app');
const text = document.getElementById('chicane-report')?.textContent;
if (root && text) {
  const shown = JSON.parse(text) as ReportDocument;
  document.title = shown.title;
  render(<DocumentView shown={shown} />, root);
}

// Paper is light.
const dress = (theme: 'light' | 'dark'): void => {
  document.documentElement.dataset.theme = theme;
};
addEventListener('beforeprint', () => dress('light'));
addEventListener('afterprint', () => dress(scheme.value));
