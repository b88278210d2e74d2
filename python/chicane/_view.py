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


def view(run: Run | Recording | str | os.PathLike[str], *, page: str | os.PathLike[str] = "", height: int = 700,
         open_browser: bool | None = None) -> Page:
    """Shows a run in the dashboard: in a notebook in its cell, elsewhere in a tab of the browser.

    run: of drive() or read(), or a recording's file. A run that was not recorded is driven once more.
    page: where to write the page, one HTML file without network; a temporary file when left out.
    height: of the cell [px].
    open_browser: None: unless in a notebook.
    ValueError for a run with a Controller of your own that was not recorded (drive(..., record=...)), and where the
    module was built without Node.js, which the dashboard needs."""
    import tempfile  # here, because importing chicane shall be quick
    import webbrowser
    file = os.fspath(page) or tempfile.mkstemp(prefix="chicane-", suffix=".html")[1]
    with tempfile.TemporaryDirectory(prefix="chicane-") as folder:
        recording = _recording_of(run, folder)
        _chicane.write_page(recording, Path(recording).name, file)
    if open_browser or (open_browser is None and not _is_notebook()):
        webbrowser.open(Path(file).resolve().as_uri())
    return Page(file, height)


def _recording_of(run: Run | Recording | str | os.PathLike[str], folder: str) -> str:
    if not isinstance(run, (Run, Recording)):
        return os.fspath(run)
    if run.file:
        return run.file
    if isinstance(run, Recording) or run._request is None:
        raise ValueError("view: got a run with a controller of your own that was not recorded, expected drive(..., record=\"run.mcap\")")
    file = str(Path(folder) / "run.mcap")
    _chicane.drive(make_request(**run._request), None, None, file, False, 0.0)
    return file


def _is_notebook() -> bool:
    shell: Any = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"
