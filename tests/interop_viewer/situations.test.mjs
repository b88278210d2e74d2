// SPDX-License-Identifier: MIT
// What live pages say beside what acted on the car: combinations of preset, car and fault, each with a page of its own
// that is read again and again, and a second viewer that has every frame. CHICANE_COMBINATIONS: how many.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { after, before, it } from 'node:test';
import { launch } from './browser.mjs';
import { startDrive, watch } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';

const COUNT = Number(process.env.CHICANE_COMBINATIONS ?? 60);
const PACE = 8;
const FAULT_AT_S = 5;
const FAULT_S = 4;
const UNTIL_S = 16; // of the run
const LOOK_EVERY_MS = 40;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const namesOf = (shelf) =>
  execFileSync(process.env.CHICANE ?? 'chicane', ['list', shelf], { encoding: 'utf8' })
    .split('\n')
    .flatMap((line) => /^([a-z][\w-]*) {2,}/.exec(line)?.[1] ?? []);

/** Each preset, car and fault equally often, in other company each time; `race` plans a lap, once for one car. */
function combinations() {
  const [presets, cars, faults] = ['presets', 'cars', 'faults'].map(namesOf);
  return Array.from({ length: COUNT }, (_, i) => {
    const round = Math.floor(i / presets.length);
    return {
      preset: presets[i % presets.length],
      car: presets[i % presets.length] === 'race' ? 'udacity' : cars[(i + 4 * round) % cars.length],
      fault: faults[(7 * i + round) % faults.length],
    };
  });
}

/** Runs in the page: keeps what the strip says, whenever that changes. */
function keepLooks(every) {
  globalThis.looks = [];
  const read = (id) => document.querySelector(`[data-testid="${id}"]`)?.textContent ?? '';
  setInterval(() => {
    const strip = document.querySelector('.strip');
    const why = document.querySelector('[data-testid="why"] > p')?.textContent ?? '';
    const look = {
      why,
      isAlarm: strip?.classList.contains('alarm') ?? false,
      keys: [...document.querySelectorAll('.strip .keys kbd')].map((each) => each.textContent),
      pedal: read('pedal'),
      wheels: read('wheels'),
      lapTime: read('lap-time'),
    };
    const last = globalThis.looks.at(-1);
    if (JSON.stringify(last) !== JSON.stringify(look)) globalThis.looks.push(look);
  }, every);
}

/** What a reader would say of a sentence beside the bars; null: nothing. */
function against({ why, pedal, isAlarm, keys }) {
  if (why === '' || /undefined|NaN/.test(why)) return 'no sentence';
  if (why.split(' ').length > 6) return 'more than six words';
  if (isAlarm && !(keys.includes('M') && keys.includes('R'))) return 'an alarm without its keys';
  if (isAlarm) return null; // it has the place of the bars
  const percent = Number(/\d+/.exec(pedal)?.[0] ?? NaN);
  if (/^Brakes\b(?!.*give)/.test(why) && pedal.startsWith('drive')) return 'brakes, and drives';
  if (why.startsWith('Full throttle') && !(pedal.startsWith('drive') && percent >= 98)) return 'not full throttle';
  if (why.startsWith('Part throttle') && !(pedal.startsWith('drive') && percent < 99)) return 'not part throttle';
  return why.startsWith('Rolls') && percent > 5 ? 'does not roll' : null;
}

/** The bars as the page writes them. */
function barsOf({ throttle_applied: throttle, steer_applied_rad: steer }, fullBrake) {
  const share = throttle >= 0 ? throttle : Math.min(1, -throttle / fullBrake);
  return { percent: 100 * share, isDrive: throttle >= 0, degrees: Math.abs((steer * 180) / Math.PI) };
}

/** Whether the frame that is shown has these bars, up to their digits; of two with this lap time, either. */
const isRecorded = (look, frames, fullBrake) =>
  frames.some((frame) => {
    const { percent, isDrive, degrees } = barsOf(frame, fullBrake);
    const shown = Number(/\d+/.exec(look.pedal)?.[0]);
    return (
      Math.abs(percent - shown) <= 0.51 &&
      (isDrive === look.pedal.startsWith('drive') || percent < 0.51) &&
      Math.abs(degrees - Number(/[\d.]+/.exec(look.wheels)?.[0])) <= 0.051
    );
  });

const secondsOf = (text) => {
  const [, minutes, rest] = /(\d+):([\d.]+)/.exec(text) ?? [];
  return 60 * Number(minutes) + Number(rest);
};

/** A second viewer of a run: a lap that is planned first has none, nor while the page of the plan gives way. */
async function whenPlanned(url) {
  for (;;) {
    const viewer = await watch(url).catch((error) => {
      if (!/503|ECONNREFUSED/.test(String(error))) throw error;
    });
    if (viewer) return viewer;
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
}

it('no page contradicts what acted on the car', { timeout: 3_600_000 }, async () => {
  const found = new Map();
  const most = { alarms: 0, name: 'none' };
  let [looks, compared, alarms] = [0, 0, 0];
  for (const { preset, car, fault } of combinations()) {
    const name = `${preset} ${car} ${fault}`;
    const options = ['--preset', preset, '--car', car, '--track', 'oval', '--pace', String(PACE)];
    const drive = await startDrive([...options, '--fault', `${fault}@${FAULT_AT_S}+${FAULT_S}`]);
    const other = await whenPlanned(drive.url);
    const dashboard = await DashboardPage.open(browser, drive.url, { mode: 'watch', state: 'Live' });
    const time = () => Number(other.newest?.time_s ?? NaN);
    // The page was opened in the middle of the run.
    for (let i = 0; !(time() < FAULT_AT_S - 1); ++i) {
      assert.ok(i < 600, `${name}: its start, still ${time()}`);
      if (i % 20 === 0) await dashboard.startAgain();
      await dashboard.page.waitForTimeout(50);
    }
    const earlier = [...other.frames.values()]; // the page may still show one of them
    other.frames.clear();
    await dashboard.page.evaluate(keepLooks, LOOK_EVERY_MS);
    await dashboard.until(time, (seconds) => seconds >= UNTIL_S, `${name}: its ${UNTIL_S} s`);
    const seen = await dashboard.page.evaluate(() => globalThis.looks);
    const fullBrake = other.fullBrake();
    const frames = [...earlier, ...other.frames.values()];
    let onsets = 0;
    seen.forEach((look, i) => {
      ++looks;
      if (look.isAlarm && !seen[i - 1]?.isAlarm) ++onsets;
      const wrong = against(look);
      if (wrong) found.set(`${wrong}: ${look.why} | ${look.pedal}`, name);
      const at = secondsOf(look.lapTime);
      if (look.isAlarm || !Number.isFinite(at)) return;
      const then = frames.filter((each) => Math.abs(each.lap_time_s - at) <= 0.0051);
      if (then.length === 0) return;
      ++compared;
      if (!isRecorded(look, then, fullBrake)) found.set(`not recorded: ${look.pedal} ${look.wheels}`, `${name} ${at}`);
    });
    alarms += onsets;
    if (onsets > most.alarms) Object.assign(most, { alarms: onsets, name });
    other.close();
    await dashboard.leave();
    await drive.stop();
  }
  console.log(
    `${looks} looks at ${COUNT} runs, ${compared} of them beside the recorded frame, ${found.size} contradictions; ` +
      `${alarms} alarms, at most ${most.alarms} in a run (${most.name})`,
  );
  assert.deepEqual(Object.fromEntries(found), {});
  assert.ok(compared > 5 * COUNT, `${compared} looks beside recorded frames`);
});
