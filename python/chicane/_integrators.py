# SPDX-License-Identifier: MIT
"""Implicit integrators: the states inside a step are unknowns of the problem, tied by equalities (docs/python_problems.md)."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ._types import npt

Array = npt.NDArray[np.float64]
_ROOT = float(np.sqrt(3.0))
_TABLEAUS = {1: ([[0.5]], [1.0]),
             2: ([[0.25, 0.25 - _ROOT / 6], [0.25 + _ROOT / 6, 0.25]], [0.5, 0.5])}
"""Of Gauss and Legendre, by stages: weights inside a step and over it."""


class Implicit:
    """Dynamics by an implicit method of Runge and Kutta. What Problem.dynamics() makes of it: `count` unknowns for each state, the
    states inside each interval, with as many equalities."""

    def __init__(self, derivative: Callable[..., Any], h: float, steps: int, inside: Array, over: Array) -> None:
        self.__wrapped__ = derivative
        self.h, self.steps, self.inside, self.over = h / steps, steps, inside, over
        self.count = steps * len(over)

    def apply(self, x: Any, unknowns: Any, *rest: Any) -> tuple[Any, list[Any]]:
        """The next state, and what is zero. unknowns: (count, nx)."""
        x = np.asarray(x, dtype=object)
        stages, zeros = len(self.over), []
        for step in range(self.steps):
            own = unknowns[step * stages:(step + 1) * stages]
            rates = [np.array(self.__wrapped__(state, *rest), dtype=object) for state in own]
            if any(rate.shape != x.shape for rate in rates):
                raise ValueError(f"dynamics: got a derivative of {rates[0].size} values, expected {x.size}, one for each state")
            for row, state in zip(self.inside, own):
                zeros += list(state - x - self.h * sum(weight * rate for weight, rate in zip(row, rates)))
            is_stiffly_accurate = bool(np.array_equal(self.inside[-1], self.over))
            x = own[-1] if is_stiffly_accurate else x + self.h * sum(weight * rate for weight, rate in zip(self.over, rates))
        return x, zeros


def _check(name: str, h: float, steps: int) -> None:
    if not (h > 0 and steps >= 1 and int(steps) == steps):
        raise ValueError(f"{name}: got h = {h} and {steps} steps, expected h > 0 and at least one")


def implicit_euler(derivative: Callable[..., Any], h: float, steps: int = 1) -> Implicit:
    """Makes dynamics from ẋ = derivative(x, u[, p]) by the implicit method of Euler, of first order, for stiff systems.

    Adds steps · nx unknowns and equalities to each stage.

    Parameters
    ----------
    derivative : function
        Rates of the states.
    h : float
        Length of an interval [s], in which the input is held.
    steps : int
        Steps in an interval.

    Returns
    -------
    Implicit
        Argument for Problem.dynamics().
    """
    _check("implicit_euler", h, steps)
    return Implicit(derivative, h, steps, np.array([[1.0]]), np.array([1.0]))


def gauss_legendre(derivative: Callable[..., Any], h: float, stages: int = 2, steps: int = 1) -> Implicit:
    """Makes dynamics from ẋ = derivative(x, u[, p]) by collocation at Legendre's points.

    With one stage it is of order 2 (the implicit midpoint rule), with two of order 4; A-stable, and symplectic. Adds
    steps · stages · nx unknowns and equalities to each stage of the problem.

    Parameters
    ----------
    derivative : function
        Rates of the states.
    h : float
        Length of an interval [s], in which the input is held.
    stages : {2, 1}
        Points in a step.
    steps : int
        Steps in an interval.

    Returns
    -------
    Implicit
        Argument for Problem.dynamics().
    """
    _check("gauss_legendre", h, steps)
    if stages not in _TABLEAUS:
        raise ValueError(f"gauss_legendre: got {stages} stages, expected 1 or 2")
    inside, over = _TABLEAUS[stages]
    return Implicit(derivative, h, steps, np.array(inside), np.array(over))
