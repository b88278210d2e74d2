#!/usr/bin/env python3
"""Checks the arrows between modules: every #include and every DEPENDS in a CMakeLists.txt against tools/layers.txt.

    tools/check_layers.py [ROOT]        prints file:line: what is wrong; exit code 1 when anything is
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"(?P<path>[^"]+)"')
MODULE_CALL = re.compile(r"chicane_module\((?P<name>\w+)(?P<arguments>[^)]*)\)", re.DOTALL)
KEYWORDS = {"HEADERS", "SOURCES", "DEPENDS", "PRIVATE"}


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
            if name.split("/")[0] not in seen:
                yield f"tools/layers.txt:1: {module}: {name} has to be listed above it"
        seen.add(module)


def depends_of(cmake_file):
    """The DEPENDS of the chicane_module() call in a CMakeLists.txt."""
    call = MODULE_CALL.search(re.sub(r"#.*", "", cmake_file.read_text(encoding="utf-8")))
    keyword, depends = None, set()
    for word in call["arguments"].split() if call else []:
        keyword = word if word in KEYWORDS else keyword
        if keyword == "DEPENDS" and word != keyword:
            depends.add(word)
    return depends


def check_folder(root, folder, module, table):
    """Violations in one folder: includes that climb, links that climb, includes that are not linked."""
    if module not in table:
        yield f"{folder.relative_to(root)}:1: module {module} is not in tools/layers.txt"
        return
    allowed = table[module]
    cmake_file = folder / "CMakeLists.txt"
    linked = depends_of(cmake_file) if cmake_file.exists() and module != "apps" else None
    for name in sorted(linked or ()):
        if not any(entry.split("/")[0] == name for entry in allowed):
            yield f"{cmake_file.relative_to(root)}:1: {module} must not link {name}"
    for source in sorted(p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp")):
        for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            where = f"{source.relative_to(root)}:{number}"
            parts = include["path"].split("/")
            if parts[0] != "chicane" or len(parts) < 3:
                if module != "apps" and not (source.parent / include["path"]).exists():
                    yield f'{where}: got "{include["path"]}", expected "chicane/module/file.hpp"'
                continue
            target, header = parts[1], "/".join(parts[1:])
            if target == module:
                continue
            if target not in allowed and header not in allowed:
                yield f"{where}: {module} must not include {header}"
            elif parts[2] == "detail":
                yield f"{where}: {module} must not include {header}: it is an implementation detail of {target}"
            elif linked is not None and target not in linked:
                yield f"{where}: {module} includes {header} but does not list {target} in DEPENDS"


def check(root):
    table = read_table(root / "tools/layers.txt")
    yield from check_acyclic(table)
    for folder in sorted(p for p in (root / "src/chicane").iterdir() if p.is_dir()):
        yield from check_folder(root, folder, folder.name, table)
    for folder in sorted(p for p in (root / "apps").glob("*") if p.is_dir()):
        yield from check_folder(root, folder, "apps", table)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    violations = list(check(root))
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of tools/layers.txt")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
