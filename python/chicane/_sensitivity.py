# SPDX-License-Identifier: MIT
"""Derivatives of a solution by the conditions of optimality, the active set fixed (docs/python_problems.md, eq. 5)."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._types import npt
from . import _chicane

if TYPE_CHECKING:
    from ._problem import Problem
    from ._solution import Solution

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int_]
_Entries = tuple[Integers, Integers, Array]
_CLEAR = 3e-4
"""Constraint and multiplier both below this: which of them is zero cannot be decided."""


class Sensitivity:
    """How a solution changes: u of shape (horizon, nu, n) and x of shape (horizon + 1, nx, n) are derivatives by the n numbers of x0
    or p. is_one_sided: a constraint is about to become active or inactive, so that the derivative on one side is another one.
    margin: of the constraint that is nearest to that, its room or its multiplier, whichever is more."""

    def __init__(self, u: Array, x: Array, is_one_sided: bool, margin: float) -> None:
        self.u, self.x, self.is_one_sided, self.margin = u, x, is_one_sided, margin

    def __repr__(self) -> str:
        return f"<Sensitivity: u {self.u.shape}, x {self.x.shape}{', one-sided' if self.is_one_sided else ''}>"


class _Conditions:
    """The conditions of optimality of a solution, linearised: unknowns are u_k and x_{k+1}, stage by stage, then multipliers."""

    def __init__(self, problem: Problem, solution: Solution) -> None:
        self.problem, self.solution = problem, solution
        self.nx, self.nu, self.horizon = problem.nx, problem.all_inputs, problem.horizon
        self.u = np.hstack([solution.u, solution.unknowns])
        self.interpreter = problem.make_interpreter(with_parameters=True)
        self.block = self.nx + self.nu
        self.size = self.horizon * self.block
        self.full = solution.full_parameters
        self.np = self.full.shape[1]
        count = self.nx + self.np
        self.hessian: list[_Entries] = []
        self.mixed = np.zeros((self.size, count))                      # by x0 and by p of every stage alike
        self.gradient = np.zeros(self.size)
        self.rows: list[tuple[Integers, Array]] = []                   # where a row of the conditions has entries, and which
        self.row_changes: list[Array] = []
        self.curved: list[tuple[int, int, int]] = []                   # function, stage and row that a multiplier belongs to
        self.is_one_sided = False
        self.margin = np.inf

    def see(self, room: float, multiplier: float) -> None:
        """A constraint. The solver ends with room · multiplier at its last barrier: neither differs from zero below its root."""
        larger = max(room, multiplier)
        self.margin = min(self.margin, larger)
        self.is_one_sided = self.is_one_sided or larger < max(_CLEAR, 10.0 * float(np.sqrt(max(0.0, room * multiplier))))

    def place(self, stage: int) -> Integers:
        """Where the variables (x_k, u_k, p) of a stage are; x_0 and p behind the unknowns."""
        first = self.size if stage == 0 else stage * self.block - self.nx
        states = np.arange(first, first + self.nx)
        inputs = stage * self.block + np.arange(self.nu)
        return np.concatenate([states, inputs, self.size + self.nx + np.arange(self.np)])

    def points(self, stages: range) -> Array:
        s = self.solution
        u = np.vstack([self.u, np.zeros((1, self.nu))])
        return np.ascontiguousarray(np.hstack([s.x[stages], u[stages], self.full[stages]]))

    def evaluate(self, function: int, stages: range, weights: Array) -> tuple[Array, Array, Array]:
        return self.interpreter.evaluate(function, self.points(stages), np.zeros((len(stages), 0)), np.ascontiguousarray(weights), stages[0])

    def add_curvature(self, stage: int, matrix: Array) -> None:
        at = self.place(stage)
        inside = at < self.size
        rows = at[inside]
        self.hessian.append((np.repeat(rows, len(rows)), np.tile(rows, len(rows)), matrix[np.ix_(inside, inside)].ravel()))
        self.mixed[np.ix_(rows, at[~inside] - self.size)] += matrix[np.ix_(inside, ~inside)]

    def add_gradient(self, stage: int, slope: Array) -> None:
        at = self.place(stage)
        np.add.at(self.gradient, at[at < self.size], slope[at < self.size])

    def add_row(self, slope: Array, curved: tuple[int, int, int], next_state: int = -1) -> None:
        """slope · (x, u, p) of a stage, less a state of the next one where that has a number."""
        stage = curved[1]
        at = self.place(stage)
        inside = at < self.size
        columns, values = at[inside], slope[inside]
        if next_state >= 0:
            columns, values = np.append(columns, stage * self.block + self.nu + next_state), np.append(values, -1.0)
        change = np.zeros(self.nx + self.np)
        change[at[~inside] - self.size] = slope[~inside]
        self.rows.append((columns, values))
        self.row_changes.append(change)
        self.curved.append(curved)

    def add_costs(self) -> None:
        for function, stages in ((1, range(self.horizon)), (4, range(self.horizon, self.horizon + 1))):
            count = len(self.problem.all_rows()[("", "residual", "", "", "terminal_residual")[function]])
            if count == 0:
                continue
            values, slopes, _ = self.evaluate(function, stages, np.zeros((len(stages), count)))
            _, _, curvatures = self.evaluate(function, stages, values)
            for n, k in enumerate(stages):
                self.add_curvature(k, slopes[n].T @ slopes[n] + curvatures[n])
                self.add_gradient(k, slopes[n].T @ values[n])

    def add_dynamics(self) -> None:
        _, slopes, _ = self.evaluate(0, range(self.horizon), np.zeros((self.horizon, self.nx)))
        for k in range(self.horizon):
            for i in range(self.nx):
                self.add_row(slopes[k, i], (0, k, i), next_state=i)

    def add_constraints(self) -> None:
        """Soft ones: nothing where they hold with room, a penalty where they are violated, an equality at the edge."""
        count = len(self.problem.rows["constraint"])
        if count == 0:
            return
        multiplier = self.solution.multipliers["constraints"]
        values, slopes, _ = self.evaluate(2, range(self.horizon), np.zeros((self.horizon, count)))
        weights = np.zeros((self.horizon, count))
        for k in range(self.horizon):
            for c in range(count):
                value, z = values[k, c], multiplier[k, c]
                linear, quadratic, _ = self.problem.penalties[c]
                left = linear + quadratic * max(value, 0.0) - z
                is_violated = not self.problem.is_hard[c] and value > 0.0 and value > left
                if is_violated:
                    weights[k, c] = linear + quadratic * value
                    self.add_curvature(k, quadratic * np.outer(slopes[k, c], slopes[k, c]))
                    self.add_gradient(k, weights[k, c] * slopes[k, c])
                elif z > -value:
                    self.add_row(slopes[k, c], (2, k, c))
                is_beyond = value > 0.0 and not self.problem.is_hard[c]
                if is_beyond:
                    self.see(value, left)
                else:
                    self.see(-value, z)
        _, _, curvatures = self.evaluate(2, range(self.horizon), weights)
        for k in range(self.horizon):
            self.add_curvature(k, curvatures[k])

    def add_equalities(self) -> None:
        s, end = self.solution, range(self.horizon, self.horizon + 1)
        for function, stages, name in ((3, range(self.horizon), "equality"), (5, end, "terminal_equality"), (6, end, "terminal_constraint")):
            count = len(self.problem.rows[name])
            if count == 0:
                continue
            values, slopes, _ = self.evaluate(function, stages, np.zeros((len(stages), count)))
            for n, k in enumerate(stages):
                for row in range(count):
                    if name == "terminal_constraint":
                        y = s.multipliers[name][row]
                        self.see(-values[n, row], y)
                        if y <= -values[n, row]:
                            continue
                    self.add_row(slopes[n, row], (function, k, row))

    def add_bounds(self) -> None:
        lower, upper = self.problem.input_bounds
        for k in range(self.horizon):
            for m in range(self.problem.nu):
                room = min(self.solution.u[k, m] - lower[k, m], upper[k, m] - self.solution.u[k, m])
                multiplier = abs(self.solution.multipliers["bounds"][k, m])
                if room <= 1e-9 * (1.0 + abs(self.solution.u[k, m])):
                    self.rows.append((np.array([k * self.block + m]), np.ones(1)))
                    self.row_changes.append(np.zeros(self.nx + self.np))
                    self.curved.append((-1, k, m))
                if lower[k, m] < upper[k, m] and np.isfinite(room):
                    self.see(room, multiplier)

    def add_curvature_of_rows(self) -> None:
        """Second derivatives of what is an equality, by the multipliers that make the gradient vanish: those of least squares."""
        identity = np.arange(self.size)
        right = np.concatenate([-self.gradient, np.zeros(len(self.rows))])[:, None]
        multipliers = self.solve_with([(identity, identity, np.ones(self.size))], right)[self.size:, 0]
        rows, end = self.problem.all_rows(), range(self.horizon, self.horizon + 1)
        for function, name in ((0, "dynamics"), (2, "constraint"), (3, "equality"), (5, "terminal_equality"), (6, "terminal_constraint")):
            stages = end if name.startswith("terminal") else range(self.horizon)
            weights = np.zeros((len(stages), len(rows[name])))
            for (of, stage, row), value in zip(self.curved, multipliers):
                if of == function:
                    weights[stage - stages[0], row] = value
            if weights.any():
                for stage, curvature in zip(stages, self.evaluate(function, stages, weights)[2]):
                    self.add_curvature(stage, curvature)

    def solve_with(self, upper_left: list[_Entries], right: Array) -> Array:
        """Of the matrix (upper_left Jᵀ; J 0), J being the rows. Stage by stage its unknowns and rows make a band."""
        number = np.repeat(np.arange(len(self.rows)), [len(columns) for columns, _ in self.rows]) + self.size
        columns, values = (np.concatenate(parts) for parts in zip(*self.rows))
        parts = [*upper_left, (number, columns, values), (columns, number, values)]
        rows, columns, values = (np.concatenate(part) for part in zip(*parts))
        unknowns = np.arange(self.size)
        stage = np.concatenate([unknowns // self.block, [of for _, of, _ in self.curved]])
        kind = np.concatenate([np.where(unknowns % self.block < self.nu, 0, 2), np.ones(len(self.rows), int)])
        order = np.lexsort((kind, stage))
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        is_entry = values != 0.0
        solved: Array = _chicane.solve_banded(place[rows[is_entry]], place[columns[is_entry]], values[is_entry], np.ascontiguousarray(right[order]))
        return np.ascontiguousarray(solved[place])

    def solve(self) -> Array:
        """Derivatives of the unknowns by x_0 and by p, (size, nx + np)."""
        self.add_costs()
        self.add_dynamics()
        self.add_constraints()
        self.add_equalities()
        self.add_bounds()
        try:
            self.add_curvature_of_rows()
            return self.solve_with(self.hessian, -np.vstack([self.mixed, np.array(self.row_changes)]))[:self.size]
        except np.linalg.LinAlgError:
            raise ValueError("sensitivity: got a solution whose active constraints depend on each other or whose optimum is not unique, "
                             "expected one with a regular system of conditions") from None


def find(problem: Problem, solution: Solution, of: str) -> Sensitivity:
    if of not in ("x0", "p"):
        raise ValueError(f'sensitivity: got {of!r}, expected "x0" or "p"')
    if of == "p" and problem.parameters == 0:
        raise ValueError('sensitivity: got "p", expected a problem with parameters')
    if not solution.is_usable:
        raise ValueError(f"sensitivity: got a solution that is {solution.status}, expected a usable one")
    conditions = _Conditions(problem, solution)
    change: Any = conditions.solve()
    nx, nu, inputs = problem.nx, problem.nu, problem.all_inputs
    columns = slice(0, nx) if of == "x0" else slice(nx, nx + problem.parameters)
    steps = change[:, columns].reshape(problem.horizon, inputs + nx, -1)
    first = np.eye(nx)[None] if of == "x0" else np.zeros((1, nx, problem.parameters))
    return Sensitivity(np.ascontiguousarray(steps[:, :nu]), np.vstack([first, steps[:, inputs:]]), conditions.is_one_sided, float(conditions.margin))
