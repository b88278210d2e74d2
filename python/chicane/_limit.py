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

    Attributes
    ----------
    bound_s : float
        Optimum of the plant's own equations [s].
    witness_s : float or None
        Best lap that was driven after such a plan [s]; None: not asked for, or none could be driven.
    sector_times_s : list of float
        Thirds of the bound [s].
    iterations : int
        Iterations of the optimisation.
    violation : float
        Largest violation of a constraint, scaled to 1.
    line : dict of array
        Racing line of the optimum: "s_m" and "speed_mps" of shape (n,), "xy_m" of shape (n, 2).
    """

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


def limit(track: AnyTrack | None = None, *, car: str | None = None, settings: Settings | None = None, witness: bool = True) -> Limit:
    """Finds the fastest lap of a car on a closed road in 1 to 60 s, as `chicane limit` does.

    Parameters
    ----------
    track : str, path or Track
        Closed road, as for drive().
    car : str or path
        Car, as for drive().
    settings : dict
        Any setting by its key.
    witness : bool
        Whether a lap is driven after the plan, too, which takes most of the time.

    Returns
    -------
    Limit
        Times and line.

    Raises
    ------
    ValueError
        If the road is open, too narrow for the car or has a bend too tight for it, or the car is a model car.
    """
    return Limit(_chicane.limit(make_request({"track": track, "car": car}, settings), witness))
