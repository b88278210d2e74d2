#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Problems written in Python, interpreted and compiled, side by side: the tables of docs/python_problems.md.

    ./run.sh python python/tests/problem_table.py             a row for each family
    ./run.sh python python/tests/problem_table.py --many      10,000 cart-poles at once
    ./run.sh python python/tests/problem_table.py --changes   sensitivities of 200 instances against differences

Compiles each family by g++: minutes the first time. Exit code 1 where an answer is wrong."""
import argparse
import os
import sys
import time

import numpy as np

import families


def fastest(solve, times=30):
    """The solution that took least."""
    return min((solve() for _ in range(times)), key=lambda solution: solution.time)


def row(name, make):
    """Its line, and whether both kinds agree."""
    begin = time.perf_counter()
    ocp, x0, p = make()
    first = ocp.solve(x0, p)
    waited = time.perf_counter() - begin
    cold, warm = fastest(lambda: ocp.solve(x0, p)), fastest(lambda: ocp.solve(x0, p, u=first.u, x=first.x))
    begin = time.perf_counter()
    ocp.compile(wait=True)
    compiling = time.perf_counter() - begin
    cold_compiled = fastest(lambda: ocp.solve(x0, p))
    warm_compiled = fastest(lambda: ocp.solve(x0, p, u=first.u, x=first.x))
    apart = abs(cold.cost - cold_compiled.cost) / max(1.0, abs(cold.cost))
    print(f"| {name} | {cold.status} | {cold.cost:.6g} | {apart:.0e} | {1e3 * waited:.1f} | {1e3 * cold.time:.2f} | {1e3 * warm.time:.3f} | "
          f"{1e3 * cold_compiled.time:.2f} | {1e3 * warm_compiled.time:.3f} | {warm.time / warm_compiled.time:.1f} | {compiling:.0f} |", flush=True)
    return cold.status == cold_compiled.status == "optimal" and apart < 1e-9, waited, warm.time / warm_compiled.time


def table():
    print("| family | status | cost | apart | first answer [ms] | cold [ms] | warm [ms] | compiled cold [ms] | warm [ms] | ratio | compiler [s] |")
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    rows = [row(name, make) for name, make in families.FAMILIES.items()]
    print(f"\nmedian ratio {np.median([ratio for _, _, ratio in rows]):.2f}, longest wait {1e3 * max(waited for _, waited, _ in rows):.0f} ms")
    return all(right for right, _, _ in rows)


def many(count):
    ocp, _, _ = families.cart_pole()
    x0 = np.random.default_rng(1).normal(0, 0.3, (count, 4))
    times = {}
    for threads in (1, 2):
        begin = time.perf_counter()
        answers = ocp.solve_many(x0, threads=threads)
        times[threads] = time.perf_counter() - begin
        print(f"{threads} threads: {1e3 * times[threads] / count:.3f} ms for each of {count}; {answers!r}", flush=True)
        if threads == 1:
            inputs = answers.u
    is_same = bool(np.array_equal(inputs, answers.u))
    loop = x0[:max(1, count // 20)]
    begin = time.perf_counter()
    for each in loop:
        ocp.solve(each)
    print(f"a loop of solve(): {1e3 * (time.perf_counter() - begin) / len(loop):.3f} ms; same bits: {is_same}")
    return is_same


def changes(count):
    worst, one_sided, compared, missed = 0.0, 0, 0, 0
    random = np.random.default_rng(5)
    makers = [families.cart_pole, families.rocket, families.crane, families.parking, families.race_car]
    while compared < count:
        ocp, x0, p = makers[compared % len(makers)]()
        x0 = x0 + 0.1 * random.standard_normal(len(x0))
        solution = ocp.solve(x0, p, tolerance=1e-10)
        if solution.status != "optimal":                     # to that tolerance
            missed += 1
            continue
        compared += 1
        change = solution.sensitivity("x0")
        if change.is_one_sided:
            one_sided += 1
            continue
        n = int(random.integers(1, len(x0)))                # of a race car, the first one matters to nothing
        step = np.zeros(len(x0))
        step[n] = 1e-5
        ends = [ocp.solve(x0 + sign * step, p, start=solution, tolerance=1e-10) for sign in (1, -1)]
        bend = abs(ends[0].cost + ends[1].cost - 2 * solution.cost)
        if not all(end.status == "optimal" for end in ends) or bend > 1e-5 * solution.cost:       # at another optimum
            missed += 1
            continue
        numeric = (ends[0].u - ends[1].u) / 2e-5
        worst = max(worst, float(np.abs(numeric - change.u[:, :, n]).max() / np.abs(numeric).max()))
    print(f"{compared} instances, {one_sided} said to be one-sided, {missed} not solved to 1e-10 or with a neighbour at another optimum; of the others the largest relative error {worst:.1e}")
    return worst <= 1e-5


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--many", type=int, nargs="?", const=10000, default=0)
    parser.add_argument("--changes", type=int, nargs="?", const=200, default=0)
    given = parser.parse_args()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    if given.many:
        return 0 if many(given.many) else 1
    if given.changes:
        return 0 if changes(given.changes) else 1
    return 0 if table() else 1


if __name__ == "__main__":
    sys.exit(main())
