// SPDX-License-Identifier: MIT
// A headless Chromium of the system, as Debian installs it.
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const SWITCHES = (
  '--headless --no-sandbox --disable-gpu --enable-unsafe-swiftshader --disable-quic --no-first-run ' +
  '--disable-background-networking --disable-component-update --disable-sync'
).split(' ');

/** WebGL is drawn by the processor. `more`: further switches, e.g. '--disable-3d-apis'. */
export const launch = (...more) =>
  chromium.launch({
    executablePath: fileURLToPath(new URL('chromium.sh', import.meta.url)),
    args: [...SWITCHES, ...more],
  });
