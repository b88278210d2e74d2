# SPDX-License-Identifier: MIT
"""numpy.typing for annotations, which are not evaluated: importing it takes as long as all of this package."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

__all__ = ["npt"]

if TYPE_CHECKING:
    import numpy.typing as npt
else:
    class npt:
        """Stands in for it where aliases are made."""

        NDArray = list
        ArrayLike = Any
