// Hash of the states of a finished run, for the page that needs no program.
import { useEffect, useState } from 'preact/hooks';
import { programPage } from '../state/program_page';
import { commandOf, sharedNow } from '../state/share';

/** End of a run as /run.json describes it. */
interface Ended {
  readonly state_hash: string | null;
  readonly arithmetic: string;
}

/** Hash of the states of the run, and the command of the program that gives the same. */
export function HashView() {
  const [ended, setEnded] = useState<Ended | null>(null);
  useEffect(() => {
    void programPage('run.json').then((text) => text !== null && setEnded(JSON.parse(text) as Ended));
  }, []);
  if (!ended?.state_hash) return null;
  return (
    <p title="The same bits as the program's, as long as nothing was changed while it ran">
      State hash <code data-testid="state-hash">{ended.state_hash}</code>, as{' '}
      <code>CHICANE_SIMD=baseline {commandOf(sharedNow.value)} --fast</code> gives it ({ended.arithmetic} arithmetic).
    </p>
  );
}
