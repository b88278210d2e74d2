#!/usr/bin/env python3
"""Prints what the last build of each file cost in processor time (user and system), the sum, and the most expensive ones.

    tools/build_times.py [BUILD] [-n COUNT]     BUILD: a folder configured by a preset, default build/release

The times are noted by tools/note_time.sh while ninja runs; ninja's own log has waiting times only, which depend on what else
runs. A file that ccache had costs next to nothing: how many those were is said, and CCACHE_DISABLE=1 does without.
"""
import argparse
import sys
from collections import defaultdict
from pathlib import Path

LOG = ".processor_times"


def read_log(lines):
    """{file: (seconds, is_cached)}, of the last time each file was made."""
    made = {}
    for line in lines:
        words = line.rstrip("\n").split("\t")
        try:
            seconds = sum(map(float, words[0].split()))
            made[words[2]] = (seconds, words[1] == "cached")
        except (ValueError, IndexError):
            continue  # cut short by a full disk or a kill
    return made


def short(file):
    """An object by its folder and source: src/chicane/net/server.cpp."""
    parts = [p for p in file.removesuffix(".o").split("/") if p != "CMakeFiles"]
    parts = [p for p in parts if p != "__"]
    return "/".join(parts)


def report(made, count):
    """Lines of text."""
    total = sum(seconds for seconds, _ in made.values())
    cached = sum(is_cached for _, is_cached in made.values())
    yield f"processor time of the build: {total:.0f} s in {len(made)} steps" + (
        f", {cached} of which came from the compiler's cache" if cached else "")
    folders = defaultdict(float)
    for file, (seconds, _) in made.items():
        folders[file.split("/")[0]] += seconds
    yield "  " + ", ".join(f"{name} {s:.0f} s" for name, s in sorted(folders.items(), key=lambda f: -f[1]) if s >= 0.5)
    compiled = [(seconds, file) for file, (seconds, is_cached) in made.items() if not is_cached]
    for seconds, file in sorted(compiled, reverse=True)[:count]:
        yield f"{seconds:7.1f} s  {short(file)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent / "build/release")
    parser.add_argument("-n", "--count", type=int, default=20, help="how many of the most expensive files, default 20")
    arguments = parser.parse_args()
    log = arguments.build / LOG
    if not log.exists():
        print(f"{log}: not there: nothing was built since the folder was configured by a preset", file=sys.stderr)
        return 2
    made = read_log(log.read_text(encoding="utf-8").splitlines())
    made = {file: cost for file, cost in made.items() if (arguments.build / file).exists()}
    print("\n".join(report(made, arguments.count)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
