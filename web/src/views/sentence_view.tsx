import { useRef } from 'preact/hooks';
import { sentenceOf } from '../lib/words';
import { situation } from '../state/situation';

/** State of the run in words; `alarm`: a person must know or act. */
export interface Situation {
  readonly kind: 'driving' | 'manual' | 'alarm';
  readonly text: string;
  readonly why: string;
}

/** Part of `ends_it` that names keys (telemetry/frame.cpp): left out, since an alarm has their buttons. */
const KEYS_REMEDY = / ?On the dashboard, [^.]*\./;

/** What the program says of the frame that is shown; null without one. */
export function situationNow(): Situation | null {
  const now = situation.value;
  if (!now) return null;
  const kind = now.severity === 'alarm' ? 'alarm' : now.driver === 'person' ? 'manual' : 'driving';
  const why = [sentenceOf(now.reason), now.ends_it.replace(KEYS_REMEDY, '')].filter(Boolean).join(' ');
  return { kind, text: sentenceOf(now.sentence), why };
}

/**
 * The one sentence of the run. Screen readers hear it when it becomes an alarm, a person takes the wheel, or the
 * controller drives again; not with every corner.
 */
export function SentenceView({ of }: { of: Situation }) {
  const spoken = useRef({ kind: of.kind, text: '' });
  if (spoken.current.kind !== of.kind) spoken.current = { kind: of.kind, text: of.text };
  const isAlarm = of.kind === 'alarm';
  return (
    <div class="true value" data-testid="why">
      <p role={isAlarm ? 'alert' : undefined}>{of.text}</p>
      {of.why !== '' && <small>{of.why}</small>}
      {!isAlarm && (
        <p class="sr-only" role="status">
          {spoken.current.text}
        </p>
      )}
    </div>
  );
}
