#!/usr/bin/env python3
"""Identifies cars from logs of driving them, and races with what was found: the tables of docs/measured/plants.md.

    studies/tables/identification.py CHICANE [--keep FOLDER] [--seeds N] [--cars A,B] [--tracks A,B] [--noise X] [--no-race]

Each car drives laps with sensor noise (0.05 m, 0.3 deg, 0.1 m/s of a car in full size) and another delay of 20 to 250 ms for each log:
with odd seeds by the preset `default`, with even ones nearer to the limit (tracking_mpc.grip_share=1). The search begins with a car that is
off: stiffnesses -25 %, grip -8 %, inertia -15 %, drive and brakes -15 %, wheelbase +6 %, steering lag +50 %, drive lag +40 %, drag -20 %.

With --keep, logs and answers stay in FOLDER, and a run that is started again goes on where it was.
"""
import argparse
import json
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

OFF = {"cornering_front": 0.75, "cornering_rear": 0.75, "friction": 0.92, "yaw_inertia_kgm2": 0.85, "drive_acceleration_mps2": 0.85,
       "brake_acceleration_mps2": 0.85, "steer_lag_ms": 1.5, "front_axle_m": 1.06, "rear_axle_m": 1.06, "drive_lag_ms": 1.4,
       "drag_constant_mps2": 0.8, "drag_quadratic": 0.8}
ALL_CARS = "road-car,bmw-320i,vw-vanagon,formula-student,indy,tum-1200,f1tenth,orca-1-43,udacity"
ROOT = Path(__file__).resolve().parents[2]


def run(*words):
    return subprocess.run([str(each) for each in words], capture_output=True, text=True)


def car_file(car, folder):
    """A file of the car whose model is derived from its plant: what is fitted in the shipped one is not exactly true."""
    if car != "road-car":
        return ROOT / f"data/cars/{car}.yaml"
    file = folder / "road-car.yaml"
    if not file.exists():
        lines = [line for line in (ROOT / "data/cars/road-car.yaml").read_text().splitlines()
                 if not re.search(r"\[fit\]|cornering_|plant: road-car", line) or "friction_coupling" in line]
        file.write_text("plant: double-track\n" + "\n".join(lines) + "\n")
    return file


def stated(file, key, otherwise):
    """A number that a car file states, of the plant or of the model."""
    found = re.search(rf"^  {key}: *([-+.\de]+)", file.read_text(), re.M)
    return float(found[1]) if found else otherwise


class Campaign:
    def __init__(self, options):
        self.chicane = options.chicane
        self.options = options
        self.folder = Path(options.keep)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.cars = {}

    def car(self, name):
        if name not in self.cars:
            file = car_file(name, self.folder)
            self.cars[name] = (file, {"scale": stated(file, "scale", 1.0)})
        return self.cars[name]

    def learn_truth(self, name, log):
        """What a search assumes that begins with the car itself: the model that follows from its plant."""
        file, numbers = self.car(name)
        kept = self.folder / f"{name}.truth.json"
        if not kept.exists():
            done = run(self.chicane, "identify", log, "--car", file, "--hold-out", "0.8", "--json")
            if done.returncode != 0:
                raise SystemExit(f"{name}: {done.stderr.strip()}")
            kept.write_text(json.dumps({each["key"]: each["assumed"] for each in json.loads(done.stdout)["estimates"]}))
        numbers.update(json.loads(kept.read_text()))
        for key in ("front_axle_m", "rear_axle_m"):
            numbers[key] = stated(file, key, math.nan)

    def answer(self, car, track, seed):
        """What the log tells, or a line that says why it does not."""
        kept = self.folder / f"{car}-{track}-{seed}.json"
        if kept.exists():
            return json.loads(kept.read_text())
        answer = self.fresh_answer(*self.car(car), f"{car}-{track}-{seed}", track, seed)
        kept.write_text(json.dumps(answer))
        return answer

    def fresh_answer(self, file, numbers, name, track, seed):
        scale = numbers["scale"]
        # A model car's time is shorter by the square root of its scale, its delays, too.
        delay = random.Random(name).randrange(20, 250, 10) * math.sqrt(scale)
        log = self.folder / f"{name}.mcap"
        if not log.exists():
            part = self.folder / f"{name}.part.mcap"
            noise = self.options.noise
            words = [f"sensor.position_noise_m={0.05 * scale * noise:.6g}", f"sensor.heading_noise_deg={0.3 * noise:.6g}",
                     f"sensor.speed_noise_mps={0.1 * math.sqrt(scale) * noise:.6g}", *(["tracking_mpc.grip_share=1"] if seed % 2 == 0 else [])]
            driven = run(self.chicane, "drive", "--fast", "--json", "--car", file, "--track", track, "--laps", self.options.laps, "--seed", seed,
                       "--latency-ms", f"{delay:.1f}", "--record", part, *(word for each in words for word in ("--set", each)))
            if not driven.stdout.startswith("{"):
                return {"refused": driven.stderr.strip().splitlines()[-1] if driven.stderr.strip() else "not driven"}
            part.rename(log)
        self.learn_truth(name.split("-" + track)[0], log)
        off = [f"vehicle.{key}={numbers[key] * by:.8g}" for key, by in OFF.items() if numbers.get(key, 0.0) > 0.0]
        if "relaxation_m" in numbers:
            off += [f"plant_params.relaxation_across_m={numbers['relaxation_m'] * 1.4:.8g}",
                    f"plant_params.load_lag_ms={numbers['load_lag_ms'] * 0.7:.8g}"]
        done = run(self.chicane, "identify", log, "--car", file, "-o", self.folder / f"{name}.yaml", "--json", "--budget-s", "3000",
                   *(word for each in off for word in ("--set", each)))
        if done.returncode != 0:
            return {"refused": done.stderr.strip()}
        if not self.options.keep_logs:
            log.unlink()
        return {**json.loads(done.stdout), "delay_true_ms": delay}

    def truth(self, car, answer):
        true = json.loads((self.folder / f"{car}.truth.json").read_text())
        return {**true, "latency_ms": answer["delay_true_ms"], "steer_offset_deg": 0.0}

    def lap(self, car, track, seed, delay, is_found):
        """Third lap of `race` by the car's own plant, with its own model or with the one that was found."""
        kept = self.folder / f"{car}-{track}-{seed}.{'found' if is_found else 'true'}.lap"
        if kept.exists():
            return kept.read_text()
        file, _ = self.car(car)
        words, group = [], ""
        for line in (self.folder / f"{car}-{track}-{seed}.yaml").read_text().splitlines() if is_found else ():
            line = line.split("#")[0].rstrip()
            key, _, value = line.strip().partition(": ")
            if line.endswith(":") and not line.startswith(" "):
                group = line[:-1]
            elif line.startswith("  ") and group == "vehicle" and key != "name":
                words += ["--set", f"vehicle.{key}={value}"]
            elif key == "friction_low":
                words += ["--set", f"{key}={value}"]
        done = run(self.chicane, "drive", "--fast", "--json", "--car", file, "--preset", "race", "--track", track, "--laps", "3",
                   "--latency-ms", f"{delay:.1f}", *words)
        if not done.stdout.startswith("{"):
            text = "refused"
        else:
            race = json.loads(done.stdout)
            ok = race["off_track_events"] == 0 and len(race["laps"]) == 3
            text = f"{race['laps'][-1]['lap_time_s']:.2f}" if ok else "off"
        kept.write_text(text)
        return text


def tally_of(campaign, rows):
    by_key, by_car = {}, {}
    for car, answer in rows:
        true = campaign.truth(car, answer)
        for each in answer["estimates"]:
            key = each["key"]
            if key not in true or not each["is_excited"]:
                continue
            half = 0.5 * (each["high"] - each["low"])
            error = each["value"] - true[key]
            is_inside = each["low"] <= true[key] <= each["high"]
            for table, at in ((by_key, key), (by_car, car)):
                table.setdefault(at, []).append((is_inside, error / max(half, 1e-12), error / true[key] if true[key] else float("nan"),
                                                 half / abs(true[key]) if true[key] else float("nan")))
    return by_key, by_car


def print_tally(table, title):
    print(f"\n| {title} | inside | mean error, in halves of the interval | its rms | median error | median half of the interval |")
    print("|---|--:|--:|--:|--:|--:|")
    median = lambda values: sorted(values)[len(values) // 2]
    percent = lambda value: "–" if math.isnan(value) else f"{100 * value:.1f} %"
    for key, rows in sorted(table.items()):
        print(f"| {key} | {sum(r[0] for r in rows)} of {len(rows)} | {sum(r[1] for r in rows) / len(rows):+.2f} | "
              f"{math.sqrt(sum(r[1]**2 for r in rows) / len(rows)):.2f} | {percent(median([abs(r[2]) for r in rows]))} | {percent(median([r[3] for r in rows]))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("chicane")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--laps", default="2")
    parser.add_argument("--noise", type=float, default=1.0, help="of the sensors, times the one above; 0 shows what the model itself lacks")
    parser.add_argument("--cars", default=ALL_CARS)
    parser.add_argument("--tracks", default="hairpins,oval")
    parser.add_argument("--keep", default="", help="folder for logs and answers; a run that is started again goes on")
    parser.add_argument("--keep-logs", action="store_true", help="keep the recordings, too (30 MB each)")
    parser.add_argument("--no-race", action="store_true", help="identify only: for intervals over many logs")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as away:
        options.keep = options.keep or away
        campaign = Campaign(options)
        head = "| car | track | seed | delay | found | left unexplained | 2 s ahead | tyres used |"
        runs = sys.stderr if options.no_race else sys.stdout
        print(head + ("" if options.no_race else " race, true model | race, found |"), file=runs)
        print("|---|---|--:|--:|--:|--:|--:|--:|" + ("" if options.no_race else "--:|--:|"), file=runs)
        rows = []
        for seed in range(options.first_seed, options.first_seed + options.seeds):
            for track in options.tracks.split(","):
                for car in options.cars.split(","):
                    answer = campaign.answer(car, track, seed)
                    if "refused" in answer:
                        print(f"| {car} | {track} | {seed} | | {answer['refused']} |", file=runs, flush=True)
                        continue
                    rows.append((car, answer))
                    delay = answer["delay_true_ms"]
                    laps = "" if options.no_race else "".join(f" {campaign.lap(car, track, seed, delay, which)} |" for which in (False, True))
                    ahead = next((e["position_m"] for e in answer["held_out"][1:2]), float("nan"))
                    use = answer["tire_use"]
                    print(f"| {car} | {track} | {seed} | {delay:.0f} | {answer['delay_ms']:.0f} | {answer['residual_m']:.3f} m | {ahead:.2f} m | "
                          f"{100 * use[0]:.0f}, {100 * use[1]:.0f} % |{laps}", file=runs, flush=True)
        by_key, by_car = tally_of(campaign, rows)
        inside = sum(r[0] for each in by_key.values() for r in each)
        total = sum(len(each) for each in by_key.values())
        print(f"{inside} of {total} excited numbers lie inside their 95 % interval:")
        print_tally(by_key, "number")
        print_tally(by_car, "car")
    return 0


if __name__ == "__main__":
    sys.exit(main())
