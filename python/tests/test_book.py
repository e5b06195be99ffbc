"""``book/build.py`` finds links, checks them, and adapts them to the book."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

PROGRAM = Path(__file__).parents[2] / "book" / "build.py"


@pytest.fixture(scope="module")
def book() -> Any:
    """The program, as a module."""
    spec = importlib.util.spec_from_file_location("book_build", PROGRAM)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_link_of_the_repository_has_a_target(book: Any) -> None:
    assert book.of_repository(book.ROOT) == []


@pytest.mark.parametrize(
    "page, expected",
    [
        ("[old](old.md) and ![x](old/y.png)", ["old.md", "old/y.png"]),
        ("[![a](b.png)](c.md)\n", ["b.png", "c.md"]),
        ("[a][b]\n\n[b]: old.md\n", ["old.md"]),
        ("`[x](old.md)`\n\n```\n[x](old.md)\n```\n", []),
    ],
)
def test_links_of_every_kind_are_found_except_in_code(book: Any, page: str, expected: list[str]) -> None:
    assert [link[0] for link in book.links(page)] == expected


@pytest.mark.parametrize("link", ["d.html", "a/c.html#z", "#x", "../p.html", "a/b.jpg"])
def test_missing_file_or_heading_is_reported(book: Any, tmp_path: Path, link: str) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "b.png").touch()
    page, other = '<h2 id="y">Y</h2><a href="a/c.html#y"><img src="a/b.png"><a href="https://a.b/c">', '<p id="y">'
    (tmp_path / "a" / "c.html").write_text(other)
    (tmp_path / "p.html").write_text(f'{page}<!-- <a href="gone"> --><script>"<a href=gone>"</script>')
    assert book.of_book(tmp_path) == []
    (tmp_path / "p.html").write_text(f'{page}<a href="{link}">')
    assert len(book.of_book(tmp_path)) == 1


def test_heading_anchors_match_links(book: Any) -> None:
    page = "# A `b` (c)\n## [D](e.md): 2 × 3\n## D\n## D\n```sh\n# no heading\n```\n"
    assert book.headings(page) == {"a-b-c", "d-2--3", "d", "d-1"}


def test_links_are_adapted_to_the_book(book: Any) -> None:
    page = "[a](../docs/worlds.md#doors) [b](https://a.org/b.md) [c](#d)"
    assert book.adapted(page, "examples/README.md", book.place) == "[a](../../worlds.md#doors) [b](https://a.org/b.md) [c](#d)"
    assert book.place("docs/how-to/README.md") == "how-to/index.md"


def test_links_with_md_in_them_lead_to_pages(book: Any, tmp_path: Path) -> None:
    """mdBook takes them for links to pages, and writes `.html` in place of `.md` and all after it."""
    book.write_sources(tmp_path / "src")
    for page in (tmp_path / "src").rglob("*.md"):
        for link in book.links(page.read_text(encoding="utf-8")):
            file = link[0].partition("#")[0]
            if ".md" in file and "://" not in file:
                assert file.endswith(".md") and (page.parent / file).exists(), f"{page}: {link[0]}"
