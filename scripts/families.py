"""Measures the task families, and writes a page with a film for each, docs/families/NAME.md, and their list,
docs/families.md.

    python scripts/families.py target/release/driftworld measure [NAME]...    writes examples/families.json
    python scripts/families.py target/release/driftworld film [NAME]...       writes docs/images/families/: films, and pictures of all variants
    python scripts/families.py target/release/driftworld sheet                writes docs/images/families.png, all families in one picture
    python scripts/families.py target/release/driftworld pages                writes the pages from the above and examples/families_learned.json

scripts/learn_families.py writes the last file. Pictures need Pillow.

Measures for each variant the mean rewards of a random agent and of the planner in 1,000 worlds, the planner's success
rate, the elements that differ from the first variant, and the distance from the first variant.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
MEASURED, LEARNED = ROOT / "examples/families.json", ROOT / "examples/families_learned.json"
FILMS = ROOT / "docs/images/families"
WORLDS = 1000
MAX_BYTES = 160_000

#: Names of the same tasks in other projects.
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
    "t_maze": "the T-maze of psychology",
    "thin_ice": "FrozenLake",
    "three_rooms": "MiniWorld-ThreeRooms",
    "unlock": "MiniGrid-Unlock",
    "unlock_pickup": "MiniGrid-UnlockPickup",
    "wall_gap": "MiniWorld-WallGap",
    "water_maze": "the Morris water maze, DMLab's watermaze",
    "way_home": "ViZDoom's my_way_home",
    "y_maze": "MiniWorld-YMaze, MiniWorld-TMaze",
}


#: Reasons why the planner succeeds in less than 99 % of the worlds.
REASONS = {
    "find_objects#penalty": "The cubes cost, so it is best to touch none: nobody succeeds.",
    "find_objects#slow": "The time limit is sometimes too short.",
    "moving_object#stings": "The balls cost, so it is best to touch none: nobody succeeds.",
}


def run_json(command: str, *words: str) -> Any:
    """A command's JSON output."""
    process = subprocess.run([command, *words, "--json"], check=False, capture_output=True, text=True)
    if process.returncode not in (0, 1) or not process.stdout:
        raise SystemExit(f"{' '.join(words)}: {process.stderr}")
    return json.loads(process.stdout)


def families(command: str) -> dict[str, dict[str, Any]]:
    """All built-in families, in the command's order."""
    return {task["task"]: task for task in run_json(command, "tasks")}


def measure(command: str, name: str, variants: list[str]) -> dict[str, Any]:
    """Measures the variants of a family, in the given order."""
    scales = run_json(command, "scales", name, "--worlds", str(WORLDS))["scales"]
    by_name = {scale["variant"].partition("#")[2]: scale for scale in scales.values()}
    elements = {each["variant"]: each for each in run_json(command, "elements", name)["variants"]}
    first, found = variants[0], {}
    for variant in variants:
        scale = by_name[variant]
        own = elements.get(variant, {"measured": [], "verdict": "sound"})
        distance = 0.0 if variant == first else run_json(command, "distance", f"{name}#{first}", f"{name}#{variant}", "--worlds", "20")["total"]
        found[variant] = {
            "random": round(scale["agents"]["random"]["mean"], 2), "planner": round(scale["agents"]["onrails"]["mean"], 2),
            "success": scale["agents"]["onrails"]["success"],
            "elements": " ".join(dict.fromkeys(each["element"] for each in own["measured"])), "verdict": own["verdict"],
            "distance": round(distance, 2),
        }  # fmt: skip
    return found


def film(command: str, name: str, variants: list[str]) -> None:
    """Films the planner in a world of the first variant, in at most 160 kB if possible, and draws the first 16 variants in
    one image.
    """
    variant = variants[0]
    FILMS.mkdir(parents=True, exist_ok=True)
    path = FILMS / f"{name}.gif"
    for every in (1, 2, 3, 4, 6, 8, 12):
        words = ["film", f"{name}#{variant}", "--size", "112", "--seed", "1", "--every", str(every), "-o", str(path)]
        subprocess.run([command, *words], check=True, capture_output=True)
        if path.stat().st_size <= MAX_BYTES:
            break
    sheet(command, [f"{name}#{each}" for each in variants[:16]], FILMS / f"{name}.png", 4)


def sheet(command: str, variants: list[str], path: Path, columns: int) -> None:
    """Draws variants in one image with few colours."""
    from PIL import Image

    words = ["sheet", *variants, "--size", "84", "--columns", str(columns), "-o", str(path)]
    subprocess.run([command, *words], check=True, capture_output=True)
    with Image.open(path) as drawn:
        drawn.convert("RGB").quantize(128).save(path, optimize=True)


def curve(name: str, runs: dict[str, list[dict[str, Any]]], scale: dict[str, float]) -> str:
    """An SVG of learning curves: thin lines for seeds, a bold line for their mean, and grey lines for the random agent and
    the planner.
    """
    width, height, left = 300, 120, 60
    shown = [each for seeds in runs.values() for run in seeds for each in run["curve"]] + [scale["random"], scale["planner"]]
    low, high = min(shown), max(shown)

    def y(value: float) -> float:
        return round(height * (high - value) / (high - low), 1)

    parts = []
    for agent in ("random", "planner"):
        parts.append(f'<path stroke="#999" stroke-dasharray="4" d="M0 {y(scale[agent])}H{width}"/>')
        parts.append(f'<text x="-4" y="{y(scale[agent]) + 4}" text-anchor="end">{agent}</text>')
    for learner, color in zip(runs, ("#0b5394", "#b45f06"), strict=False):
        seeds = [run["curve"] for run in runs[learner]]
        for line, stroke in [*((each, 0.8) for each in seeds), ([sum(each) / len(each) for each in zip(*seeds, strict=True)], 2.5)]:
            points = " ".join(f"{width * (k + 0.5) / len(line):.0f} {y(value)}" for k, value in enumerate(line))
            parts.append(f'<path stroke="{color}" stroke-width="{stroke}" d="M{points}"/>')
        label = learner.replace("recurrent_ppo", "recurrent PPO").replace("ppo", "PPO")
        parts.append(f'<text x="{width + 4}" y="{y(line[-1]) + 4}" style="fill:{color}">{label}</text>')
    size = f'width="{left + width + 100}" height="{height + 30}" viewBox="{-left} -8 {left + width + 100} {height + 30}"'
    style = "svg{background:#fff}text{font:12px sans-serif;fill:#333}path{fill:none}"
    foot = f'<text x="{width}" y="{height + 18}" text-anchor="end">100,000 decisions</text>'
    title = f"<title>Mean reward while {name} is learned</title>"
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{title}<style>{style}</style>{"".join(parts)}{foot}</svg>\n'


def share(reward: float, scale: dict[str, float]) -> float:
    """A reward in per cent of the range from the random agent's reward to the planner's."""
    return 100 * (reward - scale["random"]) / (scale["planner"] - scale["random"])


def result_lines(runs: dict[str, list[dict[str, Any]]], scale: dict[str, float]) -> str:
    """The results of the learners, a line for each."""
    titles = {"ppo": "PPO", "recurrent_ppo": "Recurrent PPO"}
    lines = []
    for learner, seeds in runs.items():
        each = ", ".join(f"{share(run['reward'], scale):.0f}" for run in seeds)
        success = ", ".join(f"{100 * run['success']:.0f}" for run in seeds)
        lines.append(f"- {titles[learner]}: {each} % of the way from random to the planner; success in {success} % of 100 worlds")
    return "\n".join(lines)


def page(name: str, task: dict[str, Any], measured: dict[str, Any], descriptions: dict[str, str], runs: dict[str, Any]) -> str:
    """The page of a family."""
    folder = "tasks" if task["group"] == "the paper's" else "worlds"
    elsewhere = f"\n\nKnown elsewhere as: {ELSEWHERE[name]}." if name in ELSEWHERE else ""
    lines = [
        f"# {name}", "", task["description"] + elsewhere, "", f"![The planner in {name}](../images/families/{name}.gif)", "",
        "| variant | what it is | differs in | distance | random | planner | succeeds |", "|---|---|---|--:|--:|--:|--:|",
    ]  # fmt: skip
    for variant, each in measured.items():
        lines.append(
            f"| `{variant}` | {descriptions.get(variant, '')} | {each['elements']} | {each['distance']:g} | {each['random']:g} | {each['planner']:g} "
            f"| {100 * each['success']:.0f} % |"
        )
    lines += [
        "", "*differs in*: the elements in which the variant differs from the first, found by experiment (`driftworld elements`);",
        "`p`: where things are at the start, `phi`: how a state looks.",
        "*distance*: from the first variant, by worlds (`driftworld distance A B --worlds 20`; by parameters without `--worlds`).",
        f"*random*, *planner*: mean reward in {WORLDS} worlds. *succeeds*: the planner's success rate.", "",
        *(f"`{each}`: {REASONS[f'{name}#{each}']}\n" for each in measured if f"{name}#{each}" in REASONS),
        f"![Variants of {name}](../images/families/{name}.png)", "",
    ]  # fmt: skip
    if runs:
        first = next(iter(measured))
        lines += [
            f"![Learning curves of {name}](../images/families/{name}.svg)", "",
            f"Mean reward while `{first}` is learned: `python scripts/learn_families.py {name}`.",
            "After training, for each seed, with sampled actions:", "",
            result_lines(runs, measured[first]), "",
        ]  # fmt: skip
    lines += [
        f"All parameters: `driftworld tasks show {name}`. Its document: [{name}.json](../../examples/{folder}/{name}.json).", "",
    ]  # fmt: skip
    return "\n".join(lines)


def pages(command: str, docs: Path = ROOT / "docs") -> None:
    """Writes all pages, with their curves, and the list."""
    measured, tasks = json.loads(MEASURED.read_text(encoding="utf-8")), families(command)
    learned = json.loads(LEARNED.read_text(encoding="utf-8"))
    for folder in ("families", "images/families"):
        (docs / folder).mkdir(parents=True, exist_ok=True)
    listed: dict[str, list[str]] = {}
    for name, task in tasks.items():
        descriptions = run_json(command, "tasks", "show", name)["descriptions"]
        runs = learned.get(name, {})
        (docs / f"families/{name}.md").write_text(page(name, task, measured[name], descriptions, runs), encoding="utf-8")
        first = next(iter(measured[name].values()))
        if runs:
            (docs / f"images/families/{name}.svg").write_text(curve(name, runs, first), encoding="utf-8")
        averages = [sum(share(run["reward"], first) for run in seeds) / len(seeds) for seeds in runs.values()]
        row = f"| [`{name}`](families/{name}.md) | {task['description']} | {len(measured[name])} | {first['random']:g} | {first['planner']:g} "
        row += f"| {', '.join(f'{each:.0f}' for each in averages)} |"
        listed.setdefault(task["group"], []).append(row)
    parts = [
        "# The families", "", "Every task that comes with Driftworld, by name in each command, in Python, and as a Gymnasium id",
        "(`driftworld/KeyCorridor-v0`). Rewards are those of the first variant. *PPO*: its reward after 100,000 decisions of 32 × 32 pixels,",
        "in per cent of the way from random to the planner, averaged over the seeds on the family's page; in memory families, recurrent PPO follows.", "",
        "![The first variant of each family](images/families.png)", "",
    ]  # fmt: skip
    for group, rows in listed.items():
        parts += [f"## {group.capitalize()}", "", "| family | task | variants | random | planner | PPO |", "|---|---|--:|--:|--:|--:|", *rows, ""]
    (docs / "families.md").write_text("\n".join(parts), encoding="utf-8")
    lines = [line for line in (ROOT / "docs/SUMMARY.md").read_text(encoding="utf-8").splitlines() if "](families/" not in line]
    index = lines.index("- [The families](families.md)") + 1
    lines[index:index] = [f"  - [{name}](families/{name}.md)" for name in tasks]
    (docs / "SUMMARY.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Runs the requested action."""
    command, what, *names = sys.argv[1:]
    tasks = families(command)
    if what == "pages":
        pages(command)
        return
    if what == "sheet":
        sheet(command, [f"{name}#{task['variants'][0]}" for name, task in tasks.items()], ROOT / "docs/images/families.png", 5)
        return
    measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    for name in names or tasks:
        if what == "film":
            film(command, name, tasks[name]["variants"])
            continue
        measured[name] = measure(command, name, tasks[name]["variants"])
        ordered = {each: measured[each] for each in tasks if each in measured}
        MEASURED.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
