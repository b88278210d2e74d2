#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts the tree and holds it to tools/budget.txt, whose first lines say what counts.

    tools/code_lines.py [ROOT]            name, budget and count; of modules only those that have more than their budget. Exit code 1
                                          where one has, where a module has no budget, or a budget no module
    tools/code_lines.py --modules [ROOT]  all modules, too
    tools/code_lines.py --lower [ROOT]    lowers each budget to what there is, rounded up to tens; new modules get one
"""
import os
import re
import sys
from pathlib import Path

import usage

# A literal is kept, a comment goes: "//" in a text is none.
TOKEN = re.compile(r'R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|(?P<comment>//[^\n]*|/\*.*?\*/)', re.DOTALL)
DOCSTRING = re.compile(r'^\s*r?"""(?:.*?)"""$', re.DOTALL | re.MULTILINE)
CPP = (".cpp", ".hpp", ".h", ".c")
WEB = (".ts", ".tsx", ".mjs", ".js", ".css", ".html")
NOT_OURS = {".git", ".cache", "__pycache__", "build", "dist", "node_modules"}
ENTRY = re.compile(r"^([^#\s]\S*) +(\d+)$")
RAISED = re.compile(r"# raised: \S+ \d+ -> \d+: \S.*")


def code_lines(text):
    """Lines of `text` with something on them beside comments."""
    def without(match):
        if match["comment"] is None:
            return match[0]
        return "\n" * match[0].count("\n")
    # The ' of 1'000 begins no character.
    text = re.sub(r"(?<=\d)'(?=\d)", "", text)
    return sum(1 for line in TOKEN.sub(without, text).splitlines() if line.strip())


def script_lines(text):
    """The same of Python, shell and CMake. Docstrings are comments."""
    return sum(1 for line in DOCSTRING.sub("", text).splitlines() if line.strip() and not line.lstrip().startswith("#"))


def part_of(path):
    """The part of the tree that a file counts for: "src/live", "tests"; None where it does not count."""
    top, name, kind = path.parts[0], path.name, path.suffix
    if name == "CMakeLists.txt" or kind == ".cmake":
        return "cmake"
    if kind == ".md":
        return "docs" if top in ("docs", "README.md", "CONTRIBUTING.md") else None
    if kind not in (*CPP, *WEB, ".py", ".sh") and (top, name) not in (("tools", "check_figures"), (".ci", "run")):
        return None
    if top == "tests" or path.parts[:2] == ("python", "tests") or ".test." in name:
        return "tests"
    if kind in WEB and top == "apps":
        return "web"
    module = {"src": "/".join(("src", *path.parts[2:3])), "apps": "/".join(path.parts[:2]), "bench": "bench"}
    if top in module:
        return module[top] if kind in CPP else None
    return {"tools": "tools", "studies": "studies", "run.sh": "tools", "test.sh": "tools", ".ci": "tools", "web": "web", "python": "python"}.get(top)


def counts(root):
    """What there is of each part; modules first."""
    modules, parts = {}, dict.fromkeys(("src+apps", "files", "tests", "bench", "tools", "studies", "web", "python", "cmake", "docs"), 0)
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(set(folders) - NOT_OURS)
        for path in (Path(folder, name).relative_to(root) for name in sorted(names)):
            part = part_of(path)
            if part is None:
                continue
            text = (root / path).read_text(encoding="utf-8")
            count = len(text.split()) if part == "docs" else (code_lines if path.suffix in (*CPP, *WEB) else script_lines)(text)
            if part in parts:
                parts[part] += count
                continue
            modules[part] = modules.get(part, 0) + count
            parts["src+apps"] += count
            parts["files"] += path.suffix in (".cpp", ".hpp")
    return modules, parts


def lines_of(budget):
    """What stands before the budgets, the budgets by name, and what stands behind."""
    lines = budget.read_text(encoding="utf-8").splitlines()
    found = {each: match for each in range(len(lines)) if (match := ENTRY.match(lines[each]))}
    return lines[:min(found)], {match[1]: int(match[2]) for match in found.values()}, lines[max(found) + 1:]


def violations(root):
    now = {name: count for part in counts(root) for name, count in part.items()}
    _, budgets, notes = lines_of(root / "tools/budget.txt")
    for name in sorted(now.keys() | budgets.keys()):
        if name not in budgets or name not in now:
            yield f"tools/budget.txt: {name}: " + ("has no budget" if name not in budgets else "is not in the tree: remove its budget")
        elif now[name] > budgets[name]:
            yield f"tools/budget.txt: {name}: got {now[name]}, expected at most {budgets[name]}"
    for note in notes:
        if note.startswith("# raised") and not RAISED.fullmatch(note):
            yield f"tools/budget.txt: got {note}, expected # raised: NAME FROM -> TO: REASON"


def lower(root):
    head, budgets, notes = lines_of(root / "tools/budget.txt")
    rows = [f"{name:20} {min(-(-count // 10) * 10, budgets.get(name, sys.maxsize)):6}" for part in counts(root) for name, count in part.items()]
    (root / "tools/budget.txt").write_text("\n".join([*head, *rows, *notes]) + "\n", encoding="utf-8")


def main():
    usage.print_if_asked(__doc__)
    options = [each for each in sys.argv[1:] if each in ("--modules", "--lower")]
    root = Path(next((each for each in sys.argv[1:] if each not in options), Path(__file__).resolve().parent.parent)).resolve()
    if "--lower" in options:
        lower(root)
    modules, parts = counts(root)
    budgets = lines_of(root / "tools/budget.txt")[1]
    print(f"{'lines of code':20} {'budget':>7} {'now':>7}")
    for name, count in (modules | parts).items():
        budget = budgets.get(name, 0)
        if name in parts or count > budget or "--modules" in options:
            print(f"{name:20} {budget:7} {count:7}" + (" words" if name == "docs" else "") + (" too many" if count > budget else ""))
    found = list(violations(root))
    print("".join(each + "\n" for each in found), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
