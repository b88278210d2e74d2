import { useEffect, useState } from 'preact/hooks';
import { programPage } from '../state/program_page';
import { commandOf, sharedNow } from '../state/share';

interface Ended {
  readonly state_hash: string | null;
  readonly arithmetic: string;
}

/** With what the run of a page without a program is compared: the hash of its states, and the command that gives it. */
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
