#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that pages can be read: no line of text beyond 120 columns, each formula a paragraph, README and guides without riddle words.

    tools/check_pages.py [ROOT]      prints what is too long or not rendered, and the words of each group of pages; exit code 1 on a violation
    tools/check_pages.py --lengths   also, for each page, words, words of a sentence (mean and most), riddle words and you/we per 1,000 words

Code, tables, formulas, pictures and what a program writes between two markers may be wider. Riddle words stand for an agent or a noun that
the sentence should name; README and the guides (the pages that docs/index.md lists under Start and Guides) have at most 2 per 1,000 words,
other pages, and the comments and texts of src and apps, at most 4."""
import re
import sys
from pathlib import Path

import usage

COLUMNS = 120
# Pages of tables that a program writes whole.
WRITTEN = {"configuration.md", "league_tables.md", "python_reference.md"}
RIDDLES = re.compile(r"\b(?:told|those of|that of|what is|beside|anew|in the place of)\b", re.IGNORECASE)
READER = re.compile(r"\b(?:you|your|yours|yourself|we)\b", re.IGNORECASE)
MOST_RIDDLES, MOST_ELSEWHERE = {"README": 2.0, "guides": 2.0}, 4.0  # per 1,000 words
GUIDES = re.compile(r"^## (?:Start|Guides)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
WORD = re.compile(r"[A-Za-z0-9][\w'/%.-]*")
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


def prose(page):
    """Text and hand-written tables of a page, without code, formulas and targets of links; comments and texts of a program."""
    if page.suffix != ".md":
        return "\n".join(re.findall(r'//.*|"(?:[^"\\]|\\.)*"', page.read_text(encoding="utf-8")))
    lines = page.read_text(encoding="utf-8").splitlines()
    text = "\n".join(line if kept is not None or line.startswith("|") else "" for (_, kept), line in zip(text_lines(page), lines))
    return re.sub(r"`[^`]*`|\$[^$]*\$", "X", re.sub(r"\]\([^)]*\)", "]", text))


def sentences(page):
    """The number of words of each sentence, list item and row of a table."""
    parts = re.split(r"\n\s*\n|\n\s*(?:[-*|]|\d+\.)|(?<=[.!?])[*)]*\s+(?=[A-Z(\"*])", prose(page))
    return [count for count in (len(WORD.findall(part)) for part in parts) if count > 2] or [0]


def counts_of(pages):
    """Words, and riddle words and you/we per 1,000 of them; pictures."""
    text = "\n".join(map(prose, pages))
    words = max(len(WORD.findall(text)), 1)
    pictures = sum(page.read_text(encoding="utf-8").count("\n![") for page in pages)
    return words, *(1000 * len(each.findall(text)) / words for each in (RIDDLES, READER)), pictures


def groups_of(root, pages):
    """README, guides, other pages that somebody wrote, and the folders of reference, measurements and decisions."""
    guides = {"index.md", *re.findall(r"\]\((\w+\.md)", "\n".join(GUIDES.findall((root / "docs/index.md").read_text(encoding="utf-8"))))}
    groups = {"README": [], "guides": [], "other pages": [], "reference": [], "measured": [], "decisions": []}
    for page in pages:
        kind = "guides" if page.name in guides else "other pages"
        groups[{"docs": kind, root.name: "README"}.get(page.parent.name, page.parent.name)].append(page)
    return groups | {"all": pages, "comments and texts": [each for folder in ("src", "apps") for each in (root / folder).rglob("*.[ch]pp")]}


def main():
    usage.print_if_asked(__doc__)
    root = Path(next((word for word in sys.argv[1:] if not word.startswith("-")), Path(__file__).parents[1])).resolve()
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    if "--lengths" in sys.argv[1:]:
        print("words, of a sentence: mean, most; riddle words and you/we per 1,000 words")
        for page in pages:
            counts = sentences(page)
            words, riddles, reader, _ = counts_of([page])
            print(f"{words:6} {sum(counts) / len(counts):5.1f} {max(counts):4} {riddles:5.1f} {reader:5.1f} {page.relative_to(root)}")
    found = [f"{page.relative_to(root)}:{number}: got {len(line)} columns, expected at most {COLUMNS}" for page in pages
             if page.name not in WRITTEN for number, line in text_lines(page) if line is not None and len(line) > COLUMNS]
    found += [f"{page.relative_to(root)}: got two formulas in one paragraph, expected an empty line between them: the site renders neither"
              for page in pages if re.search(r"\$\$[ \t]*\n\$\$", page.read_text(encoding="utf-8"))]
    print("\n".join([*found, f"{len(found)} violations"]))
    print(f"{'':20} pages  words  riddle words  you/we (per 1,000 words)  pictures")
    for name, group in groups_of(root, pages).items():
        words, riddles, reader, pictures = counts_of(group)
        print(f"{name:20} {len(group):5} {words:6} {riddles:13.1f} {reader:7.1f} {pictures:26}")
        if riddles > MOST_RIDDLES.get(name, MOST_ELSEWHERE):
            found.append(name)
            print(f"{name}: got {riddles:.1f} riddle words per 1,000 words, expected at most {MOST_RIDDLES.get(name, MOST_ELSEWHERE)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
