"""Tests `examples/python/text_maps.py`: walls, objects, doors and lava are at their letters, and the world is valid."""

from __future__ import annotations

import importlib.util
import random
import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from driftworld import validate

SCRIPT = Path(__file__).parents[2] / "examples" / "python" / "text_maps.py"
LEVEL = """\
*********
*P  *  A*
*   I   *
* Q *  G*
*****H***
*P
*********

.........
.AAA.BBB.
.AAA.BBB.
.AAA.BBB.
.........
.........
.........
"""


@pytest.fixture(scope="module")
def maps() -> ModuleType:
    specification = importlib.util.spec_from_file_location("text_maps", SCRIPT)
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def problems(world: dict[str, Any]) -> list[dict[str, Any]]:
    """The problems of a world. Warnings are ignored: random maps have unreachable cells."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return validate(world)


def tagged(world: dict[str, Any], tag: str) -> list[dict[str, Any]]:
    return [thing for thing in world["objects"] if thing["tag"] == tag]


def test_dmlab_level_gives_walls_objects_and_warnings(maps: ModuleType, capsys: Any) -> None:
    world = maps.dmlab("level.txt", LEVEL)
    assert problems(world) == []
    layout = world["environment_params"]["layout"]
    assert layout["text"][5] == "*P#######", "the rest of a short line is wall"
    assert (layout["cell"], layout["legend"]["H"]) == (3.125, "doorway")
    assert world["agent_params"]["coordinates"] == [-3 * 3.125, 2 * 3.125]
    assert [(thing["coordinates"], thing["reward"]) for thing in tagged(world, "apple")] == [([9.375, 6.25], 1.0)]
    assert [(thing["coordinates"], thing["reward"]) for thing in tagged(world, "goal")] == [([9.375, 0.0], 10.0)]
    assert world["rules"] == {"success": [{"touch": "goal"}]}
    assert [door["heading"] for door in tagged(world, "door")] == [90.0, 0.0]
    assert capsys.readouterr().err.splitlines() == [
        "warning: level.txt:9:1: the variations layer, which says how rooms look, is ignored",
        "warning: level.txt:4:3: the letter 'Q' is not known; it is read as floor",
        "warning: level.txt: the agent has 2 possible starts; the first is used",
    ]


def test_minigrid_grid_gives_rooms_objects_and_lava(maps: ModuleType, capsys: Any) -> None:
    grid = "WGWGWGWGWGWG\nWG>>  DY  WG\nWG  KYWGGGWG\nWGVRARWGXXWG\nWGWGWGWGWGWG\n"
    world = maps.minigrid("grid.txt", grid)
    assert problems(world) == []
    assert world["agent_params"] == {"agent_width": 2 / 3, "coordinates": [-3.0, 2.0], "heading": 90.0, "carry_limit": 1}
    assert [thing["tag"] for thing in world["objects"]] == ["yellow_key", "goal", "ball", "door"]
    (zone,) = world["environment_params"]["zones"]
    # The zone covers its whole cell: the second of the fourth row.
    assert zone["polygon"] == [[-4.0, -3.0], [-2.0, -3.0], [-2.0, -1.0], [-4.0, -1.0]]
    assert zone["ends"] == "failure"
    assert '"XX" is not known' in capsys.readouterr().err


def test_agent_without_a_start_is_not_placed_in_a_door(maps: ModuleType) -> None:
    world = maps.dmlab("level.txt", "**H**\n*   *\n*****\n")
    door, start = tagged(world, "door")[0]["coordinates"], world["agent_params"]["coordinates"]
    assert start[1] < door[1] - 1


def test_minigrid_doors_span_their_doorways_and_need_keys_of_their_colour(maps: ModuleType) -> None:
    grid = "WGWGWGWGWG\nWG>>DRKBWG\nWGLBWGWGWG\nWG__WGGGWG\nWG      WG\nWGWGWGWGWG\n"
    world = maps.minigrid("grid.txt", grid)
    assert problems(world) == []
    doors = [(door["coordinates"], door["heading"], door["scale"], door["door"]) for door in tagged(world, "door")]
    toggled = {"closes_on": ["AgentInteract"]}
    assert doors == [
        ([0.0, 3.0], 90.0, 2.0, toggled),
        ([-2.0, 1.0], 0.0, 2.0, {**toggled, "key": "blue_key"}),
        ([-2.0, -1.0], 0.0, 2.0, {**toggled, "open": True}),
    ]
    assert [key["class"] for key in tagged(world, "blue_key")] == ["key"]


def test_keys_of_several_colours_have_different_letters(maps: ModuleType) -> None:
    world = maps.minigrid("grid.txt", "WGWGWGWGWGWG\nWG>>KRKBKR  WG\nWGWGWGWGWGWG\n")
    layout = world["environment_params"]["layout"]
    assert layout["text"][1] == "#AKkK #"
    assert layout["legend"] == {"K": {"group": "red_key"}, "k": {"group": "blue_key"}}


def test_name_above_a_grid_is_skipped(maps: ModuleType) -> None:
    for name in ["<DoorKeyEnv<MiniGrid-DoorKey-5x5-v0>>", "<GoToLocal<BabyAI-GoToLocal-v0>>"]:
        world = maps.minigrid("grid.txt", f"{name}\nWGWGWG\nWG>>WG\nWGWGWG\n")
        assert world["environment_params"]["layout"]["text"] == ["###", "#A#", "###"]


@pytest.mark.parametrize("text", ["", "\n\n", "***\n***\n"])
def test_map_without_floor_is_refused(maps: ModuleType, text: str) -> None:
    with pytest.raises(SystemExit, match="found no free cell, expected at least one letter for floor"):
        maps.dmlab("letter.txt", text)


def test_text_that_is_not_a_map_is_refused(maps: ModuleType) -> None:
    with pytest.raises(SystemExit, match="33 of 34 cells are not recognised, expected a letter for each cell"):
        maps.dmlab("letter.txt", "Dear all,\nhere is the map that I promised.\n")


def test_objects_are_at_their_letters(maps: ModuleType) -> None:
    rng, num_read = random.Random(3), 0
    for _ in range(100):
        rows = ["".join(rng.choices("*PGA IH?", k=rng.randint(1, 12))) for _ in range(rng.randint(1, 9))]
        try:
            world = maps.dmlab("drawn", "\n".join(rows))
        except SystemExit:
            continue
        num_read += 1
        assert problems(world) == []
        text = world["environment_params"]["layout"]["text"]
        middle = [len(text[0]) / 2, len(text) / 2]
        for thing in world["objects"]:
            column, row = (thing["coordinates"][0] / 3.125 + middle[0], middle[1] - thing["coordinates"][1] / 3.125)
            assert text[int(row)][int(column)] in {"goal": "G", "apple": "A", "door": "IH"}[thing["tag"]]
        assert len(world["objects"]) == sum(letter in "GAIH" for row in rows for letter in row)
    assert num_read > 50


def test_script_writes_a_world(tmp_path: Path) -> None:
    (tmp_path / "level.txt").write_text("*****\n*P G*\n*****\n", encoding="utf-8")
    command = [sys.executable, str(SCRIPT), "level.txt", "--of", "dmlab", "-o", "world.json"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert validate(tmp_path / "world.json", check=True) == []
