"""Measures the families of tasks, and writes a page of each: docs/families/NAME.md with its film, and docs/families.md, the list.

    python scripts/families.py target/release/driftworld measure [NAME]...    into examples/families.json
    python scripts/families.py target/release/driftworld film [NAME]...       into docs/images/families/
    python scripts/families.py target/release/driftworld pages                from these

Of each variant: what a random agent and the planner earn in 100 worlds, how often the planner succeeds, which elements differ from
the first variant in 32 pairs of worlds, and how far it is from it.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
MEASURED = ROOT / "examples/families.json"
PAGES, FILMS = ROOT / "docs/families", ROOT / "docs/images/families"
WORLDS = 100
MOST_BYTES = 160_000

#: What others call it.
ELSEWHERE = {
    "collect_health": "MiniWorld-CollectHealth, ViZDoom's health_gathering",
    "contextual_bandit": "the contextual bandit",
    "cue_t_maze": "MiniGrid-Memory, bsuite's memory_len",
    "delayed_reward": "Key-to-Door, bsuite's umbrella",
    "door_key": "MiniGrid-DoorKey",
    "dynamic_obstacles": "MiniGrid-Dynamic-Obstacles",
    "fetch": "MiniGrid-Fetch",
    "four_rooms": "MiniGrid-FourRooms, MiniWorld-FourRooms",
    "go_to_door": "MiniGrid-GoToDoor",
    "go_to_object": "MiniGrid-GoToObject, BabyAI's GoTo",
    "hallway": "MiniWorld-Hallway",
    "hidden_goal": "DMLab's explore_goal_locations",
    "k_armed": "bsuite's bandit, within an episode",
    "key_corridor": "MiniGrid-KeyCorridor",
    "lava_crossing": "MiniGrid-LavaCrossing",
    "locked_rooms": "MiniGrid-LockedRoom",
    "match_to_sample": "delayed match to sample, as in DMLab's Psychlab",
    "maze": "MiniWorld-Maze",
    "multi_room": "MiniGrid-MultiRoom",
    "nav_maze": "DMLab's nav_maze_random_goal",
    "obstacle_course": "MiniGrid-SimpleCrossing",
    "one_room": "MiniWorld-OneRoom",
    "pickup": "MiniWorld-PickupObjects",
    "push_box": "Sokoban, MiniHack's Boxoban",
    "put_next": "MiniGrid-PutNear, MiniWorld-PutNext",
    "red_blue_doors": "MiniGrid-RedBlueDoors",
    "reversal": "reversal learning",
    "sequence_recall": "Simon",
    "sidewalk": "MiniWorld-Sidewalk",
    "sign_reading": "MiniWorld-Sign",
    "t_maze": "MiniWorld-TMaze",
    "thin_ice": "FrozenLake",
    "three_rooms": "MiniWorld-ThreeRooms",
    "unlock": "MiniGrid-Unlock",
    "unlock_pickup": "MiniGrid-UnlockPickup",
    "wall_gap": "MiniWorld-WallGap",
    "water_maze": "the Morris water maze, DMLab's watermaze",
    "way_home": "ViZDoom's my_way_home",
    "y_maze": "MiniWorld-YMaze",
}


def said(command: str, *words: str) -> Any:
    """What a command prints as JSON."""
    done = subprocess.run([command, *words, "--json"], check=False, capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")
    return json.loads(done.stdout)


def families(command: str) -> dict[str, dict[str, Any]]:
    """All that come with the command, in its order."""
    return {task["task"]: task for task in said(command, "tasks")}


def measure(command: str, name: str, variants: list[str]) -> dict[str, Any]:
    """The variants of a family, in its order."""
    scales = said(command, "scales", name, "--worlds", str(WORLDS))["scales"]
    by_name = {scale["variant"].partition("#")[2]: scale for scale in scales.values()}
    elements = {each["variant"]: each for each in said(command, "elements", name)["variants"]}
    first, found = variants[0], {}
    for variant in variants:
        scale = by_name[variant]
        own = elements.get(variant, {"measured": [], "verdict": "sound"})
        far = 0.0 if variant == first else said(command, "distance", f"{name}#{first}", f"{name}#{variant}", "--worlds", "20")["total"]
        found[variant] = {
            "random": round(scale["agents"]["random"]["mean"], 2), "planner": round(scale["agents"]["onrails"]["mean"], 2),
            "success": scale["agents"]["onrails"]["success"],
            "elements": " ".join(dict.fromkeys(each["element"] for each in own["measured"])), "verdict": own["verdict"],
            "distance": round(far, 2),
        }  # fmt: skip
    return found


def film(command: str, name: str, variant: str) -> None:
    """The planner in a world of the first variant, in at most 160 kB."""
    FILMS.mkdir(parents=True, exist_ok=True)
    path = FILMS / f"{name}.gif"
    for every in (1, 2, 3, 4, 6, 8, 12):
        words = ["film", f"{name}#{variant}", "--size", "112", "--seed", "1", "--every", str(every), "-o", str(path)]
        subprocess.run([command, *words], check=True, capture_output=True)
        if path.stat().st_size <= MOST_BYTES:
            return


def page(name: str, task: dict[str, Any], measured: dict[str, Any], told: dict[str, str]) -> str:
    """The page of a family."""
    folder = "tasks" if task["group"] == "the paper's" else "worlds"
    elsewhere = f"\n\nKnown elsewhere as: {ELSEWHERE[name]}." if name in ELSEWHERE else ""
    lines = [
        f"# {name}", "", task["description"] + elsewhere, "", f"![The planner in {name}](../images/families/{name}.gif)", "",
        "| variant | what it is | differs in | distance | random | planner | succeeds |", "|---|---|---|--:|--:|--:|--:|",
    ]  # fmt: skip
    for variant, each in measured.items():
        lines.append(
            f"| `{variant}` | {told.get(variant, '')} | {each['elements']} | {each['distance']:g} | {each['random']:g} | {each['planner']:g} "
            f"| {100 * each['success']:.0f} % |"
        )
    lines += [
        "", "*differs in*: the elements in which the variant differs from the first, found by experiment. *distance*: from the first.",
        f"*random*, *planner*: mean reward in {WORLDS} worlds. *succeeds*: how often the planner does.", "",
        f"All parameters: `driftworld tasks show {name}`. Its document: [{name}.json](../../examples/{folder}/{name}.json).", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages(command: str) -> None:
    """Writes all pages and their list."""
    measured, tasks = json.loads(MEASURED.read_text(encoding="utf-8")), families(command)
    PAGES.mkdir(exist_ok=True)
    listed: dict[str, list[str]] = {}
    for name, task in tasks.items():
        told = said(command, "tasks", "show", name)["descriptions"]
        (PAGES / f"{name}.md").write_text(page(name, task, measured[name], told), encoding="utf-8")
        first = next(iter(measured[name].values()))
        row = f"| [`{name}`](families/{name}.md) | {task['description']} | {len(measured[name])} | {first['random']:g} | {first['planner']:g} |"
        listed.setdefault(task["group"], []).append(row)
    parts = [
        "# The families", "", "Every task that comes with Driftworld, by name in each command, in Python, and as a Gymnasium id",
        "(`driftworld/KeyCorridor-v0`). Rewards are those of the first variant.", "",
    ]  # fmt: skip
    for group, rows in listed.items():
        parts += [f"## {group.capitalize()}", "", "| family | what is to be done | variants | random | planner |", "|---|---|--:|--:|--:|", *rows, ""]
    (ROOT / "docs/families.md").write_text("\n".join(parts), encoding="utf-8")
    summary = ROOT / "docs/SUMMARY.md"
    lines = [line for line in summary.read_text(encoding="utf-8").splitlines() if "](families/" not in line]
    place = lines.index("- [The families](families.md)") + 1
    lines[place:place] = [f"  - [{name}](families/{name}.md)" for name in tasks]
    summary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Does what is asked."""
    command, what, *names = sys.argv[1:]
    tasks = families(command)
    if what == "pages":
        pages(command)
        return
    measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    for name in names or tasks:
        if what == "film":
            film(command, name, tasks[name]["variants"][0])
            continue
        measured[name] = measure(command, name, tasks[name]["variants"])
        ordered = {each: measured[each] for each in tasks if each in measured}
        MEASURED.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
