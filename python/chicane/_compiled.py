# SPDX-License-Identifier: MIT
"""A problem compiled by g++ in the background, kept by its content."""
from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _export

if TYPE_CHECKING:
    from ._problem import Problem

Array = npt.NDArray[np.float64]
_HERE = Path(__file__)
_GLUE = """
#include <algorithm>
#include <chrono>
#include <memory>
namespace {
using namespace chicane::solver;
struct Solver {
  Problem problem;
  OcpSolver<Problem, Problem::kHorizon> solver;
  Trajectory<Problem::kNx, Problem::kNu, Problem::kHorizon> trajectory;
};
// Multipliers and misses of what must hold, where the problem has such rows.
template <class Solver, class Report>
void store_hard(const Solver& solver, const Report& r, double* equalities, double* end, double* report) {
  if constexpr (HardProblem<Problem>) {
    report[9] = r.miss;
    report[10] = static_cast<int>(r.kind);
    report[11] = r.miss_stage;
    report[12] = r.miss_row;
    for (int k = 0; k < Problem::kHorizon; ++k) {
      for (int n = 0; n < equality_count<Problem>(); ++n) *equalities++ = solver.equality_multiplier(k, n);
    }
    for (int n = 0; n < terminal_equality_count<Problem>(); ++n) *end++ = solver.terminal_equality_multiplier(n);
    for (int n = 0; n < terminal_constraint_count<Problem>(); ++n) *end++ = solver.terminal_constraint_multiplier(n);
  }
}
}  // namespace
#pragma GCC visibility push(default)
extern "C" {
void* chicane_new() { return new Solver; }
void chicane_delete(void* self) { delete static_cast<Solver*>(self); }
// options: tolerance, turns, second order, start from states, budget [s]; report: status, turns, cost, stationarity, defect,
// complementarity, violation, its stage and constraint, miss, its kind, stage and row, seconds
void chicane_solve(void* self, const double* options, const double* lower, const double* upper, const double* p, const double* x0, double* x,
                   double* u, double* dynamics, double* bounds, double* constraints, double* equalities, double* end, double* report) {
  Solver& s = *static_cast<Solver*>(self);
  constexpr int kN = Problem::kHorizon, kNx = Problem::kNx, kNu = Problem::kNu;
  const auto begin = std::chrono::steady_clock::now();
  s.solver.set_options({.tolerance = options[0], .max_iterations = static_cast<int>(options[1]), .start_from_states = options[3] != 0.0,
                        .second_order = options[2] != 0.0});
  s.trajectory.horizon = kN;
  for (int k = 0; k <= kN; ++k) {
    for (std::size_t n = 0; n < PARAMETERS; ++n) s.problem.p[n][static_cast<std::size_t>(k)] = *p++;
    std::copy_n(x + k * kNx, kNx, s.trajectory.x[k].begin());
    if (k == kN) break;
    std::copy_n(u + k * kNu, kNu, s.trajectory.u[k].begin());
    std::copy_n(lower + k * kNu, kNu, s.problem.lower[k].begin());
    std::copy_n(upper + k * kNu, kNu, s.problem.upper[k].begin());
  }
  std::array<double, Problem::kNx> start;
  std::copy_n(x0, kNx, start.begin());
  const chicane::Deadline deadline = options[4] > 0.0 ? chicane::Deadline::after(std::chrono::nanoseconds(static_cast<long long>(1e9 * options[4])))
                                             : chicane::Deadline::never();
  const auto r = s.solver.solve(s.problem, start, s.trajectory, deadline);
  for (int k = 0; k <= kN; ++k) std::copy_n(s.trajectory.x[k].begin(), kNx, x + k * kNx);
  for (int k = 0; k < kN; ++k) {
    std::copy_n(s.trajectory.u[k].begin(), kNu, u + k * kNu);
    for (int i = 0; i < kNx; ++i) *dynamics++ = s.solver.adjoint(k, i);
    for (int m = 0; m < kNu; ++m) *bounds++ = s.solver.bound_multiplier(k, m);
    for (int c = 0; c < Problem::kNc; ++c) *constraints++ = s.solver.constraint_multiplier(k, c);
  }
  const double told[] = {static_cast<double>(static_cast<int>(r.status)), double(r.iterations), r.cost, r.stationarity, r.defect, r.complementarity,
                         r.violation, double(r.worst_stage), double(r.worst_constraint)};
  std::copy(std::begin(told), std::end(told), report);
  report[9] = report[10] = 0.0;
  report[11] = report[12] = -1.0;
  store_hard(s.solver, r, equalities, end, report);
  report[13] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
}
"""


def headers() -> Path:
    """The folder with the library's headers: in the package, in the clone, or in the system."""
    package = _HERE.resolve().parent
    places = [package / "share/chicane/include", package.parents[1] / "src", Path("/usr/include"), Path("/usr/local/include")]
    for place in places:
        if (place / "chicane/solver/sparse_row.hpp").is_file():
            return place
    raise RuntimeError(f"compile: the library's headers are in none of {', '.join(map(str, places))}")


def instruction_set() -> tuple[str, list[str]]:
    """The widest one of this processor, and g++'s flags for it."""
    try:
        words = set(Path("/proc/cpuinfo").read_text(encoding="utf-8").split("flags", 1)[1].split("\n", 1)[0].split())
    except (OSError, IndexError):
        words = set()
    if {"avx512f", "avx512dq", "avx512vl", "fma"} <= words:
        return "Avx512", ["-mavx2", "-mfma", "-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]
    if {"avx2", "fma"} <= words:
        return "Avx2", ["-mavx2", "-mfma"]
    return "Baseline", []


class Compilation:
    """A problem on its way to a shared library, and the solver in it."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        compiler = shutil.which("g++") or shutil.which("c++")
        if compiler is None:
            raise RuntimeError("compile: g++ is not there: apt-get install g++")
        name, flags = instruction_set()
        include = headers()
        source = _export.header(problem, "Problem") + _GLUE.replace("PARAMETERS", str(problem.full_count))
        # What several such libraries in one process have in common must not be taken for the same.
        command = [compiler, "-std=c++20", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-gnu-unique", "-ffp-contract=off", "-fno-math-errno", "-w", f"-DCHICANE_ARCH={name}", *flags]
        version = (include / "chicane/version.hpp").read_bytes() if (include / "chicane/version.hpp").is_file() else b""
        library = b"".join(file.read_bytes() for file in sorted((include / "chicane/solver").rglob("*.hpp")))
        key = hashlib.sha256(source.encode() + repr(command[1:]).encode() + version + library).hexdigest()[:24]
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "chicane"
        cache.mkdir(parents=True, exist_ok=True)
        self.file = cache / f"{key}.so"
        self.seconds = 0.0
        self._error = ""
        self.solver: CompiledSolver | None = None
        self._thread = threading.Thread(target=self._run, args=(command, source, include), daemon=True)
        self._thread.start()

    def _run(self, command: list[str], source: str, include: Path) -> None:
        begin = time.perf_counter()
        try:
            if not self.file.exists():
                with tempfile.TemporaryDirectory(dir=self.file.parent) as folder:
                    text = Path(folder) / "problem.cpp"
                    text.write_text(source, encoding="utf-8")
                    made = Path(folder) / "problem.so"
                    done = subprocess.run([*command, f"-I{include}", str(text), str(include / "chicane/base/math.cpp"), "-o", str(made)],
                                          capture_output=True, text=True)
                    if done.returncode != 0:
                        self._error = f"compile: {' '.join(command)} has failed:\n{done.stderr[:2000]}"
                        return
                    made.rename(self.file)
            self.seconds = time.perf_counter() - begin
            self.solver = CompiledSolver(self._problem, self.file)
        except OSError as error:
            self._error = f"compile: {error}"

    def is_done(self, wait: bool) -> bool:
        if wait:
            self._thread.join()
        if self._error:
            raise RuntimeError(self._error)
        return self.solver is not None


class CompiledSolver:
    """The same functions as the interpreter's, by the compiled library."""

    def __init__(self, problem: Problem, file: Path) -> None:
        self._library = ctypes.CDLL(str(file))
        self._library.chicane_new.restype = ctypes.c_void_p
        self._library.chicane_delete.argtypes = [ctypes.c_void_p]
        self._library.chicane_solve.argtypes = [ctypes.c_void_p] + [ctypes.c_void_p] * 13
        self._library.chicane_solve.restype = None
        self._problem = problem
        self._handle = self._library.chicane_new()
        rows = {name: len(own) for name, own in problem.all_rows().items()}
        self._rows = rows

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            self._library.chicane_delete(self._handle)

    def set(self, lower: Array, upper: Array, prices: Array, is_hard: list[bool], options: dict[str, Any]) -> None:
        """For the next solves; prices are compiled in."""
        self._lower, self._upper = np.ascontiguousarray(lower), np.ascontiguousarray(upper)
        self._options = np.array([options["tolerance"], options["max_iterations"], options["second_order"], options["start_from_states"],
                                  options["budget_s"]], float)

    def solve(self, x0: Array, parameters: Array, x: Array, u: Array, goes_on: bool) -> dict[str, Any]:
        return self._solve(self._handle, x0, parameters, x, u)

    def _solve(self, handle: int, x0: Array, parameters: Array, x: Array, u: Array) -> dict[str, Any]:
        horizon, nx, nu = self._problem.horizon, self._problem.nx, self._problem.nu
        rows = self._rows
        told: dict[str, Any] = {"x": x.copy(), "u": u.copy(), "dynamics": np.empty((horizon, nx)), "bounds": np.empty((horizon, nu)),
                                "constraints": np.empty((horizon, rows["constraint"])), "equalities": np.zeros((horizon, rows["equality"]))}
        end = np.zeros(rows["terminal_equality"] + rows["terminal_constraint"])
        report = np.zeros(14)
        given = [self._options, self._lower, self._upper, np.ascontiguousarray(parameters), np.ascontiguousarray(x0), *told.values(), end, report]
        self._library.chicane_solve(handle, *(array.ctypes.data for array in given))
        names = ("status", "iterations", "cost", "stationarity", "defect", "complementarity", "violation", "worst_stage", "worst_constraint",
                 "miss", "miss_kind", "miss_stage", "miss_row", "time")
        for name, value in zip(names, report):
            told[name] = int(value) if name in ("status", "iterations") or name.endswith(("_stage", "_row", "_kind", "_constraint")) else float(value)
        told["terminal_equality"], told["terminal_constraint"] = np.split(end, [rows["terminal_equality"]])
        return told

    def solve_many(self, x0: Array, parameters: Array, guess: Array, threads: int) -> dict[str, Any]:
        states = np.zeros((self._problem.horizon + 1, self._problem.nx))

        def work(numbers: range) -> list[dict[str, Any]]:
            handle = self._library.chicane_new()
            try:
                return [self._solve(handle, x0[n], parameters[n if len(parameters) > 1 else 0], states, guess) for n in numbers]
            finally:
                self._library.chicane_delete(handle)
        share = -(-len(x0) // threads)
        with ThreadPoolExecutor(threads) as pool:
            answers = [told for part in pool.map(work, [range(n, min(n + share, len(x0))) for n in range(0, len(x0), share)]) for told in part]
        many = {name: np.array([told[name] for told in answers]) for name in ("x", "u", "cost", "status", "iterations", "time")}
        many["violation"] = np.array([max(told["violation"], told["miss"]) for told in answers])
        return many
