# SPDX-License-Identifier: MIT
"""gymnasium's classes where it can be imported, and what stands in for them where not."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._types import npt

Array = npt.NDArray[np.float64]


class PlainBox:
    """A box of numbers, as gymnasium.spaces.Box: low, high, shape, dtype, sample(), contains()."""

    def __init__(self, low: Array, high: Array) -> None:
        self.low = low
        self.high = high
        self.shape = low.shape
        self.dtype = low.dtype
        self._random = np.random.default_rng()

    def seed(self, seed: int | None = None) -> None:
        """Of sample()."""
        self._random = np.random.default_rng(seed)

    def sample(self) -> Array:
        """Evenly inside the bounds; normal where there are none."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        inside = self._random.uniform(np.where(bounded, self.low, 0.0), np.where(bounded, self.high, 1.0))
        return np.where(bounded, inside, self._random.normal(size=self.shape))

    def contains(self, x: npt.ArrayLike) -> bool:
        """Whether it has the shape, and is inside the bounds."""
        values = np.asarray(x)
        return values.shape == self.shape and bool(np.all((values >= self.low) & (values <= self.high)))

    def __repr__(self) -> str:
        return f"Box{self.shape}"


class PlainEnv:
    """Of gymnasium.Env what agents use beside reset() and step()."""

    @property
    def unwrapped(self) -> Any:
        """The environment itself."""
        return self

    def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
        """Keeps no generator: everything random is C++'s."""

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()  # type: ignore[attr-defined]


AUTORESET: Any = "SameStep"
if TYPE_CHECKING:
    Box = PlainBox
    BaseEnv = PlainEnv
    BaseVecEnv = PlainEnv
else:
    try:
        from gymnasium import Env as BaseEnv
        from gymnasium.spaces import Box
        from gymnasium.vector import AutoresetMode
        from gymnasium.vector import VectorEnv as BaseVecEnv
    except ImportError:
        Box, BaseEnv, BaseVecEnv = PlainBox, PlainEnv, PlainEnv
    else:
        AUTORESET = AutoresetMode.SAME_STEP


def box(low: Array, high: Array) -> Box:
    """A space of float64."""
    if Box is PlainBox:
        return PlainBox(low, high)
    return Box(low=low, high=high, dtype=np.float64)  # type: ignore[call-arg]


def batch_space(space: Box, count: int) -> Box:
    """The space of `count` at once."""
    return box(np.tile(space.low, (count, 1)), np.tile(space.high, (count, 1)))
