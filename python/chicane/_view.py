# SPDX-License-Identifier: MIT
"""The dashboard with a run."""
from __future__ import annotations

import os
import sys
from html import escape
from pathlib import Path
from typing import Any

from . import _chicane
from ._request import make_request
from ._run import Recording, Run


class Page:
    """A page with the dashboard and one recording; a notebook shows it in its cell."""

    def __init__(self, file: str, height: int) -> None:
        self.file = file
        self._height = height

    def __repr__(self) -> str:
        return f"<Page {self.file}>"

    def _repr_html_(self) -> str:
        page = escape(Path(self.file).read_text(encoding="utf-8"), quote=True)
        return f'<iframe width="100%" height="{self._height}" style="border: 0" srcdoc="{page}"></iframe>'


def report(run: Run | Recording | str | os.PathLike[str], output: str | os.PathLike[str], *, height: int = 700) -> Page:
    """Writes the dashboard with a run as one HTML file that needs no network, as `chicane report` does.

    Parameters
    ----------
    run : Run, Recording, str or path
        Result of drive() or read(), or a recording's file. A run that was not recorded is driven once more.
    output : str or path
        Page to write; an older one is replaced.
    height : int
        Height of the cell of a notebook that shows the answer [px].

    Returns
    -------
    Page
        Shown by a notebook.

    Raises
    ------
    ValueError
        If a Controller of your own drove without drive(..., record=...), or the module was built without Node.js, which the
        dashboard needs.
    """
    import tempfile  # here, because importing chicane shall be quick
    file = os.fspath(output)
    with tempfile.TemporaryDirectory(prefix="chicane-") as folder:
        recording = _recording_of(run, folder)
        _chicane.write_page(recording, Path(recording).name, file)
    return Page(file, height)


def view(run: Run | Recording | str | os.PathLike[str], *, height: int = 700) -> Page:
    """Shows the page of report(): in a notebook in its cell, elsewhere in a tab of the browser.

    Parameters
    ----------
    run : Run, Recording, str or path
        As for report().
    height : int
        Height of the cell of a notebook [px].

    Returns
    -------
    Page
        Shown by a notebook.
    """
    import tempfile
    import webbrowser
    page = report(run, tempfile.mkstemp(prefix="chicane-", suffix=".html")[1], height=height)
    if not _is_notebook():
        webbrowser.open(Path(page.file).resolve().as_uri())
    return page


def _recording_of(run: Run | Recording | str | os.PathLike[str], folder: str) -> str:
    if not isinstance(run, (Run, Recording)):
        return os.fspath(run)
    if run.file:
        return run.file
    if isinstance(run, Recording) or run._request is None:
        raise ValueError("run: got one with a controller of your own that was not recorded, expected drive(..., record=\"run.mcap\")")
    file = str(Path(folder) / "run.mcap")
    _chicane.drive(make_request(**run._request), None, None, file, False, 0.0)
    return file


def _is_notebook() -> bool:
    shell: Any = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"
