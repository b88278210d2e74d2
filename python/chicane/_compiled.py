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

from ._types import npt
from . import _export

if TYPE_CHECKING:
    from ._problem import Problem

Array = npt.NDArray[np.float64]
_HERE = Path(__file__)

_Double = ctypes.POINTER(ctypes.c_double)


class _Sizes(ctypes.Structure):
    """chicane_sizes of chicane/solver.h, as the structures below."""
    _fields_ = [(name, ctypes.c_int) for name in ("version", "nx", "nu", "horizon", "parameters", "constraints", "equalities",
                                                  "terminal_equalities", "terminal_constraints")] + [("bytes", ctypes.c_size_t)]


class _Options(ctypes.Structure):
    _fields_ = [("tolerance", ctypes.c_double), ("budget_s", ctypes.c_double), ("max_iterations", ctypes.c_int),
                ("second_order", ctypes.c_int), ("start_from_states", ctypes.c_int)]


class _Report(ctypes.Structure):
    _fields_ = [("status", ctypes.c_int), ("is_usable", ctypes.c_int), ("iterations", ctypes.c_int), ("cost", ctypes.c_double),
                ("stationarity", ctypes.c_double), ("defect", ctypes.c_double), ("complementarity", ctypes.c_double),
                ("violation", ctypes.c_double), ("worst_stage", ctypes.c_int), ("worst_constraint", ctypes.c_int), ("miss", ctypes.c_double),
                ("miss_kind", ctypes.c_int), ("miss_stage", ctypes.c_int), ("miss_row", ctypes.c_int), ("time", ctypes.c_double), ("gap", ctypes.c_double)]


_PARAMETERS, _LOWER, _UPPER, _STATES, _INPUTS = range(5)
_ANSWERS = ("x", "u", "dynamics", "bounds", "constraints", "equalities", "end")
"""Arrays of chicane/solver.h that a solve writes, from CHICANE_STATES on."""


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
        source = _export.c_source(problem, "problem", with_hidden=True)
        # What several such libraries in one process have in common must not be taken for the same.
        command = [compiler, "-std=c++20", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-gnu-unique",
                   "-ffp-contract=off", "-fno-math-errno", "-w", f"-DCHICANE_ARCH={name}", *flags]
        version = (include / "chicane/version.hpp").read_bytes() if (include / "chicane/version.hpp").is_file() else b""
        library = b"".join(file.read_bytes() for file in [*sorted((include / "chicane/solver").rglob("*.hpp")), include / "chicane/solver.h"])
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


class _Handle:
    """A solver of the library in memory of its own. One thread at a time."""

    def __init__(self, calls: ctypes.CDLL) -> None:
        self._calls = calls
        self.problem = calls.problem()
        self.sizes = _Sizes()
        self.check(calls.chicane_sizes_of(self.problem, ctypes.byref(self.sizes)))
        self._memory = ctypes.create_string_buffer(self.sizes.bytes)
        self.solver = ctypes.c_void_p()
        self.check(calls.chicane_create(self.problem, self._memory, self.sizes.bytes, ctypes.byref(self.solver)))

    def check(self, error: int) -> None:
        if error != 0:
            raise RuntimeError(f"compile: {self._calls.chicane_error_text(error).decode()}")

    def put(self, array: int, numbers: Array) -> None:
        numbers = np.ascontiguousarray(numbers, float)
        if numbers.size > 0:
            self.check(self._calls.chicane_set(self.solver, array, numbers.ctypes.data_as(_Double), numbers.size))

    def get(self, array: int, shape: tuple[int, ...]) -> Array:
        numbers = np.zeros(shape)
        if numbers.size > 0:
            self.check(self._calls.chicane_get(self.solver, array, numbers.ctypes.data_as(_Double), numbers.size))
        return numbers

    def solve(self, setting: tuple[_Options, Array, Array], x0: Array, parameters: Array, x: Array, u: Array) -> dict[str, Any]:
        options, lower, upper = setting
        self.check(self._calls.chicane_set_options(self.solver, ctypes.byref(options)))
        for array, numbers in ((_PARAMETERS, parameters), (_LOWER, lower), (_UPPER, upper), (_STATES, x), (_INPUTS, u)):
            self.put(array, numbers)
        report = _Report()
        x0 = np.ascontiguousarray(x0, float)
        self.check(self._calls.chicane_solve(self.solver, x0.ctypes.data_as(_Double), ctypes.byref(report)))
        reply: dict[str, Any] = {name: getattr(report, name) for name, _ in _Report._fields_}
        return reply | self.answer()

    def answer(self) -> dict[str, Any]:
        """States, inputs and multipliers of the last solve or feedback."""
        s = self.sizes
        shapes = ((s.horizon + 1, s.nx), (s.horizon, s.nu), (s.horizon, s.nx), (s.horizon, s.nu), (s.horizon, s.constraints),
                  (s.horizon, s.equalities), (s.terminal_equalities + s.terminal_constraints,))
        reply: dict[str, Any] = {name: self.get(_STATES + n, shape) for n, (name, shape) in enumerate(zip(_ANSWERS, shapes))}
        reply["terminal_equality"], reply["terminal_constraint"] = np.split(reply.pop("end"), [s.terminal_equalities])
        return reply


def _load(file: Path) -> ctypes.CDLL:
    library = ctypes.CDLL(str(file))
    library.problem.restype = ctypes.c_void_p
    pointer, count = ctypes.c_void_p, ctypes.c_size_t
    library.chicane_sizes_of.argtypes = [pointer, pointer]
    library.chicane_create.argtypes = [pointer, pointer, count, pointer]
    library.chicane_error_text.restype = ctypes.c_char_p
    library.chicane_set_options.argtypes = [pointer, pointer]
    library.chicane_feedback.argtypes = [pointer, _Double, pointer]
    library.chicane_set.argtypes = library.chicane_get.argtypes = [pointer, ctypes.c_int, _Double, count]
    library.chicane_solve.argtypes = [pointer, _Double, pointer]
    library.chicane_prepare.argtypes = [pointer]
    return library


class CompiledSolver:
    """The same functions as the interpreter's, by the compiled library."""

    def __init__(self, problem: Problem, file: Path) -> None:
        self._problem = problem
        self._library = _load(file)
        self._main = _Handle(self._library)

    def set(self, lower: Array, upper: Array, penalties: Array, is_hard: list[bool], options: dict[str, Any]) -> None:
        """For the next solves; penalties are compiled in."""
        words = _Options(options["tolerance"], options["budget_s"], options["max_iterations"], options["second_order"], options["start_from_states"])
        self._setting = words, lower, upper

    def solve(self, x0: Array, parameters: Array, x: Array, u: Array, goes_on: bool, iterations: int) -> dict[str, Any]:
        return self._main.solve(self._setting, x0, parameters, x, u)

    def prepare(self) -> bool:
        return bool(self._library.chicane_prepare(self._main.solver) == 0)

    def feedback(self, x0: Array) -> dict[str, Any]:
        is_solved = ctypes.c_int()
        state = np.ascontiguousarray(x0).ctypes.data_as(_Double)
        begin = time.perf_counter()
        self._main.check(self._library.chicane_feedback(self._main.solver, state, ctypes.byref(is_solved)))
        seconds = time.perf_counter() - begin
        return self._main.answer() | {"time": seconds, "is_solved": bool(is_solved.value)}

    def solve_many(self, x0: Array, parameters: Array, guess: Array, threads: int) -> dict[str, Any]:
        states = np.zeros((self._problem.horizon + 1, self._problem.nx))

        def work(numbers: range) -> list[dict[str, Any]]:
            handle = _Handle(self._library)
            return [handle.solve(self._setting, x0[n], parameters[n if len(parameters) > 1 else 0], states, guess) for n in numbers]
        share = -(-len(x0) // threads)
        with ThreadPoolExecutor(threads) as pool:
            answers = [reply for part in pool.map(work, [range(n, min(n + share, len(x0))) for n in range(0, len(x0), share)]) for reply in part]
        many = {name: np.array([reply[name] for reply in answers]) for name in ("x", "u", "cost", "status", "iterations", "time")}
        many["violation"] = np.array([max(reply["violation"], reply["miss"]) for reply in answers])
        return many
