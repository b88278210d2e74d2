// SPDX-License-Identifier: MIT
// What the tests of a file have in common: a browser and, mostly, a run of `chicane drive` that they watch.
import { after, before } from 'node:test';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';

/**
 * Begins before the tests of the file, or of the suite in which it is called, and ends after them: `browser`, and
 * `drive` where there are `args` for it. A test may put another run in the place of `drive`.
 */
export function browserAndDrive(args) {
  const here = { browser: null, drive: null };
  before(async () => {
    here.browser = await launch();
    if (args) here.drive = await startDrive(args);
  });
  after(async () => {
    await here.browser?.close();
    await here.drive?.stop();
  });
  return here;
}
export const browserAlone = () => browserAndDrive(null);
