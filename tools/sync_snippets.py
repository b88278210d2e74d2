#!/usr/bin/env python3
"""Cuts marked blocks out of compiled files into README.md and docs/, so that what is printed there compiles.

    tools/sync_snippets.py          writes the blocks
    tools/sync_snippets.py --check  only compares; exit code 1 and the names when a page is behind

In the source: `// [name]` and `// [/name]` (or `#`) around the lines. In the page, a comment and the block that follows it:

    <!-- snippet: examples/01_drive_a_lap.cpp name -->
"""
import re
import sys
import textwrap
from pathlib import Path

import usage

SNIPPET = re.compile(r"(?P<marker><!-- snippet: (?P<file>\S+)(?: (?P<name>\w+))? -->\n)```(?P<language>\w*)\n(?P<body>.*?)```",
                     re.DOTALL)


def cut(root, file, name):
    """The marked lines of a file without their common indentation; the whole file without a name."""
    text = (root / file).read_text(encoding="utf-8")
    if not name:
        return text
    block = re.search(rf"^[ \t]*(?://|#) \[{name}\]\n(.*?)^[ \t]*(?://|#) \[/{name}\]", text, re.DOTALL | re.MULTILINE)
    if not block:
        raise SystemExit(f"{file}:1: no block // [{name}] ... // [/{name}]")
    return textwrap.dedent(block[1])


def synced(root, text):
    def replace(match):
        return f"{match['marker']}```{match['language']}\n{cut(root, match['file'], match['name'])}```"
    return SNIPPET.sub(replace, text)


def main():
    usage.print_if_asked(__doc__)
    root = Path(__file__).resolve().parent.parent
    behind = []
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        new = synced(root, text)
        if new != text:
            behind.append(page)
            if "--check" not in sys.argv:
                page.write_text(new, encoding="utf-8")
    for page in behind:
        print(f"{page.relative_to(root)}: {'differs from its sources: run tools/sync_snippets.py' if '--check' in sys.argv else 'written'}")
    return 1 if behind and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
