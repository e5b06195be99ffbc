"""A terminal's output as an animated SVG: `screen` is its final lines, `picture` the animation.

Supports only what Driftworld's commands send: text, newlines, carriage returns, erased lines, and colours. The SVG
needs no script and no network; it stands still for readers who prefer reduced motion.
"""

from __future__ import annotations

import re
from html import escape

# Pixels: the width of a character, the height of a line, the margin, and the height of the title bar.
LETTER, LINE, RIM, BAR = 7.8, 17, 14, 26
# The shortest time between two frames in seconds: progress bars are redrawn more often than anyone can see.
SHORTEST = 0.2
# Seconds for which the last frame stays.
END = 6.0
CLASSES = {"1": "b", "2": "d", "31": "r", "32": "g", "33": "y", "34": "u", "36": "c"}
STYLE = """text{font:13px ui-monospace,SFMono-Regular,Menlo,Consolas,"DejaVu Sans Mono",monospace;fill:#d8dee9;white-space:pre}
.b{font-weight:700;fill:#fff}.d{fill:#8b95a5}.r{fill:#ff8a80}.g{fill:#a5d6a7}.y{fill:#ffe082}.u{fill:#90caf9}.c{fill:#80deea}
.p{fill:#80cbc4}"""

# A character and its classes; a line is a list of them.
Line = list[tuple[str, str]]
Events = list[tuple[float, str]]


def screen(text: str, columns: int) -> list[Line]:
    """The final lines, without a limit on their number: characters with the names of their styles."""
    lines: list[Line] = [[]]
    row, column, style = 0, 0, ""
    for part in re.findall(r"\x1b\[[0-9;?]*[A-Za-z]|[\r\n]|[^\x1b\r\n]+", text):
        if part == "\r":
            column = 0
        elif part == "\n":
            row += 1
        elif part.endswith("m") and part.startswith("\x1b"):
            codes = [code for code in part[2:-1].split(";") if code]
            style = " ".join(CLASSES[code] for code in codes if code in CLASSES)
        elif part == "\x1b[2K":
            lines[row] = []
        elif part.startswith("\x1b"):
            message = f"found the escape sequence {part!r}, expected only colours and erased lines"
            raise ValueError(message)
        else:
            for letter in part:
                if column == columns:
                    row, column = row + 1, 0
                while len(lines) <= row:
                    lines.append([])
                line = lines[row]
                line.extend([(" ", "")] * (column + 1 - len(line)))
                line[column] = (letter, style)
                column += 1
        while len(lines) <= row:
            lines.append([])
    return lines


def runs(line: Line) -> list[tuple[int, str, str]]:
    """Pieces of one style: start, characters, style. Trailing blanks are left out."""
    text = "".join(letter for letter, _ in line).rstrip()
    found: list[tuple[int, str, str]] = []
    for column, (letter, style) in enumerate(line[: len(text)]):
        if found and found[-1][2] == style:
            found[-1] = (found[-1][0], found[-1][1] + letter, style)
        else:
            found.append((column, letter, style))
    return found


def drawn(line: Line, row: int) -> str:
    """A line in its row: each piece is as wide as its characters are on a terminal, whatever the font."""
    y = row * LINE + 13
    parts = []
    for column, letters, style in runs(line):
        before = len(letters) - len(letters.lstrip())
        letters = letters.strip()
        if not letters:
            continue
        if column == 0 and letters.startswith(("$ ", "> ")):
            style = "p"
        of = f' class="{style}"' if style else ""
        width = f' textLength="{len(letters) * LETTER:.1f}" lengthAdjust="spacingAndGlyphs"' if len(letters) > 1 else ""
        parts.append(f'<text x="{(column + before) * LETTER:.1f}" y="{y}"{of}{width}>{escape(letters, quote=False)}</text>')
    return "".join(parts)


def moments(events: Events, columns: int) -> list[tuple[float, list[Line]]]:
    """The screen over time, with one frame for everything drawn within the shortest time."""
    found = []
    text = ""
    for number, (at, piece) in enumerate(events):
        text += piece
        is_last = number + 1 == len(events)
        if is_last or events[number + 1][0] - at >= SHORTEST or (not found or at - found[-1][0] >= SHORTEST):
            found.append((at, screen(text, columns)))
    return found


def picture(events: Events, columns: int, rows: int) -> str:
    """The animation."""
    # Starts when there is something to see.
    begin = events[0][0]
    shown = moments([(at - begin, text) for at, text in events], columns)
    length = shown[-1][0] + END
    # The drawn rows, by the time span during which they are on screen.
    lives: dict[tuple[float, float], list[str]] = {}
    scrolls: list[tuple[float, int]] = [(0.0, 0)]
    since: dict[int, tuple[float, Line]] = {}
    for at, lines in [*shown, (length, [])]:
        for row in range(max(len(lines), 1 + max(since, default=-1))):
            line = lines[row] if row < len(lines) else []
            before = since.get(row)
            if before and (before[1] != line or at == length):
                lives.setdefault((before[0], at), []).append(drawn(before[1], row))
                del since[row]
            if line and row not in since and at != length:
                since[row] = (at, line)
        offset = max(0, len(lines) - rows) * LINE if at != length else scrolls[-1][1]
        if offset != scrolls[-1][1]:
            scrolls.append((at, offset))
    styles, groups = [], []

    def share(seconds: float) -> str:
        return f"{100 * seconds / length:.2f}%"

    for number, ((begin, end), parts) in enumerate(sorted(lives.items())):
        content = "".join(parts)
        if not content:
            continue
        frames = f"0%{{visibility:hidden}}{share(begin)}{{visibility:visible}}" if begin > 0 else ""
        if end < length:
            frames += f"{share(end)}{{visibility:hidden}}"
        still = "visible" if end == length else "hidden"
        if frames:
            styles.append(f"@keyframes k{number}{{{frames}}}#k{number}{{visibility:{still};animation-name:k{number}}}")
        groups.append(f'<g id="k{number}" class="m">{content}</g>')
    steps = "".join(f"{share(at)}{{transform:translateY(-{offset}px)}}" for at, offset in scrolls)
    width, height = columns * LETTER + 2 * RIM, rows * LINE + BAR + RIM
    dots = "".join(f'<circle cx="{18 + 16 * place}" cy="13" r="5" fill="{color}"/>' for place, color in enumerate(("#ff5f57", "#febc2e", "#28c840")))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" width="{width:.0f}" height="{height}" role="img">\n'
        f"<title>The first hour, in a terminal of {columns} columns</title>\n"
        f"<style>{STYLE}\n.m,#s{{animation:0s step-end infinite;animation-duration:{length:.1f}s}}#s{{animation-name:s}}@keyframes s{{{steps}}}\n"
        + "\n".join(styles)
        + "\n@media (prefers-reduced-motion:reduce){.m,#s{animation:none!important}}</style>\n"
        f'<rect width="100%" height="100%" rx="8" fill="#1d232e"/>{dots}\n'
        f'<svg x="{RIM}" y="{BAR}" width="{columns * LETTER:.1f}" height="{rows * LINE}"><g id="s">\n'
        + "\n".join(groups)
        + "\n</g></svg>\n</svg>\n"
    )
