#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the Python module costs: the figures of docs/python.md, each pair taken in turns.

    ./run.sh python python/tests/speed_table.py

f1tenth_gym's simulator class, where it can be imported (`F110Env`'s Simulator), is stepped beside it."""
import importlib.util
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

import chicane as ch

STEPS = 200


def seconds(work, clock=time.perf_counter):
    begin = clock()
    work()
    return clock() - begin


def import_time():
    """Processor time of a process that imports the module, of one that imports numpy, and of one that imports nothing."""
    with tempfile.TemporaryDirectory() as folder:             # compiled Python, as after the first import
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"} | {"PYTHONPYCACHEPREFIX": folder}

        def cpu(code):
            before = os.times()
            subprocess.run([sys.executable, "-c", code], check=True, env=environment)
            after = os.times()
            return after.children_user + after.children_system - before.children_user - before.children_system
        pairs = [(cpu("import chicane"), cpu("import numpy"), cpu("pass")) for _ in range(8)]
    return [min(column) for column in zip(*pairs[1:])]


def make_env(car, **others):
    return ch.Env("oval", car=car, rate_hz=20, ends_off_road=False, seed=1, **others)


def lap(car):
    """Commands that drive the car round the oval at 20 Hz."""
    run = ch.drive("oval", car=car, laps=1, settings={"control_period_ms": 50, "guard.mode": "off"})
    return np.column_stack([run.frames["steer_asked_rad"], run.frames["throttle_asked"]])[:STEPS]


def environment(car):
    """Steps per second of processor time at 20 Hz, by Python and in C++, with the commands of a lap."""
    python, native, actions = make_env(car), make_env(car), lap(car)
    works = lambda env: [env.step(action) for action in actions], lambda env: env._core.repeat(actions)  # noqa: E731
    least = [np.inf, np.inf]
    for _ in range(15):
        for n, (env, work) in enumerate(zip((python, native), works)):
            env.reset(seed=1)
            least[n] = min(least[n], seconds(lambda: work(env), clock=time.thread_time))
    assert python.state_hash == native.state_hash
    return [len(actions) / each for each in least]


def threads(car, count=16, repeats=60):
    """Steps per second of a VecEnv on one thread and on two, of the clock on the wall: the least time of each step, so that a burst of
    other work does not count."""
    made = [ch.VecEnv(count, "oval", car=car, rate_hz=20, threads=number, ends_off_road=False, seed=1) for number in (1, 2)]
    actions = np.repeat(lap(car)[:, None], count, axis=1)[:25]
    least = np.full((2, len(actions)), np.inf)
    for _ in range(repeats):
        for n, envs in enumerate(made):
            envs.reset()
            least[n] = np.minimum(least[n], [seconds(lambda action=action: envs.step(action)) for action in actions])
    return count * len(actions) / least.sum(axis=1)


def main():
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    own, numpy, nothing = import_time()
    print(f"import chicane: {1e3 * own:.0f} ms of processor time in all; import numpy {1e3 * numpy:.0f}, Python itself {1e3 * nothing:.0f}")
    print("\n| car | steps/s in Python | in C++ | share | VecEnv(16), 1 thread | 2 threads | gain |\n|---|--:|--:|--:|--:|--:|--:|")
    for car in ("f1tenth", "road-car", "udacity"):
        python, native = environment(car)
        one, two = threads(car)
        print(f"| `{car}` | {python:,.0f} | {native:,.0f} | {python / native:.2f} | {one:,.0f} | {two:,.0f} | {two / one:.2f} |", flush=True)
    if importlib.util.find_spec("f110_gym") is None:
        print("\nf1tenth_gym is not there: pip install f110-gym in another environment, and run this again")
        return
    import f110_gym
    from f110_gym.envs.base_classes import Integrator, Simulator
    from f110_gym.envs.f110_env import F110Env  # its parameters
    simulator = Simulator(F110Env().params, 1, 12345, time_step=0.01, integrator=Integrator.RK4)
    simulator.set_map(f110_gym.__path__[0] + "/envs/maps/vegas.yaml", ".png")
    simulator.reset(np.zeros((1, 3)))
    control = np.array([[0.05, 2.0]])
    gym = min(seconds(lambda: [simulator.step(control) for _ in range(5 * STEPS)]) for _ in range(5))
    env = make_env("f1tenth", observation="scan")
    ours = min(seconds(lambda: [env.reset(seed=1), *map(env.step, [[0.05, 0.1]] * 100)]) for _ in range(5)) / 100
    print(f"50 ms of simulated time with scans: f1tenth_gym's Simulator {STEPS / gym:,.0f} a second, Env {1 / ours:,.0f}")


if __name__ == "__main__":
    main()
