# SPDX-License-Identifier: MIT
"""The log of a solve."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._types import npt

if TYPE_CHECKING:
    import pandas as pd

_KINDS = np.array(["full step", "descent", "filter"])


class Iterations(Mapping[str, npt.NDArray[Any]]):
    """The iterations of a solve as columns, each of shape (iterations,): iterations["cost"]. print() shows a table.

    The columns are:

    kind: how the step was found: "full step" by the working set, "descent" by a line search over simulations, "filter" by the filter
    method.
    cost: of the point where the iteration began.
    stationarity, defect, complementarity: how far that point is from optimal.
    step: the longest move of an input from there; 0 if none was taken.
    barrier: of soft constraints, or of the filter method.
    round: of the multipliers of what must hold, from 1, whose shares are in the cost; 0: of none.
    """

    def __init__(self, columns: dict[str, npt.NDArray[Any]]) -> None:
        self._columns = columns | {"kind": _KINDS[columns["kind"]]}

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"got {name!r}, expected one of {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def count(self) -> int:
        """Number of iterations."""
        return len(self._columns["cost"])

    def to_pandas(self) -> pd.DataFrame:
        """Makes a table (needs python3-pandas).

        Returns
        -------
        pandas.DataFrame
            Row for each iteration.
        """
        import pandas as pd
        return pd.DataFrame(self._columns)

    def _rows(self) -> list[list[str]]:
        return [[str(value) if name in ("round", "kind") else f"{value:.6g}" if name == "cost" else f"{value:.1e}"
                 for name, value in zip(self._columns, row)] for row in zip(*self._columns.values())]

    def __str__(self) -> str:
        rows = [["iteration", *self._columns], *([str(n), *row] for n, row in enumerate(self._rows()))]
        widths = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows)

    def __repr__(self) -> str:
        return f"<Iterations: {self.count}, columns {', '.join(self._columns)}>"

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in self._columns)
        return f"<table><tr>{head}</tr>" + "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in self._rows()) + "</table>"
