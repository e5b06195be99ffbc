"""The installed wheel has types, stubs and the command, and depends only on NumPy and Gymnasium."""

from __future__ import annotations

import ast
import importlib
import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import driftworld
import pytest

#: Allowed besides the standard library; other imports are inside functions, in adapters, or in learners.
ALLOWED = {"driftworld", "gymnasium", "numpy"}


def distribution() -> importlib.metadata.Distribution:
    try:
        return importlib.metadata.distribution("driftworld")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the package is on the path but not installed, so it has no metadata")


def test_types_come_with_the_package(package: Path) -> None:
    assert (package / "py.typed").is_file()
    assert (package / "_native.pyi").is_file()


def test_only_numpy_and_gymnasium_are_needed() -> None:
    needed = [line for line in distribution().requires or [] if "extra ==" not in line]
    assert sorted(re.split(r"[<>=!~ ]", line)[0] for line in needed) == ["gymnasium", "numpy"]


def test_extras_match_the_guide() -> None:
    guide = (Path(__file__).parents[2] / "docs" / "python.md").read_text(encoding="utf-8")
    documented = set(re.findall(r"^\| `\./python\[(\w+)\]`", guide, re.MULTILINE))
    assert documented == set(distribution().metadata.get_all("Provides-Extra") or [])


def test_version_is_the_same_everywhere() -> None:
    assert distribution().version == driftworld.__version__
    done = subprocess.run([sys.executable, "-m", "driftworld", "--version"], capture_output=True, text=True, check=True)
    assert driftworld.__version__ in done.stdout


def test_modules_import_nothing_else_at_the_top(package: Path) -> None:
    known = ALLOWED | set(sys.stdlib_module_names)
    found = []
    for path in sorted(package.rglob("*.py")):
        if {"adapters", "learners"} & set(path.parts):
            continue
        for statement in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(statement, ast.Import):
                names = [alias.name for alias in statement.names]
            elif isinstance(statement, ast.ImportFrom):
                names = [statement.module or ""]
            else:
                continue
            found.extend(f"{path.name}: {name}" for name in names if name.partition(".")[0] not in known)
    assert found == []


def test_every_file_starts_with_a_docstring(package: Path) -> None:
    wrong = [
        path.name
        for path in package.rglob("*.py")
        if not ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert wrong == []


def test_every_public_name_exists_and_is_documented() -> None:
    assert sorted(driftworld.__all__) == driftworld.__all__
    for name in driftworld.__all__:
        value = getattr(driftworld, name)
        if name != "__version__":
            assert value.__doc__, name
