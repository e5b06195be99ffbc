"""Converts text maps (DeepMind Lab text levels, MiniGrid grids) to worlds.

    python examples/python/text_maps.py level.txt --of dmlab -o world.json
    python examples/python/text_maps.py grid.txt --of minigrid -o world.json

DeepMind Lab: the entity layer of a text level. `*` is a wall, `P` a possible start of the agent, `G` a goal of 10 points
that ends the episode, `A` an apple of 1 point, and `I` and `H` doors, which open when the agent touches them. Cells are
3.125 m wide, as in DeepMind Lab. A variations layer after an empty line is ignored: it only affects how rooms look.

MiniGrid: the output of `env.unwrapped.pprint_grid()`, two characters per cell, of which the second is its colour. `W` is a wall, `F`
and two spaces are floor, `G` a goal of 1 point that ends the episode, `V` lava, which ends it as a failure, `K` a key,
`A` a ball, `B` a box, `D` a closed door, `L` a door unlocked by a key of its colour, `__` an open door; `>>`, `VV`,
`<<` and `^^` are the agent. It carries one object at a time. Cells are 2 m wide.

Unknown characters are read as floor and reported on standard error with line and column. Needs no packages.
"""

from __future__ import annotations

import argparse
import json
import string
import sys
from pathlib import Path
from typing import Any

FLOOR = " "
COLORS = {"R": "red", "G": "green", "B": "blue", "P": "purple", "Y": "yellow"}
HEADINGS = {">>": 90.0, "VV": 180.0, "<<": 270.0, "^^": 0.0}


class Map:
    """The layout read so far, as letters, and the objects on it."""

    def __init__(self, name: str, cell: float) -> None:
        self.name, self.cell = name, cell
        self.rows: list[list[str]] = []
        self.legend: dict[str, Any] = {}
        self.starts: list[tuple[tuple[int, int], float]] = []
        self.objects: list[tuple[dict[str, Any], tuple[int, int]]] = []
        self.doors: list[tuple[dict[str, Any], tuple[int, int]]] = []
        self.lava: list[tuple[int, int]] = []
        self.unknown: dict[str, list[tuple[int, int]]] = {}

    def warn(self, place: str, text: str) -> None:
        """Prints a warning about something that the world lacks or changes."""
        print(f"warning: {self.name}{place}: {text}", file=sys.stderr)

    def put(self, letter: str, thing: dict[str, Any], at: tuple[int, int]) -> str:
        """Adds an object; returns the letter of its group, which is a new one if another group uses the given letter."""
        group = {"group": thing["tag"]}
        self.objects.append((thing, at))
        letters = [letter, letter.lower(), *"123456789"]
        free = next((one for one in letters if self.legend.get(one, group) == group), letter)
        self.legend[free] = group
        return free

    def put_door(self, letter: str, door: dict[str, Any], color: str | None, at: tuple[int, int]) -> str:
        """Adds a door in a doorway; returns its letter."""
        self.legend[letter] = "doorway"
        paint = {"color": color} if color else {}
        self.doors.append(({"class": "door", **paint, "tag": "door", "scale": self.cell, "door": door}, at))
        return letter

    def floor_for_unknown(self, what: str, place: tuple[int, int]) -> str:
        """Records an unknown character, and returns the letter for floor."""
        self.unknown.setdefault(what, []).append(place)
        return FLOOR

    def place(self, at: tuple[int, int]) -> list[float]:
        """The centre of a cell in metres."""
        columns, rows = len(self.rows[0]), len(self.rows)
        return [(at[0] + 0.5 - columns / 2) * self.cell, (rows / 2 - 0.5 - at[1]) * self.cell]

    def is_open(self, column: int, row: int) -> bool:
        """Whether a cell is on the map and not a wall."""
        return 0 <= row < len(self.rows) and 0 <= column < len(self.rows[0]) and self.rows[row][column] not in "#*"

    def start(self) -> tuple[tuple[int, int], float] | None:
        """The agent's start: the first marked position, else the first free cell; `None` if no cell is free."""
        if self.starts:
            if len(self.starts) > 1:
                self.warn("", f"the agent has {len(self.starts)} possible starts; the first is used")
            return self.starts[0]
        self.warn("", "nothing says where the agent starts; it starts in the first free cell")
        occupied = {at for _, at in [*self.objects, *self.doors]} | set(self.lava)
        cells = ((column, row) for row in range(len(self.rows)) for column in range(len(self.rows[0])))
        return next(((at, 0.0) for at in cells if self.is_open(*at) and at not in occupied), None)

    def zones(self) -> list[dict[str, Any]]:
        """The zones of lava: one for each run of adjacent cells in a row."""
        runs: list[list[tuple[int, int]]] = []
        for column, row in self.lava:
            if runs and runs[-1][-1] == (column - 1, row):
                runs[-1].append((column, row))
            else:
                runs.append([(column, row)])
        zones = []
        for run in runs:
            (west, y), (east, _), half = self.place(run[0]), self.place(run[-1]), self.cell / 2
            low, high = (west - half, y - half), (east + half, y + half)
            corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]
            zones.append({"polygon": corners, "name": "lava", "ends": "failure", "color": "orangered"})
        return zones

    def door(self, door: dict[str, Any], at: tuple[int, int]) -> dict[str, Any]:
        """A door across its doorway. The passage runs along the axis with more open neighbours."""
        column, row = at
        along_x = self.is_open(column - 1, row) + self.is_open(column + 1, row)
        along_y = self.is_open(column, row - 1) + self.is_open(column, row + 1)
        return {**door, "coordinates": self.place(at), "heading": 90.0 if along_x > along_y else 0.0}

    def world(self, expected: str) -> dict[str, Any]:
        """Builds the world; short lines are padded with walls."""
        for what, places in sorted(self.unknown.items(), key=lambda item: item[1][0]):
            times = f" ({len(places)} occurrences, this is the first)" if len(places) > 1 else ""
            self.warn(f":{places[0][0]}:{places[0][1]}", f"{what} is not known{times}; it is read as floor")
        known = sum(letter != FLOOR for row in self.rows for letter in row)
        unknown = sum(map(len, self.unknown.values()))
        if unknown > known:
            sys.exit(f"error: {self.name}: {unknown} of {unknown + known} cells are not recognised, expected {expected}")
        columns = max(map(len, self.rows), default=0)
        self.rows = [row + ["#"] * (columns - len(row)) for row in self.rows]
        if not any(self.is_open(column, row) for row in range(len(self.rows)) for column in range(columns)):
            sys.exit(f"error: {self.name}: found no free cell, expected at least one letter for floor")
        used = {letter for row in self.rows for letter in row}
        layout = {
            "text": ["".join(row) for row in self.rows],
            "cell": self.cell,
            "height": min(self.cell, 4.0),
            "legend": {letter: meaning for letter, meaning in sorted(self.legend.items()) if letter in used},
        }
        # The agent fits through a single cell, as in the original environment.
        agent: dict[str, Any] = {"agent_width": min(self.cell / 3, 1.0)}
        if start := self.start():
            agent |= {"coordinates": self.place(start[0]), "heading": start[1]}
        agent["carry_limit"] = int(any("portable" in thing for thing, _ in self.objects))
        goals = [thing for thing, _ in self.objects if thing["tag"] == "goal"]
        things = [{**thing, "coordinates": self.place(at)} for thing, at in self.objects]
        return {
            "environment_params": {"layout": layout, "zones": self.zones()},
            "agent_params": agent,
            "rules": {"success": [{"touch": "goal"}]} if goals else {},
            "objects": things + [self.door(door, at) for door, at in self.doors],
        }


def thing(kind: str, color: str, group: str) -> dict[str, Any]:
    """An object that the agent passes through."""
    return {"class": kind, "color": color, "solid": False, "tag": group}


def pays(reward: float) -> dict[str, Any]:
    """Properties of an object that pays once on contact and then disappears."""
    return {"reward": reward, "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"]}


def variations(lines: list[str]) -> int:
    """Index of the first line of the variations layer, or the number of lines if there is none. The layer follows an empty
    line, has as many lines as the entity layer, and contains only capital letters, dots and spaces.
    """
    nonempty = [number for number, line in enumerate(lines) if line]
    first = nonempty[0] if nonempty else 0
    empty = next((number for number in range(first, len(lines)) if not lines[number]), len(lines))
    rest = [number for number in nonempty if number > empty]
    allowed = set(string.ascii_uppercase + ". ")
    is_layer = rest and len(rest) == empty - first and all(set(lines[number]) <= allowed for number in rest)
    return rest[0] if is_layer else len(lines)


def dmlab(name: str, text: str) -> dict[str, Any]:
    """The world of a DeepMind Lab text level, from its entity layer."""
    level, lines = Map(name, 3.125), text.splitlines()
    end = variations(lines)
    if end < len(lines):
        level.warn(f":{end + 1}:1", "the variations layer, which says how rooms look, is ignored")
    for number, line in enumerate(lines[:end]):
        if not line:
            continue
        row: list[str] = []
        for column, letter in enumerate(line):
            at, place, kept = (column, len(level.rows)), (number + 1, column + 1), letter
            if letter == "P":
                level.starts.append((at, 0.0))
            elif letter == "G":
                level.put(letter, {**thing("geometric", "gold", "goal"), **pays(10.0)}, at)
            elif letter == "A":
                level.put(letter, {**thing("icosphere", "limegreen", "apple"), **pays(1.0), "scale": 0.5}, at)
            elif letter in "IH":
                level.put_door(letter, {"opens_on": ["AgentCollide"]}, None, at)
            elif letter not in "* ":
                kept = level.floor_for_unknown(f"the letter {letter!r}", place)
            row.append(kept)
        level.rows.append(row)
    return level.world("a letter for each cell, such as * for a wall, P for the start, G for a goal")


def minigrid(name: str, text: str) -> dict[str, Any]:
    """The world of a MiniGrid grid."""
    level = Map(name, 2.0)
    for number, line in enumerate(text.splitlines()):
        shown = line.strip()
        # The environment's name may precede the grid, which has no lower-case letters.
        if not line or (shown.startswith("<") and shown.endswith(">") and shown != shown.upper()):
            continue
        # Trailing spaces may have been stripped.
        pairs = [line[column : column + 2].ljust(2) for column in range(0, len(line), 2)]
        row = len(level.rows)
        cells = [cell_of_minigrid(level, pair, (column, row), (number + 1, 2 * column + 1)) for column, pair in enumerate(pairs)]
        level.rows.append(cells)
    return level.world("two characters for each cell, such as WG for a wall, >> for the agent, GG for a goal")


def cell_of_minigrid(level: Map, pair: str, at: tuple[int, int], place: tuple[int, int]) -> str:
    """The layout letter for two characters; also adds the object there."""
    what, color = pair[0], COLORS.get(pair[1])
    toggled = {"closes_on": ["AgentInteract"]}
    if pair in HEADINGS:
        level.starts.append((at, HEADINGS[pair]))
        return "A"
    if pair == "__":
        return level.put_door("D", {**toggled, "open": True}, None, at)
    if pair == "  " or what in "WF":
        return "#" if what == "W" else FLOOR
    if color is None or what not in "VDLGKAB":
        return level.floor_for_unknown(f'"{pair}"', place)
    if what == "V":
        level.lava.append(at)
        level.legend["V"] = "floor"
        return "V"
    if what in "DL":
        lock = {"key": f"{color}_key"} if what == "L" else {}
        return level.put_door("D", {**toggled, **lock}, color, at)
    if what == "G":
        return level.put("G", {**thing("geometric", color, "goal"), **pays(1.0)}, at)
    kind, group = {"K": ("key", f"{color}_key"), "A": ("icosphere", "ball"), "B": ("cube", "box")}[what]
    # In a layout, `A` is the agent.
    return level.put("O" if what == "A" else what, {**thing(kind, color, group), "portable": {}}, at)


READERS = {"dmlab": dmlab, "minigrid": minigrid}


def main() -> None:
    """Reads a map and writes its world."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("map", type=Path, help="the text file")
    parser.add_argument("--of", choices=READERS, required=True, help="the format of the map")
    parser.add_argument("-o", "--output", type=Path, help="file to write (default: standard output)")
    args = parser.parse_args()
    world = READERS[args.of](args.map.name, args.map.read_text(encoding="utf-8"))
    text = json.dumps(world, indent=2) + "\n"
    if args.output:
        args.output.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
