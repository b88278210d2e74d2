import { store } from '../lib/store';

/** Whether only the picture is shown, for an audience. */
export const isStageAlone = store.signal('page', false);

/** For an audience: the picture alone, on the whole screen where the browser allows it; and back. */
export function togglePresentation(): void {
  isStageAlone.value = !isStageAlone.value;
  if (isStageAlone.value) void document.documentElement.requestFullscreen?.().catch(() => undefined);
  else if (document.fullscreenElement) void document.exitFullscreen();
}

if (typeof document !== 'undefined') {
  document.addEventListener('fullscreenchange', () => {
    if (!document.fullscreenElement) isStageAlone.value = false;
  });
}
