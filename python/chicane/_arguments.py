# SPDX-License-Identifier: MIT
"""Checks numbers and arrays that functions are given: what is wrong is said as `name: got X, expected Y`."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._types import npt

Array = npt.NDArray[np.float64]


def array_of(name: str, given: Any, shape: tuple[int, ...]) -> Array:
    """A number, or an array of that shape or of its last dimensions."""
    try:
        array = np.asarray(given, float)
        if array.ndim == 0:
            return np.full(shape, array)
        if array.shape == shape[-array.ndim:]:
            return np.ascontiguousarray(array if array.ndim == len(shape) else np.broadcast_to(array, shape))
    except (ValueError, TypeError):
        pass
    got = f"shape {np.shape(given)}" if isinstance(given, (np.ndarray, list, tuple, float, int)) else repr(given)
    raise ValueError(f"{name}: got {got}, expected numbers of shape {shape}")


def number_of(name: str, value: float, least: float, most: float) -> float:
    """The number itself, where it lies in that range."""
    if not least <= value <= most:
        raise ValueError(f"{name}: got {value}, expected a number from {least:g} to {most:g}")
    return value


def state_of(x0: npt.ArrayLike, count: int) -> Array:
    """Where a motion begins: `count` finite numbers."""
    given = np.atleast_1d(x0)
    state = array_of("x0", given, (count,))
    if given.shape != state.shape:
        raise ValueError(f"x0: got shape {given.shape}, expected numbers of shape {state.shape}")
    if not np.isfinite(state).all():
        raise ValueError(f"x0: got {state}, expected finite numbers")
    return state
