# SPDX-License-Identifier: MIT
"""Builds the wheel of the Python module with CMake: the build backend of pyproject.toml (PEP 517), which needs no network
and nothing but Python.

CMake builds in build/python, so that a second build takes seconds, for the interpreter that runs this. The environment may say:

    CHICANE_SIMD              instruction sets (README): native unless said otherwise; all for a wheel that is carried elsewhere
    CHICANE_PYTHON_BUILD_DIR  a build folder in which the target chicane_python is built already
"""
from __future__ import annotations

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("presets", "cars", "tracks", "scenarios")
"""Of the data that a program finds by name; the package carries them in share/chicane."""


def version() -> str:
    """Of the library."""
    text = (ROOT / "src/chicane/version.hpp").read_text(encoding="utf-8")
    return ".".join(re.findall(r"#define CHICANE_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", text))


def check_interpreter() -> None:
    """Refuses an interpreter of pyenv that has no numpy: the module that it builds could not be imported."""
    plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}  # pip's own, which hides numpy
    has_numpy = subprocess.run([sys.executable, "-c", "import numpy"], env=plain, capture_output=True).returncode == 0
    if not has_numpy and is_pyenv(sys.base_prefix):
        sys.exit(f"chicane: {sys.executable} is an interpreter of pyenv ({sys.base_prefix}), which does not see Debian's numpy: expected "
                 "one of a virtual environment made by /usr/bin/python3 -m venv --system-site-packages (docs/python.md)")


def is_pyenv(prefix: str) -> bool:
    """Whether an interpreter lies in pyenv's folder."""
    root = os.environ.get("PYENV_ROOT", "")
    return ".pyenv" in Path(prefix).parts or (bool(root) and Path(root) in Path(prefix).parents)


def run(*command: str) -> None:
    """Fails with the command that failed."""
    print("+", " ".join(command), flush=True)
    if subprocess.run(command).returncode != 0:
        sys.exit(f"chicane: this has failed: {' '.join(command)}")


def check_tools() -> None:
    """Names what is missing in one sentence, not in CMake's."""
    missing = [package for program, package in (("cmake", "cmake"), ("ninja", "ninja-build"), ("c++", "g++")) if not shutil.which(program)]
    if not list(Path("/usr").glob("include/pybind11/pybind11.h")):
        missing.append("pybind11-dev")
    if missing:
        print(f"chicane: probably missing: apt-get install {' '.join(missing)} (docs/python.md has all)", file=sys.stderr)


def compiled_package() -> Path:
    """Builds the module, and returns the folder of the package."""
    given = os.environ.get("CHICANE_PYTHON_BUILD_DIR")
    build = Path(given) if given else ROOT / "build" / "python"
    if not given:
        check_interpreter()
        check_tools()
        run("cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCHICANE_PYTHON=ON",
            f"-DCHICANE_PYTHON_EXECUTABLE={sys.executable}", f"-DCHICANE_SIMD={os.environ.get('CHICANE_SIMD', 'native')}",
            "-DCHICANE_BUILD_TESTS=OFF", "-DCHICANE_BUILD_EXAMPLES=OFF", "-DCHICANE_BUILD_APPS=OFF")
        run("cmake", "--build", str(build), "--target", "chicane_python")
    return build / "python" / "chicane"


def files_of(package: Path) -> dict[str, bytes]:
    """What the wheel holds, by the name in it."""
    files = {f"chicane/{file.name}": file.read_bytes() for file in sorted(package.iterdir())
             if file.suffix in (".py", ".pyi", ".so", ".typed") or file.name == "py.typed"}
    for folder in FOLDERS:
        for file in sorted((ROOT / "data" / folder).iterdir()):
            if file.is_file():
                files[f"chicane/share/chicane/{folder}/{file.name}"] = file.read_bytes()
    return files


def metadata() -> str:
    """Core metadata 2.1."""
    return (f"Metadata-Version: 2.1\nName: chicane\nVersion: {version()}\nSummary: Model predictive control of cars: drive, measure, "
            "train, in C++ from Python\nLicense: MIT\nRequires-Python: >=3.11\nRequires-Dist: numpy\n")


def tag() -> str:
    """Of this interpreter and system."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub(r'[-.]', '_', sysconfig.get_platform())}"


def descriptions() -> dict[str, bytes]:
    """The files that say what a wheel is, but for its record."""
    return {"METADATA": metadata().encode(),
            "WHEEL": f"Wheel-Version: 1.0\nGenerator: chicane\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode(),
            "entry_points.txt": b"[gymnasium.envs]\n__root__ = chicane:register_environments\n",
            "LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: dict[str, Any] | None = None) -> str:
    """PEP 517: the name of the folder with the metadata, without a build."""
    info = f"chicane-{version()}.dist-info"
    folder = Path(metadata_directory) / info
    folder.mkdir(parents=True)
    for name, content in descriptions().items():
        (folder / name).write_bytes(content)
    return info


def write_wheel(file: Path, files: dict[str, bytes]) -> None:
    """Packs the files with their record, the same bytes for the same content."""
    info = f"chicane-{version()}.dist-info"
    files = files | {f"{info}/{name}": content for name, content in descriptions().items()}
    record = f"{info}/RECORD"
    lines = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},{len(content)}"
             for name, content in files.items()]
    files[record] = ("\n".join([*lines, f"{record},,"]) + "\n").encode()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)


def build_wheel(wheel_directory: str, config_settings: dict[str, Any] | None = None, metadata_directory: str | None = None) -> str:
    """PEP 517: the name of the wheel in that folder."""
    name = f"chicane-{version()}-{tag()}.whl"
    write_wheel(Path(wheel_directory) / name, files_of(compiled_package()))
    return name


def build_sdist(sdist_directory: str, config_settings: dict[str, Any] | None = None) -> str:
    """PEP 517: none is made, the clone is the source."""
    raise RuntimeError("chicane: got a request for a source distribution, expected --wheel: the clone is the source")
