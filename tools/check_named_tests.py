#!/usr/bin/env python3
"""Checks that each `ctest … -R PATTERN` in the pages and claims names a test that is there.

    tools/check_named_tests.py BUILD        prints file:line: what names none; exit code 1 when anything does
"""
import re
import subprocess
import sys
from pathlib import Path

import usage

COMMAND = re.compile(r"ctest (?:--preset release |--test-dir build/release )?(?:-LE slow )?-R (?:'(?P<quoted>[^']+)'|(?P<plain>[^\s`'\"]+))")


def names(build):
    """Of all tests of a build folder."""
    listed = subprocess.run(["ctest", "--test-dir", build, "-N"], check=True, capture_output=True, text=True).stdout
    return re.findall(r"^ *Test +#\d+: (.+)$", listed, re.MULTILINE)


def main():
    usage.print_if_asked(__doc__)
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = Path(__file__).resolve().parent.parent
    tests = names(sys.argv[1])
    if unbuilt := [test for test in tests if test.endswith("_NOT_BUILT")]:
        sys.exit(f"{len(unbuilt)} test programs are not built, so that their tests are not known: build all first")
    pages = sorted([*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("studies/claims/*.yaml")])
    unknown, commands = 0, 0
    for page in pages:
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            for command in COMMAND.finditer(line):
                commands += 1
                pattern = (command["quoted"] or command["plain"]).replace("\\|", "|")
                if not any(re.search(pattern, test) for test in tests):
                    print(f"{page.relative_to(root)}:{number}: -R {pattern} names no test")
                    unknown += 1
    print(f"{commands} commands, {unknown} of them name no test")
    sys.exit(1 if unknown or not commands else 0)


if __name__ == "__main__":
    main()
