import { persisted } from '../lib/persisted';
import type { Tab } from './workbench_view';

/** The panel that is shown. */
export const tab = persisted<Tab>('tab', 'plots', (value) => typeof value === 'string');
