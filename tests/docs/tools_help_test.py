#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every program in tools/ and studies/tables/ says what it is for when asked by --help, at once and without doing anything."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
FOLDERS = ("tools", "studies/tables")
PROGRAMS = sorted(path.relative_to(ROOT) for folder in FOLDERS for path in (ROOT / folder).iterdir()
                  if path.is_file() and (path.suffix == ".mjs" or path.read_bytes().startswith(b"#!")))


def files_of(folder):
    return {str(path): path.stat().st_mtime_ns for path in folder.rglob("*") if "__pycache__" not in path.parts}


class ToolsHelp(unittest.TestCase):
    def test_each_program_prints_what_it_is_for(self):
        self.assertGreater(len(PROGRAMS), 20)
        node = shutil.which("node")
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for each in FOLDERS:
                shutil.copytree(ROOT / each, root / each, ignore=shutil.ignore_patterns("node_modules", "__pycache__"))
            before = files_of(root)
            for program in (root / path for path in PROGRAMS):
                with self.subTest(program=program.name):
                    interpreter = {".py": [sys.executable], ".mjs": [node], ".sh": ["bash"]}.get(program.suffix, [sys.executable])
                    if interpreter == [None]:
                        continue  # no node here: the programs that need it are not there, either
                    done = subprocess.run([*interpreter, program, "--help"], capture_output=True, text=True, timeout=60, check=False,
                                          cwd=root, env={"PATH": os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1"})
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertIn(program.name, done.stdout)
            self.assertEqual(files_of(root), before, "nothing is written")


if __name__ == "__main__":
    unittest.main()
