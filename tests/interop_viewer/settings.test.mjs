// SPDX-License-Identifier: MIT
// The reference client of the Foxglove WebSocket protocol turns the knobs of a running experiment: the whole program
// (path in CHICANE), its recording and what `replay --verify` says of it.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
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

describe('a run that goes on', () => {
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

  it('is driven by a person who lets go of the keys', async () => {
    set('manual.steer', 0.1);
    set('manual.throttle', 0.3);
    set('manual.is_on', true);
    await until('a person', () => {
      const frame = latest.get('/chicane/frame');
      return frame.is_manual && Math.abs(frame.throttle_sent - 0.3) < 1e-12;
    });
    await until('gentle braking', () => latest.get('/chicane/frame').throttle_sent < 0);
    set('manual.is_on', false);
    await until('the controller', () => !latest.get('/chicane/frame').is_manual);
  });

  it('has faults that end by themselves', async () => {
    set('fault.half_grip', '+3');
    await until(
      'the fault',
      () => values.get('fault.half_grip') === true && latest.get('/chicane/frame').active_faults !== 0,
    );
    set('run.pace', 4);
    await until(
      'its end',
      () => values.get('fault.half_grip') === false && latest.get('/chicane/frame').active_faults === 0,
    );
    set('fault.link_lost', '+600');
    await until('another', () => latest.get('/chicane/frame').active_faults !== 0);
    set('fault.link_lost', false);
    await until('its end', () => latest.get('/chicane/frame').active_faults === 0);
  });

  it('restarts with another track and preset', async () => {
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

  it('describes its settings over HTTP', async () => {
    const schema = await (await fetch(`${drive.url}schema.json`)).json();
    assert.equal(schema.find(({ key }) => key === 'cubic_mpc.horizon_steps').default, 7);
    set('cubic_mpc.weight_lateral', 321);
    await until('the weight', () => values.get('cubic_mpc.weight_lateral') === 321);
    const answer = await fetch(`${drive.url}preset.yaml`);
    const text = await answer.text();
    assert.match(answer.headers.get('content-disposition'), /preset\.yaml/);
    assert.match(text, /preset: "sixty-mph"/);
    assert.match(text, /weight_lateral: 321/);
    const file = join(folder, 'preset.yaml');
    writeFileSync(file, text);
    assert.equal(spawnSync(program, ['check', file]).status, 0);
    const again = spawnSync(program, ['drive', file, '--fast', '--laps', '1', '--set', 'time_limit_s=2', '--json']);
    assert.equal(JSON.parse(again.stdout).preset, 'sixty-mph', again.stderr.toString());
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
});
