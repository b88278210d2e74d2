#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Problems written in Python, interpreted, and exported beside Ipopt: the tables of docs/measured/python.md.

    ./run.sh python python/tests/problem_table.py [NAME...]   a row for each family
    ./run.sh python python/tests/problem_table.py --many      10,000 cart-poles at once
    ./run.sh python python/tests/problem_table.py --changes   sensitivities of 200 instances against differences
    ./run.sh python python/tests/problem_table.py --references   exported and compiled, Ipopt, and cart-pole written by hand (needs bench's packages)
    ./run.sh python python/tests/problem_table.py --feedback  feedback against whole solves

Exit code 1 where an answer is wrong."""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import families

ROOT = Path(__file__).resolve().parents[2]


def instruction_set():
    """The widest one of this processor, and g++'s flags for it."""
    words = set(Path("/proc/cpuinfo").read_text(encoding="utf-8").split("flags", 1)[1].split("\n", 1)[0].split())
    if {"avx512f", "avx512dq", "avx512vl", "fma"} <= words:
        return "Avx512", ["-mavx2", "-mfma", "-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]
    return ("Avx2", ["-mavx2", "-mfma"]) if {"avx2", "fma"} <= words else ("Baseline", [])


def fastest(solve, times=100):
    """The solution that took least."""
    return min((solve() for _ in range(times)), key=lambda solution: solution.time)


def row(name, make):
    """Its line, and whether it is solved."""
    begin = time.thread_time()
    ocp, x0, p = make()
    first = ocp.solve(x0, p)
    waited = time.thread_time() - begin
    cold, warm = fastest(lambda: ocp.solve(x0, p)), fastest(lambda: ocp.solve(x0, p, u=first.u, x=first.x))
    print(f"| {name} | {cold.status} | {cold.cost:.6g} | {1e3 * waited:.1f} | {1e3 * cold.time:.2f} | {1e3 * warm.time:.3f} |", flush=True)
    return cold.status == "optimal", waited


def table(names):
    print("| family | status | cost | first answer [ms] | cold [ms] | warm [ms] |\n|---|---|--:|--:|--:|--:|")
    rows = [row(name, make) for name, make in families.FAMILIES.items() if not names or name in names]
    print(f"\nlongest first answer {1e3 * max(waited for _, waited in rows):.0f} ms")
    return all(right for right, _ in rows)


def many(count):
    """Processor time, which threads share: what a problem costs for any number of them."""
    ocp, _, _ = families.cart_pole()
    x0 = np.random.default_rng(1).normal(0, 0.3, (count, 4))
    for threads in (1, 2):
        begin = time.process_time()
        answers = ocp.solve_many(x0, threads=threads)
        print(f"{threads} threads: {1e3 * (time.process_time() - begin) / count:.3f} ms for each of {count}; {answers!r}", flush=True)
        if threads == 1:
            inputs = answers.u
    is_same = bool(np.array_equal(inputs, answers.u))
    loop = x0[:max(1, count // 20)]
    begin = time.process_time()
    for each in loop:
        ocp.solve(each)
    print(f"a loop of solve(): {1e3 * (time.process_time() - begin) / len(loop):.3f} ms; same bits: {is_same}")
    return is_same


def solved(ocp, x0, p, start=None):
    """As far as rounding lets it be."""
    for tolerance in (1e-10, 1e-9):
        solution = ocp.solve(x0, p, start=start, tolerance=tolerance)
        if solution.status == "optimal":
            break
    return solution


def slope(ocp, solution, p, number, step):
    """Of the inputs by a number of x0, by central differences; None where a neighbour is at another optimum."""
    change = step * np.eye(len(solution.x0))[number]
    ends = [solved(ocp, solution.x0 + sign * change, p, solution) for sign in (1, -1)]
    bend = abs(ends[0].cost + ends[1].cost - 2 * solution.cost)
    if not all(end.status == "optimal" for end in ends) or bend > 1e-4 * abs(solution.cost):
        return None
    return (ends[0].u - ends[1].u) / (2 * step)


def changes(count):
    """`count` instances of all families in turns, each constraint clearly active or clearly not: differences of a solver that ends
    with room · multiplier at 1e-10 have five digits where either is above 5e-3."""
    worst, one_sided, narrow, compared, missed = 0.0, 0, 0, 0, 0
    random = np.random.default_rng(5)
    makers = list(families.FAMILIES.values())
    for n in range(20 * count):
        ocp, x0, p = makers[n % len(makers)]()
        solution = solved(ocp, x0 + 0.1 * random.standard_normal(len(x0)), p)
        number = int(random.integers(1, len(x0)))           # of a race car, the first one matters to nothing
        if solution.status != "optimal":
            missed += 1
            continue
        change = solution.sensitivity("x0")
        if change.is_one_sided or change.margin < 5e-3:
            one_sided += change.is_one_sided
            narrow += not change.is_one_sided
            continue
        near, far = (slope(ocp, solution, p, number, step) for step in (2e-4, 4e-4))
        if near is None or far is None or np.abs(near - far).max() > 1e-3 * np.abs(near).max():
            missed += 1
            continue
        numeric = (4 * near - far) / 3                       # of fourth order
        worst = max(worst, float(np.abs(numeric - change.u[:, :, number]).max() / np.abs(numeric).max()))
        compared += 1
        if compared == count:
            break
    print(f"{compared} instances of {len(makers)} families, largest relative error {worst:.1e}. Left out: {one_sided} that say that they are one-sided, "
          f"{narrow} with less margin than differences need, {missed} not solved to 1e-9 or with differences that do not agree with each other")
    return compared == count and worst <= 1e-5


def reference(name, make):
    """Its line: our solver interpreted and exported, by hand where there is one, and Ipopt, all cold from a simulation of zeros; and both of ours
    from the solution."""
    ocp, x0, p = make()
    seconds = []                                            # of the processor, as for the others
    for _ in range(25):
        begin = time.thread_time()
        interpreted = ocp.solve(x0, p)
        seconds.append(time.thread_time() - begin)
    least = min(seconds)
    warm = fastest(lambda: ocp.solve(x0, p, u=interpreted.u, x=interpreted.x), times=60).time
    with tempfile.TemporaryDirectory() as folder:
        header, program = Path(folder) / "problem.hpp", Path(folder) / "program"
        ocp.export(header, "Problem")
        flags = subprocess.run(["pkg-config", "--cflags", "--libs", "ipopt", "eigen3"], capture_output=True, text=True, check=True).stdout.split()
        arch, own = instruction_set()
        is_written = name == "cart-pole swing-up"
        subprocess.run(["g++", "-std=c++20", "-O2", "-DNDEBUG", "-ffp-contract=off", "-fno-math-errno", "-w", f"-DCHICANE_ARCH={arch}", *own,
                        f'-DEXPORTED="{header}"', *(["-DWRITTEN"] if is_written else []), f"-I{ROOT}/src", f"-I{ROOT}/bench",
                        str(ROOT / "bench/exported_problem.cpp"), str(ROOT / "src/chicane/base/math.cpp"), "-o", str(program), *flags], check=True)
        numbers = [*x0, *(ocp.stage_parameters(p).ravel() if p is not None else ())]
        told = json.loads(subprocess.run([str(program)], input=" ".join(repr(float(value)) for value in numbers), capture_output=True, text=True,
                                         check=True).stdout)
    cost = told["own_cost"] + ocp.cost_offset()
    apart = abs(told["ipopt_cost"] - told["own_cost"]) / max(1.0, abs(told["own_cost"]))
    by_hand = f"{told['own_s'] / told['written_s']:.2f}" if is_written else "–"
    print(f"| {name} | {cost:.6g} | {apart:.0e} | {1e3 * told['ipopt_s']:.1f} | {told['ipopt_turns']} | {1e3 * least:.2f} | "
          f"{1e3 * told['own_s']:.2f} | {told['ipopt_s'] / least:.0f} | {told['ipopt_s'] / told['own_s']:.0f} | {by_hand} | {1e6 * warm:.0f} | {1e6 * told['warm_s']:.0f} | {warm / told['warm_s']:.1f} |", flush=True)
    is_right = told["status"] == 0 and abs(interpreted.cost - cost) <= 1e-9 * max(1.0, abs(cost))
    return is_right, told["ipopt_s"] / least, told["ipopt_s"] / told["own_s"], warm / told["warm_s"]


def references(names):
    print("| family | cost | Ipopt's apart | Ipopt [ms] | iterations | interpreted [ms] | compiled [ms] | × interpreted | × compiled | compiled / by hand | "
          "warm interpreted [µs] | compiled [µs] | ratio |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    rows = [reference(name, make) for name, make in families.FAMILIES.items() if not names or name in names]
    print(f"\nmedians: {np.median([row[1] for row in rows]):.0f} × interpreted, {np.median([row[2] for row in rows]):.0f} × compiled, {np.median([row[3] for row in rows]):.1f} times as long warm")
    return all(row[0] for row in rows)


def feedback():
    """Of each family, interpreted: a whole warm solve from a state beside the prepared one, and feedback, in turns."""
    print("| family | prepare [ms] | feedback [µs] | whole solve [µs] | ratio | inputs apart |")
    print("|---|--:|--:|--:|--:|--:|")
    for name, make in families.FAMILIES.items():
        ocp, x0, p = make()
        beside = x0 + 1e-4
        first = ocp.solve(x0, p)
        preparation, answers, solves = [], [], []
        for _ in range(15):
            ocp.solve(x0, p, u=first.u, x=first.x)
            begin = time.perf_counter()
            ocp.prepare(x0, p)
            preparation.append(time.perf_counter() - begin)
            answers.append(ocp.feedback(beside))
            solves.append(ocp.solve(beside, p, u=first.u, x=first.x))
        quick, whole = min(answer.time for answer in answers), min(one.time for one in solves)
        apart = np.abs(answers[-1].u - solves[-1].u).max() / max(1.0, np.abs(solves[-1].u).max())
        print(f"| {name} | {1e3 * min(preparation):.2f} | {1e6 * quick:.0f} | {1e6 * whole:.0f} | {whole / quick:.0f} | {apart:.0e} |", flush=True)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="families of the table; all")
    parser.add_argument("--many", type=int, nargs="?", const=10000, default=0)
    parser.add_argument("--changes", type=int, nargs="?", const=200, default=0)
    parser.add_argument("--references", nargs="*")
    parser.add_argument("--feedback", action="store_true")
    given = parser.parse_args()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    if given.many:
        return 0 if many(given.many) else 1
    if given.references is not None:
        return 0 if references(given.references) else 1
    if given.feedback:
        return 0 if feedback() else 1
    if given.changes:
        return 0 if changes(given.changes) else 1
    return 0 if table(given.names) else 1


if __name__ == "__main__":
    sys.exit(main())
