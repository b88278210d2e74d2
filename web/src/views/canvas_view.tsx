import { useEffect, useRef } from 'preact/hooks';
import { onThemeChange } from '../draw/theme';
import { onScreen } from '../lib/on_screen';
import { everyFrame } from '../state/ticker';
import { fitCanvas } from './plot_colours';

export type Paint = (context: CanvasRenderingContext2D, width: number, height: number) => void;

/**
 * A canvas that repaints while it is on the screen: when the value of `version` changes, at most every `interval`
 * milliseconds, and when its size or the colours change.
 */
export function CanvasView({
  label,
  paint,
  version,
  interval = 50,
  tall,
}: {
  label: string;
  paint: Paint;
  version: () => unknown;
  interval?: number;
  tall?: string;
}) {
  const element = useRef<HTMLCanvasElement>(null);
  const latest = useRef({ paint, version });
  latest.current = { paint, version };
  useEffect(() => {
    const canvas = element.current;
    if (!canvas) return undefined;
    let drawn: unknown = {};
    const box = onScreen(canvas, () => (drawn = {}));
    const unwatch = onThemeChange(() => (drawn = {}));
    const draw = (): void => {
      const now = latest.current.version();
      if (Object.is(now, drawn)) return;
      const context = fitCanvas(canvas, box.width, box.height);
      if (!context) return;
      drawn = now;
      latest.current.paint(context, box.width, box.height);
    };
    const stop = everyFrame(() => box.isSeen && draw(), interval);
    return () => {
      stop();
      unwatch();
      box.end();
    };
  }, [interval]);
  return (
    <div class="canvas-area" style={tall ? { height: tall } : {}}>
      <canvas ref={element} role="img" aria-label={label} />
    </div>
  );
}
