"""Redraws the images of docs/images, each with its command.

    python scripts/images.py target/release/driftworld [WORD]...     all of them, or those whose names contain a WORD

Other images: first-hour-*.png come from docs/first-hour.md (`DRIFTWORLD_UPDATE_PAGES=1 cargo test --test all pages`),
except first-hour-report.png and report.png, which are browser screenshots of reports; first-hour.svg comes from
book/record.py, and speed.svg from scripts/speed.py.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]

#: Documents with a sheet, which is named after the document.
CURRICULA = ["reward", "state", "transition", "observation", "action", "blue_red_green"]
WORLDS = [
    "maze",
    "four_rooms",
    "t_maze",
    "cue_t_maze",
    "key_corridor",
    "locked_rooms",
    "switches",
    "put_next",
    "lava_crossing",
    "foraging",
    "hunt",
]
TASKS = {
    "find_objects": "blue spheres dusk huddle penalty near rooms village",
    "get_to_goal": "plain landmarks hazards bags sphere wandering craters maze",
    "select_object": "green red bandit spheres dusk drifting",
    "moving_object": "wandering still fast shy curious turned",
    "scavenger_hunt": "plain landmarks alike huddle woods village",
}
ORDERED = "blue slim held long_held half modest poor penalty dusk red green slow wide stiff spheres waypoints huddle clearing interact near"


def variants_of(task: str, variants: str) -> str:
    """The names of some variants of a task."""
    return " ".join(f"{task}#{variant}" for variant in variants.split())


#: Each image and its commands, without `driftworld`: `{}` is its path, `{tmp}` an empty folder.
IMAGES: dict[str, list[str]] = {
    "looks-sizes.png": ["render find_objects --view looks -o {}"],
    "models.png": ["assets show -o {}"],
    "demo.png": [f"sheet {variants_of('find_objects', 'blue red green dusk huddle penalty')} --seed 7 --size 200 -o {{}}"],
    "six-families.png": [
        (
            "sheet key_corridor#red maze#medium collect_health#four put_next#one lava_crossing#lava obstacle_course#crowded"
            " --size 120 --columns 3 -o {}"
        )
    ],
    "distances.png": ["demo -o {tmp}/demo"],
    "order.png": [f"order {variants_of('find_objects', ORDERED)} --order two-opt --start find_objects#blue --plot {{}}"],
    "distances-apart.png": [
        "vary find_objects#red --element S --distance 0.05 --name at_0.05 -o {tmp}/apart.json",
        "vary {tmp}/apart.json#red --parameters light --distance 0.2 --name at_0.2 -o {tmp}/apart.json --force",
        "vary {tmp}/apart.json#red --parameters target_color --distance 1 --name at_1 -o {tmp}/apart.json --force",
        (
            "vary {tmp}/apart.json#red --parameters target_color,target_model,light,agent_width --distance 3 --name at_3"
            " -o {tmp}/apart.json --force"
        ),
        "vary {tmp}/apart.json#red --element R --distance 1 --name unseen_1 -o {tmp}/apart.json --force",
        f"sheet {variants_of('{tmp}/apart.json', 'red at_0.05 at_0.2 at_1 at_3 unseen_1')} --seed 3 --size 150 -o {{}}",
    ],
    "curriculum-timeline.png": [
        (
            f"curriculum {variants_of('find_objects', 'blue huddle wide clearing')} --probe state --start find_objects#blue --order outward"
            " --learn 100 --eval-episodes 10 --name timeline -o {tmp}/timeline.json --plot {}"
        )
    ],
    "curriculum-map.png": ["sheet --scenario examples/curricula/map.json --size 150 -o {}"],
    "task-blue_red_green.png": [f"sheet {variants_of('blue_red_green', 'a b c d')} --size 150 -o {{}}"],
    "looks.png": [
        (
            f"sheet {variants_of('find_objects', 'huddle dusk')} examples/worlds/four_rooms.json#nine examples/worlds/key_corridor.json#closed"
            " --size 160 -o {}"
        )
    ],
    "solved-key_corridor.png": [
        "render examples/worlds/key_corridor.json#closed --seed 5 --view episode --size 200 -o {}"
    ],
    **{
        f"curriculum-{name}.png": [f"sheet --scenario examples/curricula/{name}.json --size 120 -o {{}}"]
        for name in CURRICULA
    },
    **{f"world-{name}.png": [f"sheet examples/worlds/{name}.json --size 150 -o {{}}"] for name in WORLDS},
    **{f"task-{name}.png": [f"sheet {variants_of(name, variants)} --size 150 -o {{}}"] for name, variants in TASKS.items()},
}


def main() -> None:
    """Draws the requested images."""
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    driftworld, *words = sys.argv[1:]
    for name, commands in IMAGES.items():
        if words and not any(word in name for word in words):
            continue
        path = f"docs/images/{name}"
        with tempfile.TemporaryDirectory() as folder:
            for command in commands:
                line = [word.replace("{tmp}", folder).replace("{}", path) for word in command.split()]
                print("driftworld", *line, flush=True)
                subprocess.run([Path(driftworld).resolve(), *line], cwd=ROOT, check=True)
            if name == "distances.png":
                shutil.copyfile(f"{folder}/demo/distances.png", ROOT / path)


if __name__ == "__main__":
    main()
