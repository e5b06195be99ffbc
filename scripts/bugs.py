"""Writes docs/bugs-you-know.md from docs/bugs.json.

    python scripts/bugs.py            # write the page
    python scripts/bugs.py --check    # exit with 1 if the page differs

Both exit with 1 if a test that a row names does not exist.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/bugs-you-know.md"
HEAD = """# Bugs you know, and the test that keeps them out

Each row names a public thread of another project, says what went wrong there, and names our test that keeps it out here.
A public report of a bug helps everyone who builds such software, and we thank the authors of these.
A thread is *fixed* if it shows a fix, *answered* if it ends with an answer or a workaround, and *open* if it shows neither.
"""


def missing(rows: list[dict[str, Any]]) -> list[str]:
    """The tests that are not in the file they name."""
    found = []
    for test in dict.fromkeys(test for row in rows for test in row["tests"]):
        path, _, name = test.partition("::")
        file = ROOT / path
        text = file.read_text(encoding="utf-8") if file.is_file() else ""
        if not re.search(rf"\b(?:fn|def) {re.escape(name)}\(", text):
            found.append(test)
    return found


def page(rows: list[dict[str, Any]]) -> str:
    """The page: one table for each topic, in the order of the rows."""
    parts = [HEAD]
    for topic in dict.fromkeys(row["topic"] for row in rows):
        parts.append(f"\n## {topic}\n\n| thread | what hurt | here | test |\n|---|---|---|---|\n")
        for row in (row for row in rows if row["topic"] == topic):
            number = row["thread"].rpartition("/")[2]
            thread = f"[{row['project']} #{number}]({row['thread']}): {row['title']} (*{row['state']}*)"
            tests = "<br>".join(f"[`{test.partition('::')[2]}`](../{test.partition('::')[0]})" for test in row["tests"])
            parts.append(f"| {thread} | {row['hurts']} | {row['here']} | {tests} |\n")
    return "".join(parts)


if __name__ == "__main__":
    ROWS = json.loads((ROOT / "docs/bugs.json").read_text(encoding="utf-8"))
    if MISSING := missing(ROWS):
        sys.exit("docs/bugs.json: found no test " + ", ".join(MISSING))
    if "--check" not in sys.argv[1:]:
        PAGE.write_text(page(ROWS), encoding="utf-8")
    elif not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != page(ROWS):
        sys.exit("docs/bugs-you-know.md: found a page that does not match docs/bugs.json; run python scripts/bugs.py")
