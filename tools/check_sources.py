#!/usr/bin/env python3
"""Checks rules that the compiler does not check, line by line: which module may do what, how files begin, which names are refused.

    tools/check_sources.py [ROOT]   prints file:line: what is wrong; exit code 1 when anything is
"""
import os
import re
import sys
from pathlib import Path
from typing import NamedTuple

import usage

ELEMENTARY = r"(?:sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot)"


class Rule(NamedTuple):
    pattern: str
    where: tuple  # folders or files of src/chicane the rule holds in; "" is all of them
    except_in: tuple
    reason: str


RULES = (
    Rule(rf"\bstd::{ELEMENTARY}\s*\(|(?<![\w>])::{ELEMENTARY}\s*\(", ("",), ("base",),
         "bits differ between machines: use chicane::sin, cos, ... of base/math.hpp"),
    Rule(r"\bstd::\w+_distribution\b|\bstd::(mt19937\w*|default_random_engine|random_device)\b|(?<!\w)s?rand\(", ("",), ("net",),
         "not the same on every machine: use base/random.hpp"),
    # Nothing else ends yaml-cpp from within an event; caught in the same file.
    Rule(r"\bthrow\b", ("",), ("protocol/yaml_tree.cpp",), "the library throws nothing: return Result, or a status in the loop"),
    Rule(r"\bstd::(cout|cerr|clog)\b|(?<![\w])f?(printf|puts)\s*\(|\bfmt::print\b", ("",), ("base/compiler.hpp", "live", "recording", "run", "wire"),
         "only live, wire and apps print"),
    Rule(r"\b\w*(clock|Clock)::now\(", ("",), ("base/deadline.hpp", "net", "live", "recording", "ros", "run", "wire"), "time comes in as a Deadline or a number"),
    Rule(r"\bstd::(thread|jthread|mutex|shared_mutex|recursive_mutex|atomic\w*|condition_variable\w*|async)\b", ("",),
         ("base/latest.hpp", "base/instruction_set.cpp", "net", "live", "recording", "ros", "run", "sweep", "wire"), "threads and locks live in net, run, sweep, recording, wire, live and ros"),
    Rule(r"\bboost::(asio|beast)\b", ("",), ("net",), "sockets live in net"),
    Rule(r"(?<![a-z])(car|cars|steer|steering|vehicle|wheel|tire|tyre|road)(?![a-z])", ("solver",), (),
         "solver knows no car"),
    Rule(r"\bMatrixXd\b|\bVectorXd\b|\bEigen::Dynamic\b", ("base", "model", "solver", "controller", "safety", "sim"), (),
         "fixed sizes only: dynamic ones allocate in the loop"),
    Rule(r"\b(static|thread_local)\s+(?!const\b|constexpr\b)[\w:<>,*& ]+?\w+\s*(\{|=|;)", ("",),
         ("base/instruction_set.cpp", "recording/replay.cpp", "protocol/schema.cpp"),
         "objects share nothing (docs/library.md): no variable that outlives a call"),
    Rule(r"\bconst_cast\b|\breinterpret_cast\b", ("",), ("net", "protocol"), "bytes are handled in net and protocol"),
)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
PUBLIC_THIRD_PARTY = re.compile(r"tl/expected\.hpp")
KINDS = {"C++": (".hpp", ".cpp"), "YAML": (".yaml",), "Python": (".py", ".pyi"), "TypeScript": (".ts", ".tsx"), "docs": (".md",),
         "program text": ()}  # all text of src and apps, comments and strings included
HASHED = (".yaml", ".py", ".pyi")  # comments begin with #


def without_comments(text):
    """The text with comments and string literals blanked, line by line as before."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', blank, text, flags=re.DOTALL)


def applies(rule, path):
    inside = lambda name: name == "" or path == name or path.startswith(name + "/")
    return any(map(inside, rule.where)) and not any(map(inside, rule.except_in))


def check_library_file(root, source):
    """Rules for one file of src/chicane."""
    path = source.relative_to(root / "src/chicane").as_posix()
    text = source.read_text(encoding="utf-8")
    code = without_comments(text)
    for rule in RULES:
        if not applies(rule, path):
            continue
        for match in re.finditer(rule.pattern, code):
            line = code.count("\n", 0, match.start()) + 1
            yield f"src/chicane/{path}:{line}: got {match[0].strip()}: {rule.reason}"
    includes = [(n, m[1]) for n, line in enumerate(text.splitlines(), 1) if (m := INCLUDE.match(line))]
    if source.suffix == ".hpp":
        for number, name in includes:
            is_standard = "." not in name and "/" not in name
            if path == "base/detail/instructions.hpp" and name in ("immintrin.h", "emmintrin.h", "arm_neon.h"):
                continue  # the processor's own
            if (path, name) in {("protocol/json.hpp", "nlohmann/json.hpp"), ("protocol/detail/foreign_roads.hpp", "pugixml.hpp")}:
                continue  # of our own sources only: not installed
            if not is_standard and not name.startswith("chicane/") and not PUBLIC_THIRD_PARTY.fullmatch(name):
                yield f"src/chicane/{path}:{number}: got <{name}>: headers show tl/expected.hpp only"
        if "#pragma once" not in text:
            yield f"src/chicane/{path}:1: expected #pragma once"
    elif source.with_suffix(".hpp").exists() and includes[:1] != includes[:0]:
        own = "chicane/" + str(Path(path).with_suffix(".hpp").as_posix())
        if includes[0][1] != own:
            yield f"src/chicane/{path}:{includes[0][0]}: got {includes[0][1]} first, expected its own header {own}"


def sources(root):
    for folder in ("src", "apps", "python", "tests", "examples", "bench"):
        yield from sorted(p for p in (root / folder).rglob("*") if p.suffix in (".hpp", ".cpp"))


def web_sources(root):
    for top in ("web", "tests"):
        for folder, inner, names in os.walk(root / top):
            inner[:] = sorted(set(inner) - {"node_modules", "dist"})
            yield from (Path(folder) / name for name in sorted(names) if name.endswith((".ts", ".tsx", ".mjs", ".css", ".html")))


def check_web_file(path, lines):
    """What the formatter does not break: comments and strings."""
    for number, line in enumerate(lines, 1):
        if len(line) > 120:
            yield f"{path}:{number}: got {len(line)} characters, expected at most 120"


def is_program(path):
    return path.parts[0] in ("src", "apps") and path.suffix in KINDS["C++"]


def check_names(root):
    """Names that the last table of docs/notation.md refuses, in code, and words in all text of src and apps."""
    law = root / "docs/notation.md"
    rows = re.findall(r"^\| `(\w+)` \| (.+) \| ([^|]+) \|$", law.read_text(encoding="utf-8"), re.MULTILINE) if law.exists() else []
    for folder, inner, names in os.walk(root):
        inner[:] = sorted(set(inner) - {"build", "corpus", "decisions", "dist", "node_modules", ".git"})
        for path in (Path(folder) / name for name in sorted(names) if name not in ("notation.md", "CHANGELOG.md")):
            refused = {old: new for old, new, kinds in rows if any(path.suffix in KINDS[kind] for kind in kinds.split(", "))}
            words = {old: new for old, new, kinds in rows if "program text" in kinds and is_program(path.relative_to(root))}
            text = path.read_text(encoding="utf-8", errors="replace") if refused or words else ""
            code = text if path.suffix == ".md" else re.sub("#.*", lambda match: " " * len(match[0]), text) if path.suffix in HASHED else without_comments(text)
            found = {(match.start(), match[0]): names[match[0].lower() if names is words else match[0]]
                     for names, where, flags in ((refused, code, 0), (words, text, re.IGNORECASE)) if names
                     for match in re.finditer(rf"\b(?:{'|'.join(names)})\b", where, flags)}
            for (start, old), new in sorted(found.items()):
                yield f"{path.relative_to(root)}:{text.count(chr(10), 0, start) + 1}: got {old}, expected {new} (docs/notation.md)"


def check(root):
    for source in sources(root):
        path = source.relative_to(root)
        lines = source.read_text(encoding="utf-8").splitlines()
        if not lines or lines[0] != "// SPDX-License-Identifier: MIT":
            yield f"{path}:1: expected // SPDX-License-Identifier: MIT"
        if len(lines) > 500:
            yield f"{path}:1: got {len(lines)} lines, expected at most 500: it is two files"
        if path.parts[0] == "src":
            yield from check_library_file(root, source)
    yield from check_names(root)
    for source in web_sources(root):
        yield from check_web_file(source.relative_to(root), source.read_text(encoding="utf-8").splitlines())


def main():
    usage.print_if_asked(__doc__)
    root = Path(sys.argv[1] if sys.argv[1:] else Path(__file__).parent.parent).resolve()
    violations = list(check(root))
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of tools/check_sources.py")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
