"""The pages of the Python API are what the sources make, and hold what a reader looks up. How they are made is in ``api_pages.py``."""

from __future__ import annotations

import ast
import importlib
import inspect
import subprocess
import sys
from pathlib import Path

import driftworld
import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "python" / "api_pages.py"
PAGES = ROOT / "docs" / "python-api"


def test_the_pages_are_not_stale() -> None:
    done = subprocess.run([sys.executable, str(PROGRAM), "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", sorted(set(driftworld.__all__) - {"__version__"}))
def test_every_exported_name_has_its_arguments(name: str) -> None:
    pages = "\n".join(path.read_text(encoding="utf-8") for path in PAGES.glob("*.md"))
    thing = getattr(driftworld, name)
    assert f"## class `{name}`" in pages if inspect.isclass(thing) else f"## `{name}()`" in pages
    if inspect.isfunction(thing):
        section = pages.split(f"\n## `{name}()`\n")[1].split("\n## ")[0]
        for argument in inspect.signature(thing).parameters.values():
            assert f"{argument.name}: " in section, f"{name}: {argument}"


def test_a_stale_page_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    api_pages = importlib.import_module("api_pages")
    monkeypatch.setattr(api_pages, "PAGES", tmp_path / "pages")
    monkeypatch.setattr(sys, "argv", ["api_pages.py"])
    api_pages.main()
    monkeypatch.setattr(sys, "argv", ["api_pages.py", "--check"])
    api_pages.main()
    (tmp_path / "pages" / "errors.md").write_text("# Errors\n", encoding="utf-8")
    (tmp_path / "pages" / "old.md").write_text("# Old\n", encoding="utf-8")
    with pytest.raises(SystemExit, match=r"errors\.md, old\.md"):
        api_pages.main()


def test_sections_of_a_docstring_become_lists(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    api_pages = importlib.import_module("api_pages")

    text = 'def f(a, *, b=1):\n    """Says.\n\n    Args:\n        a: One\n            more.\n\n    Returns:\n        ``x``, as :func:`g`.\n    """\n'
    node = ast.parse(text).body[0]
    lines = "\n".join(api_pages.docstring(node))
    assert lines == "Says.\n\n**Arguments**\n\n- `a`: One\n  more.\n\n**Returns**\n\n`x`, as `g`."
    assert api_pages.signature(node, "m.f", is_method=False) == "m.f(a, *, b = 1)"
