# SPDX-License-Identifier: MIT
"""What has to be right before the compiled part is imported: the interpreter, numpy, the shipped data, the processor."""
from __future__ import annotations

import ast
import os
import sys
from pathlib import Path

_DATA = "CHICANE_DATA_DIR"


def prepare() -> None:
    """Finds the shipped presets, cars and tracks, and says in one sentence what is missing."""
    find_data(Path(__file__).resolve().parent, Path(os.path.abspath(__file__)).parent)
    try:
        import numpy  # noqa: F401
    except ImportError as error:
        raise ImportError(no_numpy()) from error
    from . import _chicane
    try:
        _chicane.check_processor()
    except ValueError as error:
        raise ImportError(f"chicane: {error}") from None


def find_data(*packages: Path) -> None:
    """Tells the library of share/chicane inside the package, or beside it as in a build folder; a folder that the
    environment names already stays. Child processes inherit it."""
    if os.environ.get(_DATA):
        return
    for package in packages:
        for place in (package / "share" / "chicane", package.parent.parent / "share" / "chicane"):
            if (place / "presets").is_dir():
                os.environ[_DATA] = str(place)
                return


def document(*classes: type) -> None:
    """Gives compiled classes the docstrings of their stubs, for help()."""
    stubs = ast.parse((Path(__file__).parent / "_chicane.pyi").read_text(encoding="utf-8"))
    nodes = {node.name: node for node in stubs.body if isinstance(node, ast.ClassDef)}
    for one in classes:
        one.__doc__ = ast.get_docstring(nodes[one.__name__])
        for member in nodes[one.__name__].body:
            if isinstance(member, ast.FunctionDef) and ast.get_docstring(member):
                getattr(one, member.name).__doc__ = ast.get_docstring(member)


def no_numpy() -> str:
    """What to do about an interpreter without numpy."""
    advice = "apt-get install python3-numpy, and a virtual environment made by /usr/bin/python3 -m venv --system-site-packages"
    if is_pyenv(sys.base_prefix):
        return (f"chicane: {sys.executable} is an interpreter of pyenv ({sys.base_prefix}), which does not see Debian's numpy: "
                f"expected /usr/bin/python3 ({advice})")
    return f"chicane: {sys.executable} has no numpy: {advice}"


def is_pyenv(prefix: str) -> bool:
    """Whether an interpreter's folder, or that of the shim which starts it, is pyenv's."""
    root = os.environ.get("PYENV_ROOT", "")
    return ".pyenv" in Path(prefix).parts or (bool(root) and Path(root) in Path(prefix).parents)
