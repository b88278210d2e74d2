#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that object files define no code without a tag in its name.

    tools/check_symbols.py arch::Avx2 build/.../fast_solver.cpp.o

The linker keeps one of several weak definitions of the same name. If one of them were compiled for a newer processor,
it could end up in code that runs on older ones. So every function that such an object defines must carry its tag.
Tables of constants are data: the same whoever made them.
"""
import subprocess
import sys

import usage


def foreign_symbols(tag, path):
    listing = subprocess.run(["nm", "-C", "--defined-only", path], check=True, capture_output=True, text=True).stdout
    for line in listing.splitlines():
        _, kind, name = line.split(maxsplit=2)
        if kind in "TWi" and tag not in name:
            yield name


def main():
    usage.print_if_asked(__doc__)
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    tag, paths = sys.argv[1], sys.argv[2:]
    found = [f"{path}: {name}: no {tag} in its name" for path in paths for name in foreign_symbols(tag, path)]
    print("\n".join(found))
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
