"""Tables for notebooks. What is in them is said where the values are."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]], caption: str = "") -> str:
    """A table as HTML, its first column at the left and the others at the right. All texts are escaped."""

    def cells(tag: str, texts: Sequence[str]) -> str:
        aligned = ["left", *["right"] * (len(texts) - 1)]
        told = (
            f'<{tag} style="text-align: {side}">{html.escape(text)}</{tag}>'
            for side, text in zip(aligned, texts, strict=True)
        )
        return f"<tr>{''.join(told)}</tr>"

    told = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    body = "".join(cells("td", row) for row in rows)
    return f"<table>{told}<thead>{cells('th', head)}</thead><tbody>{body}</tbody></table>"


def number(value: object) -> str:
    """A value of a table in three digits behind the point, ``-`` for none."""
    if value is None:
        return "-"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
