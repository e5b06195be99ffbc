"""Builds the book: the pages of docs/ in the order of docs/SUMMARY.md, the Python API, and the files that pages link
to.

    python book/build.py --check           checks all links in the repository's pages, and that SUMMARY.md has all of docs/
    python book/build.py target/book       the same, then builds the book into a folder, and checks all its links

mdBook makes the HTML: `cargo install mdbook --version 0.5.4 --locked --no-default-features --features search`, or its
path in DRIFTWORLD_MDBOOK. Links to other sites are not checked, because that needs the network.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "python"))
import api_pages

#: The summary's line after which the pages of the Python API are inserted.
BEFORE_THE_API = "- [Driftworld from Python](python.md)\n"
CODE = re.compile(r"^```.*?^```|`[^`\n]*`|^    .*?$", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"(?<=\]\()[^)\s]+(?=[)\s])|(?<=\]: )\S+")
LINK_OF_HTML = re.compile(r'\s(?:href|src)="([^"]*)"')
#: Parts of an HTML page without links: scripts and comments.
UNREAD = re.compile(r"<script.*?</script>|<!--.*?-->", re.DOTALL)


def links(page: str) -> Iterator[re.Match[str]]:
    """The targets of links and images in Markdown, ignoring code."""
    yield from LINK.finditer(CODE.sub(lambda code: " " * len(code[0]), page))


def headings(page: str) -> set[str]:
    """The anchors of a Markdown page."""
    found: list[str] = []
    fences = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
    for line in re.findall(r"^#+ (.*)$", fences.sub("", page), re.MULTILINE):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line).lower()
        name = re.sub(r"[^\w -]", "", text).strip().replace(" ", "-")
        found.append(name if name not in found else f"{name}-{found.count(name)}")
    return set(found)


def broken(root: Path, pages: dict[str, tuple[list[str], set[str]]]) -> list[str]:
    """Links to missing files below `root`, or to missing anchors; `pages` are links and anchors by path."""
    findings = []
    for path, (targets, _) in pages.items():
        for target in targets:
            if not target or re.match(r"[a-z]+:", target):
                continue
            file, _, place = target.partition("#")
            found = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
            if not (root / found).exists() or found.startswith(".."):
                findings.append(f"{path}: found a link to {target}, expected a file")
            elif place and found in pages and place not in pages[found][1]:
                findings.append(f"{path}: found a link to {target}, expected a heading of {found}")
    return findings


def of_repository(root: Path) -> list[str]:
    """Broken links of all Markdown that git does not ignore, and pages of docs/ that are not chapters."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=root, check=True, capture_output=True, text=True
    )
    texts = {path: (root / path).read_text(encoding="utf-8") for path in listed.stdout.split() if (root / path).exists()}
    findings = broken(root, {path: ([m[0] for m in links(text)], headings(text)) for path, text in texts.items()})
    chapters = [*chapters_of(texts["docs/SUMMARY.md"]), "docs/SUMMARY.md"]
    lost = [path for path in texts if path.startswith("docs/") and path not in chapters]
    return findings + [f"{path}: found no chapter, expected every page of docs/ in docs/SUMMARY.md" for path in lost]


def of_book(book: Path) -> list[str]:
    """Broken links of all HTML below a folder."""
    pages = {}
    for path in book.rglob("*.html"):
        text = UNREAD.sub("", path.read_text(encoding="utf-8"))
        pages[path.relative_to(book).as_posix()] = (LINK_OF_HTML.findall(text), set(re.findall(r'\sid="([^"]*)"', text)))
    return broken(book, pages)


def chapters_of(summary: str) -> list[str]:
    """The pages of the summary, relative to the root."""
    return [os.path.normpath(f"docs/{link[0]}") for link in links(summary)]


def place(path: str) -> str:
    """The path of a page in the book: pages of docs/ keep their names, others go under project/."""
    out = path.removeprefix("docs/") if path.startswith("docs/") or path == "README.md" else f"project/{path}"
    return re.sub(r"README\.md$", "index.md", out)


def adapted(page: str, path: str, target: Callable[[str], str]) -> str:
    """A page with its links adapted to the book; `target` maps a path from the root."""
    for link in reversed(list(links(page))):
        file, mark, anchor = link[0].partition("#")
        if file and not re.match(r"[a-z]+:", file):
            found = target(os.path.normpath(os.path.join(os.path.dirname(path), file)))
            new = os.path.relpath(found, os.path.dirname(place(path)) or ".") + mark + anchor
            page = page[: link.start()] + new + page[link.end() :]
    return page


def write_sources(folder: Path) -> None:
    """Writes mdBook's input: docs/ with the pages from elsewhere, and each linked file as text that browsers show."""
    pages = {f"docs/python-api/{name}": text for name, text in api_pages.pages().items()}
    summary = (ROOT / "docs/SUMMARY.md").read_text(encoding="utf-8")
    names = [("Every name", "README"), *((title, slug) for slug, (title, *_) in api_pages.LAYOUT.items())]
    chapters = "".join(f"  - [{title}](python-api/{name}.md)\n" for title, name in names)
    summary = summary.replace(BEFORE_THE_API, BEFORE_THE_API + chapters)
    for path in chapters_of(summary):
        if path not in pages:
            pages[path] = (ROOT / path).read_text(encoding="utf-8")

    def target(path: str) -> str:
        if path == "docs/SUMMARY.md":
            return "toc.html"
        if path in pages or f"{path}/README.md" in pages:
            return place(path if path in pages else f"{path}/README.md")
        if path.startswith("docs/"):
            return path.removeprefix("docs/")
        full = ROOT / path
        # mdBook takes any link with `.md` in it for a page's.
        name = f"files/{path.removesuffix('.md')}.txt"
        shown = folder / name
        shown.parent.mkdir(parents=True, exist_ok=True)
        if full.is_dir():
            shown.write_text("\n".join(sorted(each.name for each in full.iterdir() if each.name[0] not in "._")))
        else:
            shutil.copyfile(full, shown)
        return name

    shutil.copytree(ROOT / "docs", folder, ignore=shutil.ignore_patterns("*.md"))
    for path, text in {"docs/SUMMARY.md": summary, **pages}.items():
        out = folder / place(path)
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(adapted(text, path, target), encoding="utf-8")


def build(book: Path) -> None:
    """Builds the book into a folder."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)
        shutil.copytree(ROOT / "book", source, dirs_exist_ok=True)
        write_sources(source / "src")
        program = os.environ.get("DRIFTWORLD_MDBOOK", "mdbook")
        subprocess.run([program, "build", source, "--dest-dir", book.resolve()], check=True)


def main() -> None:
    """Checks the pages; with a folder, also builds the book there."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    findings = of_repository(ROOT)
    if not findings and sys.argv[1] != "--check":
        build(Path(sys.argv[1]))
        findings = of_book(Path(sys.argv[1]))
    if findings:
        sys.exit("\n".join([*findings, f"{len(findings)} broken links; correct them, or restore their targets"]))


if __name__ == "__main__":
    main()
