#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the commands of README, the tutorial and some guides word for word, and holds them to what the pages say.

    tests/docs/tutorial_test.py PROGRAM BUILD          all; some minutes, since some of it drives in real time, on port 4567
    tests/docs/tutorial_test.py --fast PROGRAM BUILD   what runs in virtual time

The commands run in a folder with links to what the source has. Its ./run.sh starts PROGRAM as the real one does when nothing is to be
built, and `cmake` only asks whether BUILD has the target. A line that says `# exit code N` has to end so, all others with 0."""
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
FAST_PAGES = ("README.md", "docs/tutorial.md", "docs/effects.md", "docs/the_five_systems.md")
PAGES = (*FAST_PAGES, *(f"docs/{name}.md" for name in ("tracks", "identification", "racing", "sweep", "safety", "viewer")))
RUN = """#!/bin/sh
case "${1:-}" in '' | --laps | --preset) set -- drive "$@" ;; esac
exec "$PROGRAM" "$@"
"""
CMAKE = """#!/bin/sh
for last; do :; done
[ "$1" = --preset ] || grep -q "$last" "$BUILD/build.ninja" || { echo "no target $last" >&2; exit 1; }
"""
SERVERS = ("./run.sh", "./run.sh serve")  # run until Ctrl-C
REAL_TIME = ("05_any_language.py &", "./run.sh simulate", "./run.sh league", *SERVERS)
NOT_HERE = ("./run.sh python",)  # builds the module; python.drive tests it


def commands_of(page):
    """The lines of its blocks of shell commands, continued lines joined."""
    text = (ROOT / page).read_text(encoding="utf-8")
    lines = []
    for block in re.findall(r"^```bash\n(.*?)^```", text, re.M | re.S):
        lines += [line for line in block.replace("\\\n", " ").splitlines() if line.strip()]
    return lines


def files_of(page):
    """Name and content of the files that it asks its reader to save."""
    return re.findall(r"save\s+this\s+as\s+`(\S+)`:\s+```\w+\n(.*?)^```", (ROOT / page).read_text(encoding="utf-8"), re.M | re.S)


def parts_of(line):
    """Command, and the exit code that it has to end with."""
    command, _, comment = line.partition("  #")
    code = re.search(r"exit code (\d+)", comment)
    return command.strip(), int(code[1]) if code else 0


def wait_for_port(port, seconds):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise AssertionError(f"nobody listens on port {port} after {seconds} s")


class Walk:
    def __init__(self, folder, program, build):
        self.folder, self.background = folder, []
        for path in ROOT.iterdir():
            if path.name not in ("run.sh", "build", ".git", ".gitignore"):
                (folder / path.name).symlink_to(path)
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(build)
        self.write(folder / "run.sh", RUN)
        (folder / "bin").mkdir()
        self.write(folder / "bin/cmake", CMAKE)
        self.environment = dict(os.environ, PROGRAM=str(program), BUILD=str(build), CHICANE_DATA_DIR=str(ROOT / "data"),
                                PATH=f"{folder / 'bin'}:{os.environ['PATH']}")

    @staticmethod
    def write(path, text):
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def start(self, command):
        """In a process group of its own, so that Ctrl-C reaches all of it."""
        return subprocess.Popen(["bash", "-c", command], cwd=self.folder, env=self.environment, start_new_session=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def stop_background(self, how=signal.SIGINT):
        for process in self.background:
            os.killpg(process.pid, how)
        for process in self.background:
            process.communicate(timeout=60)
        self.background = []

    def step(self, line):
        command, expected = parts_of(line)
        started = time.monotonic()
        if command in SERVERS or command.endswith("&"):
            self.stop_background()
            self.background = [self.start("exec " + command.rstrip("& "))]
            wait_for_port(4567, 60)
            print(f"ok      {time.monotonic() - started:6.1f} s  {command} (goes on)", flush=True)
            return True
        if command == "kill %1":
            self.stop_background(signal.SIGTERM)
            return True
        process = self.start(command)
        try:
            output, _ = process.communicate(timeout=900)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
        is_right = process.returncode == expected
        print(f"{'ok    ' if is_right else 'not ok'}  {time.monotonic() - started:6.1f} s  {command}", flush=True)
        if not is_right:
            print(f"exit code {process.returncode}, expected {expected}\n{output[-2000:]}")
        return is_right


def main():
    is_fast = "--fast" in sys.argv
    program, build = (Path(each).resolve() for each in [each for each in sys.argv[1:] if each != "--fast"])
    lines = {parts_of(line)[0]: line for page in (FAST_PAGES if is_fast else PAGES) for line in commands_of(page)}.values()
    lines = [line for line in lines if not line.startswith(NOT_HERE)]
    if is_fast:
        lines = [line for line in lines if parts_of(line)[0] not in (*SERVERS, "kill %1") and not any(word in line for word in REAL_TIME[:3])]
    if len(lines) < 10:
        sys.exit(f"got {len(lines)} commands, expected at least 10")
    with tempfile.TemporaryDirectory(prefix=f"tutorial-{os.getpid()}-") as folder:
        walk = Walk(Path(folder), program, build)
        for name, content in [file for page in PAGES for file in files_of(page)]:
            (walk.folder / name).write_text(content, encoding="utf-8")
        try:
            wrong = [line for line in lines if not walk.step(line)]
        finally:
            walk.stop_background()
    print(f"{len(lines)} commands, {len(wrong)} not as the pages say")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
