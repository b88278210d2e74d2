#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Breaks a module on purpose, one operator, number or statement at a time, and asks whether its unit tests notice.

    tools/mutate.py --sample 100 --seed 1              # a hundred mutants of the guard chosen by chance; without --sample: all of them
    tools/mutate.py --module road --files line_planner.cpp
    tools/mutate.py --module all --sample 200          # over all modules whose test program is built

Each mutant is one file compiled anew and the module's test program, MODULE_test, linked and run with it; the sources stay as
they are. Without --files a module's sources are its *.cpp (of safety also supervisor.hpp); a header may be named. A survivor
is printed as a difference. One that cannot be noticed, because it behaves the same, is listed with its
reason in tools/equivalent_mutants.txt and not counted. Exits with 1 when there is a survivor."""
import argparse
import collections
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
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODULES = sorted(path.name for path in (ROOT / "src/chicane").glob("*") if path.is_dir() and (ROOT / "tests" / path.name).is_dir())
EQUIVALENT = ROOT / "tools/equivalent_mutants.txt"
# What each operator or word becomes. Operators count where clang-format puts spaces around them.
SWAPS = {" < ": " >= ", " > ": " <= ", " <= ": " > ", " >= ": " < ", " == ": " != ", " != ": " == ", " && ": " || ", " || ": " && ",
         " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", "true": "false", "false": "true",
         "std::min(": "std::max(", "std::max(": "std::min(", " -1.0": " 1.0", "sin(": "cos(", "cos(": "sin("}
NUMBER = re.compile(r"(?<![\w.\[])(\d+\.\d+(?:e-?\d+)?|\d+e-?\d+|\d+)(?![\w.])")
STATEMENT = re.compile(r"^\s+(?!const |constexpr |double |int |bool |auto |return|static |using |case |break|continue|default|if |for |while |else)"
                       r"[\w:.>*\[\]()\-]+( [+\-*/|]?= .*|\(.*\)|\+\+|--);$")


def folder_of(module):
    return ROOT / "src/chicane" / module


def sources_of(module):
    names = sorted(str(path.relative_to(folder_of(module))) for path in folder_of(module).rglob("*.cpp"))
    return names + (["supervisor.hpp"] if module == "safety" else [])


@dataclasses.dataclass(frozen=True)
class Mutant:
    module: str
    file: str  # in the module's folder
    line: int  # from 0
    before: str
    after: str

    def key(self):
        return f"{self.module}/{self.file}: {self.before.strip()} -> {self.after.strip()}"


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


def mutants_of(module, name):
    lines = (folder_of(module) / name).read_text().split("\n")
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
        found += [Mutant(module, name, number, line, text) for text in dict.fromkeys(after) if text != code]
    return found


def from_compiler(command):
    """The words of a compiler's command without the programs before it: ccache, timing."""
    first = next(i for i, word in enumerate(command) if re.fullmatch(r"(cc|gcc|clang|c\+\+|g\+\+|clang\+\+)(-\d+)?", pathlib.Path(word).name))
    return command[first:]


class Bench:
    """Compiles, links and runs a mutant beside the others, in a folder of its own. Sources that the build compiles as one
    file (CHICANE_UNITY) are compiled as one file here, too."""

    def __init__(self, build, module, tests):
        self.build, self.module, self.program = build, module, f"{module}_test"
        self.test = ["--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={tests}"]
        started = time.monotonic()
        program = build / "tests" / module / self.program
        if not program.exists():
            sys.exit(f"{program}: not there, build it first: cmake --build {build} --target {self.program}")
        if subprocess.run([str(program), *self.test], cwd=build, capture_output=True).returncode != 0:
            sys.exit(f"{self.program} fails without any mutant")
        self.patience = 10.0 + 5.0 * (time.monotonic() - started)  # [s] until a test that does not end counts as failed
        # Commands and objects by what is compiled: a source or a group of them, several times where it is for several instruction sets.
        self.units = collections.defaultdict(list)
        mine = re.compile(rf"/({self.program}|chicane_{module})(_\w+)?\.dir/")
        for entry in json.loads((build / "compile_commands.json").read_text()):
            command = from_compiler(shlex.split(entry["command"]))
            target = command[command.index("-o") + 1]
            if mine.search(target):
                self.units[entry["file"]].append((command, target))
        ninja = subprocess.run(["ninja", "-C", str(build), "-t", "commands", self.program], check=True, capture_output=True, text=True)
        last = [line for line in ninja.stdout.splitlines() if f"-o tests/{module}/{self.program}" in line][-1]
        self.link = from_compiler(shlex.split(last.split("&&")[1]))

    def units_with(self, name):
        """What has to be compiled anew for a changed source, or, of a header, for all that include it."""
        path = str(folder_of(self.module) / name)
        if name.endswith(".cpp"):
            found = [unit for unit in self.units if unit == path or f'"{path}"' in pathlib.Path(unit).read_text()]
        else:
            deps = subprocess.run(["ninja", "-C", str(self.build), "-t", "deps", *(target for unit in self.units.values() for _, target in unit)],
                                  capture_output=True, text=True).stdout
            users = {part.split(":")[0] for part in deps.split("\n\n") if re.search(rf"src/chicane/{self.module}/{re.escape(name)}$", part, re.M)}
            found = [unit for unit, all_of_it in self.units.items() if any(target in users for _, target in all_of_it)]
        if not found:
            sys.exit(f"{self.build}: {name} is not compiled there; build {self.program} first")
        return found

    def compiled(self, unit, which, mutant, folder):
        """The object of a unit with the mutant in the place of its file; None where it does not compile."""
        command, target = list(self.units[unit][which][0]), folder / f"{pathlib.Path(unit).stem}_{which}.o"
        path, copy = str(folder_of(self.module) / mutant.file), str(folder / "chicane" / self.module / mutant.file)
        source = copy if unit == path else unit
        if unit != path and mutant.file.endswith(".cpp"):
            source = str(folder / pathlib.Path(unit).name)
            pathlib.Path(source).write_text(pathlib.Path(unit).read_text().replace(f'"{path}"', f'"{copy}"'))
        command[command.index("-o") + 1] = str(target)
        command[command.index("-c") + 1] = source
        for flag in ("-MT", "-MF"):
            if flag in command:
                at = command.index(flag)
                del command[at:at + 2]
        command[1:1] = ["-I", str(folder), "-w"]
        run = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
        return target if run.returncode == 0 else None

    def outcome(self, mutant):
        """"killed", "survived" or "does not compile"."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            copy = folder / "chicane" / self.module / mutant.file
            copy.parent.mkdir(parents=True)
            lines = (folder_of(self.module) / mutant.file).read_text().split("\n")
            lines[mutant.line] = mutant.after
            copy.write_text("\n".join(lines))
            command = list(self.link)
            program = folder / self.program
            command[command.index("-o") + 1] = str(program)
            for unit, which in [(unit, i) for unit in self.units_with(mutant.file) for i in range(len(self.units[unit]))]:
                compiled = self.compiled(unit, which, mutant, folder)
                if compiled is None:
                    return "does not compile"
                target = self.units[unit][which][1]
                if target in command:
                    command[command.index(target)] = str(compiled)
                else:  # in front of the library the mutant's symbols are the ones that count
                    command.insert(next(i for i, word in enumerate(command) if word.endswith((".o", ".a"))), str(compiled))
            command.insert(1, "-Wl,--allow-multiple-definition")
            linked = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
            if linked.returncode != 0:
                sys.exit(f"{' '.join(command)}\n{linked.stderr}")
            try:
                tested = subprocess.run([str(program), *self.test], cwd=self.build,
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
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="a build folder with the test programs built")
    parser.add_argument("--module", default="safety", choices=["all", *MODULES], metavar="MODULE", help=f"all, or {', '.join(MODULES)}")
    parser.add_argument("--files", nargs="*", help="in the module's folder")
    parser.add_argument("--sample", type=int, help="so many of the mutants, chosen by chance")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--tests", default="*", help="which tests have to notice: a filter of GoogleTest")
    parser.add_argument("--list", action="store_true", help="print the mutants and do nothing")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    modules = [arguments.module]
    if arguments.module == "all":
        if arguments.files:
            parser.error("--files: expected one module beside it")
        modules = [module for module in MODULES if (build / "tests" / module / f"{module}_test").exists() or arguments.list]
    for name in arguments.files or []:
        if not (folder_of(arguments.module) / name).exists():
            parser.error(f"--files: got {name}, expected files in src/chicane/{arguments.module}")
    mutants = [mutant for module in modules for name in arguments.files or sources_of(module) for mutant in mutants_of(module, name)]
    known = {key: reason for key, reason in equivalents().items() if key.split("/")[0] in modules}
    for key in known:
        if not arguments.files and key not in {mutant.key() for mutant in mutants}:
            sys.exit(f"{EQUIVALENT.name}: no such mutant any more: {key}")
    total = len(mutants)
    mutants = [mutant for mutant in mutants if mutant.key() not in known]
    if arguments.sample is not None:
        mutants = random.Random(arguments.seed).sample(mutants, min(arguments.sample, len(mutants)))
    if arguments.list:
        print("\n".join(f"{mutant.module}/{mutant.file}:{mutant.line + 1}: {mutant.after.strip()}" for mutant in mutants))
        return
    benches = {module: Bench(build, module, arguments.tests) for module in dict.fromkeys(mutant.module for mutant in mutants)}
    counts = {"killed": 0, "survived": 0, "does not compile": 0}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for mutant, outcome in zip(mutants, pool.map(lambda mutant: benches[mutant.module].outcome(mutant), mutants)):
            counts[outcome] += 1
            if outcome == "survived":
                print(f"{mutant.module}/{mutant.file}:{mutant.line + 1}\n  - {mutant.before.strip()}\n  + {mutant.after.strip()}", flush=True)
    judged = counts["killed"] + counts["survived"]
    print(f"{total} mutants, {len(known)} of them equivalent; {judged} tried, {counts['killed']} killed, "
          f"{counts['survived']} survived: {100.0 * counts['killed'] / max(judged, 1):.1f} % "
          f"({counts['does not compile']} more do not compile)")
    sys.exit(1 if counts["survived"] else 0)


if __name__ == "__main__":
    main()
