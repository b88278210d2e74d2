#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`chicane claims` on a clone with nothing beside it: what needs a file that is not there is skipped by name and keeps its cell.

    tests/docs/claims_test.py PROGRAM"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = ""
ID = "A17"  # two runs in each world


class ClaimsOnAClone(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.clone = Path(self.folder.name) / "outer/clone"
        self.clone.mkdir(parents=True)
        (self.clone / "studies").mkdir()
        for name in ("data", "studies/claims"):
            (self.clone / name).symlink_to(ROOT / name)
        self.page = self.clone / "claims.md"
        shutil.copy(ROOT / "docs/measured/claims.md", self.page)

    def tearDown(self):
        self.folder.cleanup()

    def claims(self, *options):
        environment = dict(os.environ, CHICANE_DATA_DIR=str(ROOT / "data"))
        return subprocess.run([PROGRAM, "claims", ID, "--jobs", "1", *options], cwd=self.clone, env=environment, capture_output=True,
                              text=True, check=False)

    def row(self):
        return next(line for line in self.page.read_text(encoding="utf-8").splitlines() if line.startswith(f"| {ID} |"))

    def test_the_page_is_checked_and_the_missing_file_skipped_by_name(self):
        done = self.claims("--page", "claims.md", "--check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("skipped: course's file: no circuits/lake_track_waypoints.csv", done.stderr)
        self.assertIn("claims.md: 1 statements as the page has them", done.stdout)

    def test_a_changed_digit_fails_with_both_rows(self):
        row = self.row()
        self.page.write_text(self.page.read_text(encoding="utf-8").replace(row, row.replace("own: 0.", "own: 1.", 1)), encoding="utf-8")
        done = self.claims("--page", "claims.md", "--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"claims.md: got {row.replace('own: 0.', 'own: 1.', 1)}", done.stdout)
        self.assertIn(f"claims.md: expected {row}", done.stdout)

    def test_writing_keeps_the_cells_of_a_file_that_is_not_there(self):
        row = self.row()
        self.assertEqual(len(row.split(" | ")), 7)
        self.assertIn(row.split(" | ")[5], ("yes", "no"), "the page was written where the file was")
        done = self.claims("--page", "claims.md")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.row(), row)

    def test_a_quotation_that_its_write_up_does_not_have_is_a_mistake(self):
        (self.clone / "studies/claims").unlink()
        shutil.copytree(ROOT / "studies/claims", self.clone / "studies/claims")
        file = self.clone / "studies/claims/e-delay-in-model.yaml"
        file.write_text(file.read_text(encoding="utf-8").replace("the \"lake\" track", "the \"sea\" track"), encoding="utf-8")
        done = self.claims("--page", "claims.md", "--check")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r'studies/claims/e-delay-in-model.yaml:\d+: quotes: got the "sea" track, expected words of a line of')

    def test_details_have_the_command_of_each_run(self):
        done = self.claims()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("skipped: no circuits/lake_track_waypoints.csv", done.stdout)
        self.assertEqual(done.stdout.count("chicane drive "), 2)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
