// SPDX-License-Identifier: MIT
// What `chicane replay` serves to a browser, read as a browser does: by range, with the reference reader; and
// recordings of both ends of a session with an external simulator.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { McapIndexedReader } from '@mcap/core';
import { startProgram } from './chicane_drive.mjs';

/** Runs the program to its end. */
const chicane = (...words) =>
  new Promise((resolve) => {
    const tell = (error, stdout, stderr) => resolve({ code: error?.code ?? 0, stdout, stderr });
    execFile(process.env.CHICANE, words, tell);
  });

let folder;
let log;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'chicane-replay-'));
  log = join(folder, 'run.mcap');
  await chicane('drive', '--fast', '--set', 'time_limit_s=10', '--record', log); // 1: the laps were not driven
});
after(() => rmSync(folder, { recursive: true }));

/** As browsers do: once more when a connection that was kept open has been closed meanwhile. */
const get = (url, init) => fetch(url, init).catch(() => fetch(url, init));

const openByRange = (url) =>
  McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt((await get(url, { method: 'HEAD' })).headers.get('content-length')),
      read: async (offset, size) => {
        const answer = await get(url, { headers: { Range: `bytes=${offset}-${offset + size - 1n}` } });
        assert.equal(answer.status, 206);
        return new Uint8Array(await answer.arrayBuffer());
      },
    },
  });

async function steps(reader, startTime) {
  const all = [];
  for await (const message of reader.readMessages({ topics: ['/chicane/step'], startTime })) all.push(message.logTime);
  return all;
}

describe('chicane replay', () => {
  it('names its logs, which are sought in by range', async () => {
    const program = await startProgram('replay', [log]);
    const mode = await (await get(`${program.url}mode.json`)).json();
    assert.deepEqual(mode, { mode: 'replay', logs: [{ name: 'run.mcap', url: '/log/0.mcap' }], start_s: 0 });
    const reader = await openByRange(`${program.url}log/0.mcap`);
    assert.equal((await steps(reader)).length, 250);
    assert.equal((await steps(reader, 9_000_000_000n))[0], 9_000_000_000n);
    const whole = await get(`${program.url}log/0.mcap`);
    assert.deepEqual(Buffer.from(await whole.arrayBuffer()), readFileSync(log));
    for (const path of ['/log/1.mcap', '/log/0.mcap/..', '/log/', '/log/%2e%2e/run.mcap', `/log/${log}`]) {
      assert.equal((await get(program.url + path.slice(1))).status, 404, path);
    }
    assert.equal((await get(`${program.url}log/0.mcap`, { headers: { Range: 'bytes=99999999999-' } })).status, 416);
    assert.equal(await program.stop('SIGINT'), 0);
  });

  it('gives a recording whose writer was killed an index', async () => {
    const cut = join(folder, 'cut.mcap');
    const bytes = readFileSync(log);
    writeFileSync(cut, bytes.subarray(0, Math.floor(0.8 * bytes.length)));
    const program = await startProgram('replay', [cut, log]);
    const reader = await openByRange(`${program.url}log/0.mcap`);
    const count = (await steps(reader)).length;
    assert.ok(count > 100 && count < 250, `${count} steps`);
    assert.equal((await steps(await openByRange(`${program.url}log/1.mcap`))).length, 250);
    assert.equal(await program.stop('SIGINT'), 0);
  });

  it('shows a branch beside what was', async () => {
    const kept = join(folder, 'branch.mcap');
    const program = await startProgram('replay', [log, '--branch-at', '5', '--set', 'latency_ms=50', '--output', kept]);
    const { logs, start_s } = await (await get(`${program.url}mode.json`)).json();
    assert.deepEqual(
      logs.map(({ name }) => name),
      ['run.mcap', 'branch at 5.0 s'],
    );
    assert.equal(start_s, 5);
    const reader = await openByRange(`${program.url}log/1.mcap`);
    assert.equal((await steps(reader)).length, 250);
    const changes = [];
    for await (const message of reader.readMessages({ topics: ['/chicane/change'] })) changes.push(message.logTime);
    assert.equal(changes.length, 1);
    assert.equal(await program.stop('SIGINT'), 0);
    assert.equal((await chicane('replay', kept, '--verify')).code, 0);
  });
});

describe('a session with an external simulator', () => {
  it('is recorded at both ends; what was received is computed again, what another sent is not', async () => {
    const [served, simulated] = [join(folder, 'served.mcap'), join(folder, 'simulated.mcap')];
    const server = await startProgram('serve', ['--record', served]);
    const url = `ws://127.0.0.1:${server.port}/socket.io/?EIO=4&transport=websocket`;
    const recording = ['--record', simulated, '--compress'];
    await chicane('simulate', '--connect', url, '--laps', '1', '--set', 'time_limit_s=4', ...recording);
    assert.equal(await server.stop('SIGINT'), 0);
    const verified = await chicane('replay', served, '--verify', '--json');
    assert.equal(verified.code, 0, verified.stdout);
    assert.ok(JSON.parse(verified.stdout).steps > 10);
    const refused = await chicane('replay', simulated, '--verify');
    assert.equal(refused.code, 2);
    assert.match(refused.stderr, /mode: got simulate, expected drive or serve/);
    const refusedToo = await chicane('replay', served, '--branch-at', '1', '--json');
    assert.equal(refusedToo.code, 2);
    assert.match(refusedToo.stderr, /mode: got serve, expected drive/);
  });
});
