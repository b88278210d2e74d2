# SPDX-License-Identifier: MIT
"""What can be named: shipped files, settings, faults, columns."""
from __future__ import annotations

from . import _chicane


def tracks() -> dict[str, str]:
    """Names of the shipped tracks; a file (.csv) can replace a name.

    Returns
    -------
    dict of str
        Description by name.
    """
    return _chicane.entries("tracks")


def cars() -> dict[str, str]:
    """Names of the shipped cars; a file (.yaml) can replace a name.

    Returns
    -------
    dict of str
        Description by name.
    """
    return _chicane.entries("cars")


def presets() -> dict[str, str]:
    """Names of the shipped presets; a file (.yaml) can replace a name.

    Returns
    -------
    dict of str
        Description by name.
    """
    return _chicane.entries("presets")


def scenarios() -> dict[str, str]:
    """Names of the shipped scenarios; a file (.yaml) can replace a name.

    Returns
    -------
    dict of str
        Description by name.
    """
    return _chicane.entries("scenarios")


def parameters() -> dict[str, tuple[str, str]]:
    """Keys of all settings; docs/reference/configuration.md has their ranges, too.

    Returns
    -------
    dict of tuple
        Unit and meaning by key.
    """
    return _chicane.parameters()


def faults() -> dict[str, str]:
    """Names of the faults.

    Returns
    -------
    dict of str
        Meaning by name.
    """
    return _chicane.faults()


def frame_fields() -> dict[str, str]:
    """Columns of Run.frames; the end of a name is its unit.

    Returns
    -------
    dict of str
        Meaning by name.
    """
    return _chicane.frame_fields()
