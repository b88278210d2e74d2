#!/usr/bin/env python3
"""Checks the arrows between modules, and between the folders above them, against tools/layers.txt: every #include, every
file and target of another folder that a CMakeLists.txt compiles or links.

    tools/check_layers.py [ROOT]        prints file:line: what is wrong; exit code 1 when anything is
"""
import re
import sys
from pathlib import Path

import usage

INCLUDE = re.compile(r'^\s*#\s*include\s*"(?P<path>[^"]+)"')
CALL = re.compile(r"(?P<command>\w+)\s*\((?P<arguments>[^()]*(?:\([^()]*\)[^()]*)*)\)")
# Folders above the library, and where their quoted includes start.
ABOVE = {"apps": "apps/chicane", "python": "python/src", "bench": "bench", "tests": "tests", "studies": "studies", "examples": "examples"}
USERS = {"apps", "examples"}  # written as a user of the library would
DEFINES = {"add_library", "add_executable"}
# Commands through which one target gets code of another.
USES = {"target_link_libraries", "target_sources", "target_include_directories", "chicane_simd_sources", "chicane_test"}
GENERATED = {"bench_commit.hpp", "car.h"}


def read_table(path):
    """{module: set of what it may include}"""
    table = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        line = line.split("#")[0]
        if ":" in line:
            module, allowed = line.split(":")
            table[module.strip()] = set(allowed.split())
    return table


def check_acyclic(table):
    """The table itself has to be layers: a module may only allow modules named above it."""
    seen = set()
    for module, allowed in table.items():
        for name in allowed:
            if name not in seen:
                yield f"tools/layers.txt:1: {module}: {name} has to be listed above it"
        seen.add(module)


def calls(cmake_file):
    """(line, command, words) of each call in a CMakeLists.txt."""
    text = re.sub(r"#.*", "", cmake_file.read_text(encoding="utf-8"))
    for call in CALL.finditer(text):
        yield text.count("\n", 0, call.start()) + 1, call["command"], call["arguments"].split()


def includes(folder):
    """(file, line, included path) of each #include "..." below a folder."""
    for source in sorted(p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp")):
        for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
            include = INCLUDE.match(line)
            if include and include["path"] != "chicane/version.hpp":  # of the whole library
                yield source, number, include["path"]


def library_header(path):
    """("module", "module/file.hpp") of "chicane/module/file.hpp", else nothing."""
    if path == "chicane/solver.h":  # in C, with a short name for those who only have a C compiler
        return "solver", "solver/c_interface.hpp"
    parts = path.split("/")
    return (parts[1], "/".join(parts[1:])) if parts[0] == "chicane" and len(parts) > 2 else None


def check_module(root, folder, table):
    """Violations in one folder of src/chicane: includes that climb, links that climb, includes that are not linked."""
    module = folder.name
    if module not in table:
        yield f"{folder.relative_to(root)}:1: module {module} is not in tools/layers.txt"
        return
    allowed = table[module]
    for source, number, path in includes(folder):
        where = f"{source.relative_to(root)}:{number}"
        if not (included := library_header(path)):
            if not (source.parent / path).exists():
                yield f'{where}: got "{path}", expected "chicane/module/file.hpp"'
            continue
        target, header = included
        if target == module:
            continue
        if target not in allowed:
            yield f"{where}: {module} must not include {header}"
        elif header.startswith(f"{target}/detail/"):
            yield f"{where}: {module} must not include {header}: it is an implementation detail of {target}"


def check_includes_above(root, name, table):
    """Violations in the includes of one folder above the library."""
    for source, number, path in includes(root / name):
        where = f"{source.relative_to(root)}:{number}"
        if included := library_header(path):
            if included[0] not in table[name]:
                yield f"{where}: {name} must not include {included[1]}"
            elif name in USERS and included[1].startswith(f"{included[0]}/detail/"):
                yield f"{where}: {name} must not include {included[1]}: it is an implementation detail of {included[0]}"
        elif not (source.parent / path).exists() and not (root / ABOVE[name] / path).exists():
            owners = [other for other, start in ABOVE.items() if (root / start / path).exists()]
            if not owners and path not in GENERATED:
                yield f'{where}: got "{path}", expected a header of {name} or "chicane/module/file.hpp"'
            if owners and not table[name].intersection(owners):
                yield f"{where}: {name} must not include {path} of {owners[0]}"


def targets_above(root):
    """{target: the folder above the library that defines it}"""
    targets = {}
    for name in ABOVE:
        for cmake_file in (root / name).rglob("CMakeLists.txt"):
            for _, command, words in calls(cmake_file):
                if command in DEFINES and words:
                    targets[words[0]] = name
    return targets


def check_cmake_above(root, name, table, targets):
    """Violations in what one folder above the library compiles and links."""
    for cmake_file in sorted((root / name).rglob("CMakeLists.txt")):
        for line, command, words in calls(cmake_file):
            for word in words if command in USES | DEFINES else ():
                path = re.match(r"\$\{PROJECT_SOURCE_DIR\}/(\w+)", word)
                owner = path[1] if path else targets.get(word, targets.get("chicane_" + word))
                if owner in ABOVE and owner != name and owner not in table[name]:
                    yield f"{cmake_file.relative_to(root)}:{line}: {name} must not use {word} of {owner}"


def check(root):
    table = read_table(root / "tools/layers.txt")
    yield from check_acyclic(table)
    for folder in sorted(p for p in (root / "src/chicane").iterdir() if p.is_dir()):
        yield from check_module(root, folder, table)
    targets = targets_above(root)
    for name in ABOVE:
        yield from check_includes_above(root, name, table)
        yield from check_cmake_above(root, name, table, targets)


def main():
    usage.print_if_asked(__doc__)
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    violations = list(check(root))
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of tools/layers.txt")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
