#!/usr/bin/env python3
"""Checks that two builds of `driftworld` give the same worlds, distances, frames, logs and metrics, byte for byte.

    scripts/same_bits.py record target/release/driftworld before.json     # with the build before a change
    scripts/same_bits.py compare target/release/driftworld before.json    # with the build after it

Runs a fixed set of commands and stores the SHA-256 of everything that each one prints or writes. `compare` exits with 1
and names the commands with different bytes. A command that the newer build refuses with "removed in 0.3" is listed
separately. `--only GROUP` runs one group: worlds, distances, frames, logs, scores or tools. `--full` compares 20 worlds
by every measure; without it the slow measures get 2. `--variants N` takes the first N variants of each task instead of
20: with 2 it runs for some minutes, with 20 for an hour. Logs of other programs are also scored if the folder named by
DRIFTWORLD_REFERENCE (default ../shared/reference) exists.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = pathlib.Path(os.environ.get("DRIFTWORLD_REFERENCE", ROOT.parent / "shared/reference"))
BUILT_IN = ["find_objects", "get_to_goal", "select_object", "moving_object", "scavenger_hunt", "blue_red_green"]
WORLDS = sorted(path.stem for path in (ROOT / "examples/worlds").glob("*.json"))
QUICK_MEASURES = [
    "parameters",
    "worlds",
    "occupancy",
    "occupancy:jaccard",
    "occupancy:hausdorff",
    "occupancy:chamfer",
    "placements",
    "objects",
    "objects:counts",
    "colors",
    "colors:srgb",
    "colors:cie76",
    "colors:ciede2000",
    "colors:hyab",
    "rewards",
]
SLOW_MEASURES = ["pictures", "pictures:whole", "pictures:structure", "dynamics", "dynamics:bisimulation", "behavior"]
MODALITIES = ["rgb", "depth", "segmentation"]


def variants(binary: str, max_variants: int) -> list[str]:
    """The first `max_variants` variants of each built-in task and of each example world."""
    found = []
    for task in [*BUILT_IN, *(str(ROOT / "examples/worlds" / f"{name}.json") for name in WORLDS)]:
        shown = json.loads(
            subprocess.run([binary, "tasks", "show", task, "--json"], capture_output=True, check=True).stdout
        )
        names = list(shown["variants"])[:max_variants]
        found += [f"{task}#{name}" for name in names]
    return found


def commands(binary: str, max_variants: int, full: bool) -> list[tuple[str, str, list[list[str]]]]:
    """The commands to run: (group, name, commands that run one after the other in one empty folder)."""
    jobs = []

    def add(group: str, name: str, *steps: list[str]) -> None:
        jobs.append((group, name.replace(str(ROOT) + "/", ""), list(steps)))

    first_of = {}
    for variant in variants(binary, max_variants):
        task = variant.split("#")[0]
        first = first_of.setdefault(task, variant)
        add("worlds", variant, ["sample", variant, "--count", "20", "--seed", "7", "--jsonl"])
        for by in SLOW_MEASURES if variant != first else []:
            worlds = "20" if full else "2"
            add(
                "distances",
                f"{variant} --by {by}",
                ["distance", first, variant, "--by", by, "--worlds", worlds, "--json"],
            )
        if variant != first:
            add("distances", f"{variant} --explain", ["distance", first, variant, "--explain", "--json"])
        for modality in MODALITIES:
            film = ["film", variant, "--agent", "random", "--view", "agent", "--size", "84", "--no-captions"]
            add(
                "frames",
                f"{variant} {modality}",
                [*film, "--modality", modality, "--max-steps", "24", "-o", "film.apng"],
            )
        add(
            "frames",
            f"{variant} sheet",
            ["render", variant, "--agent", "onrails", "--view", "episode", "--size", "96", "-o", "episode.png"],
        )
    for task, first in first_of.items():
        for by in QUICK_MEASURES:
            worlds = [] if by == "parameters" else ["--worlds", "20"]
            add(
                "distances",
                f"{task} --by {by}, all pairs",
                ["order", task, "--by", by, *worlds, "--order", "given", "--matrix", "m.json", "--json"],
            )
        for order in ["gradual", "outward", "nearest", "two-opt", "random", "target-step", "abrupt"]:
            step = ["--target-step", "0.5"] if order == "target-step" else []
            add(
                "distances",
                f"{task} ordered {order}",
                ["order", task, "--order", order, *step, "--seed", "3", "--json"],
            )
        add("worlds", f"{task} lhs", ["sample", first, "--count", "16", "--sequence", "lhs", "--jsonl"])
        add("worlds", f"{task} sobol", ["sample", first, "--count", "16", "--sequence", "sobol", "--jsonl"])
        add("tools", f"{task} elements", ["elements", task, "--worlds", "2", "--steps", "20", "--json"])
        for agent in ["random", "onrails", "sarsa"]:
            design = ["curriculum", task, "--learn", "2", "--eval-episodes", "1", "-o", "scenario.json"]
            run = ["run", "scenario.json", "--agent", agent, "-o", "log", "--record"]
            add("logs", f"{task} {agent}", design, run, ["metrics", "log", "--json"], ["replay", "log", "--json"])
    for curriculum in sorted((ROOT / "examples/curricula").glob("*.json")):
        add(
            "logs",
            curriculum.name,
            ["run", str(curriculum), "--agent", "random", "-o", "log"],
            ["metrics", "log", "--save", "saved", "--json"],
        )
    drift = ["sample", "find_objects#blue", "--drift-to", "red", "--count", "50", "--jsonl"]
    add("worlds", "drift", drift)
    add("worlds", "drift mixed", [*drift, "--mix"])
    add(
        "worlds",
        "original scenarios' maps",
        ["render", str(REFERENCE / "l2explorer/map_simple.json"), "--l2explorer", "-o", "map.png"],
    )
    for variant in ["find_objects#village", "examples/worlds/hunt.json#meadow", "get_to_goal#landmarks"]:
        path = variant if "/" not in variant else str(ROOT / variant)
        add(
            "frames",
            f"{variant} views",
            *[
                ["render", path, "--view", view, "-o", f"{view}.png"]
                for view in ["sheet", "overview", "top-down", "looks"]
            ],
        )
        add("frames", f"{variant} photographs", ["photograph", path, "-o", "photographs"])
    add("frames", "models", ["assets", "show", "-o", "models.png"])
    add("tools", "scales", ["scales", "blue_red_green", "--worlds", "2", "--json"])
    add("tools", "vary", ["vary", "find_objects#red", "--element", "reward", "--distance", "0.5", "--json"])
    add("tools", "audit", ["audit", str(ROOT / "examples/curricula/blue_red_green.json"), "--repeats", "2", "--json"])
    for logs in [REFERENCE / "l2metrics/ll_logs/multi_task", *sorted((REFERENCE / "l2metrics/ste_logs").glob("*"))]:
        add("scores", logs.name, ["metrics", str(logs), "-p", "performance", "--json"], ["logs", "validate", str(logs)])
        add(
            "scores",
            f"{logs.name} otherwise",
            [
                "metrics",
                str(logs),
                "-p",
                "performance",
                "--json",
                "-m",
                "both",
                "-t",
                "both",
                "-n",
                "run",
                "-g",
                "hanning",
                "-x",
            ],
        )
    return jobs


def digests(binary: str, steps: list[list[str]]) -> dict[str, str]:
    """SHA-256 of everything that the commands print and write, by name; and the exit codes."""
    found = {}
    environment = os.environ | {"DRIFTWORLD_CLOCK": "2026-01-31T12:00:00Z", "COLUMNS": "100", "NO_COLOR": "1"}
    with tempfile.TemporaryDirectory() as folder:
        for number, step in enumerate(steps):
            done = subprocess.run([binary, *step], cwd=folder, env=environment, capture_output=True, check=False)
            found[f"exit {number}"] = str(done.returncode)
            if b"removed in 0.3" in done.stderr:
                return {"removed": done.stderr.decode(errors="replace").strip()}
            found[f"output {number}"] = hashlib.sha256(done.stdout).hexdigest()
        for path in sorted(pathlib.Path(folder).rglob("*")):
            if path.is_file():
                found[str(path.relative_to(folder))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=["record", "compare"])
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--only", metavar="GROUP")
    parser.add_argument("--variants", type=int, default=20, metavar="N")
    parser.add_argument("--full", action="store_true")
    arguments = parser.parse_args()
    binary = str(arguments.binary.resolve())
    jobs = [job for job in commands(binary, arguments.variants, arguments.full) if arguments.only in (None, job[0])]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda job: digests(binary, job[2]), jobs)
        found = {f"{group}: {name}": result for (group, name, _), result in zip(jobs, results)}
    counts = {group: sum(job[0] == group for job in jobs) for group in dict.fromkeys(job[0] for job in jobs)}
    failed = [
        name for name, result in found.items() if any(k.startswith("exit") and v not in "0" for k, v in result.items())
    ]
    if arguments.action == "record":
        arguments.file.write_text(json.dumps(found, indent=1) + "\n")
        print(f"recorded {counts}; commands that ended with an error: {len(failed)}", *failed, sep="\n  ")
        return 0
    before = json.loads(arguments.file.read_text())
    missing = [name for name in before if name not in found and arguments.only in (None, name.split(":")[0])]
    removed = [name for name, result in found.items() if "removed" in result]
    differ = [name for name, result in found.items() if name not in removed and result != before.get(name)]
    print(f"compared {counts}; removed: {len(removed)}, missing: {len(missing)}, different: {len(differ)}")
    for name in removed + missing + differ:
        kind = "removed" if name in removed else "missing" if name in missing else "DIFFERENT"
        now, then = found.get(name, {}), before.get(name, {})
        print(f"  {kind}: {name}", [key for key in now.keys() | then.keys() if now.get(key) != then.get(key)][:6])
    return 1 if missing or differ else 0


if __name__ == "__main__":
    sys.exit(main())
