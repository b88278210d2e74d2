# SPDX-License-Identifier: MIT
"""Sweeps: the lines of `chicane sweep`, as a table."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import chicane as ch
from chicane._sweep import plan_of

PROGRAM = os.environ["CHICANE_PROGRAM"]
AXES = {"preset": ["pid", "stanley"], "latency_ms": range(0, 200, 100)}
SETTINGS = {"laps": 0, "time_limit_s": 10, "track": "oval", "guard.mode": "off"}


class Sweep(unittest.TestCase):
    def test_has_the_bytes_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            plan, own, theirs = (Path(folder) / name for name in ("plan.yaml", "own.jsonl", "theirs.jsonl"))
            plan.write_text(
                "name: sweep\nsettings: {laps: 0, time_limit_s: 10, track: oval, guard.mode: \"off\"}\naxes:\n"
                "  - preset: [pid, stanley]\n  - latency_ms: [0, 100]\n", encoding="utf-8")
            subprocess.run([PROGRAM, "sweep", plan, "-o", theirs, "--jobs", "1"], check=True, capture_output=True)
            one = ch.sweep(AXES, settings=SETTINGS, jobs=1, output=own)
            self.assertEqual(own.read_bytes(), theirs.read_bytes())
            two = ch.sweep(AXES, settings=SETTINGS, jobs=2)
            self.assertTrue(one.equals(two))

    def test_is_a_table_in_the_order_of_the_plan(self):
        table = ch.sweep({"latency_ms": np.array([0.0, 50.0]), "seed": (1, 2)}, settings=SETTINGS, keep=["mean_speed_mps"], jobs=2)
        self.assertEqual(list(table.columns), ["run", "latency_ms", "seed", "mean_speed_mps", "state_hash"])
        self.assertEqual(list(table["run"]), [0, 1, 2, 3])
        self.assertEqual(list(table["latency_ms"]), [0, 0, 50, 50])
        self.assertTrue((table["mean_speed_mps"] > 0).all())

    def test_says_which_line_is_wrong(self):
        for axes, message in (({"latency": [1]}, r"sweep sweep:4: latency: .*did you mean"),
                              ({"latency_ms": [9000]}, r"sweep sweep:4: latency_ms: got 9000")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                ch.sweep(axes, settings=SETTINGS)
        self.assertIn("latency_ms", plan_of(AXES).splitlines()[3])


if __name__ == "__main__":
    unittest.main()
