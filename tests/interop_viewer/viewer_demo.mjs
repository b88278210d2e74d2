// SPDX-License-Identifier: MIT
// Starts the test server (viewer_demo.cpp, path in VIEWER_DEMO) and waits until it listens.
import { spawn } from 'node:child_process';
import { once } from 'node:events';

export async function startDemo(port = 0) {
  const child = spawn(process.env.VIEWER_DEMO ?? 'viewer_demo', [String(port)], { stdio: ['pipe', 'pipe', 'inherit'] });
  const [line] = await once(child.stdout, 'data');
  const url = /http:\/\/\S+/.exec(String(line))?.[0];
  if (!url) throw new Error(`viewer_demo said: ${line}`);
  return {
    url,
    port: Number(new URL(url).port),
    /** Ends it politely: it leaves when its stdin closes. */
    async stop() {
      if (child.exitCode !== null || child.signalCode !== null) return child.exitCode;
      child.stdin.end();
      const [code] = await once(child, 'exit');
      return code;
    },
  };
}
