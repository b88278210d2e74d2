#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that pages can be read: no line of text beyond 120 columns.

    tools/check_pages.py             prints file:line: what is too long; exit code 1 when anything is
    tools/check_pages.py --lengths   also the words of a sentence of each page: the mean and the most

Code, tables, formulas, pictures and what a program writes between two markers may be wider."""
import re
import sys
from pathlib import Path

import usage

COLUMNS = 120
# Pages of tables that a program writes whole.
WRITTEN = {"configuration.md", "league_tables.md", "python_reference.md", "stability_cars.md"}
BEGIN, END = re.compile(r"<!-- (?:figures|sweep|league)"), re.compile(r"<!-- (?:/figures|end of)")


def text_lines(page):
    """Number and content of the lines that somebody wrote as text; None in the place of anything else."""
    is_code = is_written = is_formula = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        is_written = (is_written or bool(BEGIN.match(line))) and not END.match(line)
        if line.startswith("```"):
            is_code = not is_code
        was_formula = is_formula
        if line.startswith("$$") or is_formula:
            is_formula = not (line.rstrip().endswith("$$") and (is_formula or len(line.strip()) > 2))
        is_other = is_code or is_written or was_formula or line.startswith(("```", "$$", "|", "    ", "#", "<", "!["))
        yield number, None if is_other else line


def sentences(page):
    """The number of words of each sentence."""
    text = "\n".join(line or "" for _, line in text_lines(page))
    text = re.sub(r"^\s*(?:[-*]|\d+\.)\s+", "\n", text, flags=re.MULTILINE)
    for pattern, by in ((r"\$[^$]*\$", "X"), (r"`[^`]*`", "X"), (r"\[([^\]]*)\]\([^)]*\)", r"\1"), (r"\beq\.", "eq")):
        text = re.sub(pattern, by, text)
    for paragraph in re.split(r"\n\s*\n", text):
        for sentence in re.split(r"(?<=[.!?])[*)]*\s+(?=[A-Z(\"*])", " ".join(paragraph.split())):
            words = re.findall(r"[A-Za-z0-9][\w'/%.-]*", sentence)
            if len(words) > 2:
                yield len(words)


def violations(root, page):
    where = page.relative_to(root)
    for number, line in text_lines(page):
        if line is not None and len(line) > COLUMNS and page.name not in WRITTEN:
            yield f"{where}:{number}: got {len(line)} columns, expected at most {COLUMNS}"


def main():
    usage.print_if_asked(__doc__)
    root = Path(__file__).resolve().parent.parent
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    if "--lengths" in sys.argv[1:]:
        for page in pages:
            counts = list(sentences(page)) or [0]
            print(f"{sum(counts) / len(counts):5.1f} {max(counts):4} {page.relative_to(root)}")
    found = [each for page in pages for each in violations(root, page)]
    print("\n".join([*found, f"{len(found)} places too long"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
