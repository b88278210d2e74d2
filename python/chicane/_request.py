# SPDX-License-Identifier: MIT
"""From Python's values to the text that the library's settings are made of."""
from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from . import _chicane
from ._track import file_of

Settings = Mapping[str, Any]


def text_of(value: Any) -> str:
    """A setting as `--set` takes it: true, 0.1, race."""
    if hasattr(value, "item"):  # a number of numpy
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)


def listed(faults: Iterable[str]) -> list[str]:
    """Faults as a list; one text is one fault."""
    return [faults] if isinstance(faults, str) else list(faults)


def make_request(named: Settings, settings: Settings | None, faults: Iterable[str] = (), scenario: str = "",
                 speed_mps: float | None = None) -> _chicane.Request:
    """The experiment asked for. `settings` win over `named`; None is left out."""
    pairs = [(key, file_of(value) if key == "track" else text_of(value)) for key, value in [*named.items(), *(settings or {}).items()] if value is not None]
    return _chicane.Request(scenario, pairs, "" if speed_mps is None else text_of(speed_mps), listed(faults))
