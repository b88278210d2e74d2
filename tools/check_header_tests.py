#!/usr/bin/env python3
"""Checks that each public header src/chicane/MODULE/NAME.hpp (not those in detail/) with a function is tested: that a test in tests/, itself
or through headers of ours, includes it and says a name that it declares. Headers in tools/header_tests.txt have none, with the reason;
lines of that list that are not needed any more are violations, too.

    tools/check_header_tests.py [ROOT]      prints file:line: what is wrong; exit code 1 when anything is
"""
import re
import sys
from pathlib import Path

import usage

LIST = "tools/header_tests.txt"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
ENTRY = re.compile(r"(?P<header>\w+/\w+\.hpp): (?P<reason>\S.+)")
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


class Tests:
    """The tests of a tree: the files that each includes, itself or through headers of ours, and its words."""

    def __init__(self, root):
        self.root = root
        self.direct = {}
        self.tests = []
        for test in sorted(root.glob("tests/*/*_test.cpp")):
            self.tests.append((self.reached(test), set(re.findall(r"\w+", code_of(test)))))

    def includes(self, source):
        if source not in self.direct:
            places = (self.root / "src", self.root / "tests", source.parent)
            paths = INCLUDE.findall(code_of(source))
            self.direct[source] = [place / path for path in paths for place in places if (place / path).exists()]
        return self.direct[source]

    def reached(self, source):
        found, left = set(), [source]
        while left:
            new = [path for path in self.includes(left.pop()) if path not in found]
            found.update(new)
            left.extend(new)
        return found

    def test(self, header):
        """Whether a test uses a name that `header` declares."""
        names = declared_names(header)
        return any(header in reached and words & names for reached, words in self.tests)


def check(root):
    modules = root / "src/chicane"
    tests = Tests(root)
    list_file = root / LIST
    listed = {}
    for number, line in enumerate(list_file.read_text(encoding="utf-8").splitlines() if list_file.exists() else (), 1):
        text = line.split("#")[0].strip()
        if not text:
            continue
        entry = ENTRY.fullmatch(text)
        if not entry:
            yield f"{LIST}:{number}: expected 'MODULE/NAME.hpp: REASON'"
            continue
        if entry["header"] in listed:
            yield f"{LIST}:{number}: {entry['header']} is listed twice"
        listed[entry["header"]] = number
        if not (modules / entry["header"]).exists():
            yield f"{LIST}:{number}: {entry['header']} is gone: remove the line"
    for header in sorted(modules.glob("*/*.hpp")):
        name = header.relative_to(modules).as_posix()
        is_tested = tests.test(header) or not has_functions(header)
        if name in listed and is_tested:
            yield f"{LIST}:{listed[name]}: {name} needs no reason: remove the line"
        if name not in listed and not is_tested:
            yield f"{header.relative_to(root)}:1: no test in tests/ uses it: add one, or a line with the reason to {LIST}"


def main():
    usage.print_if_asked(__doc__)
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    violations = list(check(root))
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of the rule for header tests")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
