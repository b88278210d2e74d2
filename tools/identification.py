#!/usr/bin/env python3
"""Identifies cars from logs of driving them, and races with what was found: the table of docs/identification.md.

    tools/identification.py CHICANE [--seeds N] [--cars A,B] [--tracks A,B]

Each car drives three laps with the sensors of `noisy-sensor` and another delay for each seed. The search begins with a tenth to a third
off: stiffnesses -25 %, grip -8 %, inertia -15 %, drive and brakes -15 %, steering lag 50 % more.
"""
import argparse
import json
import random
import subprocess
import sys
import tempfile

OFF = {"cornering_front": 0.75, "cornering_rear": 0.75,
       "friction": 0.92, "yaw_inertia_kgm2": 0.85, "drive_acceleration_mps2": 0.85, "brake_acceleration_mps2": 0.85,
       "steer_lag_ms": 1.5}
NOISE = ["sensor.position_noise_m=0.05", "sensor.heading_noise_deg=0.3", "sensor.speed_noise_mps=0.1"]


def run(*words):
    return subprocess.run(words, capture_output=True, text=True)


def drive(chicane, *words):
    """The summary, or None where the car cannot be driven there."""
    done = run(chicane, "drive", "--fast", "--json", *words)
    return json.loads(done.stdout) if done.stdout.strip().startswith("{") else None


def truth_of(chicane, car, log):
    """The numbers of the car's own model: what a search that begins with it assumes."""
    done = run(chicane, "identify", log, "--car", car, "--hold-out", "0", "--json")
    if done.returncode != 0:
        raise SystemExit(done.stderr.strip())
    answer = json.loads(done.stdout)
    return {each["key"]: each["assumed"] for each in answer["estimates"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("chicane")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--cars", default="road-car,udacity,formula-student,indy")
    parser.add_argument("--tracks", default="lakeside,hairpins,oval")
    parser.add_argument("--no-race", action="store_true", help="identify only: for intervals over many logs")
    options = parser.parse_args()
    truths = {}  # by car
    numbers = {}  # by key: [inside, excited, errors in halves of the interval]
    print("| car | track | seed | delay | found | left unexplained | 2 s ahead | tyres used | race, true model | race, found |")
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for car in options.cars.split(","):
        for track in options.tracks.split(","):
            for seed in range(1, options.seeds + 1):
                delay = random.Random(f"{car}{track}{seed}").randrange(20, 250, 10)
                with tempfile.TemporaryDirectory() as folder:
                    log, found = f"{folder}/run.mcap", f"{folder}/found.yaml"
                    noise = [word for each in NOISE for word in ("--set", each)]
                    told = drive(options.chicane, "--car", car, "--track", track, "--laps", "3", "--seed", str(seed),
                                 "--latency-ms", str(delay), "--record", log, *noise)
                    if told is None:
                        continue
                    if car not in truths:
                        truths[car] = truth_of(options.chicane, car, log)
                    truth = dict(truths[car])
                    off = [word for key, by in OFF.items() if key in truth
                           for word in ("--set", f"vehicle.{key}={truth[key] * by:.6g}")]
                    done = run(options.chicane, "identify", log, "--car", car, "-o", found, "--json", *off)
                    if done.returncode != 0:
                        print(f"| {car} | {track} | {seed} | {delay} | {done.stderr.strip()} |")
                        continue
                    answer = json.loads(done.stdout)
                    truth["latency_ms"] = delay
                    truth["steer_offset_deg"] = 0.0
                    for each in answer["estimates"]:
                        if each["key"] in truth and each["is_excited"]:
                            tally = numbers.setdefault(each["key"], [0, 0, []])
                            is_inside = each["low"] <= truth[each["key"]] <= each["high"]
                            tally[0] += is_inside
                            tally[1] += 1
                            tally[2].append(2.0 * (each["value"] - truth[each["key"]]) / max(1e-12, each["high"] - each["low"]))
                    laps = []
                    for which in () if options.no_race else (car, found):
                        race = drive(options.chicane, "--car", which, "--preset", "race", "--track", track, "--laps", "3",
                                     "--latency-ms", str(delay))
                        ok = race is not None and race["off_track_events"] == 0 and len(race["laps"]) == 3
                        laps.append(f"{race['laps'][-1]['lap_time_s']:.2f}" if ok else "off")
                    ahead = next((e["position_m"] for e in answer["held_out"][1:2]), float("nan"))
                    use = answer["tire_use"]
                    print(f"| {car} | {track} | {seed} | {delay} | {answer['delay_ms']:.0f} | {answer['residual_m']:.3f} m | {ahead:.2f} m | "
                          f"{100 * use[0]:.0f}, {100 * use[1]:.0f} % | {' | '.join(laps)} |", flush=True)
    inside, total = (sum(each[i] for each in numbers.values()) for i in (0, 1))
    print(f"\n{inside} of {total} excited numbers inside their 95 % interval.")
    if options.no_race:
        print("\n| number | inside | mean error, in halves of the interval |\n|---|--:|--:|")
        for key, (good, all_, errors) in sorted(numbers.items()):
            print(f"| {key} | {good} of {all_} | {sum(errors) / len(errors):+.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
