# SPDX-License-Identifier: MIT
"""The package: built by pip without network, at home anywhere, typed."""
import ast
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from chicane import _interpreter

ROOT = Path(__file__).resolve().parents[2]

LAP = """
import chicane as ch
assert ch.__file__.startswith(FOLDER), ch.__file__
assert ch.drive("oval", laps=1, frames=False)["completed"]
"""


class Package(unittest.TestCase):
    def test_pip_installs_it_without_network_and_it_finds_its_data(self):
        with tempfile.TemporaryDirectory() as folder:
            environment = {name: value for name, value in os.environ.items() if name not in ("CHICANE_DATA_DIR", "PYTHONPATH")}
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-compile",
                            "--disable-pip-version-check", "--root-user-action=ignore", "--target", folder, str(ROOT)],
                           check=True, env=environment)
            subprocess.run([sys.executable, "-c", LAP.replace("FOLDER", repr(folder))], check=True, cwd=folder,
                           env=environment | {"PYTHONPATH": folder})

    def test_types_are_right(self):
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), "--cache-dir",
             str(Path(os.environ["CHICANE_PYTHON_BUILD_DIR"]) / "mypy"), str(ROOT / "python" / "chicane")], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_the_stub_has_the_names_that_are_there(self):
        from chicane import _chicane
        stub = ast.parse((ROOT / "python/chicane/_chicane.pyi").read_text(encoding="utf-8"))

        def names_in(body):
            return {node.name if isinstance(node, (ast.ClassDef, ast.FunctionDef)) else node.target.id
                    for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef, ast.AnnAssign))}

        def public(thing):
            return {name for name in vars(thing) if not name.startswith("_")}
        own = {name for name in names_in(stub.body) if hasattr(_chicane, name)}
        self.assertEqual(public(_chicane) - own, set())
        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                self.assertIn(node.name, own)
            if isinstance(node, ast.ClassDef) and node.name in own:
                there = getattr(_chicane, node.name)
                with self.subTest(node.name):
                    self.assertEqual(public(there), {name for name in names_in(node.body) if not name.startswith("_")})

    def test_data_that_the_environment_names_win(self):
        with mock.patch.dict(os.environ, {"CHICANE_DATA_DIR": "/mine"}):
            _interpreter.find_data(ROOT / "python" / "chicane")
            self.assertEqual(os.environ["CHICANE_DATA_DIR"], "/mine")

    def test_an_interpreter_without_numpy_is_told_what_to_do(self):
        with mock.patch.object(sys, "base_prefix", "/home/me/.pyenv/versions/3.11.7"):
            self.assertRegex(_interpreter.no_numpy(), r"is an interpreter of pyenv \(/home/me/.pyenv.*expected /usr/bin/python3")
        self.assertNotIn("pyenv", _interpreter.no_numpy().replace(sys.executable, ""))


if __name__ == "__main__":
    unittest.main()
