// SPDX-License-Identifier: MIT
// The reference client of the Foxglove WebSocket protocol turns the knobs of a running experiment: the whole program
// (path in CHICANE), its recording and what `replay --verify` says of it.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { change, startDrive, subscribe } from './chicane_drive.mjs';
import { PATIENCE } from './patience.mjs';

const program = process.env.CHICANE ?? 'chicane';

const folder = mkdtempSync(join(tmpdir(), 'chicane-settings-'));
const recording = join(folder, 'run.mcap');
let drive;
let client;
const latest = new Map(); // topic → message
const changes = [];
const problems = [];
const values = new Map(); // as the server told us
let listeners = [];

/** The first thing that `accept` finds, looked for after every message. */
function until(what, accept) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`${what}: not within ${PATIENCE} ms`)), PATIENCE);
    const look = () => {
      const found = accept();
      if (found === undefined || found === false) return;
      clearTimeout(timer);
      listeners = listeners.filter((each) => each !== look);
      resolve(found);
    };
    listeners.push(look);
    look();
  });
}
const tell = () => listeners.slice().forEach((look) => look());

function set(name, value) {
  client.setParameters([{ name, value }], `set ${name}`);
}
const changeOf = (name) => until(`change of ${name}`, () => changes.find((change) => change.name === name));

before(async () => {
  drive = await startDrive(['--track', 'oval', '--laps', '0', '--record', recording]);
  const isOurs = (topic) => topic.startsWith('/chicane/');
  ({ client } = await subscribe(drive.url, isOurs, (topic, message) => {
    latest.set(topic, message);
    if (topic === '/chicane/change') changes.push(message);
    tell();
  }));
  client.on('parameterValues', ({ parameters }) => {
    parameters.forEach(({ name, value }) => values.set(name, value));
    tell();
  });
  client.on('status', ({ message }) => {
    problems.push(message);
    tell();
  });
  await until('a frame', () => latest.get('/chicane/frame'));
});

after(() => {
  drive?.stop('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
});

it('lists every tunable with its value', async () => {
  client.getParameters([], 'all');
  await until('the list', () => values.size > 90);
  assert.equal(values.get('tracking_mpc.horizon_steps'), 40);
  assert.equal(values.get('track'), 'oval');
  assert.equal(values.get('run.pace'), 1);
  assert.equal(values.get('manual.is_on'), false);
  client.subscribeParameterUpdates([]);
});

it('takes a setting up at a control step and goes on planning', async () => {
  set('tracking_mpc.horizon_steps', 20);
  const change = await changeOf('tracking_mpc.horizon_steps');
  assert.equal(change.value, '20');
  await until('shorter plans', () => latest.get('/chicane/plan').x_m.length === 21);
  assert.ok(latest.get('/chicane/frame').cycle >= change.cycle);
  await until('the controller drives', () => latest.get('/chicane/frame').rung === 0);
});

it('tells other viewers', async () => {
  await change(drive.url, 'latency_ms', 60);
  await until('60 ms', () => values.get('latency_ms') === 60);
  await until('60 ms in the description', () => latest.get('/chicane/run').latency_s === 0.06);
});

it('restarts with another track and preset', async () => {
  set('run.pace', 4);
  set('track', 'lakeside');
  await until('lakeside', () => latest.get('/chicane/run').track === 'lakeside');
  await until('the pace of before', () => latest.get('/chicane/frame').pace === 4);
  set('preset', 'sixty-mph');
  await until('its horizon', () => values.get('cubic_mpc.horizon_steps') === 7);
  await until('its controller', () => latest.get('/chicane/run').controller === 'cubic-mpc');
  assert.equal(values.get('latency_ms'), 60);
  await until('a plan of its own', () => latest.get('/chicane/plan').x_m.length === 7);
  set('track', 'nowhere');
  await until('the sentence', () => problems.some((text) => text.startsWith('track: got "nowhere"')));
  assert.equal(values.get('track'), 'lakeside');
});

it('comes out the same, bit for bit, when it is computed again', async () => {
  client.close();
  await drive.stop('SIGINT');
  const verified = spawnSync(program, ['replay', recording, '--verify', '--json']);
  const report = JSON.parse(verified.stdout);
  // A recorder that a busy machine holds up leaves steps out, and those behind them cannot be compared.
  assert.equal(report.different, 0, JSON.stringify(report));
  assert.ok(report.identical > 50, JSON.stringify(report));
});
