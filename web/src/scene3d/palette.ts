// Colours and lights of the 3D picture, by day and at dusk.
import { scheme } from '../lib/appearance';
import { colourOf } from './mesh';

/** Colours of lines and cars on the road, as in tokens.css; the same by day and at dusk. */
const LINES = {
  plan: colourOf('#ffcb3d'),
  predicted: colourOf('#8a7443'),
  racingLine: colourOf('#dcb3f6'),
  ghost: colourOf('#dcb3f6'),
  trace: colourOf('#f7f9fb'),
  outcome: colourOf('#f7f9fb'),
  act: colourOf('#82b6ff'),
  lost: colourOf('#ffa566'),
};

/** Colours of the scene by day, linear, and how strong its lights are. */
const DAY = {
  zenith: colourOf('#b9cfe0'),
  horizon: colourOf('#edf2f4'),
  ground: colourOf('#cbd5c0'),
  hills: colourOf('#c3d0ca'),
  farHills: colourOf('#d3dee3'),
  leaves: ['#9cb393', '#a8bc9d', '#91a98a'].map(colourOf),
  trunk: colourOf('#8f8579'),
  road: {
    road: colourOf('#5d636c'),
    edge: colourOf('#f6f6f2'),
    centreLine: colourOf('#a3aab3'),
    verge: colourOf('#d3d9c6'),
    concrete: colourOf('#c6c8c5'),
    kerbRed: colourOf('#b5645c'),
    kerbWhite: colourOf('#f2f2ee'),
  },
  ...LINES,
  rubber: colourOf('#16181c'),
  sun: 2.6, // the directional light
  sky: 1.3, // the ambient light
};

/** The same colours at dusk. */
const DUSK: typeof DAY = {
  zenith: colourOf('#0a101d'),
  horizon: colourOf('#3a4a63'),
  ground: colourOf('#1c2722'),
  hills: colourOf('#1d2a33'),
  farHills: colourOf('#2a3a4e'),
  leaves: ['#3b6651', '#457359', '#335a48'].map(colourOf),
  trunk: colourOf('#4d443c'),
  road: {
    road: colourOf('#323944'),
    edge: colourOf('#b9c2cd'),
    centreLine: colourOf('#5d6774'),
    verge: colourOf('#243029'),
    concrete: colourOf('#4a515b'),
    kerbRed: colourOf('#8f3a3a'),
    kerbWhite: colourOf('#a9b1bd'),
  },
  ...LINES,
  rubber: colourOf('#0a0c0f'),
  sun: 1.3,
  sky: 1.0,
};

/** Colours and lights of a scheme. */
export interface Palette extends Readonly<typeof DAY> {
  readonly isDark: boolean;
}

/** The palette for the page's colour scheme. */
export function palette(): Palette {
  const isDark = scheme.value === 'dark';
  return { ...(isDark ? DUSK : DAY), isDark };
}
