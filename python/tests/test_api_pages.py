"""The pages of the Python API list every public name with its arguments."""

from __future__ import annotations

import ast
import importlib
import inspect
import sys
from pathlib import Path
from typing import Any

import driftworld
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def api_pages(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The program, as a module."""
    monkeypatch.syspath_prepend(str(ROOT / "python"))
    return importlib.import_module("api_pages")


@pytest.mark.parametrize("name", sorted(set(driftworld.__all__) - {"__version__"}))
def test_every_exported_name_has_its_arguments(api_pages: Any, name: str) -> None:
    pages = "\n".join(api_pages.pages().values())
    thing = getattr(driftworld, name)
    assert f"## class `{name}`" in pages if inspect.isclass(thing) else f"## `{name}()`" in pages
    if inspect.isfunction(thing):
        section = pages.split(f"\n## `{name}()`\n")[1].split("\n## ")[0]
        for argument in inspect.signature(thing).parameters.values():
            assert f"{argument.name}: " in section, f"{name}: {argument}"


def test_name_without_a_page_is_reported(api_pages: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(api_pages, "exported", lambda: {"Variant", "Newcomer"})
    with pytest.raises(SystemExit, match="Newcomer"):
        api_pages.pages()


def test_pages_are_written_to_a_folder(api_pages: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["api_pages.py", str(tmp_path / "pages")])
    api_pages.main()
    written = {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "pages").iterdir()}
    assert written == api_pages.pages()


def test_docstring_sections_become_lists(api_pages: Any) -> None:
    text = 'def f(a, *, b=1):\n    """Says.\n\n    Args:\n        a: One\n            more.\n\n    Returns:\n        ``x``, as :func:`g`.\n    """\n'
    node = ast.parse(text).body[0]
    lines = "\n".join(api_pages.docstring(node))
    assert lines == "Says.\n\n**Arguments**\n\n- `a`: One\n  more.\n\n**Returns**\n\n`x`, as `g`."
    assert api_pages.signature(node, "m.f", is_method=False) == "m.f(a, *, b = 1)"
