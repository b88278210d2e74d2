#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes docs/reference/python_reference.md from the docstrings of the Python module and the stubs of its compiled part.

    ./run.sh python tools/python_reference.py           writes the page
    ./run.sh python tools/python_reference.py --check   exit code 1 where it is another one"""
import ast
import inspect
import re
import sys
from pathlib import Path

import usage

usage.print_if_asked(__doc__)  # before an import that may fail

import chicane as ch

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/reference/python_reference.md"
PARTS = (
    ("Runs", ("drive", "read", "verify", "report", "view", "sweep", "limit", "Run", "Frames", "Recording", "Limit")),
    ("Parts of your own", ("Controller", "Measurement", "Command", "Plant", "CarState", "Track", "TrackReader", "use_track_reader")),
    ("By the program", ("road", "Road", "identify", "league")),
    ("Environments", ("Env", "VecEnv")),
    ("Optimal control problems", ("Problem", "Solution", "Solutions", "Feedback", "Iterations", "TraceError")),
    ("Functions for problems", ("rk4", "implicit_euler", "gauss_legendre", "table", "where", "minimum", "maximum", "clip", "hypot", "norm2", "atan2")),
    ("Names", ("tracks", "cars", "presets", "scenarios", "parameters", "faults", "frame_fields")),
)
PLAIN = {"Symbol", "NO_ANSWER", "acos", "asin", "atan", "cos", "exp", "log", "sin", "sqrt", "tan", "tanh"}
"""Of numpy, or said elsewhere."""


def stubs() -> dict[str, ast.ClassDef]:
    """Classes of the compiled part, whose docstrings are in its stubs."""
    tree = ast.parse((ROOT / "python/chicane/_chicane.pyi").read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


def signature(function: object) -> str:
    """Without annotations."""
    try:
        parameters = inspect.signature(function).parameters.values()  # type: ignore[arg-type]
    except ValueError:
        return "(...)"
    kept = [each.replace(annotation=each.empty) for each in parameters if each.name not in ("self", "cls")]
    return re.sub(r"\s+", " ", str(inspect.Signature(kept)))


def block(text: str) -> str:
    """A docstring: examples, which are indented, as code; words as they are."""
    lines, is_code = [], False
    for line in inspect.cleandoc(text).split("\n"):
        deep = line.startswith("    ") and (is_code or not lines or not lines[-1].strip())
        if deep and not is_code:
            lines.append("```python")
        if is_code and not deep and line.strip():
            lines.append("```\n")
            deep = False
            is_code = False
        is_code = is_code or deep
        lines.append(line[4:] if is_code else re.sub(r"^([a-z][\w, ]{0,60}: )", r"- \1", line))
    if is_code:
        lines.append("```")
    return "\n".join(line.rstrip() if line.strip() else "" for line in "\n".join(lines).split("\n"))


def members(one: type) -> list[str]:
    """Public functions and properties of a class, written in it."""
    text = []
    for name, member in vars(one).items():
        doc = inspect.getdoc(member)
        if name.startswith("_") or not doc:
            continue
        if isinstance(member, property):
            text.append(f"**`{name}`** {block(doc)}")
        elif callable(member):
            text.append(f"**`{name}{signature(member)}`**\n\n{block(doc)}")
    return text


def entry(name: str, compiled: dict[str, ast.ClassDef]) -> list[str]:
    one = getattr(ch, name)
    if name in compiled:
        node = compiled[name]
        text = [f"### {name}", block(ast.get_docstring(node) or "")]
        rows = [f"| `{member.name}` | {' '.join((ast.get_docstring(member) or '').split())} |" for member in node.body
                if isinstance(member, ast.FunctionDef) and ast.get_docstring(member)]
        return text + (["| | |\n|---|---|\n" + "\n".join(rows)] if rows else [])
    doc = block(inspect.getdoc(one) or "")
    if not isinstance(one, type):
        return [f"### `{name}{signature(one)}`", doc]
    return [f"### {name}", f"`{name}{signature(one.__init__)}`" if "__init__" in vars(one) and name in ("Problem", "Env", "VecEnv", "Track") else "", doc,
            *members(one)]


def page() -> str:
    compiled = stubs()
    missing = set(ch.__all__) - PLAIN - {"__version__"} - {name for _, names in PARTS for name in names}
    if missing:
        sys.exit(f"python_reference: in no part of the page: {', '.join(sorted(missing))}")
    text = ["# Reference of the Python module", "Made from the docstrings by `./run.sh python tools/python_reference.py`. How to begin: "
            "[python.md](../python.md), [python_problems.md](../python_problems.md).", block((ch.__doc__ or "").split("\n\n", 2)[2])]
    for title, names in PARTS:
        text.append(f"## {title}")
        for name in names:
            text += entry(name, compiled)
    return "\n\n".join(part.strip() for part in text if part.strip()) + "\n"


def main() -> int:
    text = page()
    if "--check" not in sys.argv:
        PAGE.write_text(text, encoding="utf-8")
        return 0
    is_same = PAGE.is_file() and PAGE.read_text(encoding="utf-8") == text
    if not is_same:
        print(f"{PAGE}: is not what the docstrings say: ./run.sh python tools/python_reference.py")
    return 0 if is_same else 1


if __name__ == "__main__":
    sys.exit(main())
