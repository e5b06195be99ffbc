"""Takes pictures of the book, as `cargo xtask docs` makes it, at the widths of a desktop and of a phone.

    python book/screenshots.py target/book [chromium]     writes docs/images/book-*.png

Needs Chromium, in PATH or named by DRIFTWORLD_BROWSER or the second argument; no network.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
# Name, page of the book, width and height in pixels. A browser's window is never as narrow as a phone: there the page
# stands in a frame of that width.
PICTURES = [
    ("book-desktop.png", "first-hour.html", 1100, 700),
    ("book-search.png", "concepts.html?search=forgetting", 1100, 560),
    ("book-phone.png", "tasks.html#find-objects", 390, 760),
]
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--allow-file-access-from-files",
    "--virtual-time-budget=6000",
]


def browser(flags: list[str], page: str, program: str) -> None:
    """Opens a page in a browser."""
    with tempfile.TemporaryDirectory() as profile:
        command = [program, *FLAGS, f"--user-data-dir={profile}", *flags, page]
        subprocess.run(command, check=True, capture_output=True)


def framed(page: str, width: int, height: int) -> str:
    """A page with another in a frame of this size."""
    style = f"border:0;width:{width}px;height:{height}px;display:block"
    return f'<body style="margin:0"><iframe src="{page}" style="{style}"></iframe></body>'


def take(book: Path, program: str) -> None:
    """Takes every picture."""
    for name, page, width, height in PICTURES:
        with tempfile.NamedTemporaryFile("w", suffix=".html") as frame:
            frame.write(framed((book / page.split("?")[0].split("#")[0]).as_uri() + re.sub(r"^[^?#]*", "", page), width, height))
            frame.flush()
            browser([f"--screenshot={IMAGES / name}", f"--window-size={width},{height}"], Path(frame.name).as_uri(), program)
        print(f"wrote {(IMAGES / name).relative_to(ROOT)}")


def main() -> None:
    """Takes the pictures."""
    book, *named = sys.argv[1:]
    program = (named or [os.environ.get("DRIFTWORLD_BROWSER") or shutil.which("chromium") or "chromium"])[0]
    take(Path(book).resolve(), program)


if __name__ == "__main__":
    main()
