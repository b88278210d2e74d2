#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_figures: a page that is true passes, one changed digit fails with both values, --write mends it."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent

README = """# A page

<!-- figures (fast): printf '| a | b |\\n|---|---|\\n| 1 | 2.50 |\\n' -->
| a | b |
|---|---|
| 1 | 2.50 |
<!-- /figures -->

<!-- figures (within 20 %): echo it took 110 s -->
it took 100 s
<!-- /figures -->

<!-- figures (needs no/such/file): false -->
as it was
<!-- /figures -->

The lap takes
25.97 s.
"""
SETTINGS = """
[[text]]
page = "README.md"
text = "The lap takes {lap:.2f} s."
command = "echo '{\\"laps\\": [{\\"time\\": 30}, {\\"time\\": 25.968}]}'"
values.lap = "laps[-1].time"
"""


class CheckFigures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        (self.root / "docs/measured").mkdir(parents=True)
        self.write(README, SETTINGS)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, readme, settings):
        (self.root / "README.md").write_text(readme, encoding="utf-8")
        (self.root / "docs/figures.toml").write_text(settings, encoding="utf-8")

    def check(self, *options):
        done = subprocess.run([sys.executable, ROOT / "tools/check_figures", "--root", self.root, *options, "/bin/true"],
                              capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_equal_figures_pass_and_are_counted(self):
        code, text = self.check()
        self.assertEqual(code, 0, text)
        self.assertIn("4 figures in 2 blocks and 1 sentences", text)
        self.assertIn("skipped: README.md:", text)
        self.assertIn("no/such/file", text)

    def test_one_changed_digit_fails_with_both_values(self):
        self.write(README.replace("| 1 | 2.50 |\n<!--", "| 1 | 2.51 |\n<!--"), SETTINGS)
        for options in ([], ["--fast"]):
            code, text = self.check(*options)
            self.assertEqual(code, 1)
            self.assertIn("README.md:6: got | 1 | 2.51 |\nREADME.md:6: expected | 1 | 2.50 |", text)

    def test_a_changed_sentence_fails_with_both_values(self):
        self.write(README.replace("25.97", "25.98"), SETTINGS)
        code, text = self.check()
        self.assertEqual(code, 1)
        self.assertIn("README.md:18: got lap 25.98\nREADME.md:18: expected lap 25.97", text)

    def test_write_mends_what_differs(self):
        self.write(README.replace("| 1 | 2.50 |\n<!--", "| 7 | 2.51 |\n<!--").replace("25.97", "25.98"), SETTINGS)
        code, text = self.check("--write")
        self.assertEqual(code, 0, text)
        self.assertEqual((self.root / "README.md").read_text(encoding="utf-8"), README)

    def test_a_table_of_numbers_without_a_command_fails(self):
        self.write(README + "\n| a | b |\n|---|---|\n| 1 | 2 |\n| 3 | 4 |\n| 5 | 6 |\n", SETTINGS)
        code, text = self.check()
        self.assertEqual(code, 1)
        self.assertIn("README.md: got 1 tables of numbers without a command (lines 20), expected 0 at most", text)
        self.write(README + "\n| a | b |\n|---|---|\n| 1 | 2 |\n| 3 | 4 |\n| 5 | 6 |\n",
                   SETTINGS + '[by_hand]\n"README.md" = {tables = 1, why = "definitions"}\n')
        self.assertEqual(self.check()[0], 0)
        (self.root / "docs/measured/page.md").write_text("| a | b | c |\n|---|---|---|\n| 1 | 2 | 3 |\n| 4 | 5 | 6 |\n", encoding="utf-8")
        self.assertIn("docs/measured/page.md: got 1 tables of numbers", self.check()[1])

    def test_mistakes_name_place_and_expectation(self):
        self.write(README.replace("(fast)", "(quick)"), SETTINGS)
        code, text = self.check()
        self.assertEqual(code, 2)
        self.assertIn("README.md:3: got quick, expected fast, within N % or needs FILE", text)
        self.write(README, SETTINGS.replace("values.lap", "values.time"))
        self.assertEqual(self.check()[0], 2)
        self.write(README.replace("<!-- /figures -->", "", 1), SETTINGS)
        code, text = self.check()
        self.assertEqual(code, 2)
        self.assertIn("begins in the one of line 3", text)


if __name__ == "__main__":
    unittest.main()
