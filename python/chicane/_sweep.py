# SPDX-License-Identifier: MIT
"""Many runs."""
from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _chicane
from ._request import Settings
from ._track import file_of

if TYPE_CHECKING:
    import pandas as pd


def plan_of(axes: Mapping[str, Any], settings: Settings | None = None, keep: Iterable[str] = (), name: str = "sweep") -> str:
    """The plan of a sweep as YAML, a line for each part (docs/sweep.md): what `chicane sweep` reads from a file."""
    lines = [f"name: {_json(name)}"]
    if settings:
        lines.append("settings: {" + ", ".join(f"{_json(key)}: {_json(value)}" for key, value in settings.items()) + "}")
    if axes:
        lines += ["axes:"] + [f"  - {{{_json(key)}: {_json(values)}}}" for key, values in axes.items()]
    if kept := list(keep):
        lines.append(f"keep: {_json(kept)}")
    return "\n".join(lines) + "\n"


def sweep(axes: Mapping[str, Any], *, settings: Settings | None = None, keep: Iterable[str] = (), jobs: int = 0, name: str = "sweep",
          output: str | os.PathLike[str] = "") -> pd.DataFrame:
    """Drives one run for each combination of the axes' values, on threads.

        ch.sweep({"preset": ["default", "race"], "latency_ms": range(0, 300, 50)}, settings={"laps": 2}, jobs=2)

    Parameters
    ----------
    axes : dict
        Values by key (docs/sweep.md): a list, range or array, or a range of the plan's grammar ({"from": 20, "to": 80,
        "step": 10}). The last axis changes fastest.
    settings : dict
        Settings of all runs.
    keep : list of str
        Columns of the results; empty: all.
    jobs : int
        Threads; 0: as many as processors.
    name : str
        Name of the sweep.
    output : str or path
        File for the results (.jsonl), as `chicane sweep` writes them. Runs that it holds are not driven again.

    Returns
    -------
    pandas.DataFrame
        Row for each run in the order of the plan: `run`, the keys of the axes, the results; None and not-a-number if nothing
        was measured, `error` if a run could not be driven. A run depends on the plan and its number only, not on `jobs`.

    Raises
    ------
    ValueError
        If the plan is wrong, with the line of plan_of().
    """
    import tempfile  # here, because importing chicane shall be quick

    import pandas as pd
    settings = settings or {}
    if "track" in settings:
        settings = {**settings, "track": file_of(settings["track"])}
    if isinstance(axes.get("track"), list):
        axes = {**axes, "track": [file_of(track) for track in axes["track"]]}
    plan = plan_of(axes, settings, keep, name)
    with tempfile.TemporaryDirectory(prefix="chicane-") as folder:
        file = Path(os.fspath(output) or Path(folder) / "sweep.jsonl")
        _chicane.sweep(plan, f"sweep {name}", str(file), jobs)
        lines = file.read_text(encoding="utf-8").splitlines()
    # Settings are columns; results of the same name win.
    rows = ({"run": reply.pop("run"), **reply.pop("settings"), **reply} for reply in map(json.loads, lines[1:]))
    return pd.DataFrame(sorted(rows, key=lambda row: int(row["run"])))


def _json(value: Any) -> str:
    """JSON, which is YAML; ranges and arrays are lists."""
    return json.dumps(value, default=_plain, ensure_ascii=False)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):  # of numpy
        return value.tolist()
    if isinstance(value, Iterable):
        return list(value)
    raise TypeError(f"axes: got {value!r}, expected numbers, texts and lists of them")
