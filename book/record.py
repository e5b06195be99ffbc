"""Records the first hour as a new user would type it: the commands of `docs/first-hour.md`, in a terminal of 80
columns.

    python book/record.py target/release/driftworld      writes the three files below
    python book/record.py --check                        fails if they disagree, or lack a command of the tutorial

`docs/recordings/first-hour.cast` is the timed terminal output (asciicast v2, for asciinema);
`docs/images/first-hour.svg` is the same as an animation (`terminal_picture.py`); `docs/first-hour-recording.md` is the
final screen. The last two are made from the first. Tests in `tests/pages/` check that the commands still print the
same.

The commands run in a temporary folder, in a pseudo-terminal. Their timing is recorded; that of typing and reading is
simulated. Needs only Python on Unix.
"""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
import time
from itertools import pairwise
from pathlib import Path

from terminal_picture import picture, screen

ROOT = Path(__file__).parents[1]
TUTORIAL = ROOT / "docs" / "first-hour.md"
CAST = ROOT / "docs" / "recordings" / "first-hour.cast"
PICTURE = ROOT / "docs" / "images" / "first-hour.svg"
PAGE = ROOT / "docs" / "first-hour-recording.md"
COLUMNS, ROWS = 80, 24
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
HEAD = """# The first hour, recorded

The contents of an 80-column terminal after typing the commands of [the first hour](first-hour.md) one after the other.
Files are saved between commands, as the page says.

![A terminal in which the commands of the first hour are typed](images/first-hour.svg)

The recording itself is [first-hour.cast](recordings/first-hour.cast), for `asciinema play`. The tests compare it with what
the commands print. `python book/record.py target/release/driftworld` records it again. The whole screen:

"""
# Seconds to type a word and to read a line; the minimum and maximum for all lines of a command.
TYPING, READING, SHORTEST, LONGEST = 0.12, 0.15, 1.0, 5.0

Events = list[tuple[float, str]]


def steps() -> list[tuple[str, str]]:
    """The tutorial's steps: files to save, by name, and commands to type, under the name `$`."""
    found = []
    for language, marks, text in BLOCK.findall(TUTORIAL.read_text(encoding="utf-8")):
        name = re.search(r"file=(\S+)", marks)
        if name:
            found.append((name[1], text))
        elif language == "sh" and "by-hand" not in marks:
            found += [("$", command) for command in re.split(r"(?<!\\)\n", text) if command]
    return found


def typed(command: str) -> list[str]:
    """A command as typed, word by word; continuation lines start with `>`."""
    lines = [("$ " if number == 0 else "> ") + line.strip() for number, line in enumerate(command.split("\n"))]
    words = re.findall(r"\S+ ?", "\n".join(lines).replace("\n", " \n"))
    text = "\r\n".join(lines)
    pieces, rest = [], text
    for word in words:
        at = rest.index(word.strip()) + len(word.strip())
        pieces.append(rest[:at])
        rest = rest[at:]
    return [*pieces, rest + "\r\n"]


def run(command: str, folder: Path, program: Path) -> Events:
    """A command's terminal output, with the seconds since its start."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
    environment = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "NO_COLOR")}
    environment |= {"PATH": f"{program.resolve().parent}{os.pathsep}{os.environ['PATH']}", "TERM": "xterm-256color"}
    begun = time.monotonic()
    child = subprocess.Popen(["bash", "-c", command], cwd=folder, env=environment, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    events, pending = [], b""
    while True:
        try:
            piece = os.read(ours, 65536)
        except OSError:  # On Linux, when the other end is closed.
            break
        if not piece:
            break
        pending += piece
        # A character may be split between two reads.
        whole = pending.decode(errors="ignore")
        pending = pending[len(whole.encode()) :]
        events.append((time.monotonic() - begun, whole))
    os.close(ours)
    if child.wait() != 0:
        sys.exit(f"record: `{command}` ended with {child.returncode}:\n{''.join(text for _, text in events)}")
    return events


def record(program: Path) -> str:
    """Makes the recording."""
    events: Events = []
    now = 0.0

    def show(text: str, seconds: float) -> None:
        nonlocal now
        now += seconds
        events.append((now, text))

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for what, text in steps():
            if what != "$":
                (folder / what).write_text(text, encoding="utf-8")
                lines = len(text.splitlines())
                show(f"(save {what}: {lines} line{'s' if lines > 1 else ''})\r\n\r\n", 1.0)
                continue
            for word in typed(text):
                show(word, TYPING)
            drawn = run(text, folder, program)
            begun = now
            for seconds, piece in drawn:
                show(piece, begun + seconds - now)
            lines = sum(piece.count("\n") for _, piece in drawn)
            show("\r\n", min(max(SHORTEST, lines * READING), LONGEST))
    header = {"version": 2, "width": COLUMNS, "height": ROWS, "title": "The first hour of Driftworld"}
    lines = [json.dumps(header), *(json.dumps([round(at, 3), "o", text], ensure_ascii=False) for at, text in events)]
    return "\n".join(lines) + "\n"


def read(cast: str) -> Events:
    """The events of a recording."""
    header, *events = [json.loads(line) for line in cast.splitlines()]
    assert header["version"] == 2 and header["width"] == COLUMNS, header
    assert all(before[0] <= after[0] for before, after in pairwise(events)), "times rise"
    return [(at, text) for at, kind, text in events if kind == "o"]


def page(events: Events) -> str:
    """The page with the final screen."""
    lines = ["".join(letter for letter, _ in line).rstrip() for line in screen("".join(text for _, text in events), COLUMNS)]
    return HEAD + "```text\n" + "\n".join(lines).strip() + "\n```\n"


def check() -> None:
    """Fails if the files disagree, a command of the tutorial is missing, or a line is wider than the terminal."""
    events = read(CAST.read_text(encoding="utf-8"))
    wrong = [
        f"{path.relative_to(ROOT)} does not match the recording"
        for path, made in ((PAGE, page(events)), (PICTURE, picture(events, COLUMNS, ROWS)))
        if path.read_text(encoding="utf-8") != made
    ]
    shown = page(events).splitlines()
    wrong += [
        f"found no `{text}` in the recording"
        for what, text in steps()
        if what == "$" and f"$ {text.split(chr(10))[0]}" not in shown
    ]
    begin = shown.index("```text")
    wrong += [f"too wide: {line}" for line in shown[begin:] if len(line) > COLUMNS and not line.startswith("$")]
    if wrong:
        sys.exit("\n".join([*wrong, "python book/record.py PROGRAM records it again"]))


def main() -> None:
    """Records, or checks the recording."""
    [argument] = sys.argv[1:] or ["--check"]
    if argument == "--draw":
        pass
    elif argument != "--check":
        CAST.write_text(record(Path(argument)), encoding="utf-8")
    if argument != "--check":
        events = read(CAST.read_text(encoding="utf-8"))
        PAGE.write_text(page(events), encoding="utf-8")
        PICTURE.write_text(picture(events, COLUMNS, ROWS), encoding="utf-8")
    check()


if __name__ == "__main__":
    main()
