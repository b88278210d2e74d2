# SPDX-License-Identifier: MIT
"""What solving an optimal control problem gives."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._types import npt
from . import _chicane
from ._iterations import Iterations

if TYPE_CHECKING:
    from ._problem import Problem
    from ._sensitivity import Sensitivity

Array = npt.NDArray[np.float64]


class Solution:
    """The answer to an optimal control problem.

    Attributes
    ----------
    u : array of shape (horizon, nu)
        Inputs.
    x : array of shape (horizon + 1, nx)
        States.
    status : str
        "optimal"; "at_floor" and "budget_spent", which are usable; "stalled", "infeasible" and "not_finite", which are not.
    is_usable : bool
        Whether the inputs may be applied.
    cost : float
        Objective, penalties of violated soft constraints included.
    violation : float
        Largest violation of a constraint, in the constraint's unit.
    violated : str
        Name and stage of that constraint.
    multipliers : dict of array
        "dynamics" (horizon, nx), of each next state; "bounds" (horizon, nu); "constraints" and "equalities",
        (horizon, rows); "terminal_equality", "terminal_constraint", (rows,).
    unknowns : array of shape (horizon, count)
        States inside the intervals of an implicit method.
    iterations : int
        Iterations of the solver.
    residual : float
        Distance from the conditions of an optimum.
    gap : float
        Cost of the barrier of soft and hard limits, at most in a convex problem.
    time : float
        Time of the work in C++ [s].
    log : Iterations or None
        Iterations, with solve(log=True).
    """

    def __init__(self, problem: Problem, reply: dict[str, Any], x0: Array, parameters: Array, full: Array,
                 tolerance: float) -> None:
        self._problem = problem
        self._parameters, self._full = parameters, full
        self.x0 = x0
        self.u: Array = np.ascontiguousarray(reply["u"][:, :problem.nu])
        self.unknowns: Array = np.ascontiguousarray(reply["u"][:, problem.nu:])
        self.x: Array = reply["x"]
        self.status: str
        self.status, self._sentence = _chicane.SOLVE_STATUSES[reply["status"]]
        self.is_usable: bool = reply["status"] >= 0
        if problem.has_expression_cost:
            self._sentence += "; a cost that is no sum of squares has to stay above its at_least"
        self.cost: float = reply["cost"]
        self.iterations: int = reply["iterations"]
        self.residual: float = max(reply["stationarity"], reply["defect"], reply["complementarity"])
        self.gap: float = reply["gap"]
        self.time: float = reply["time"]
        self.log = Iterations(reply["log"]) if "log" in reply else None
        self.multipliers: dict[str, Array] = {name: reply[name] for name in ("dynamics", "bounds", "constraints", "equalities",
                                                                            "terminal_equality", "terminal_constraint")}
        self.multipliers["equalities"] = np.ascontiguousarray(reply["equalities"][:, problem.unknowns:])
        self.multipliers["bounds"] = np.ascontiguousarray(reply["bounds"][:, :problem.nu])
        self.violation, self.violated = self._find_violation(reply, tolerance)

    def _find_violation(self, reply: dict[str, Any], tolerance: float) -> tuple[float, str]:
        """The worst one above the tolerance of the solve, and its name and stage."""
        names = self._problem.names
        found = (0.0, "")
        if reply["worst_constraint"] >= 0 and reply["violation"] > tolerance:
            found = reply["violation"], f"{names['constraint'][reply['worst_constraint']]} at stage {reply['worst_stage']}"
        if reply["miss_row"] >= 0 and reply["miss"] > max(tolerance, found[0]):
            kind = ("", "equality", "terminal_equality", "terminal_constraint", "constraint")[reply["miss_kind"]]
            found = reply["miss"], f"{names[kind][reply['miss_row']]} at stage {reply['miss_stage']}"
        return found

    def sensitivity(self, of: str = "x0") -> Sensitivity:
        """Derivatives of u and x, the set of active constraints fixed.

        Parameters
        ----------
        of : {"x0", "p"}
            Numbers that change.

        Returns
        -------
        Sensitivity
            Derivatives, and whether they hold on one side only.
        """
        if not hasattr(self, "_problem"):
            raise ValueError("sensitivity: got a solution from a pickle, expected one that solve() has returned")
        from . import _sensitivity
        return _sensitivity.find(self._problem, self, of)

    @property
    def parameters(self) -> Array:
        """Parameters p by stage, (horizon + 1, parameters)."""
        return self._parameters

    @property
    def full_parameters(self) -> Array:
        """Parameters p by stage, followed by the problem's own."""
        return self._full

    def __bool__(self) -> bool:
        return self.is_usable

    def __repr__(self) -> str:
        text = f"{self.status} after {self.iterations} iterations, cost {self.cost:.6g}, {1e3 * self.time:.3g} ms"
        if not self.is_usable:
            text += f": not usable, {self._sentence}"
        if self.violated:
            text += f"; violates {self.violated} by {self.violation:.3g}"
        return f"<Solution: {text}>"

    def _repr_html_(self) -> str:
        rows = [("status", self.status if self.is_usable else f"{self.status} (not usable: {self._sentence})"), ("cost", f"{self.cost:.6g}"),
                ("violation", f"{self.violation:.3g}: {self.violated}" if self.violated else "none"), ("iterations", str(self.iterations)),
                ("residual", f"{self.residual:.1e}"), ("time", f"{1e3 * self.time:.3g} ms")]
        return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"

    def __getstate__(self) -> dict[str, Any]:
        """All but the problem, whose functions cannot be pickled: a copy has no sensitivities."""
        return {name: value for name, value in self.__dict__.items() if name != "_problem"}


class Feedback:
    """The answer of feedback(), by the linearisation of the last prepare().

    Attributes
    ----------
    u : array of shape (horizon, nu)
        Inputs from x0.
    x : array of shape (horizon + 1, nx)
        States from x0.
    is_solved : bool
        Whether the quadratic program is solved; else inputs were cut to their bounds.
    time : float
        Time of the work in C++ [s].
    """

    def __init__(self, reply: dict[str, Any], x0: Array) -> None:
        self.x0 = x0
        self.u: Array = reply["u"]
        self.x: Array = reply["x"]
        self.is_solved: bool = reply["is_solved"]
        self.time: float = reply["time"]

    def __repr__(self) -> str:
        return f"<Feedback: u[0] = {self.u[0]}, {1e6 * self.time:.3g} µs{'' if self.is_solved else ', cut to bounds'}>"


class Solutions:
    """The answers to many problems, row by row.

    Attributes
    ----------
    u : array of shape (n, horizon, nu)
        Inputs.
    x : array of shape (n, horizon + 1, nx)
        States.
    cost, violation, iterations, status, is_usable : array of shape (n,)
        As of Solution.
    time : array of shape (n,)
        Times of the work in C++ [s].
    """

    def __init__(self, reply: dict[str, Any]) -> None:
        self.u: Array = reply["u"]
        self.x: Array = reply["x"]
        self.cost: Array = reply["cost"]
        self.violation: Array = reply["violation"]
        self.iterations: npt.NDArray[np.int32] = reply["iterations"]
        self.time: Array = reply["time"]
        self.status = np.array([_chicane.SOLVE_STATUSES[int(number)][0] for number in reply["status"]])
        self.is_usable: npt.NDArray[np.bool_] = reply["status"] >= 0

    def __len__(self) -> int:
        return len(self.cost)

    def __repr__(self) -> str:
        return f"<Solutions: {np.count_nonzero(self.is_usable)} of {len(self)} usable, {np.count_nonzero(self.status == 'optimal')} optimal>"
