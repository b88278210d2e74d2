import { useEffect, useRef } from 'preact/hooks';
import { onThemeChange } from '../draw/theme';
import { everyFrame } from '../state/ticker';
import { fitCanvas } from './plot_colours';

export type Paint = (context: CanvasRenderingContext2D, width: number, height: number) => void;

/**
 * A canvas that repaints itself while it is on the screen: when `version` gives another value, at most every `interval`
 * milliseconds, and when its size or the colours change.
 */
export function CanvasView({ label, paint, version, interval = 50, tall }: { label: string; paint: Paint; version: () => unknown; interval?: number; tall?: string }) {
  const element = useRef<HTMLCanvasElement>(null);
  const latest = useRef({ paint, version });
  latest.current = { paint, version };
  useEffect(() => {
    const canvas = element.current;
    if (!canvas) return undefined;
    let drawn: unknown = {};
    const watcher = new ResizeObserver(() => (drawn = {}));
    watcher.observe(canvas);
    const unwatch = onThemeChange(() => (drawn = {}));
    const stop = everyFrame(() => {
      const now = latest.current.version();
      if (Object.is(now, drawn) || canvas.offsetParent === null) return;
      const fit = fitCanvas(canvas);
      if (!fit) return;
      drawn = now;
      latest.current.paint(fit.context, fit.width, fit.height);
    }, interval);
    return () => {
      stop();
      unwatch();
      watcher.disconnect();
    };
  }, [interval]);
  return (
    <div class="canvas-area" style={tall ? { height: tall } : {}}>
      <canvas ref={element} role="img" aria-label={label} />
    </div>
  );
}
