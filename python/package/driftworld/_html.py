"""HTML tables for notebooks."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def table(
    head: Sequence[str],
    rows: Iterable[Sequence[str]],
    caption: str = "",
    shades: Iterable[Sequence[float]] = (),
) -> str:
    """An HTML table: the first column and all text columns are left-aligned, other numeric columns
    right-aligned. All texts are escaped.

    ``shades`` gives the tint of every cell after the first, row by row, in 0..=1.
    """

    listed = [*rows]
    numeric = [all(_is_number(row[column]) for row in listed) for column in range(len(head))]
    aligned = ["right" if column and numeric[column] else "left" for column in range(len(head))]

    def cells(tag: str, texts: Sequence[str], tints: Sequence[float] = ()) -> str:
        # Translucent, so that the text is readable on light and dark pages.
        colors = ["", *(f"; background-color: rgba(66, 133, 244, {0.6 * tint:.2f})" for tint in tints)]
        colors += [""] * (len(texts) - len(colors))
        marked_up = (
            f'<{tag} style="text-align: {side}{color}">{html.escape(text)}</{tag}>'
            for side, color, text in zip(aligned, colors, texts, strict=True)
        )
        return f"<tr>{''.join(marked_up)}</tr>"

    caption_html = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    tinted = [*shades]
    body = "".join(cells("td", row, tinted[place] if tinted else ()) for place, row in enumerate(listed))
    return f"<table>{caption_html}<thead>{cells('th', head)}</thead><tbody>{body}</tbody></table>"


def _is_number(text: str) -> bool:
    """Whether a cell holds a number or the placeholder for a missing one."""
    return text in ("", "-") or text.lstrip("-+\N{MINUS SIGN}")[:1].isdigit()


def note(text: str) -> str:
    """A line below a table. The text is escaped."""
    return f'<p style="opacity: 0.7">{html.escape(text)}</p>' if text else ""


def number(value: object) -> str:
    """A table value with three decimals, ``-`` for ``None``."""
    if value is None:
        return "-"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
