// SPDX-License-Identifier: MIT
/** How long tests wait for what must come [ms]: long, for a busy machine is slow but not wrong. */
export const PATIENCE = Number(process.env.PATIENCE_MS ?? 120_000);
