# SPDX-License-Identifier: MIT
"""Runs: driven, read from recordings, computed again."""
from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable
from typing import Any

from . import _chicane
from ._controller import Controller
from ._plant import Plant
from ._request import Settings, listed, make_request
from ._run import Frames, Recording, Run
from ._track import AnyTrack


def drive(track: AnyTrack | None = None, *, car: str | None = None, preset: str | None = None, scenario: str = "",
          controller: str | Controller | None = None, plant: str | Plant | None = None, laps: int | None = None, latency_ms: float | None = None,
          seed: int | None = None, speed_mps: float | None = None, settings: Settings | None = None, faults: Iterable[str] = (),
          record: str | os.PathLike[str] = "", frames: bool = True, step_limit_s: float = 10.0) -> Run:
    """Drives a car round a track in virtual time, as `chicane drive --fast` does.

    Parameters
    ----------
    track : str, path or Track
        Name of a shipped track (tracks()), file, or road of your own.
    car : str or path
        Name of a shipped car (cars()), or file.
    preset : str or path
        Name of a controller with its settings (presets()), or file.
    scenario : str
        Name of settings that the other arguments override (scenarios()), or file.
    controller : str or Controller
        Name of a controller, or one of your own.
    plant : str or Plant
        Name of the simulated car's equations, or a car of your own.
    laps : int
        Laps to drive, the first from standstill; 0: until the car is lost or `settings["time_limit_s"]` is over.
    latency_ms : float
        Time from a measurement to its command's effect [ms].
    seed : int
        Seed of everything random.
    speed_mps : float
        Speed reference of the controller [m/s].
    settings : dict
        Any setting by its key, such as {"plant_options.friction_scale": 0.7}: parameters() lists them.
    faults : list of str
        "half_grip@12+5*0.5" is half_grip at 12 s for 5 s of strength 0.5; faults() lists them.
    record : str or path
        Recording to write (.mcap), for read(), verify(), `chicane replay` and the dashboard; an older one is replaced.
    frames : bool
        False leaves Run.frames empty, which saves 500 bytes for each control cycle.
    step_limit_s : float
        Longest time of one step of a Controller or Plant of your own by the wall clock [s]; 0: none.

    Returns
    -------
    Run
        Report, laps and frames. The same arguments give the same run, bit for bit: compare run["state_hash"].

    Raises
    ------
    ValueError
        If this cannot be driven.
    """
    _refuse_classes(controller=controller, plant=plant)
    own = controller if isinstance(controller, Controller) or hasattr(controller, "step") else None
    own_plant = plant if not isinstance(plant, str) else None
    named: dict[str, Any] = {"track": track, "car": car, "preset": preset, "laps": laps, "latency_ms": latency_ms, "seed": seed,
                             "controller": None if own is not None else controller, "plant": plant if own_plant is None else None}
    request = make_request(named, settings, faults, scenario, speed_mps)
    _make_room(record)
    reply = _chicane.drive(request, own, own_plant, os.fspath(record), frames, step_limit_s)
    error = reply["error"]
    if error is not None:
        print(f"chicane: {type(own).__name__} failed at {reply['error_time']:.2f} s; the guard stops the car:\n{error}", end="", file=sys.stderr)
    again = None if own is not None or own_plant is not None else dict(named=named, settings=dict(settings or {}), faults=listed(faults), scenario=scenario,
                                              speed_mps=speed_mps)
    return Run(json.loads(reply["report"]), reply["table"], Frames(reply["frames"]), reply["situations"], reply["road"], error,
               os.fspath(record), again)


def _refuse_classes(**given: object) -> None:
    for name, value in given.items():
        if isinstance(value, type):
            raise ValueError(f"{name}: got the class {value.__name__}, expected an instance of it: {value.__name__}()")


def _make_room(record: str | os.PathLike[str]) -> None:
    """Removes an older recording; any other file stays, and is refused."""
    if record and os.path.isfile(record):
        with open(record, "rb") as file:
            is_recording = file.read(6) == b"\x89MCAP0"
        if is_recording:
            os.unlink(record)


def read(path: str | os.PathLike[str]) -> Recording:
    """Reads a recording of drive(), or of the program's `drive`, `serve` or `simulate`.

    Parameters
    ----------
    path : str or path
        Recording (.mcap); of several runs in one file the last is read.

    Returns
    -------
    Recording
        Head, laps, frames and road.

    Raises
    ------
    ValueError
        If the file is no recording of chicane.
    """
    reply = _chicane.read(os.fspath(path))
    return Recording(os.fspath(path), reply["head"], Frames(reply["frames"]), reply["laps"], reply["road"])


def verify(path: str | os.PathLike[str], controller: Controller | None = None, step_limit_s: float = 10.0) -> dict[str, Any]:
    """Computes every command of a recording again, as `chicane replay --verify` does.

    Parameters
    ----------
    path : str or path
        Recording (.mcap).
    controller : Controller
        New instance of the Controller that drove; None: the library's controller that did.
    step_limit_s : float
        Longest time of one step of a Controller of your own by the wall clock [s]; 0: none.

    Returns
    -------
    dict
        "steps", "identical", "different", "first_difference" (a cycle, or None), "is_verified" and "error".
    """
    _refuse_classes(controller=controller)
    return _chicane.verify(os.fspath(path), controller, step_limit_s)
