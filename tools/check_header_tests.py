#!/usr/bin/env python3
"""Checks that each public header src/chicane/MODULE/NAME.hpp (not those in detail/) has a test tests/MODULE/NAME_test.cpp, or stands in
tools/header_tests.txt with the reason why not. A test counts when it includes the header, itself or through headers of ours, and
says a name that the header declares. Lines of the list that are not needed any more are violations, too.

    tools/check_header_tests.py [ROOT]      prints file:line: what is wrong; exit code 1 when anything is
"""
import re
import sys
from pathlib import Path

import usage

LIST = "tools/header_tests.txt"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
ENTRY = re.compile(r"(?P<header>\w+/\w+\.hpp):\s+(?:tested by (?P<test>[\w/]+\.cpp)|(?P<data>data only)|no test: (?P<reason>\S.+))")
DECLARED = re.compile(r"\b(?:struct|class|enum|using|concept|namespace|define)\s+(?:class\s+)?(\w{3,})|(?<![\w:.>])(\w{3,})\s*\(|\b(k[A-Z]\w+)\b")
NOT_NAMES = {"chicane", "if", "for", "while", "return", "switch", "sizeof", "noexcept", "operator", "static_assert", "decltype", "defined", "constexpr",
             "requires", "explicit", "void", "bool", "auto"}


def code_of(path):
    return COMMENT.sub("", path.read_text(encoding="utf-8"))


def declared_names(header):
    """Types, functions, constants and macros of a header, and some names that it only uses."""
    own_modules = {p.name for p in header.parents[1].iterdir()}
    found = {name for match in DECLARED.finditer(code_of(header)) for name in match.groups() if name}
    return found - NOT_NAMES - own_modules


def has_functions(header):
    """Whether a header declares functions; default values, and comparisons that the compiler writes, are none."""
    code = re.sub(r"operator(?:==|<=>)\([^)]*\)[^;]*= default;", "", code_of(header))
    code = re.sub(r"=\s*\{\}", "", code)
    code = re.sub(r"=[^;{}]*;|\{[^{};]*\}(?=\s*;)", ";", code)
    return re.search(r"\w\s*\([^;{}]*\)[^;{}()]*[;{]", code) is not None


def reaches(root, source, header, seen=None):
    """Whether `source` includes `header`, itself or through other headers of the tree."""
    seen = set() if seen is None else seen
    for path in INCLUDE.findall(code_of(source)):
        for candidate in (root / "src" / path, root / "tests" / path, source.parent / path):
            if candidate == header:
                return True
            if candidate not in seen and candidate.exists():
                seen.add(candidate)
                if reaches(root, candidate, header, seen):
                    return True
    return False


def is_listed(file, keyword):
    """Whether the CMakeLists.txt beside `file` names it, or lists no files after `keyword` itself."""
    cmake_file = file.parent / "CMakeLists.txt"
    text = re.sub(r"#.*", "", cmake_file.read_text(encoding="utf-8")) if cmake_file.exists() else ""
    takes_all = keyword not in text.split() or "GLOB" in text
    return takes_all or re.search(rf"(?<![\w/]){re.escape(file.name)}(?!\w)", text) is not None


def why_no_test(root, test, header):
    """Why `test` is no test of `header`; nothing when it is."""
    if not test.exists():
        return "does not exist"
    if not reaches(root, test, header):
        return "does not include it"
    words = set(re.findall(r"\w+", code_of(test)))
    return None if words & declared_names(header) else "uses no name that it declares"


def check_entry(root, entry, header, named):
    """What is wrong with one line of the list."""
    if not header.exists():
        return "is gone: remove the line"
    if named.exists():
        return f"has {named.relative_to(root)}: remove the line"
    if entry["test"] and (why := why_no_test(root, root / "tests" / entry["test"], header)):
        return f"tests/{entry['test']} {why}"
    if entry["data"] and has_functions(header):
        return "declares functions: it is not data only"
    return None


def check(root):
    modules = root / "src/chicane"
    named_test = lambda header: root / "tests" / header.parent.name / f"{header.stem}_test.cpp"  # noqa: E731
    listed = {}
    list_file = root / LIST
    for number, line in enumerate(list_file.read_text(encoding="utf-8").splitlines() if list_file.exists() else (), 1):
        text = line.split("#")[0].strip()
        if not text:
            continue
        entry = ENTRY.fullmatch(text)
        if not entry:
            yield f"{LIST}:{number}: expected 'MODULE/NAME.hpp: tested by FOLDER/FILE.cpp', ': data only' or ': no test: REASON'"
            continue
        if entry["header"] in listed:
            yield f"{LIST}:{number}: {entry['header']} is listed twice"
        listed[entry["header"]] = number
        header = modules / entry["header"]
        if wrong := check_entry(root, entry, header, named_test(header)):
            yield f"{LIST}:{number}: {entry['header']} {wrong}"
    for header in sorted(modules.glob("*/*.hpp")):
        where = f"{header.relative_to(root)}:1"
        if header.relative_to(modules).as_posix() in listed:
            continue
        test = named_test(header)
        if not test.exists():
            yield f"{where}: got no test, expected {test.relative_to(root)} or a line in {LIST}"
        elif why := why_no_test(root, test, header):
            yield f"{where}: {test.relative_to(root)} {why}"
        elif not is_listed(test, "SOURCES"):
            yield f"{where}: {test.relative_to(root)} is not compiled: add it to {test.parent.relative_to(root)}/CMakeLists.txt"
        if not is_listed(header, "HEADERS"):
            yield f"{where}: is not installed: add it to HEADERS in {header.parent.relative_to(root)}/CMakeLists.txt"


def main():
    usage.print_if_asked(__doc__)
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    violations = list(check(root))
    for violation in violations:
        print(violation)
    print(f"{len(violations)} headers without their test")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
