# SPDX-License-Identifier: MIT
"""What the program `chicane` does with files: roads, cars from logs, leagues. It is run for that, and must be there."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._request import Settings, text_of

if TYPE_CHECKING:
    import pandas as pd

AnyFile = str | os.PathLike[str]


class Road(os.PathLike[str]):
    """A road that was imported: give it to drive(), limit() or Env() as their track.

    Attributes
    ----------
    file : str
        Table of points with widths.
    remarks : list of str
        Assumptions about the file, in the words of `chicane import`.
    numbers : dict
        "is_closed", "length_m", "narrowest_m", "widest_m", "tightest_radius_m" (None: straight), "points" of the file, and
        "rms_m" and "max_m", their distance from the line.
    """

    def __init__(self, file: str, reply: dict[str, Any]) -> None:
        self.file = file
        self.remarks: list[str] = reply.pop("notices")
        self.numbers = reply

    def __fspath__(self) -> str:
        return self.file

    def __repr__(self) -> str:
        return f"<Road {self.file}: {self.numbers['length_m']:.1f} m, {len(self.remarks)} remarks>"


def road(file: AnyFile, output: AnyFile = "", **options: Any) -> Road:
    """Makes a road of a map, cones, coordinates or another program's file (docs/tracks.md), as `chicane import` does.

    Parameters
    ----------
    file : str or path
        File, whose content decides about the format.
    output : str or path
        Table to write (.csv), an older one is replaced; empty: a temporary file.
    **options : Any
        Options of `chicane import --help`, with underscores: width_m=7, direction="cw", start=(3.5, -1), closed=True.

    Returns
    -------
    Road
        Table, remarks and numbers.

    Raises
    ------
    ValueError
        If the file is no road (with file, line and element), or an option is unknown or out of its range.
    RuntimeError
        If the program is not there.
    """
    to = os.fspath(output) or str(Path(tempfile.mkdtemp(prefix="chicane-")) / f"{Path(os.fspath(file)).stem}.csv")
    return Road(to, json.loads(run("import", file, output=to, json=True, **options)))


def identify(logs: AnyFile | Sequence[AnyFile], output: AnyFile = "", *, settings: Settings | None = None, **options: Any) -> dict[str, Any]:
    """Finds the model of a car in logs of driving it (docs/identification.md), as `chicane identify` does.

    Parameters
    ----------
    logs : str, path or list of these
        Recordings, bags and CSV files of one car.
    output : str or path
        Car file to write (.yaml), for `car` of drive(); an older one is replaced.
    settings : dict
        Start of the search by key: {"vehicle.mass_kg": 950}.
    **options : Any
        Options of `chicane identify --help`, with underscores: car="road-car", report="mine.html", budget_s=60.

    Returns
    -------
    dict
        "estimates" (a list with key, unit, value, low, high, assumed and is_excited), "delay_ms", "residual_m", "held_out" (errors of
        the predictions), "predicts", "knows_tires", "friction_low" and more.

    Raises
    ------
    ValueError
        If logs cannot be read or hold too little driving or, with `output`, the car does not predict its log; force=True writes it.
    RuntimeError
        If the program is not there.
    """
    files = [logs] if isinstance(logs, (str, os.PathLike)) else logs
    chosen = [word for key, value in (settings or {}).items() for word in ("--set", f"{key}={text_of(value)}")]
    found: dict[str, Any] = json.loads(run("identify", *files, *chosen, output=output, json=True, **options))
    return found


def league(entries: AnyFile | Mapping[str, Any], output: AnyFile = "", **options: Any) -> pd.DataFrame:
    """Compares controllers on tracks, in cars and under disturbances (docs/sweep.md), as `chicane league` does.

    Parameters
    ----------
    entries : str, path or dict
        League's file, or its content: {"entries": {...}, "tracks": [...], ...}.
    output : str or path
        Page to write (.html); an older one is replaced.
    **options : Any
        Options of `chicane league --help`, with underscores: results="mine.jsonl" keeps what was driven, jobs=2.

    Returns
    -------
    pandas.DataFrame
        Row for each controller, track, car and disturbance, with the columns of `--json`.

    Raises
    ------
    ValueError
        If the league cannot be driven.
    RuntimeError
        If the program is not there.
    """
    import pandas as pd
    with tempfile.TemporaryDirectory(prefix="chicane-") as folder:
        file = entries
        if isinstance(entries, Mapping):
            file = Path(folder) / "league.yaml"
            file.write_text(json.dumps(entries), encoding="utf-8")     # JSON is YAML
            options.setdefault("results", str(Path(folder) / "league.jsonl"))
        return pd.DataFrame(json.loads(run("league", file, output=output, json=True, **options)))


def program() -> str:
    """$CHICANE_PROGRAM, else the one of the build folder that this package is in, else the one in $PATH."""
    built = Path(os.path.abspath(__file__)).parents[2] / "apps/chicane/chicane"
    found = os.environ.get("CHICANE_PROGRAM") or (str(built) if built.is_file() else shutil.which("chicane"))
    if not found or not shutil.which(found):
        raise RuntimeError("chicane: got no program `chicane` in $PATH, expected it there or named by $CHICANE_PROGRAM (docs/packages.md)")
    return found


def run(command: str, *words: Any, **options: Any) -> str:
    """What a command prints; ValueError with its last sentence where it fails."""
    given = [os.fspath(word) for word in words]
    for name, value in options.items():
        if value is not None and value is not False and value != "":
            text = ",".join(map(str, value)) if isinstance(value, (tuple, list)) else text_of(value)
            given += [f"--{name.replace('_', '-')}"] + ([] if value is True else [text])
    done = subprocess.run([program(), command, *given], capture_output=True, text=True)
    if done.returncode != 0:
        reply = [line for line in done.stderr.splitlines() if line and not line.startswith("See `")]
        raise ValueError(reply[-1] if reply else f"chicane {command}: exit code {done.returncode}")
    return done.stdout
