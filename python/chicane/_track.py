# SPDX-License-Identifier: MIT
"""Roads of your own, and readers of their files."""
from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numpy as np

from ._types import npt


class Track:
    """A road of your own: give it to drive(), limit() or Env() instead of a name, or as the setting "track".

    An edge across itself or a gap is refused when you drive on the road.

    Parameters
    ----------
    xy : array of shape (n, 2)
        Points of a line along the road in driving order [m], n >= 4.
    left, right : float or array of shape (n,)
        Distance from the points to the edges [m].
    closed : bool
        Whether it is a circuit; None: if the gap from end to start is like the others.
    name : str
        Name of the road in reports and recordings.
    **options : float
        Options of a road's file (docs/tracks.md), such as start_s_m, kerb_width_m, smoothing_sigma_m.
    """

    def __init__(self, xy: npt.ArrayLike, left: npt.ArrayLike = 4.5, right: npt.ArrayLike = 4.5, *, closed: bool | None = None,
                 name: str = "own", **options: float) -> None:
        self.xy = np.ascontiguousarray(xy, float)
        if self.xy.ndim != 2 or self.xy.shape[1] != 2 or len(self.xy) < 4:
            raise ValueError(f"Track: xy: got shape {self.xy.shape}, expected (n, 2) with n >= 4")
        try:
            self.left, self.right = (np.broadcast_to(np.asarray(width, float), len(self.xy)) for width in (left, right))
        except ValueError:
            raise ValueError(f"Track: got widths of shapes {np.shape(left)} and {np.shape(right)}, expected numbers or ({len(self.xy)},)") from None
        if not name or Path(name).name != name:
            raise ValueError(f"Track: name: got {name!r}, expected the name of a file without its ending")
        self.closed, self.name, self.options = closed, name, options

    def text(self) -> str:
        """Text of the road as a file of the library, exact to the last bit.

        Returns
        -------
        str
            Table with the columns x_m, y_m, w_tr_right_m, w_tr_left_m.
        """
        options = {key: repr(float(value)) for key, value in self.options.items()}
        if self.closed is not None:
            options["closed"] = "true" if self.closed else "false"
        head = [f"# {self.name}"] + (["# " + ", ".join(f"{key}={value}" for key, value in options.items())] if options else [])
        rows = [",".join(repr(float(value)) for value in row) for row in np.column_stack([self.xy, self.right, self.left])]
        return "\n".join([*head, "# x_m,y_m,w_tr_right_m,w_tr_left_m", *rows]) + "\n"

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the road as a table that the program reads.

        Parameters
        ----------
        file : str or path
            File to write (.csv).
        """
        Path(file).write_text(self.text(), encoding="utf-8")

    def file(self) -> str:
        """Keeps the road in $XDG_CACHE_HOME/chicane/tracks, by its content, so that recordings can name it.

        Returns
        -------
        str
            Path of the file.
        """
        text = self.text()
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "chicane/tracks"
        file = cache / hashlib.sha256(text.encode()).hexdigest()[:16] / f"{self.name}.csv"
        if not file.is_file():
            file.parent.mkdir(parents=True, exist_ok=True)
            unfinished = file.with_name(f"{file.name}.{os.getpid()}")
            unfinished.write_text(text, encoding="utf-8")
            unfinished.replace(file)
        return str(file)

    def __repr__(self) -> str:
        return f"<Track {self.name}: {len(self.xy)} points>"


AnyTrack = str | os.PathLike[str] | Track
"""A name, a file, or a road."""


class TrackReader:
    """Reads roads from files of a format of your own: derive from it, write read(), and give it to use_track_reader().

        class Points(ch.TrackReader):
            extension = ".points"

            def read(self, path):
                return ch.Track(np.loadtxt(path), left=4, right=4)
        ch.use_track_reader(Points())
        ch.drive("road.points")

    Attributes
    ----------
    extension : str
        End of the files' names, such as ".gpx".
    """

    extension: str = ""

    def read(self, path: str) -> Track:
        """Reads the road of a file.

        Parameters
        ----------
        path : str
            File.

        Returns
        -------
        Track
            Its road.
        """
        raise NotImplementedError(f"{type(self).__name__}.read(path) is not written yet")


_readers: dict[str, TrackReader] = {}


def use_track_reader(reader: TrackReader) -> None:
    """Lets you give files with the reader's extension as tracks; a later reader of the same extension replaces it.

    Parameters
    ----------
    reader : TrackReader
        Reader, with an extension other than ".csv".
    """
    if not isinstance(reader, TrackReader) or not reader.extension.startswith(".") or reader.extension == ".csv":
        raise ValueError(f"use_track_reader: got {reader!r}, expected a TrackReader with an extension such as \".gpx\"; .csv is the library's")
    _readers[reader.extension] = reader


def file_of(track: AnyTrack) -> str:
    """The track as the library takes it: a name, or a file that it reads."""
    if isinstance(track, Track):
        return track.file()
    name = os.fspath(track)
    reader = _readers.get(Path(name).suffix)
    if reader is None:
        return name
    if not Path(name).is_file():
        raise ValueError(f"track: got {name!r}, and there is no such file")
    road = reader.read(name)
    if not isinstance(road, Track):
        raise ValueError(f"{type(reader).__name__}.read: got {road!r}, expected a Track")
    return road.file()
