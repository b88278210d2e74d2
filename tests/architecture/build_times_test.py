#!/usr/bin/env python3
"""Processor times of a build: noted for each step by tools/note_time.sh, read by tools/build_times.py."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import build_times  # noqa: E402

# What ccache writes into CCACHE_STATSLOG, as far as it is looked at.
CCACHE = "printf '# a.cpp\\n%s\\n' {} >\"$CCACHE_STATSLOG\""


class NoteTime(unittest.TestCase):
    def note(self, *words):
        """(process, lines of the log)"""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([ROOT / "tools/note_time.sh", *words], cwd=folder, capture_output=True, text=True)
            left = [p.name for p in Path(folder).iterdir()]
            self.assertEqual(left, [".processor_times"])
            return done, (Path(folder) / ".processor_times").read_text(encoding="utf-8").splitlines()

    def test_notes_the_file_and_passes_on_what_the_step_says(self):
        done, lines = self.note("sh", "-c", "echo out; echo err >&2; exit 3", "-o", "some/a.o", "-c")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (3, "out\n", "err\n"))
        self.assertEqual(len(lines), 1)
        self.assertRegex(lines[0], r"^\d+\.\d+ \d+\.\d+\trun\tsome/a\.o$")

    def test_counts_the_processor_and_not_the_waiting(self):
        _, idle = self.note("-o", "idle", "sleep", "0.3")
        _, busy = self.note("-o", "busy", "sh", "-c", "i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done")
        seconds = [build_times.read_log(lines)[name][0] for lines, name in ((idle, "idle"), (busy, "busy"))]
        self.assertLess(seconds[0], seconds[1])

    def test_says_what_the_compilers_cache_had(self):
        for result, kind in (("direct_cache_hit", "cached"), ("preprocessed_cache_hit", "cached"), ("cache_miss", "run")):
            _, lines = self.note("-o", "a.o", "sh", "-c", CCACHE.format(result))
            self.assertEqual(lines[0].split("\t")[1], kind, result)


class ProcessorSeconds(unittest.TestCase):
    def test_counts_what_the_shell_has_started(self):
        busy = "i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done"
        script = f"source {ROOT}/tools/build.sh; processor_seconds before; sh -c '{busy}'; processor_seconds after; echo $before $after"
        before, after = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()
        self.assertLess(float(before), 0.1)
        self.assertGreater(float(after), float(before))


class BuildTimes(unittest.TestCase):
    def test_the_last_time_of_each_file_counts(self):
        made = build_times.read_log(["1.5 0.5\trun\ta.o", "9 1\trun\tb.o", "0.25 0.25\trun\ta.o", "0.1 0\tcached\tc.o", "1.2 0."])
        self.assertEqual(made, {"a.o": (0.5, False), "b.o": (10.0, False), "c.o": (0.1, True)})

    def test_prints_the_sum_the_folders_and_the_worst(self):
        made = {"src/m/CMakeFiles/t.dir/a.cpp.o": (30.0, False), "apps/b.cpp.o": (5.0, True),
                "src/c.o": (1.0, False), "src/d.o": (0.5, False)}
        lines = list(build_times.report(made, 2))
        self.assertEqual(lines[0], "processor time of the build: 36 s in 4 steps, 1 of which came from the compiler's cache")
        self.assertEqual(lines[1], "  src 32 s, apps 5 s")
        self.assertEqual(lines[2:], ["   30.0 s  src/m/t.dir/a.cpp", "    1.0 s  src/c"])


if __name__ == "__main__":
    unittest.main()
