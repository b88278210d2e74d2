# SPDX-License-Identifier: MIT
"""What can be named: shipped files, settings, faults, columns."""
from __future__ import annotations

from . import _chicane


def tracks() -> dict[str, str]:
    """Names of the shipped tracks, each with a description. Files (.csv) may be given in their place."""
    return _chicane.entries("tracks")


def cars() -> dict[str, str]:
    """Names of the shipped cars, each with a description. Files (.yaml) may be given in their place."""
    return _chicane.entries("cars")


def presets() -> dict[str, str]:
    """Names of the shipped presets, each with a description. Files (.yaml) may be given in their place."""
    return _chicane.entries("presets")


def scenarios() -> dict[str, str]:
    """Names of the shipped scenarios, each with a description. Files (.yaml) may be given in their place."""
    return _chicane.entries("scenarios")


def parameters() -> dict[str, tuple[str, str]]:
    """Every setting by its key: unit and meaning, as docs/reference/configuration.md lists them with their ranges."""
    return _chicane.parameters()


def faults() -> dict[str, str]:
    """Names of the faults, each with its meaning."""
    return _chicane.faults()


def frame_fields() -> dict[str, str]:
    """Columns of Run.frames, each with its meaning; the unit is the end of the name."""
    return _chicane.frame_fields()
