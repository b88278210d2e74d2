# SPDX-License-Identifier: MIT
"""Model predictive control of cars, their simulator and their recordings (docs/python.md).

    import chicane as ch
    run = ch.drive("lakeside", car="road-car", laps=2)
    run.laps, run.frames["speed_mps"], run.frames.to_pandas()

All numbers are SI with angles in radians, in the axes of ISO 8855: x ahead, y to the left, yaw and steering positive to
the left. Where a name ends with a unit (`latency_ms`), that unit counts. What cannot be done is refused with a
ValueError that says what was got and what was expected.

Functions release the interpreter's lock while C++ works, and end with KeyboardInterrupt at Ctrl-C. They share nothing:
any thread may call them. An Env, VecEnv or Controller belongs to one thread at a time.
"""
from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from . import _interpreter

_interpreter.prepare()

from ._chicane import NO_ANSWER, CarState, Command, Measurement, __version__  # noqa: E402
from ._controller import Controller  # noqa: E402
from ._drive import drive, read, verify  # noqa: E402
from ._integrators import gauss_legendre, implicit_euler  # noqa: E402
from ._known import cars, faults, frame_fields, parameters, presets, scenarios, tracks  # noqa: E402
from ._limit import Limit, limit  # noqa: E402
from ._plant import Plant  # noqa: E402
from ._problem import Problem  # noqa: E402
from ._program import Road, identify, league, road  # noqa: E402
from ._run import Frames, Recording, Run  # noqa: E402
from ._solution import Feedback, Solution, Solutions  # noqa: E402
from ._sweep import sweep  # noqa: E402
from ._symbols import (  # noqa: E402
    Symbol, TraceError, acos, asin, atan, atan2, clip, cos, exp, hypot, log, maximum, minimum, norm2, rk4, sin, sqrt, table, tan, tanh, where,
)
from ._track import Track, TrackReader, use_track_reader  # noqa: E402
from ._iterations import Iterations  # noqa: E402
from ._view import report, view  # noqa: E402

if TYPE_CHECKING:
    from ._env import Env, VecEnv

_interpreter.document(CarState, Command, Measurement, type(NO_ANSWER))
__all__ = [
    "CarState", "Command", "Controller", "Env", "Feedback", "Frames", "Iterations", "Limit", "NO_ANSWER", "Plant", "Problem", "Recording", "Road", "Run",
    "Measurement", "Solution", "Solutions", "Symbol", "TraceError", "Track", "TrackReader", "VecEnv", "__version__", "acos", "asin", "atan", "atan2",
    "cars", "clip", "cos", "drive", "exp", "faults", "frame_fields", "gauss_legendre", "hypot", "identify", "implicit_euler", "league", "limit", "log",
    "maximum", "minimum", "norm2", "parameters", "presets", "read", "report", "rk4", "road", "scenarios", "sin", "sqrt", "sweep", "table", "tan", "tanh",
    "tracks", "use_track_reader", "verify", "view", "where",
]


def register_environments() -> None:
    """Makes chicane/Race-v0 known to gymnasium.make(). Done by `import gymnasium` where the package is installed, and by `import chicane` after
    it; call it in a build folder where chicane is imported first."""
    from gymnasium.envs.registration import register, registry
    if "chicane/Race-v0" not in registry:
        register(id="chicane/Race-v0", entry_point="chicane:Env")


if "gymnasium.envs.registration" in sys.modules:
    register_environments()


def __getattr__(name: str) -> Any:
    """Env and VecEnv when they are first used: gymnasium, which they build on where it is there, takes long to import."""
    if name in ("Env", "VecEnv"):
        from . import _env
        return getattr(_env, name)
    raise AttributeError(f"module 'chicane' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
