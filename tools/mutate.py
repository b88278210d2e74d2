#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Breaks the guard on purpose, one operator, number or statement at a time, and asks whether its unit tests notice.

    tools/mutate.py --sample 100 --seed 1        # a hundred mutants chosen by chance; without --sample: all of them

Each mutant is one file compiled anew and the test program `safety_test` linked and run with it; the sources stay as they
are. A survivor is printed as a difference. One that cannot be noticed, because it behaves the same, is listed with its
reason in tools/equivalent_mutants.txt and not counted. Exits with 1 when there is a survivor."""
import argparse
import concurrent.futures
import dataclasses
import json
import pathlib
import random
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ["command_gate.cpp", "fallback.cpp", "guard.cpp", "measurement_monitor.cpp", "stop_planner.cpp", "stop_player.cpp", "stop_search.cpp",
           "supervisor.hpp"]
FOLDER = "src/chicane/safety"
TEST = "safety_test"
EQUIVALENT = ROOT / "tools/equivalent_mutants.txt"
# What each operator or word becomes. Operators count where clang-format puts spaces around them.
SWAPS = {" < ": " >= ", " > ": " <= ", " <= ": " > ", " >= ": " < ", " == ": " != ", " != ": " == ", " && ": " || ", " || ": " && ",
         " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", "true": "false", "false": "true",
         "std::min(": "std::max(", "std::max(": "std::min(", " -1.0": " 1.0", "sin(": "cos(", "cos(": "sin("}
NUMBER = re.compile(r"(?<![\w.\[])(\d+\.\d+(?:e-?\d+)?|\d+e-?\d+|\d+)(?![\w.])")
STATEMENT = re.compile(r"^\s+(?!const |constexpr |double |int |bool |auto |return|static |using |case |break|continue|default|if |for |while |else)"
                       r"[\w:.>*\[\]()\-]+( [+\-*/|]?= .*|\(.*\)|\+\+|--);$")


@dataclasses.dataclass(frozen=True)
class Mutant:
    file: str
    line: int  # from 0
    before: str
    after: str

    def key(self):
        return f"{self.file}: {self.before.strip()} -> {self.after.strip()}"


def code_of(line):
    """The line without its comment; empty for what is no code."""
    if line.lstrip().startswith(("#", "//", "///", "namespace", "template", "using", "class ", "struct ", "public:", "private:")):
        return ""
    return line.split("  //")[0].split("///<")[0]


def number_instead(text):
    value = float(text)
    if "." not in text and "e" not in text:
        return str(int(value) + 1)
    return "1.0" if value == 0.0 else repr(2.0 * value)


def mutants_of(name):
    lines = (ROOT / FOLDER / name).read_text().split("\n")
    found = []
    for number, line in enumerate(lines):
        code = code_of(line)
        after = []
        for old, new in SWAPS.items():
            for match in re.finditer(re.escape(old), code):
                before = code[match.start() - 1] if match.start() else " "
                if old[0].isalpha() and (before.isalnum() or before in "_:."):
                    continue  # part of another word
                after.append(code[:match.start()] + new + code[match.end():])
        for match in NUMBER.finditer(code):
            after.append(code[:match.start()] + number_instead(match[0]) + code[match.end():])
        for match in re.finditer(r"!(?=[\w(])", code):
            after.append(code[:match.start()] + code[match.end():])
        for match in re.finditer(r"(?<=[(,{?:=] )-(?=[\w(])|(?<=[({])-(?=[\w(])", code):
            after.append(code[:match.start()] + code[match.end():])
        if STATEMENT.match(code):
            after.append(re.match(r"\s*", code)[0] + ";")
        found += [Mutant(name, number, line, text) for text in dict.fromkeys(after) if text != code]
    return found


class Bench:
    """Compiles, links and runs a mutant beside the others, in a folder of its own."""

    def __init__(self, build, patience):
        self.build = build
        self.patience = patience
        commands = json.loads((build / "compile_commands.json").read_text())
        self.compile = {}
        for entry in commands:
            for source in re.findall(r"\S+\.cpp$|\S+\.cxx$", entry["file"]):
                self.compile[source] = shlex.split(entry["command"])
        ninja = subprocess.run(["ninja", "-C", str(build), "-t", "commands", TEST], check=True, capture_output=True, text=True)
        last = [line for line in ninja.stdout.splitlines() if f"-o tests/safety/{TEST}" in line][-1]
        self.link = shlex.split(last.split("&&")[1])
        # A mutated header has to reach those that include it.
        tests = [source for source in self.compile if "safety_test" in source and "safety_2" in source or
                 source.endswith("tests/safety/supervisor_test.cpp")]
        self.users = {"supervisor.hpp": [str(ROOT / FOLDER / "guard.cpp")] + tests[:1]}

    def compiled(self, source, name, folder):
        command = list(self.compile[str(ROOT / FOLDER / name) if name.endswith(".cpp") else source])
        target = folder / (pathlib.Path(source).stem + ".o")
        command[command.index("-o") + 1] = str(target)
        command[command.index("-c") + 1] = source
        overlay = ["-I", str(folder)]
        for flag in ("-MD", ):
            if flag in command:
                command.remove(flag)
        for flag in ("-MT", "-MF"):
            if flag in command:
                at = command.index(flag)
                del command[at:at + 2]
        command[1:1] = [*overlay, "-w"] if "ccache" not in command[0] else []
        if "ccache" in command[0]:
            command = [command[1], *overlay, "-w", *command[2:]]
        run = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
        return target if run.returncode == 0 else None

    def outcome(self, mutant):
        """"killed", "survived" or "does not compile"."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            copy = folder / "chicane/safety" / mutant.file
            copy.parent.mkdir(parents=True)
            lines = (ROOT / FOLDER / mutant.file).read_text().split("\n")
            lines[mutant.line] = mutant.after
            copy.write_text("\n".join(lines))
            if mutant.file.endswith(".cpp"):
                objects = [self.compiled(str(copy), mutant.file, folder)]
            else:
                objects = [self.compiled(source, mutant.file, folder) for source in self.users[mutant.file]]
            if None in objects:
                return "does not compile"
            program = folder / TEST
            command = list(self.link)
            command[command.index("-o") + 1] = str(program)
            # In front of the library the mutant's symbols are the ones that count.
            at = next(i for i, word in enumerate(command) if word.endswith((".o", ".a")))
            command[at:at] = [str(each) for each in objects] + ["-Wl,--allow-multiple-definition"]
            linked = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
            if linked.returncode != 0:
                sys.exit(f"{' '.join(command)}\n{linked.stderr}")
            try:
                tested = subprocess.run([str(program), "--gtest_fail_fast", "--gtest_brief=1"], cwd=self.build,
                                        capture_output=True, timeout=self.patience)
            except subprocess.TimeoutExpired:
                return "killed"
            return "survived" if tested.returncode == 0 else "killed"


def equivalents():
    """Key of a mutant, and why nobody could notice it."""
    found = {}
    if EQUIVALENT.exists():
        for line in EQUIVALENT.read_text().splitlines():
            if line and not line.startswith("#"):
                key, _, reason = line.partition("  # ")
                if not reason:
                    sys.exit(f"{EQUIVALENT.name}: without a reason: {line}")
                found[key.strip()] = reason
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="a build folder with safety_test built")
    parser.add_argument("--files", nargs="*", default=SOURCES)
    parser.add_argument("--sample", type=int, help="so many of the mutants, chosen by chance")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--patience", type=float, default=60.0, help="seconds until a test that does not end counts as failed")
    parser.add_argument("--list", action="store_true", help="print the mutants and do nothing")
    arguments = parser.parse_args()
    mutants = [mutant for name in arguments.files for mutant in mutants_of(name)]
    known = equivalents()
    for key in known:
        if set(arguments.files) == set(SOURCES) and key not in {mutant.key() for mutant in mutants}:
            sys.exit(f"{EQUIVALENT.name}: no such mutant any more: {key}")
    total = len(mutants)
    mutants = [mutant for mutant in mutants if mutant.key() not in known]
    if arguments.sample is not None:
        mutants = random.Random(arguments.seed).sample(mutants, min(arguments.sample, len(mutants)))
    if arguments.list:
        print("\n".join(f"{mutant.file}:{mutant.line + 1}: {mutant.after.strip()}" for mutant in mutants))
        return
    bench = Bench(arguments.build.resolve(), arguments.patience)
    counts = {"killed": 0, "survived": 0, "does not compile": 0}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for mutant, outcome in zip(mutants, pool.map(bench.outcome, mutants)):
            counts[outcome] += 1
            if outcome == "survived":
                print(f"{mutant.file}:{mutant.line + 1}\n  - {mutant.before.strip()}\n  + {mutant.after.strip()}", flush=True)
    judged = counts["killed"] + counts["survived"]
    print(f"{total} mutants, {len(known)} of them equivalent; {judged} tried, {counts['killed']} killed, "
          f"{counts['survived']} survived: {100.0 * counts['killed'] / max(judged, 1):.1f} % "
          f"({counts['does not compile']} more do not compile)")
    sys.exit(1 if counts["survived"] else 0)


if __name__ == "__main__":
    main()
