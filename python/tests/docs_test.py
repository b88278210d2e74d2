# SPDX-License-Identifier: MIT
"""The code of docs/python.md and docs/python_problems.md does what the pages say."""
import contextlib
import importlib.util
import inspect
import io
import os
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

import chicane as ch

DOCS = Path(__file__).resolve().parents[2] / "docs"


class Pages(unittest.TestCase):
    def run_page(self, name):
        """Its blocks from top to bottom in one folder; what they print."""
        page = DOCS / name
        blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        self.assertGreater(len(blocks), 6)
        names = {}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as printed:
            os.chdir(folder)
            try:
                for block in blocks:
                    exec(compile(block, str(page), "exec"), names)
            finally:
                os.chdir(before)
        return printed.getvalue()

    def test_python(self):
        self.assertIn("(did you mean oval?)", self.run_page("python.md"))

    def test_problems(self):
        self.assertRegex(self.run_page("python_problems.md"), r"optimal after 65 iterations, cost 89\.58(.|\n)*got a branch on a symbol, expected ch\.where")

    def test_the_packages_to_install_are_those_that_are_needed(self):
        listed = set(re.search(r"apt-get install --no-install-recommends (.*?)\n/usr", (DOCS / "python.md").read_text(encoding="utf-8"), re.DOTALL)[1]
                     .replace("\\", " ").split())
        script = (DOCS.parent / "tools/install_packages.sh").read_text(encoding="utf-8")
        needed = {name for group in ("run_packages", "python_packages") for name in re.search(rf"^{group}=\((.*?)\)", script, re.DOTALL | re.M)[1].split()}
        self.assertEqual(needed - listed, {"ccache", "libcli11-dev", "python3"})     # for others, the program, and there already

    @unittest.skipUnless(importlib.util.find_spec("numpydoc"), "needs python3-numpydoc")
    def test_public_docstrings_are_numpydocs_and_have_units(self):
        from numpydoc.validate import validate
        kept = {"GL08", "RT01", "RT03", "SS01", "SS03", *(f"PR{n:02}" for n in range(1, 11))}
        own = [name for name in set(ch.__all__) - {"NO_ANSWER", "Symbol", "__version__"} if not isinstance(getattr(ch, name), np.ufunc)]
        things = {name: getattr(ch, name) for name in own}
        for name, one in list(things.items()):
            fields = re.findall(r"\w+", " ".join(re.findall(r"^(\S.*) : ", inspect.getdoc(one), re.M)))
            things |= {f"{name}.{part}": each for part, each in (vars(one).items() if isinstance(one, type) else ())
                       if not part.startswith("_") and part not in fields and (callable(each) or isinstance(each, property))}
        for name, one in things.items():
            with self.subTest(name):
                is_made_by_functions = isinstance(one, type) and name not in ("Env", "Problem", "Track", "VecEnv")
                found = [error for error in validate(f"chicane.{name}")["errors"] if error[0] in kept - ({"PR01"} if is_made_by_functions else set())]
                bare = re.findall(r"^(\w+_(?:s|ms|m|mps|hz|px)) : .*\n((?:    [^[\n]*\n)+)(?=\S|\n|$)", inspect.getdoc(one) + "\n", re.M)
                self.assertEqual((found, bare), ([], []))


if __name__ == "__main__":
    unittest.main()
