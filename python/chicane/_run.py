# SPDX-License-Identifier: MIT
"""What came of a run: its report, laps and frames."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from ._types import npt
from . import _chicane

if TYPE_CHECKING:
    import pandas as pd

Array = npt.NDArray[Any]
Text = Literal["track", "car", "controller", "preset", "end_reason", "state_hash", "arithmetic", "step_time_is"]
Count = Literal["seed", "laps_completed", "off_track_events", "cycles", "fallbacks", "gate_interventions", "deadline_misses"]
Number = Literal["latency_ms", "out_of_track_time_s", "duration_s", "wall_time_s"]
Rows = Literal["laps", "corners"]
Part = Literal["guard", "total", "step_time_us", "solve_time_us", "solver", "guard_reasons", "learned"]


class Frames(Mapping[str, Array]):
    """The control cycles of a run as columns: frames["speed_mps"] is an array of shape (cycles,).

    frame_fields() has the meaning of each column; its unit is the end of its name. Columns of a run that was driven have
    the type of the message (float64, bool, uint8, ...) and own their memory; arrays of a recording are float64.
    """

    def __init__(self, columns: Mapping[str, Array]) -> None:
        self._columns = dict(columns)

    def __getitem__(self, name: str) -> Array:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"got {name!r}, expected one of {', '.join(self._columns) or 'no columns (frames=False)'}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def cycles(self) -> int:
        """Number of control cycles."""
        return len(next(iter(self._columns.values()), ()))

    def to_pandas(self) -> pd.DataFrame:
        """Makes a table (needs python3-pandas).

        Returns
        -------
        pandas.DataFrame
            Row for each control cycle, indexed by time_s.
        """
        import pandas as pd
        return pd.DataFrame(self._columns).set_index("time_s")

    def meaning(self, name: str) -> str:
        """Says what a column means.

        Parameters
        ----------
        name : str
            Column.

        Returns
        -------
        str
            One sentence.
        """
        return _chicane.frame_fields()[name]

    def __repr__(self) -> str:
        return f"<Frames: {self.cycles} cycles, {len(self)} columns: {', '.join(list(self)[:6])}, ...>"


class Run(Mapping[str, Any]):
    """A run that was driven, as a mapping the report of `chicane drive --json`: run["off_track_events"], run["state_hash"].

    Its keys are in docs/reference/cli.md. It can be pickled.

    Attributes
    ----------
    frames : Frames
        What happened in each control cycle.
    situations : list of dict
        What the car did and what limited or stopped it, one for each change: time_s of the run at which it began, severity
        ("normal", "notice", "alarm"), sentence of at most six words, reason, ends_it, driver. Empty with frames=False.
    road : dict of array
        "centre", "left" and "right" of shape (n, 2) [m].
    error : str or None
        Traceback of a Controller of your own that failed.
    """

    def __init__(self, report: dict[str, Any], table: str, frames: Frames, situations: list[dict[str, Any]], road: dict[str, Array],
                 error: str | None, file: str, request: dict[str, Any] | None) -> None:
        self._report = report
        self._table = table
        self._request = request
        self.frames = frames
        self.situations = situations
        self.road = road
        self.error = error
        self.file = file

    @overload
    def __getitem__(self, key: Text) -> str: ...
    @overload
    def __getitem__(self, key: Count) -> int: ...
    @overload
    def __getitem__(self, key: Number) -> float: ...
    @overload
    def __getitem__(self, key: Literal["completed"]) -> bool: ...
    @overload
    def __getitem__(self, key: Rows) -> list[dict[str, Any]]: ...
    @overload
    def __getitem__(self, key: Part) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, key: str) -> Any: ...

    def __getitem__(self, key: str) -> Any:
        try:
            return self._report[key]
        except KeyError:
            raise KeyError(f"got {key!r}, expected one of {', '.join(self._report)}; laps and frames have their own") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._report)

    def __len__(self) -> int:
        return len(self._report)

    @property
    def laps(self) -> list[dict[str, Any]]:
        """The completed laps, the first from standstill: dicts with lap_time_s, mean_speed_mps, min_edge_distance_m and more."""
        laps: list[dict[str, Any]] = self._report["laps"]
        return laps

    @property
    def best_lap_s(self) -> float:
        """Shortest lap time [s]; not-a-number without a completed lap."""
        return min((float(lap["lap_time_s"]) for lap in self.laps), default=float("nan"))

    def table(self) -> str:
        """Laps and totals, as the program prints them.

        Returns
        -------
        str
            Table of text.
        """
        return self._table

    def summary(self) -> str:
        """The run in one line.

        Returns
        -------
        str
            Car, track, preset, laps and end.
        """
        laps = f"{self['laps_completed']} laps, the best {self.best_lap_s:.3f} s" if self.laps else "no lap completed"
        off = self["off_track_events"]
        end = self["end_reason"]
        return (f"{self['car']} on {self['track']}, {self['preset']}: {laps}, off the road {off} times"
                + (f"; {end}" if end else "") + ("; its controller failed" if self.error else ""))

    def __repr__(self) -> str:
        return f"<Run: {self.summary()}>"

    def _repr_html_(self) -> str:
        rows = [f"<tr><td>{number}</td><td>{lap['lap_time_s']:.3f}</td><td>{lap['mean_speed_mps']:.2f}</td>"
                f"<td>{lap['top_speed_mps']:.2f}</td><td>{_number(lap['min_edge_distance_m'])}</td></tr>"
                for number, lap in enumerate(self.laps, 1)]
        head = "".join(f"<th>{name}</th>" for name in ("lap", "time [s]", "mean [m/s]", "top [m/s]", "to edge, least [m]"))
        error = f"<pre>{escape(self.error)}</pre>" if self.error else ""
        return (f"<p>{escape(self.summary())}</p>{_picture(self.road, self.frames)}<table><tr>{head}</tr>{''.join(rows)}</table>"
                f"{error}")


class Recording:
    """A recording that was read.

    Attributes
    ----------
    head : dict of str
        Who recorded what (docs/viewer.md#recordings).
    frames : Frames
        What happened in each control cycle, all columns float64.
    laps : list of dict
        Completed laps.
    road : dict of array
        "centre", "left" and "right" of shape (n, 2) [m]; empty if no track was known.
    """

    def __init__(self, file: str, head: dict[str, str], frames: Frames, laps: list[dict[str, float]], road: dict[str, Array]) -> None:
        self.file = file
        self.head = head
        self.frames = frames
        self.laps = laps
        self.road = road

    def __repr__(self) -> str:
        what = ", ".join(self.head[key] for key in ("car", "track", "preset") if self.head.get(key))
        return f"<Recording {self.file}: {what}; {self.frames.cycles} cycles, {len(self.laps)} laps>"

    def _repr_html_(self) -> str:
        return f"<p>{escape(repr(self))}</p>{_picture(self.road, self.frames)}"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _picture(road: Mapping[str, Array], frames: Frames) -> str:
    """Road and driven line from above, as SVG."""
    edges = [road[name] for name in ("left", "right") if name in road and len(road[name])]
    if not edges:
        return ""
    points = np.concatenate(edges)
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = np.maximum(high - low, 1.0)
    lines = [(edge, "#888") for edge in edges]
    if "x_m" in frames:
        step = max(1, frames.cycles // 1000)
        lines.append((np.stack([frames["x_m"], frames["y_m"]], axis=1)[::step], "#c33"))
    drawn = "".join(f'<polyline fill="none" stroke="{colour}" vector-effect="non-scaling-stroke" points="{_points(line, low, high)}"/>'
                    for line, colour in lines)
    return f'<svg width="360" viewBox="0 0 {width:.1f} {height:.1f}" xmlns="http://www.w3.org/2000/svg">{drawn}</svg>'


def _points(line: Array, low: Array, high: Array) -> str:
    """Points in the picture, whose y points down."""
    inside = line[np.isfinite(line).all(axis=1)]
    return " ".join(f"{x - low[0]:.1f},{high[1] - y:.1f}" for x, y in inside)
