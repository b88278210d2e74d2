import { store } from '../lib/store';

/** What renders 3D on this machine. */
export type Renderer = 'card' | 'processor' | 'none';

/** Names of renderers that run on the processor. */
const BY_PROCESSOR = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Asks a context of its own. */
function ask(): Renderer {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) return 'none';
  const info = context.getExtension('WEBGL_debug_renderer_info');
  const name = String(context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext(); // the number of contexts is limited
  return BY_PROCESSOR.test(name) ? 'processor' : 'card';
}

const found = store.data('page', () => ({ renderer: null as Renderer | null }));

/** Determined once, without the console messages that the library prints where there is no WebGL. */
export const renderer = (): Renderer => (found.renderer ??= ask());
