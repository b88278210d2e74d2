#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts lines of C++ in src and apps, blank lines and comments apart.

    tools/code_lines.py [ROOT]              one line: src, apps, and both
    tools/code_lines.py --modules [ROOT]    a line for each module, the longest first
"""
import re
import sys
from pathlib import Path

import usage

# A literal is kept, a comment goes: "//" in a text is none.
TOKEN = re.compile(r'R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|(?P<comment>//[^\n]*|/\*.*?\*/)', re.DOTALL)


def code_lines(text):
    """Lines of `text` with something on them beside comments."""
    def without(match):
        if match["comment"] is None:
            return match[0]
        return "\n" * match[0].count("\n")
    # The ' of 1'000 begins no character.
    text = re.sub(r"(?<=\d)'(?=\d)", "", text)
    return sum(1 for line in TOKEN.sub(without, text).splitlines() if line.strip())


def modules(root):
    """Lines by folder: "src/live", "apps/page"."""
    found = {}
    for base in ("src/chicane", "apps"):
        for file in sorted((root / base).rglob("*")):
            if file.suffix in (".cpp", ".hpp", ".h", ".c"):
                place = file.relative_to(root / base).parts[0]
                name = f"{base.split('/', maxsplit=1)[0]}/{place}"
                found[name] = found.get(name, 0) + code_lines(file.read_text(encoding="utf-8"))
    return found


def main():
    usage.print_if_asked(__doc__)
    arguments = [each for each in sys.argv[1:] if each != "--modules"]
    counts = modules(Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent)
    if "--modules" in sys.argv:
        for name, lines in sorted(counts.items(), key=lambda each: -each[1]):
            print(f"{lines:6} {name}")
        return 0
    apps = sum(lines for name, lines in counts.items() if name.startswith("apps/"))
    total = sum(counts.values())
    print(f"lines of code: {total} (src {total - apps}, apps {apps}), blank lines and comments apart")
    return 0


if __name__ == "__main__":
    sys.exit(main())
