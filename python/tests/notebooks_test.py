# SPDX-License-Identifier: MIT
"""The notebooks of examples/notebooks: without outputs, and run.

    notebooks_test.py                    what all have in common; the cells of those that take seconds, drawing nothing
    notebooks_test.py --all              each by jupyter nbconvert --execute (apt-get install jupyter-nbconvert python3-ipykernel python3-matplotlib)
    notebooks_test.py --pictures FOLDER  the same, and their pictures as FOLDER/notebook_NAME.png"""
import base64
import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import chicane

FOLDER = Path(__file__).resolve().parents[2] / "examples/notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
QUICK = ("3_your_own_controller", "4_mpc_in_30_lines", "5_cart_pole", "6_quadrotor", "7_parking")


def cells(notebook):
    return json.loads(notebook.read_text(encoding="utf-8"))["cells"]


class Notebooks(unittest.TestCase):
    def test_all_are_committed_without_outputs_and_say_what_they_are(self):
        self.assertEqual(len(NOTEBOOKS), 9)
        for notebook in NOTEBOOKS:
            with self.subTest(notebook.name):
                own = cells(notebook)
                self.assertTrue("".join(own[0]["source"]).startswith("# "))
                for cell in own:
                    self.assertFalse(cell.get("outputs"))
                    self.assertIsNone(cell.get("execution_count"))
                    if cell["cell_type"] == "code":
                        compile("".join(cell["source"]), notebook.name, "exec")

    def test_quick_ones_run(self):
        for name in QUICK:
            with self.subTest(name):
                names = run_cells(FOLDER / f"{name}.ipynb")
                if name == "4_mpc_in_30_lines":
                    self.assertTrue(names["run"]["completed"])
                    self.assertEqual(names["run"]["off_track_events"], 0)

    def test_thirty_lines_are_thirty(self):
        code = [("".join(cell["source"])) for cell in cells(FOLDER / "4_mpc_in_30_lines.ipynb") if cell["cell_type"] == "code"]
        lines = max(code, key=len).split("\n")
        begin, end = next(n for n, line in enumerate(lines) if "ch.Problem" in line), next(n for n, line in enumerate(lines) if "def reset" in line)
        self.assertLessEqual(len([line for line in lines[begin:end] if line.strip()]), 30)       # as its title says


def run_cells(notebook):
    """Without Jupyter and matplotlib, whose place something takes that draws nothing; the names that the cells leave."""
    plots = mock.MagicMock()
    plots.subplots = lambda rows=1, columns=1, **_: (mock.MagicMock(), [mock.MagicMock() for _ in range(columns)] if columns > 1 else mock.MagicMock())
    names = {}
    with mock.patch.dict(sys.modules, {"matplotlib": mock.MagicMock(pyplot=plots), "matplotlib.pyplot": plots}), \
            contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        for cell in cells(notebook):
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), notebook.name, "exec"), names)
    return names


def run(notebook, pictures):
    """By jupyter; what went wrong."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"PYTHONPATH": str(Path(chicane.__file__).parents[1]), "JUPYTER_PLATFORM_DIRS": "1", "HOME": folder,
                                    "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME", folder), "IPYTHONDIR": folder}
        kernel = Path(folder) / "kernels/python3"                # of this interpreter, whichever others are there
        kernel.mkdir(parents=True)
        (kernel / "kernel.json").write_text(json.dumps({"argv": [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"],
                                                        "display_name": "Python 3", "language": "python"}), encoding="utf-8")
        copy = shutil.copy(notebook, folder)
        done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--inplace", copy], cwd=folder,
                              env=environment | {"JUPYTER_PATH": folder}, capture_output=True, text=True)
        if done.returncode != 0:
            return done.stderr
        if pictures:
            images = [output["data"]["image/png"] for cell in cells(Path(copy)) for output in cell.get("outputs", ())
                      if "image/png" in output.get("data", {})]
            for n, image in enumerate(images[:1]):
                (pictures / f"notebook_{notebook.stem[2:]}.png").write_bytes(base64.b64decode(image))
    return ""


def main():
    pictures = Path(sys.argv[2]).resolve() if "--pictures" in sys.argv else None
    for module in ("nbconvert", "ipykernel", "matplotlib"):
        if subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True).returncode != 0:
            print(f"skipped: {module} is not there: apt-get install jupyter-nbconvert python3-ipykernel python3-matplotlib")
            return 77
    failed = 0
    for notebook in NOTEBOOKS:
        error = run(notebook, pictures)
        print(f"{notebook.name}: {error or 'runs'}", flush=True)
        failed += bool(error)
    return 1 if failed else 0


if __name__ == "__main__":
    if len(sys.argv) > 1:
        sys.exit(main())
    unittest.main()
