#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints what GCC needs for a program with one problem of the solver: processor time and largest memory.

    studies/tables/compile_costs.py                        the examples, and four problems of bench/families
    studies/tables/compile_costs.py FILE.cpp ...           these files
    studies/tables/compile_costs.py bench/families/X.hpp:Type    a problem, by header and type

Flags: -O2 -std=c++20 -DNDEBUG, one instruction set (baseline). Measure on an idle machine. Exit code 1 if a file does not compile."""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLAGS = ["-O2", "-std=c++20", "-DNDEBUG", f"-I{ROOT}/src", f"-I{ROOT}/bench", "-c", "-o", "/dev/null"]
FAMILIES = ("flights.hpp:Quadrotor", "machines.hpp:Reactor", "hard_limits.hpp:Tube", "chains.hpp:LongChain")
SOLVE = """#include "{header}"
#include "chicane/solver/ocp_solver.hpp"
using P = chicane::bench::{type};
using Solver = chicane::solver::OcpSolver<P, P::kHorizon>;
bool solve(Solver& ocp, const P& one, chicane::solver::Trajectory<P::kNx, P::kNu, P::kHorizon>& plan) {{
  return ocp.solve(one, one.start, plan).status == chicane::solver::SolveStatus::kOptimal;
}}
"""


def compile_once(source):
    """Processor time [s] and largest memory [MB] of one compilation, or None where it fails."""
    pid = os.spawnvp(os.P_NOWAIT, "g++", ["g++", *FLAGS, str(source)])
    _, status, used = os.wait4(pid, 0)
    return None if status else (used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0)


def cost(name, folder):
    """Compiles `name`, a file or HEADER:TYPE."""
    if ":" not in name:
        return compile_once(ROOT / name)
    header, kind = name.split(":")
    source = Path(folder) / f"{kind}.cpp"
    source.write_text(SOLVE.format(header=(ROOT / header).resolve(), type=kind), encoding="utf-8")
    return compile_once(source)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="FILE.cpp | HEADER:TYPE")
    options = parser.parse_args()
    examples = sorted((ROOT / "examples" / "solver").glob("*.cpp"))
    names = options.names or [str(file.relative_to(ROOT)) for file in examples] + [f"bench/families/{name}" for name in FAMILIES]
    version = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True, check=True).stdout.strip()
    print(f"| problem (GCC {version}) | time | memory |\n|---|--:|--:|")
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            found = cost(name, folder)
            failed |= found is None
            print(f"| `{name}` | " + ("does not compile | – |" if found is None else f"{found[0]:.1f} s | {found[1]:.0f} MB |"), flush=True)
    sys.exit(1 if failed else 0)


main()
