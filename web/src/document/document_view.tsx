// View of a page of results: headings, texts, tables and plots in the order of the document.
import { PlotView } from '../parts/plot_view';
import { TableView } from '../parts/table_view';
import { type Part, type ReportDocument, type Section, wordsOf } from './model';

/** A paragraph; words between backticks are code. */
function ProseView({ text }: { text: string }) {
  return (
    <p class="prose">{wordsOf(text).map(({ words, isCode }, i) => (isCode ? <code key={i}>{words}</code> : words))}</p>
  );
}

/** A text, a table or a plot. */
function PartView({ part, label }: { part: Part; label: string }) {
  if (part.part === 'text') return <ProseView text={part.text} />;
  return 'rows' in part ? <TableView table={part} label={label} /> : <PlotView plot={part} />;
}

/** A section with its heading. */
function SectionView({ section, label }: { section: Section; label: string }) {
  return (
    <section class="columns" aria-label={label}>
      {section.title !== '' && <h2>{section.title}</h2>}
      {section.parts.map((part, i) => (
        <PartView key={i} part={part} label={label} />
      ))}
    </section>
  );
}

/** The whole page. */
export function DocumentView({ shown }: { shown: ReportDocument }) {
  const sections = shown.sections.filter(({ parts }) => parts.length > 0);
  return (
    <main>
      <h1>{shown.title}</h1>
      {sections.map((section) => (
        <SectionView key={section.title} section={section} label={section.title || shown.title} />
      ))}
    </main>
  );
}
