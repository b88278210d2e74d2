#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes docs/reference/python_reference.md from the docstrings of the Python module, in numpydoc's format.

    ./run.sh python tools/python_reference.py           writes the page
    ./run.sh python tools/python_reference.py --check   exit code 1 where it is another one"""
import inspect
import re
import sys
import textwrap
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
INSIDE = {"all_inputs", "all_rows", "close", "cost_offset", "full_count", "full_parameters", "has_expression_cost", "hidden_parameters", "input_bounds",
          "make_interpreter", "stage_parameters"}
"""Members for other modules of the package."""


def signature(function: object) -> str:
    """Without annotations."""
    try:
        parameters = inspect.signature(function).parameters.values()  # type: ignore[arg-type]
    except ValueError:
        return "(...)"
    kept = [each.replace(annotation=each.empty) for each in parameters if each.name not in ("self", "cls")]
    return re.sub(r"\s+", " ", str(inspect.Signature(kept)))


def items(title: str, text: str) -> str:
    """A section of names with types and meanings as a table; an answer without a name, and what is raised, as a sentence."""
    found = [(name, kind, " ".join(meaning.split())) for name, kind, meaning in re.findall(r"^(\S[^:\n]*?)(?: : (.*))?\n((?: +.*\n?)+)", text + "\n", re.M)]
    if title in ("Returns", "Raises"):
        said = [f"{f'`{name}`, {kind}' if kind else name}: {meaning[0].lower()}{meaning[1:].rstrip('.')}" for name, kind, meaning in found]
        return textwrap.fill(f"*{title}* {'; '.join(said)}.", 120, break_long_words=False, break_on_hyphens=False)
    return "||||\n|---|---|---|\n" + "\n".join(f"|`{name}`|{kind}|{meaning}|" for name, kind, meaning in found)


def block(text: str) -> str:
    """A docstring: sections as lists, examples, which are indented, as code, words as they are."""
    words, *sections = re.split(r"\n\n(\w+)\n-+\n", inspect.cleandoc(text))
    lines, is_code = [], False
    for line in words.split("\n"):
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
    lines += [f"\n{items(title, part)}" for title, part in zip(sections[::2], sections[1::2])]
    return "\n".join(line.rstrip() if line.strip() else "" for line in "\n".join(lines).split("\n"))


def members(one: type) -> list[str]:
    """Public functions and properties of a class, written in it."""
    text = []
    for name, member in vars(one).items():
        doc = inspect.getdoc(member)
        if name.startswith("_") or name in INSIDE or not doc:
            continue
        if isinstance(member, property):
            text.append(f"**`{name}`** {block(doc)}")
        elif callable(member):
            text.append(f"**`{name}{signature(member)}`**\n\n{block(doc)}")
    return text


def entry(name: str) -> list[str]:
    one = getattr(ch, name)
    doc = block(inspect.getdoc(one) or "")
    if not isinstance(one, type):
        return [f"### `{name}{signature(one)}`", doc]
    return [f"### {name}", f"`{name}{signature(one.__init__)}`" if "__init__" in vars(one) and name in ("Problem", "Env", "Track") else "", doc,
            *members(one)]


def page() -> str:
    missing = set(ch.__all__) - PLAIN - {"__version__"} - {name for _, names in PARTS for name in names}
    if missing:
        sys.exit(f"python_reference: in no part of the page: {', '.join(sorted(missing))}")
    text = ["# Reference of the Python module", "Made from the docstrings by `./run.sh python tools/python_reference.py`. How to begin: "
            "[python.md](../python.md), [python_problems.md](../python_problems.md).", block((ch.__doc__ or "").split("\n\n", 2)[2])]
    for title, names in PARTS:
        text.append(f"## {title}")
        for name in names:
            text += entry(name)
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
