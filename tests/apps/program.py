# SPDX-License-Identifier: MIT
"""The program as users start it. The first word behind a test's name is its path."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1)
ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "CHICANE_DATA_DIR": str(ROOT / "data")}


def run(*words, cwd=ROOT):
    """Exit code and both outputs."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=cwd, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


class InFolder(unittest.TestCase):
    """Tests with a folder of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(suffix=f".{os.getpid()}")
        self.addCleanup(folder.cleanup)
        self.at = Path(folder.name)
