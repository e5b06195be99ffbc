"""Records the first hour as a stranger would type it: the commands of `docs/first-hour.md`, in a terminal of 80 columns.

    python book/record.py target/release/driftworld      writes docs/first-hour-recording.md
    python book/record.py --check                        fails if a command of the tutorial is not in it

The commands run in a folder of their own, in a pseudo-terminal. What is written down is what stands on the screen: progress bars
that were drawn over are gone. Needs Python on a Unix, and nothing else.
"""

from __future__ import annotations

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
from pathlib import Path

ROOT = Path(__file__).parents[1]
TUTORIAL = ROOT / "docs" / "first-hour.md"
RECORDING = ROOT / "docs" / "first-hour-recording.md"
COLUMNS, ROWS = 80, 200
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
HEAD = """# The first hour, recorded

What stands on a terminal of 80 columns when the commands of [the first hour](first-hour.md) are typed one after the other.
Files are saved between them, as the page says. `python book/record.py target/release/driftworld` records it anew.

"""


def steps() -> list[tuple[str, str]]:
    """What a reader does: files to save, by name, and commands to type, under the name `$`."""
    found = []
    for language, marks, text in BLOCK.findall(TUTORIAL.read_text(encoding="utf-8")):
        name = re.search(r"file=(\S+)", marks)
        if name:
            found.append((name[1], text))
        elif language == "sh" and "by-hand" not in marks:
            found += [("$", command) for command in re.split(r"(?<!\\)\n", text) if command]
    return found


def screen(text: str) -> list[str]:
    """The lines of a screen after everything was drawn: moves, erasures and overwriting; colours are left out."""
    lines, row, column = [""], 0, 0
    for part in re.findall(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[^\[]|[\r\n\b]|[^\x1b\r\n\b]+", text):
        if part == "\r":
            column = 0
        elif part == "\n":
            row += 1
        elif part == "\b":
            column = max(column - 1, 0)
        elif part.startswith("\x1b["):
            count = int(re.match(r"\d*", part[2:])[0] or 1)
            if part.endswith("A"):
                row = max(row - count, 0)
            elif part.endswith("B"):
                row += count
            elif part.endswith("G"):
                column = count - 1
            elif part.endswith("K"):
                lines[row] = "" if part == "\x1b[2K" else lines[row][:column]
            elif part.endswith("J"):
                lines[row] = lines[row][:column]
                del lines[row + 1 :]
        elif not part.startswith("\x1b"):
            for letter in part:
                if column == COLUMNS:
                    row, column = row + 1, 0
                while len(lines) <= row:
                    lines.append("")
                line = lines[row].ljust(column)
                lines[row] = line[:column] + letter + line[column + 1 :]
                column += 1
        while len(lines) <= row:
            lines.append("")
    return [line.rstrip() for line in lines]


def run(command: str, folder: Path, program: Path) -> list[str]:
    """What a command draws on a terminal."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
    path = f"{program.resolve().parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "TERM": "xterm-256color"}
    child = subprocess.Popen(["bash", "-c", command], cwd=folder, env=environment, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    drawn = b""
    while True:
        try:
            piece = os.read(ours, 65536)
        except OSError:  # Linux says so when the other end is closed.
            break
        if not piece:
            break
        drawn += piece
    os.close(ours)
    if child.wait() != 0:
        sys.exit(f"record: `{command}` ended with {child.returncode}:\n{drawn.decode(errors='replace')}")
    lines = screen(drawn.decode(errors="replace"))
    while lines and not lines[-1]:
        lines.pop()
    return lines


def record(program: Path) -> str:
    """The page."""
    session = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for what, text in steps():
            if what != "$":
                (folder / what).write_text(text, encoding="utf-8")
                session += [f"(save {what}: {len(text.splitlines())} lines)", ""]
                continue
            first, *rest = text.split("\n")
            session += [f"$ {first}", *(f"> {line.strip()}" for line in rest), *run(text, folder, program), ""]
    return HEAD + "```text\n" + "\n".join(session).strip() + "\n```\n"


def check(page: str) -> None:
    """Fails if a command of the tutorial is missing, or a line is wider than the terminal."""
    typed = [line for what, text in steps() if what == "$" for line in [f"$ {text.split(chr(10))[0]}"]]
    shown = page.splitlines()
    missing = [line for line in typed if line not in shown]
    block = page.split("```text\n")[1].split("```")[0]
    wide = [line for line in block.splitlines() if len(line) > COLUMNS and not line.startswith("$")]
    if missing or wide:
        sys.exit(f"docs/first-hour-recording.md: found no {missing}, and too wide {wide}; python book/record.py PROGRAM records it anew")


def main() -> None:
    """Records, or checks the recording."""
    [argument] = sys.argv[1:] or ["--check"]
    if argument == "--check":
        check(RECORDING.read_text(encoding="utf-8"))
    else:
        RECORDING.write_text(record(Path(argument)), encoding="utf-8")
        check(RECORDING.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
