# SPDX-License-Identifier: MIT
"""Optimal control problems in plain Python, solved at once (docs/python_problems.md).

Over 500 lines because most of them are docstrings of one class, `Problem`, and of its solution.
"""
from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from . import _chicane, _cost
from ._arguments import Array, array_of, number_of, state_of
from ._integrators import Implicit
from ._solution import Feedback, Solution, Solutions
from ._symbols import Graph, Objects, Symbol, TraceError, line_of, refuse, where
from ._types import npt

Function = Callable[..., Any]
FUNCTIONS = ("dynamics", "residual", "constraint", "equality", "terminal_residual", "terminal_equality", "terminal_constraint")
_INSIDE = "the implicit step"


class Problem:
    """Minimises Σ_k cost(x_k, u_k) + terminal(x_N) with x_0 given, x_{k+1} = dynamics(x_k, u_k), and further constraints.

        ocp = ch.Problem(nx=2, nu=1, horizon=20)

        @ocp.dynamics
        def _(x, u):
            return [x[0] + 0.1 * x[1], x[1] + 0.1 * u[0]]
        ocp.cost(lambda x, u: x @ x + 0.1 * u @ u)
        ocp.bounds(u=(-1, 1))
        solution = ocp.solve([1.0, 0.0])

    Functions are called once, with symbols: x of shape (nx,), u of shape (nu,), then, if they take them, p of shape
    (parameters,) and k, the number of the stage. Functions at the end are called with x, and p and k if they take them.
    Their operations are recorded and differentiated; what cannot be recorded is refused with its line.

    One thread at a time; the interpreter's lock is released while C++ works.

    Parameters
    ----------
    nx : int
        Number of states, at most 52.
    nu : int
        Number of inputs, at most 8.
    horizon : int
        Number of intervals N, at most 200.
    parameters : int
        Number of values that solve() gets as p.
    """

    def __init__(self, nx: int, nu: int, horizon: int, parameters: int = 0) -> None:
        for name, value, least, most in (("nx", nx, 1, 52), ("nu", nu, 1, 8), ("horizon", horizon, 1, 200), ("parameters", parameters, 0, 1000)):
            if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
                raise ValueError(f"Problem: {name}: got {value!r}, expected a whole number from {least} to {most}")
        self.nx, self.nu, self.horizon, self.parameters = int(nx), int(nu), int(horizon), int(parameters)
        self.graph = Graph()
        self._x = self._symbols("variable", range(self.nx))
        self._u = self._symbols("variable", range(self.nx, self.nx + self.nu))
        self._p = self._symbols("parameter", range(self.parameters))
        self._k = Symbol(self.graph, self.graph.add("stage"))
        self.rows: dict[str, list[Symbol]] = {name: [] for name in FUNCTIONS}
        self.names: dict[str, list[str]] = {name: [] for name in FUNCTIONS}
        self.penalties: list[tuple[float, float, float]] = []
        self.is_hard: list[bool] = []
        self._lower = np.full((self.horizon, self.nu), -np.inf)
        self._upper = np.full((self.horizon, self.nu), np.inf)
        self.unknowns = 0                                        # of a stage, beside its inputs: states inside an implicit step
        self._rest: dict[str, Symbol | None] = {"residual": None, "terminal_residual": None}
        self._numbers = {"residual": 0.0, "terminal_residual": 0.0}
        self._at_least = {"residual": 0.0, "terminal_residual": 0.0}
        self._interpreter: _chicane.Interpreter | None = None
        self._last: Solution | None = None
        self._prepared: Any = None
        self._solved_by: Any = None
        self._course: Solution | Feedback | None = None

    # ---- what the problem is

    def dynamics(self, function: Function) -> Function:
        """Sets the next state; also a decorator.

        Parameters
        ----------
        function : function
            Function of x, u[, p, k] that returns nx values. ch.rk4, ch.implicit_euler and ch.gauss_legendre make one from ẋ = f(x, u).

        Returns
        -------
        function
            Unchanged.
        """
        if self.rows["dynamics"]:
            raise ValueError("dynamics: got a second function, expected one: a problem has one next state")
        if isinstance(function, Implicit):
            return self._add_implicit(function)
        rows = self._trace(function, "dynamics")
        if len(rows) != self.nx:
            raise ValueError(f"dynamics: got {len(rows)} values, expected {self.nx}, one for each state")
        self.rows["dynamics"] = rows
        self._change()
        return function

    def cost(self, function: Function, at_least: float = 0.0) -> Function:
        """Adds a cost of each stage.

        Parameters
        ----------
        function : function
            Function of x, u[, p, k] that returns one twice differentiable expression, or a list of residuals r, which costs ½ Σ r².
        at_least : float
            Bound below an expression that is not a sum of squares.

        Returns
        -------
        function
            Unchanged.
        """
        return self._add_cost(function, "residual", at_least)

    def terminal(self, function: Function, at_least: float = 0.0) -> Function:
        """Adds a cost of the last state.

        Parameters
        ----------
        function : function
            Function of x[, p, k], as for cost().
        at_least : float
            As for cost().

        Returns
        -------
        function
            Unchanged.
        """
        return self._add_cost(function, "terminal_residual", at_least)

    def bounds(self, u: Any = None, x: Any = None) -> None:
        """Sets bounds of inputs, which they never leave, and of states, hard constraints from x_1 on.

        Parameters
        ----------
        u : pair
            Low and high: numbers, or arrays of shape (nu,) or (horizon, nu). Infinite: none.
        x : pair
            Low and high: numbers, or arrays of shape (nx,). Infinite: none.
        """
        if u is not None:
            self._lower, self._upper = self._pair("u", u, (self.horizon, self.nu))
        if x is not None:
            low, high = self._pair("x", x, (self.nx,))
            for i in range(self.nx):
                for bound, sign, word in ((low[i], -1.0, "below its bound"), (high[i], 1.0, "above its bound")):
                    if np.isfinite(bound):
                        beyond = sign * (self._x[i] - float(bound))
                        self._add_constraint([where(self._k < 0.5, -1.0, beyond)], f"x[{i}] {word}", True, (500.0, 200.0), np.inf)
                        self.rows["terminal_constraint"].append(beyond)
                        self.names["terminal_constraint"].append(f"x[{i}] {word}")
        self._change()

    def subject_to(self, function: Function, *, hard: bool = False, penalty: tuple[float, float] = (500.0, 200.0), cap: float = np.inf,
                   name: str = "", at_end: bool = False, price: tuple[float, float] | None = None) -> Function:
        """Adds the constraint function(x, u) <= 0 of each stage, or of the last state, which is hard.

        Parameters
        ----------
        function : function
            Function of x, u[, p, k] that returns one value or several; with `at_end` of x[, p, k].
        hard : bool
            Whether the problem is infeasible if the constraint does not hold.
        penalty : tuple of two float
            Cost of violating a soft constraint by s > 0: penalty[0] s + ½ penalty[1] s².
        cap : float
            Violation of a soft constraint above which the problem is infeasible.
        name : str
            Name in messages.
        at_end : bool
            Whether it constrains the last state only.
        price : tuple of two float
            Former name of penalty.

        Returns
        -------
        function
            Unchanged.
        """
        if at_end:
            self._add_hard(function, "terminal_constraint", name)
        else:
            penalty = penalty if price is None else price
            if not (penalty[0] > 0 and penalty[1] >= 0):
                raise ValueError(f"subject_to: penalty: got {penalty}, expected a linear one above 0 and a quadratic one that is not below")
            rows = self._trace(function, "constraint")
            self._add_constraint(rows, name or f"constraint {len(self.rows['constraint'])}", hard, penalty, cap)
        self._change()
        return function

    def equality(self, function: Function, name: str = "") -> Function:
        """Adds function(x, u) = 0 in each stage.

        Parameters
        ----------
        function : function
            Function of x, u[, p, k] that returns one value or several.
        name : str
            Name in messages.

        Returns
        -------
        function
            Unchanged.
        """
        return self._add_hard(function, "equality", name)

    def terminal_equality(self, function: Function, name: str = "") -> Function:
        """Adds function(x) = 0 of the last state.

        Parameters
        ----------
        function : function
            Function of x[, p, k] that returns one value or several.
        name : str
            Name in messages.

        Returns
        -------
        function
            Unchanged.
        """
        return self._add_hard(function, "terminal_equality", name)

    # ---- solving it

    def solve(self, x0: npt.ArrayLike, p: npt.ArrayLike | None = None, *, u: npt.ArrayLike | None = None, x: npt.ArrayLike | None = None,
              start: Solution | None = None, tolerance: float = 1e-6, max_iterations: int = 1000, budget_s: float = 0.0,
              second_order: bool = True, log: bool = False) -> Solution:
        """Finds the best inputs from x0.

        Parameters
        ----------
        x0 : array of shape (nx,)
            First state.
        p : array
            Parameters: (parameters,), or (horizon + 1, parameters) with a row for each stage and the end.
        u : array of shape (horizon, nu)
            Inputs to start from; None: 0.
        x : array of shape (horizon + 1, nx)
            States to start from; None: simulated.
        start : Solution
            Earlier solution that replaces u and x, with its multipliers.
        tolerance : float
            Tolerance of the conditions of optimality, (0, 1e-2].
        max_iterations : int
            Most iterations.
        budget_s : float
            Time after which the best answer so far is returned [s]; 0: no limit.
        second_order : bool
            Whether exact second derivatives are used.
        log : bool
            Whether the solution gets its iterations.

        Returns
        -------
        Solution
            Inputs, states, status and multipliers.
        """
        state = state_of(x0, self.nx)
        inputs = array_of("u", 0.0 if start is None and u is None else start.u if start is not None else u, (self.horizon, self.nu))
        has_states = start is not None or x is not None
        states = array_of("x", (start.x if start is not None else x) if has_states else 0.0, (self.horizon + 1, self.nx))
        if start is not None and start.unknowns.shape[1] != self.unknowns:
            raise ValueError("start: got a solution of another problem")
        if self.unknowns > 0:
            inputs = np.hstack([inputs, start.unknowns if start is not None else self._guess_unknowns(state, states if has_states else None)])
        options = {"tolerance": number_of("tolerance", tolerance, 1e-14, 1e-2), "budget_s": number_of("budget_s", budget_s, 0.0, 1e6),
                   "max_iterations": int(number_of("max_iterations", max_iterations, 1, 10000)), "second_order": bool(second_order),
                   "start_from_states": has_states}
        values = self.stage_parameters(p)
        reply = {}
        iterations = 2 * int(max_iterations) + 1000 if log else 0
        for shift in self._shifts():
            full = self._with_shifts(values, shift)
            solver = self._solver(options)
            reply = solver.solve(state, full, states, inputs, start is not None and start is self._last, iterations)
            if reply["status"] >= 0 or not self.has_expression_cost:
                break
        reply["cost"] += self._offset(full)
        self._solved_by, self._prepared = solver, None
        self._course = self._last = Solution(self, reply, state, values, full, tolerance)
        return self._last

    def prepare(self, x0: npt.ArrayLike | None = None, p: npt.ArrayLike | None = None, *, shift: int = 0, tolerance: float = 1e-6,
                max_iterations: int = 1000, budget_s: float = 0.0) -> Solution:
        """Solves for the expected x0, linearises and factorises there, before the state is measured.

        Then feedback(x0) answers the measured one in microseconds.

        Parameters
        ----------
        x0 : array of shape (nx,)
            Expected state; None: the last answer's x[shift].
        p : array
            As for solve(); None: the last solution's.
        shift : int
            Stages by which the horizon has moved on since the last answer, with which the solve starts.
        tolerance : float
            As for solve().
        max_iterations : int
            Most iterations; 1 is the real-time iteration, more give a better point to linearise at.
        budget_s : float
            As for solve() [s].

        Returns
        -------
        Solution
            The answer for the expected state.
        """
        last = self._last
        if last is None and x0 is None:
            raise ValueError("prepare: got no x0 and no earlier answer, expected one of both")
        shift = int(number_of("shift", shift, 0, self.horizon))
        options = {"tolerance": tolerance, "max_iterations": max_iterations, "budget_s": budget_s}
        if last is None or self._course is None:
            solution = self.solve(x0, p, **options)  # type: ignore[arg-type]
        else:
            stages = np.minimum(np.arange(self.horizon + 1) + shift, self.horizon)
            x, u = self._course.x[stages], self._course.u[np.minimum(stages[:-1], self.horizon - 1)]
            given = last.parameters if p is None and self.parameters > 0 else p
            solution = self.solve(x[0] if x0 is None else x0, given, x=x, u=u, **options)  # type: ignore[arg-type]
        if not np.all(np.isfinite(solution.x)) or not self._solved_by.prepare():
            raise ValueError(f"prepare: got a solution that is {solution.status}, expected a finite one")
        self._prepared = self._solved_by
        return solution

    def feedback(self, x0: npt.ArrayLike) -> Feedback:
        """Answers the measured x0 by the last prepare(), exact to first order in the distance from the expected one.

        Input bounds become active and inactive as in a quadratic program; soft constraints, and what must hold, answer by their
        derivatives. May be called again and again.

        Parameters
        ----------
        x0 : array of shape (nx,)
            Measured state.

        Returns
        -------
        Feedback
            Inputs and states.
        """
        if self._prepared is None:
            raise ValueError("feedback: got no preparation, expected prepare() after the last solve() or change")
        state = state_of(x0, self.nx)
        reply = self._prepared.feedback(state)
        self._course = Feedback(reply | {"u": np.ascontiguousarray(reply["u"][:, :self.nu])}, state)
        return self._course

    def solve_many(self, x0: npt.ArrayLike, p: npt.ArrayLike | None = None, *, u: npt.ArrayLike | None = None, threads: int = 0,
                   tolerance: float = 1e-6, max_iterations: int = 1000) -> Solutions:
        """Solves from each row of x0 on threads, with the same bits for any number of them.

        Parameters
        ----------
        x0 : array of shape (n, nx)
            First states.
        p : array
            As for solve(), or (n, parameters), or (n, horizon + 1, parameters).
        u : array of shape (horizon, nu)
            Inputs from which all start; None: 0.
        threads : int
            Threads; 0: as many as processors.
        tolerance : float
            As for solve().
        max_iterations : int
            As for solve().

        Returns
        -------
        Solutions
            One row for each problem.
        """
        states = np.ascontiguousarray(x0, float)
        if states.ndim != 2 or states.shape[1] != self.nx:
            raise ValueError(f"x0: got shape {states.shape}, expected (n, {self.nx})")
        threads = int(number_of("threads", threads, 0, 1000)) or os.cpu_count() or 1
        options = {"tolerance": number_of("tolerance", tolerance, 1e-14, 1e-2), "budget_s": 0.0, "second_order": True,
                   "max_iterations": int(number_of("max_iterations", max_iterations, 1, 10000)), "start_from_states": False}
        given = np.asarray(0.0 if p is None else p, float)
        has_own = self.parameters > 0 and given.ndim > 1 and given.shape[0] == len(states) and given.shape != (self.horizon + 1, self.parameters)
        own = np.stack([self.stage_parameters(each) for each in given]) if has_own else self.stage_parameters(p)[None]
        full = np.stack([self._with_shifts(each, next(iter(self._shifts()))) for each in own])
        inputs = array_of("u", 0.0 if u is None else u, (self.horizon, self.nu))
        if self.unknowns > 0:
            inputs = np.hstack([inputs, self._guess_unknowns(states.mean(axis=0) if len(states) else np.zeros(self.nx), None)])
        reply = self._solver(options).solve_many(states, full, inputs, threads)
        reply["u"] = np.ascontiguousarray(reply["u"][:, :, :self.nu])
        reply["cost"] += self._offset(full[0])
        return Solutions(reply)

    def export(self, file: str | Path, name: str = "Problem") -> None:
        """Writes the problem as a C++ header for the library (docs/python_problems.md), with the same optimum.

        Parameters
        ----------
        file : str or path
            Header to write.
        name : str
            Name of the struct, which chicane::solver::OcpSolver takes.
        """
        from . import _export
        Path(file).write_text(_export.header(self, name), encoding="utf-8")

    def export_c(self, path: str | Path) -> None:
        """Writes the problem for programs in C, and for all that call C (docs/python_problems.md).

        Parameters
        ----------
        path : str or path
            Writes path.cpp, which a C++ compiler compiles, and path.h, with a function of that name for chicane/solver.h.
        """
        from . import _export
        _export.write_c(self, Path(path))

    # ---- inside

    def _symbols(self, op: str, numbers: range) -> Objects:
        symbols = np.empty(len(numbers), dtype=object)
        for n, number in enumerate(numbers):
            symbols[n] = Symbol(self.graph, self.graph.add(op, number))
        return symbols

    def _change(self) -> None:
        self._interpreter = self._last = self._prepared = self._course = None

    def _call(self, function: Function, kind: str) -> Any:
        """What a function returns when it is called with symbols."""
        if not callable(function):
            raise ValueError(f"{kind}: got {type(function).__name__}, expected a function")
        is_end = kind.startswith("terminal")
        given = [self._x, self._p, self._k] if is_end else [self._x, self._u, self._p, self._k]
        wanted = [word for word in inspect.signature(inspect.unwrap(function)).parameters.values() if word.default is word.empty]
        if not 1 <= len(wanted) <= len(given):
            raise ValueError(f"{kind}: got a function of {len(wanted)} arguments, expected the first of "
                             f"({'x, p, k' if is_end else 'x, u, p, k'})")
        try:
            result = function(*(part.copy() if isinstance(part, np.ndarray) else part for part in given[:len(wanted)]))
        except TypeError as error:
            if "Symbol" not in str(error):
                raise
            raise TraceError(f"{line_of(error)}: got {error}, expected what docs/python_problems.md lists: arithmetic, ch.where, and functions that "
                             "have a derivative") from error
        except IndexError as error:
            raise ValueError(f"{kind}: {error}: expected x of {self.nx} entries, u of {self.nu}, p of {self.parameters}") from error
        if result is None:
            raise ValueError(f"{kind}: got a function that returns nothing, expected one that returns values")
        return result

    def _trace(self, function: Function, kind: str) -> list[Symbol]:
        """What a function returns, as symbols."""
        return self._listed(self._call(function, kind), kind)

    def _add_implicit(self, method: Implicit) -> Function:
        """Dynamics with unknowns behind the inputs."""
        count = method.count * self.nx
        if self.nu + count > 8:
            raise ValueError(f"dynamics: got {count} unknowns inside the interval beside {self.nu} inputs, expected at most 8 together: fewer "
                             "steps or stages, or ch.rk4 with more steps")
        unknowns = self._symbols("variable", range(self.nx + self.nu, self.nx + self.nu + count)).reshape(-1, self.nx)
        zeros: list[Symbol] = []

        def step(x: Any, u: Any, *rest: Any) -> Any:
            next_state, misses = method.apply(x, unknowns, u, *rest)
            zeros.extend(self._listed(misses, "dynamics"))
            return next_state
        step.__wrapped__ = method.__wrapped__  # type: ignore[attr-defined]
        self.rows["dynamics"] = self._trace(step, "dynamics")
        self.unknowns = count
        self.rows["equality"][:0] = zeros
        self.names["equality"][:0] = [_INSIDE] * count
        self._change()
        return method.__wrapped__

    def _guess_unknowns(self, x0: Array, states: Array | None) -> Array:
        """States inside intervals, as the ones at their ends, or all as the first one."""
        ends = np.tile(x0, (self.horizon, 1)) if states is None else states[1:]
        return np.tile(ends, (1, self.unknowns // self.nx))

    def _listed(self, result: Any, kind: str) -> list[Symbol]:
        rows = [self._symbol(value, kind) for value in np.ravel(np.array(result, dtype=object))]
        if any(row.is_comparison() for row in rows):
            wanted = "what has to be <= 0: a - b for a <= b" if kind.endswith("constraint") else "a value: ch.where(comparison, a, b)"
            raise ValueError(f"{kind}: got a comparison, expected {wanted}")
        return rows

    def _symbol(self, value: Any, kind: str) -> Symbol:
        if isinstance(value, Symbol):
            if value.graph is not self.graph:
                raise refuse("a symbol of another problem", "symbols that the function was called with")
            return value
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise ValueError(f"{kind}: got {value!r} in the result, expected numbers and symbols") from None
        if not np.isfinite(number):
            raise TraceError(f"{kind}: got {number} in the result, expected finite numbers")
        return Symbol(self.graph, self.graph.constant(number))

    def _add_cost(self, function: Function, kind: str, at_least: float) -> Function:
        result = self._call(function, kind)
        rows = self._listed(result, kind)
        if isinstance(result, (list, tuple)) or (isinstance(result, np.ndarray) and result.ndim > 0):
            self.rows[kind] += rows
            self._change()
            return function
        residuals, rest, number = _cost.split(rows[0])
        self.rows[kind] += residuals
        self._numbers[kind] += number
        if rest is not None:
            own = self._rest[kind]
            self._rest[kind] = rest if own is None else own + rest
            self._at_least[kind] += float(at_least) - number
        self._change()
        return function

    def _add_hard(self, function: Function, kind: str, name: str) -> Function:
        rows = self._trace(function, kind)
        first = len(self.rows[kind])
        self.rows[kind] += rows
        self.names[kind] += [name or f"{kind.replace('_', ' ')} {first + n}" for n in range(len(rows))]
        self._change()
        return function

    def _add_constraint(self, rows: list[Symbol], name: str, hard: bool, penalty: tuple[float, float], cap: float) -> None:
        self.rows["constraint"] += rows
        self.names["constraint"] += [name] * len(rows)
        self.penalties += [(float(penalty[0]), float(penalty[1]), float(min(cap, 1e30)))] * len(rows)
        self.is_hard += [bool(hard)] * len(rows)

    def _pair(self, name: str, given: Any, shape: tuple[int, ...]) -> tuple[Array, Array]:
        if not isinstance(given, (tuple, list)) or len(given) != 2:
            raise ValueError(f"bounds: {name}: got {given!r}, expected (low, high)")
        low, high = (array_of(f"bounds: {name}", part, shape) for part in given)
        if not np.all(low <= high):
            raise ValueError(f"bounds: {name}: got a lower bound above the upper one, expected low <= high")
        return low, high

    def stage_parameters(self, p: npt.ArrayLike | None) -> Array:
        """Parameters p by stage, as solve() takes them.

        Parameters
        ----------
        p : array
            As for solve().

        Returns
        -------
        array of shape (horizon + 1, parameters)
            Row for each stage and the end.
        """
        if p is None and self.parameters > 0:
            raise ValueError(f"p: got none, expected {self.parameters} numbers")
        if p is None:
            return np.zeros((self.horizon + 1, 0))
        values = np.asarray(p, float)
        if self.parameters == 0 and values.size > 0:
            raise ValueError("p: got numbers, expected none: Problem(…, parameters=n) has some")
        if values.ndim == 2 and values.shape == (self.horizon, self.parameters):
            values = np.vstack([values, values[-1:]])
        if not np.isfinite(values).all():
            raise ValueError("p: got a number that is not finite")
        return array_of("p", values, (self.horizon + 1, self.parameters))

    @property
    def has_expression_cost(self) -> bool:
        """Whether a cost is not a sum of squares."""
        return any(rest is not None for rest in self._rest.values())

    def _shifts(self) -> tuple[float, ...]:
        """What is added to a cost that is no sum of squares, beyond its least value, until it works."""
        return (1.0, 100.0, 1e4) if self.has_expression_cost else (0.0,)

    def _with_shifts(self, values: Array, shift: float) -> Array:
        if not self.has_expression_cost:
            return values
        own = [shift - self._at_least["residual"], shift - self._at_least["terminal_residual"]]
        return np.ascontiguousarray(np.hstack([values, np.broadcast_to(own, (len(values), 2))]))

    def _offset(self, full: Array) -> float:
        """What the residuals do not have of the cost."""
        total = self.horizon * self._numbers["residual"] + self._numbers["terminal_residual"]
        if self._rest["residual"] is not None:
            total -= self.horizon * float(full[0, -2])
        if self._rest["terminal_residual"] is not None:
            total -= float(full[0, -1])
        return total

    def all_rows(self) -> dict[str, list[Symbol]]:
        """Rows of each function, with the roots of costs that are not sums of squares.

        Returns
        -------
        dict of list
            Symbols by function.
        """
        if not self.rows["dynamics"]:
            raise ValueError("Problem: got no dynamics, expected @ocp.dynamics with a function of x and u")
        rows = {name: list(own) for name, own in self.rows.items()}
        for n, (kind, rest) in enumerate(self._rest.items()):
            if rest is not None:
                shift = Symbol(self.graph, self.graph.add("parameter", self.parameters + n))
                rows[kind].append((2.0 * (rest + shift)).sqrt())
        if not rows["residual"] and not rows["terminal_residual"]:
            raise ValueError("Problem: got no cost, expected ocp.cost(...) or ocp.terminal(...)")
        return rows

    def make_interpreter(self, with_parameters: bool = False) -> _chicane.Interpreter:
        """The recorded problem in C++.

        Parameters
        ----------
        with_parameters : bool
            Whether parameters are inputs behind the others, for derivatives in p.

        Returns
        -------
        Interpreter
            Object of the compiled part.
        """
        rows = self.all_rows()
        operations = {name: n for n, name in enumerate(_chicane.TAPE_OPERATIONS)}
        nodes = list(self.graph.nodes)
        count = self.full_count
        if with_parameters:
            nodes = [("variable", self.nx + self.all_inputs + node[1], -1, -1, 0.0) if node[0] == "parameter" else node for node in nodes]
        ops = np.array([operations[node[0]] for node in nodes], np.int32)
        operands = np.array([node[1:4] for node in nodes], np.int32)
        numbers = np.array([node[4] for node in nodes], float)
        outputs = [[symbol.node for symbol in rows[name]] for name in FUNCTIONS]
        return _chicane.Interpreter(self.nx, self.all_inputs + (count if with_parameters else 0), 0 if with_parameters else count, self.horizon, ops,
                                    operands, numbers, outputs, not with_parameters)

    def _solver(self, options: dict[str, Any]) -> _chicane.Interpreter:
        if self._interpreter is None:
            self._interpreter = self.make_interpreter()
        self._interpreter.set(*self.input_bounds, np.array(self.penalties, float).reshape(-1, 3), self.is_hard, options)
        return self._interpreter

    @property
    def full_count(self) -> int:
        """Number of parameters, the problem's own included."""
        return self.parameters + (2 if self.has_expression_cost else 0)

    def hidden_parameters(self) -> list[float]:
        """The problem's own parameters, as a solve begins with them.

        Returns
        -------
        list of float
            Values.
        """
        return [float(value) for value in self._with_shifts(np.zeros((1, 0)), self._shifts()[0])[0]]

    def cost_offset(self) -> float:
        """Difference between the problem's cost and its residuals' with these parameters.

        Returns
        -------
        float
            Cost.
        """
        return self._offset(self._with_shifts(np.zeros((1, self.parameters)), self._shifts()[0]))

    @property
    def input_bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of all inputs, (horizon, all_inputs) each."""
        if self.unknowns == 0:
            return self._lower, self._upper
        none = np.full((self.horizon, self.unknowns), np.inf)
        return np.hstack([self._lower, -none]), np.hstack([self._upper, none])

    @property
    def all_inputs(self) -> int:
        """Number of inputs, and of the unknowns inside intervals behind them."""
        return self.nu + self.unknowns

    def __repr__(self) -> str:
        parts = [f"nx {self.nx}, nu {self.nu}, horizon {self.horizon}"]
        for name, word in (("constraint", "constraints"), ("equality", "equalities"), ("terminal_equality", "equalities at the end"),
                           ("terminal_constraint", "constraints at the end")):
            if self.rows[name]:
                parts.append(f"{len(self.rows[name])} {word}")
        return f"<Problem: {', '.join(parts)}>"

    def _repr_html_(self) -> str:
        return f"<code>{repr(self)[1:-1]}</code>"
