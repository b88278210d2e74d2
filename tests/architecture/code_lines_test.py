#!/usr/bin/env python3
"""Lines of code as tools/code_lines.py counts them."""
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

    def test_modules_are_folders(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, text in (("src/chicane/live/a.cpp", "int a;\nint b;\n"), ("src/chicane/live/detail/b.hpp", "int c;\n"),
                               ("apps/page/c.cpp", "int d;\n"), ("src/chicane/live/CMakeLists.txt", "x\n")):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            self.assertEqual(code_lines.modules(root), {"src/live": 3, "apps/page": 1})


if __name__ == "__main__":
    unittest.main()
