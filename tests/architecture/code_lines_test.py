#!/usr/bin/env python3
"""Lines of code as tools/code_lines.py counts them, and their budget."""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import code_lines  # noqa: E402


class CodeLines(unittest.TestCase):
    def test_blank_lines_and_comments_do_not_count(self):
        self.assertEqual(code_lines.code_lines("// a\n\nint a;  // b\n/* c\n d */\nint b; /* e\n*/ int c;\n"), 3)

    def test_what_looks_like_a_comment_in_a_text_does(self):
        self.assertEqual(code_lines.code_lines('const char* url = "http://x";  // y\nint a = 1\'000; // \'\nchar c = \'"\'; // "\n'), 3)
        self.assertEqual(code_lines.code_lines('auto text = R"(\n// in it\n\n)";\n'), 3)

    def test_docstrings_are_comments(self):
        self.assertEqual(code_lines.script_lines('"""What\nit is."""\nimport re  # x\n\n\ndef f():\n    """Why."""\n    # so\n    return 1\n'), 3)

    def test_each_file_counts_for_one_part(self):
        for path, part in (("src/chicane/live/detail/a.hpp", "src/live"), ("src/chicane/solver.h", "src/solver.h"), ("apps/page/a.cpp", "apps/page"),
                           ("apps/page/a.js", "web"), ("web/src/a.tsx", "web"), ("web/src/a.test.ts", "tests"), ("tests/a/b.mjs", "tests"),
                           ("python/tests/a.py", "tests"), ("python/src/a.cpp", "python"), ("src/chicane/live/CMakeLists.txt", "cmake"),
                           ("tools/check_figures", "tools"), ("docs/a/b.md", "docs"), ("CHANGELOG.md", None), ("tests/data/a.csv", None)):
            self.assertEqual(code_lines.part_of(Path(path)), part, path)


class Budget(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("src/chicane/live/a.cpp", "int a;\n" * 12)
        self.write("tools/budget.txt", "# What counts.\n\nsrc/live 999\n\n# Raised.\n")
        code_lines.lower(self.root)

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def expect(self, *ends):
        found = list(code_lines.violations(self.root))
        self.assertEqual(len(found), len(ends), found)
        for violation, end in zip(found, ends):
            self.assertIn(end, violation)

    def test_is_lowered_to_tens_and_keeps_its_comments(self):
        self.expect()
        text = (self.root / "tools/budget.txt").read_text()
        self.assertRegex(text, r"^# What counts.\n\nsrc/live +20\nsrc\+apps +20\n(.*\n)+\n# Raised.\n$")
        self.write("src/chicane/live/a.cpp", "int a;\n" * 25)
        code_lines.lower(self.root)
        self.assertEqual((self.root / "tools/budget.txt").read_text(), text)

    def test_is_exceeded(self):
        self.write("src/chicane/live/a.cpp", "int a;\n" * 21)
        self.expect("src+apps: got 21, expected at most 20", "src/live: got 21, expected at most 20")

    def test_has_the_modules_of_the_tree(self):
        (self.root / "src/chicane/live").rename(self.root / "src/chicane/other")
        self.expect("src/live: is not in the tree", "src/other: has no budget")

    def test_is_raised_for_a_reason(self):
        with (self.root / "tools/budget.txt").open("a") as file:
            file.write("# raised: src/live 20 -> 30: a second receiver\n# raised: src/live\n")
        self.expect("expected # raised: NAME FROM -> TO: REASON")


if __name__ == "__main__":
    unittest.main()
