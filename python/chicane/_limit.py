# SPDX-License-Identifier: MIT
"""The fastest lap that a car can drive."""
from __future__ import annotations

from typing import Any


from ._types import npt
from . import _chicane
from ._request import Settings, make_request
from ._track import AnyTrack


class Limit:
    """The fastest lap of a car on a road (docs/limit.md): no controller should beat `bound_s`.

    bound_s: the optimum of the plant's own equations [s].
    witness_s: the best lap that was really driven after such a plan [s]; None: none was asked for, or none could be.
    sector_times_s: the thirds of the bound [s].
    line: the racing line of the optimum: "s_m" and "speed_mps" of shape (n,), "xy_m" of shape (n, 2)."""

    def __init__(self, reply: dict[str, Any]) -> None:
        self.bound_s: float = reply["bound_s"]
        self.witness_s: float | None = reply["witness_s"]
        self.sector_times_s: list[float] = reply["sector_times_s"]
        self.iterations: int = reply["iterations"]
        self.violation: float = reply["violation"]
        self.line: dict[str, npt.NDArray[Any]] = reply["line"]

    def __repr__(self) -> str:
        witness = "" if self.witness_s is None else f", driven {self.witness_s:.3f} s"
        return f"<Limit: {self.bound_s:.3f} s{witness}>"


def limit(track: AnyTrack | None = None, *, car: str | None = None, settings: Settings | None = None,
          witness: bool = True) -> Limit:
    """Finds the fastest lap of a car on a closed road: 1 to 60 s, as `chicane limit` does.

    witness: also drives it, which takes most of the time.
    ValueError for an open road, a model car, or a road too narrow or with a bend too tight for the car."""
    request = make_request({"track": track, "car": car}, settings)
    return Limit(_chicane.limit(request, witness))
