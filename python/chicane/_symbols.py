# SPDX-License-Identifier: MIT
"""Symbols: numbers that are not known yet. What is computed with them is recorded as a graph (docs/python_problems.md)."""
from __future__ import annotations

import linecache
import math
import operator
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ._types import npt

Objects = npt.NDArray[np.object_]
_OWN_FOLDERS = (str(Path(__file__).parent), str(Path(np.__file__).parent))


class TraceError(ValueError):
    """Something that cannot be recorded, with its line and what to write instead."""


def caller() -> str:
    """File, line and text of the innermost line that is neither of this package nor of numpy."""
    frame = sys._getframe(1)
    while frame.f_back is not None and _is_own(frame.f_code.co_filename):
        frame = frame.f_back
    return _place(frame.f_code.co_filename, frame.f_lineno)


def line_of(error: BaseException) -> str:
    """The same of an error that was raised."""
    at = [(frame.f_code.co_filename, line) for frame, line in traceback.walk_tb(error.__traceback__)]
    return _place(*next((place for place in reversed(at) if not _is_own(place[0])), at[-1]))


def _is_own(file: str) -> bool:
    return file.startswith((*_OWN_FOLDERS, "<__array_function__"))


def _place(file: str, line: int) -> str:
    text = linecache.getline(file, line).strip()
    return f"{file}:{line}: {text}" if text else f"{file}:{line}"


def refuse(got: str, expected: str) -> TraceError:
    return TraceError(f"{caller()}: got {got}, expected {expected}")


Node = tuple[str, int, int, int, float]
"""What is done, to which earlier nodes (-1: none), and a number: a constant or an exponent."""

_FOLD: dict[str, Callable[..., float]] = {
    "add": operator.add, "subtract": operator.sub, "multiply": operator.mul, "negate": operator.neg,
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "atan": math.atan, "exp": math.exp, "tanh": math.tanh}


class Graph:
    """Operations in the order of their making; equal ones exist once."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._known: dict[Node, int] = {}

    def add(self, op: str, a: int = -1, b: int = -1, c: int = -1, value: float = 0.0) -> int:
        node = (op, a, b, c, value)
        found = self._known.get(node)
        if found is None:
            found = self._known[node] = len(self.nodes)
            self.nodes.append(node)
        return found

    def constant(self, value: float) -> int:
        return self.add("constant", value=float(value))

    def value_of(self, node: int) -> float | None:
        """The number that a node is; None where it is none."""
        op, _, _, _, value = self.nodes[node]
        return value if op == "constant" else None

    def make(self, op: str, *of: int, value: float = 0.0) -> int:
        """The same, simplified where that is plain."""
        values = [self.value_of(node) for node in of]
        if op in _FOLD and None not in values:
            return self.constant(float(_FOLD[op](*values)))
        if op == "add":
            if values[0] == 0.0:
                return of[1]
            if values[1] == 0.0:
                return of[0]
        elif op == "subtract" and values[1] == 0.0:
            return of[0]
        elif op == "multiply":
            if values[0] == 1.0:
                return of[1]
            if values[1] == 1.0:
                return of[0]
            if values[0] == 0.0 or values[1] == 0.0:
                return self.constant(0.0)
        elif op == "divide" and values[1] == 1.0:
            return of[0]
        a, b, c = (*of, -1, -1)[:3]
        return self.add(op, a, b, c, value)


class Symbol:
    """A number that is not known yet: a state, an input, a parameter, or a result of them.

    Arithmetic, `abs`, numpy's functions of one argument and the functions of this module work on it; comparisons are for
    `where`. It has no value: a branch on it, `float()`, and functions of `math` are refused.
    """
    __slots__ = ("graph", "node")
    __array_priority__ = 1000.0

    def __init__(self, graph: Graph, node: int) -> None:
        self.graph = graph
        self.node = node

    def _of(self, other: Any) -> int:
        if isinstance(other, Symbol):
            if other.graph is not self.graph:
                raise refuse("a symbol of another problem", "symbols that the function was called with")
            return other.node
        if isinstance(other, (int, float, np.integer, np.floating)):
            return self.graph.constant(float(other))
        raise TypeError(f"{caller()}: got {type(other).__name__} beside a symbol, expected a number or a symbol")

    def _make(self, op: str, *of: int, value: float = 0.0) -> Symbol:
        return Symbol(self.graph, self.graph.make(op, *of, value=value))

    def _binary(self, op: str, other: Any, is_right: bool = False) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        operand = self._of(other)
        return self._make(op, operand, self.node) if is_right else self._make(op, self.node, operand)

    def __add__(self, other: Any) -> Any: return self._binary("add", other)
    def __radd__(self, other: Any) -> Any: return self._binary("add", other, True)
    def __sub__(self, other: Any) -> Any: return self._binary("subtract", other)
    def __rsub__(self, other: Any) -> Any: return self._binary("subtract", other, True)
    def __mul__(self, other: Any) -> Any: return self._binary("multiply", other)
    def __rmul__(self, other: Any) -> Any: return self._binary("multiply", other, True)
    def __truediv__(self, other: Any) -> Any: return self._binary("divide", other)
    def __rtruediv__(self, other: Any) -> Any: return self._binary("divide", other, True)
    def __neg__(self) -> Symbol: return self._make("negate", self.node)
    def __pos__(self) -> Symbol: return self
    def is_comparison(self) -> bool:
        """Whether it is the 1 or 0 of a < b or a <= b.

        Returns
        -------
        bool
            True for a comparison.
        """
        op, _, b = self.graph.nodes[self.node][:3]
        return op == "less" or (op == "subtract" and self.graph.nodes[b][0] == "less")

    def __abs__(self) -> Any: return where(self < 0.0, -self, self)

    def __pow__(self, exponent: Any) -> Any:
        if isinstance(exponent, Symbol):
            return (exponent * self.log()).exp()
        if exponent == 2:
            return self._make("multiply", self.node, self.node)
        return self._make("power", self.node, value=float(exponent))

    def __rpow__(self, base: Any) -> Any:
        return (self * math.log(base)).exp()

    def __lt__(self, other: Any) -> Any: return self._binary("less", other)
    def __gt__(self, other: Any) -> Any: return self._binary("less", other, True)
    def __le__(self, other: Any) -> Any: return 1.0 - self._binary("less", other, True)
    def __ge__(self, other: Any) -> Any: return 1.0 - self._binary("less", other)

    def __eq__(self, other: object) -> Any:
        raise refuse("== of a symbol", "a comparison by < or > inside ch.where(condition, a, b)")
    __hash__ = object.__hash__

    def __bool__(self) -> bool:
        raise refuse("a branch on a symbol", "ch.where(condition, a, b), or ch.minimum, ch.maximum, ch.clip")

    def __float__(self) -> float:
        raise refuse("a symbol where a number is needed", "ch.sin, np.sin or others that have a derivative: not math.sin, float(), np.floor")

    __int__ = __index__ = __float__

    def __iter__(self) -> Any:
        raise refuse("a loop over a symbol", "a loop over a vector of symbols, such as x")

    def sin(self) -> Symbol: return self._make("sin", self.node)
    def cos(self) -> Symbol: return self._make("cos", self.node)
    def tan(self) -> Symbol: return self._make("tan", self.node)
    def arctan(self) -> Symbol: return self._make("atan", self.node)
    def arcsin(self) -> Symbol: return self._make("asin", self.node)
    def arccos(self) -> Symbol: return self._make("acos", self.node)
    def exp(self) -> Symbol: return self._make("exp", self.node)
    def log(self) -> Symbol: return self._make("log", self.node)
    def tanh(self) -> Symbol: return self._make("tanh", self.node)
    def sqrt(self) -> Symbol: return self._make("sqrt", self.node)
    def square(self) -> Any: return self ** 2
    def sinh(self) -> Any: return 0.5 * (self.exp() - (-self).exp())
    def cosh(self) -> Any: return 0.5 * (self.exp() + (-self).exp())
    def arctan2(self, other: Any) -> Symbol: return self._make("atan2", self.node, self._of(other))
    def hypot(self, other: Any) -> Any: return (self * self + other * other).sqrt()
    def conjugate(self) -> Symbol: return self

    def __repr__(self) -> str:
        op, a, _, _, value = self.graph.nodes[self.node]
        return f"<symbol {op} {value if op == 'constant' else a}>"


def where(condition: Any, then: Any, otherwise: Any) -> Any:
    """Chooses `then` if the condition holds, else `otherwise`, for symbols, numbers and arrays of them.

    Both are computed: a root of a negative number in the one that is not chosen does no harm to the value, but see
    docs/python_problems.md.

    Parameters
    ----------
    condition : comparison or bool
        Condition.
    then : Symbol, float or array
        Value if it holds.
    otherwise : Symbol, float or array
        Value if not.

    Returns
    -------
    Symbol, float or array
        The chosen one.
    """
    if any(isinstance(part, (np.ndarray, list, tuple)) for part in (condition, then, otherwise)):
        return np.vectorize(where, otypes=[object])(condition, then, otherwise)
    if not isinstance(condition, Symbol):
        return then if condition else otherwise
    return condition._make("select", condition.node, condition._of(then), condition._of(otherwise))


def minimum(a: Any, b: Any) -> Any:
    """The smaller one of each pair.

    Parameters
    ----------
    a, b : Symbol, float or array
        Values.

    Returns
    -------
    Symbol, float or array
        Smaller ones.
    """
    return where(_less(b, a), b, a)


def maximum(a: Any, b: Any) -> Any:
    """The larger one of each pair.

    Parameters
    ----------
    a, b : Symbol, float or array
        Values.

    Returns
    -------
    Symbol, float or array
        Larger ones.
    """
    return where(_less(a, b), b, a)


def clip(x: Any, low: Any, high: Any) -> Any:
    """Limits `x` to [low, high].

    Parameters
    ----------
    x, low, high : Symbol, float or array
        Value and bounds.

    Returns
    -------
    Symbol, float or array
        Limited value.
    """
    return minimum(maximum(x, low), high)


def _less(a: Any, b: Any) -> Any:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.vectorize(_less, otypes=[object])(a, b)
    return a < b


def atan2(y: Any, x: Any) -> Any:
    """The angle of (x, y), in (-π, π].

    Parameters
    ----------
    y, x : Symbol, float or array
        Coordinates.

    Returns
    -------
    Symbol, float or array
        Angle [rad].
    """
    if isinstance(x, Symbol) and not isinstance(y, Symbol):
        y = Symbol(x.graph, x.graph.constant(float(y)))
    return np.arctan2(y, x)


def hypot(a: Any, b: Any) -> Any:
    """The length of (a, b).

    Parameters
    ----------
    a, b : Symbol, float or array
        Sides.

    Returns
    -------
    Symbol, float or array
        Length.
    """
    return np.sqrt(a * a + b * b)


def norm2(vector: Sequence[Any] | Objects) -> Any:
    """The sum of the squares of a vector's entries.

    Parameters
    ----------
    vector : list or array
        Vector.

    Returns
    -------
    Symbol or float
        Sum.
    """
    return sum(entry * entry for entry in vector)


sin, cos, tan, exp, log, tanh, sqrt = np.sin, np.cos, np.tan, np.exp, np.log, np.tanh, np.sqrt
asin, acos, atan = np.arcsin, np.arccos, np.arctan


def rk4(derivative: Callable[..., Any], h: float, steps: int = 1) -> Callable[..., Any]:
    """Makes dynamics from ẋ = derivative(x, u[, p]) by Runge and Kutta's method of fourth order.

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
    function
        Argument for Problem.dynamics().
    """
    if not (h > 0 and steps >= 1):
        raise ValueError(f"rk4: got h = {h} and {steps} steps, expected h > 0 and at least one")
    dt = h / steps

    def next_state(x: Any, *rest: Any) -> Any:
        x = np.asarray(x, dtype=object)
        for _ in range(steps):
            k1 = np.array(derivative(x, *rest), dtype=object)
            k2 = np.array(derivative(x + 0.5 * dt * k1, *rest), dtype=object)
            k3 = np.array(derivative(x + 0.5 * dt * k2, *rest), dtype=object)
            k4 = np.array(derivative(x + dt * k3, *rest), dtype=object)
            x = x + dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        return x
    next_state.__wrapped__ = derivative  # type: ignore[attr-defined]
    return next_state


def table(points: npt.ArrayLike, values: npt.ArrayLike) -> Callable[[Any], Any]:
    """Makes a smooth function through points: the natural cubic spline, continued by straight lines.

    Parameters
    ----------
    points : array of shape (n,)
        Increasing arguments, n from 3 to 64.
    values : array of shape (n,)
        Values there.

    Returns
    -------
    function
        Function of a number, a symbol or an array.
    """
    at, y = np.asarray(points, float), np.asarray(values, float)
    if at.ndim != 1 or at.shape != y.shape or not 3 <= at.size <= 64 or not np.all(np.diff(at) > 0):
        raise ValueError(f"table: got points of shape {at.shape} and values of shape {y.shape}, expected 3 to 64 increasing points and as "
                         "many values")
    step = np.diff(at)
    bend = np.zeros_like(at)                                   # second derivatives; zero at both ends
    rows = np.diag(2 * (step[:-1] + step[1:])) + np.diag(step[1:-1], 1) + np.diag(step[1:-1], -1)
    bend[1:-1] = np.linalg.solve(rows, 6 * np.diff(np.diff(y) / step))
    slope = (y[1] - y[0]) / step[0] - step[0] * bend[1] / 6
    kinks = np.diff(np.concatenate([[0.0], np.diff(bend) / step, [0.0]])) / 6

    def function(x: Any) -> Any:
        if isinstance(x, np.ndarray):
            return np.array([function(each) for each in x.ravel()], dtype=x.dtype).reshape(x.shape)
        value = y[0] + slope * (x - at[0])
        for point, kink in zip(at, kinks):
            beyond = maximum(x - point, 0.0)
            value = value + kink * beyond * beyond * beyond
        return value
    return function
