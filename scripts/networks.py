"""Trains PPO in some families, and writes a network of each to examples/networks. The workbench plays them, and the README shows a
film of one.

    python scripts/networks.py [NAME]... [--jobs 2] [--film target/release/driftworld]

Existing files are kept. For each new one, prints the mean reward and the success rate in 100 other worlds. Training takes
half a minute to three minutes on a core, and needs PyTorch.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

from driftworld import Curriculum
from driftworld.logs import read_log
from learn_families import ACTIONS, MEASURED, NUM_ENVS, OPTIONS, WORLDS

ROOT = Path(__file__).parents[1]
NETWORKS, FILM = ROOT / "examples/networks", ROOT / "docs/images/trained.gif"
#: The variant of each family, and the number of decisions to learn from.
TRAINED = {
    "obstacle_course": ("crowded", 150_000), "hallway": ("plain", 100_000), "one_room": ("plain", 150_000), "t_maze": ("left", 150_000),
    "sidewalk": ("plain", 200_000), "y_maze": ("either", 500_000), "collect_health": ("four", 500_000),
}  # fmt: skip


def train(name: str) -> tuple[str, float, float]:
    """Trains on a variant, writes the network, and evaluates it in other worlds; returns family, reward and success rate."""
    import torch
    from driftworld.learners import PPO, Settings

    torch.set_num_threads(1)
    variant, count = TRAINED[name]
    scale = next(iter(json.loads(MEASURED.read_text(encoding="utf-8"))[name].values()))
    blocks = [
        {"type": "learning", "regimes": [{"task": name, "variant": variant, "count": count, "steps": count, "seed": 1}]},
        {"type": "evaluation", "regimes": [{"task": name, "variant": variant, "count": WORLDS, "seed": 2}]},
    ]
    plan = Curriculum.from_dict({"version": 1, "name": "network", "blocks": blocks})
    reward_scale = 2.0 / (scale["planner"] - scale["random"])
    learner = PPO(len(ACTIONS), NUM_ENVS, seed=1, size=32, settings=Settings(annealing=count, reward_scale=reward_scale))
    with tempfile.TemporaryDirectory() as folder:
        plan.run_vector(learner, Path(folder) / "log", num_envs=NUM_ENVS, num_threads=1, check_frozen=False, **OPTIONS)
        columns = read_log(Path(folder) / "log").columns
    learner.export(NETWORKS / f"{name}.safetensors", actions=ACTIONS, frame_skip=5, interact=False)
    halve(NETWORKS / f"{name}.safetensors")
    evaluated = columns["block_type"] != "train"
    return name, float(columns["reward"][evaluated].astype(float).mean()), float(columns["success"][evaluated].astype(float).mean())


def halve(file: Path) -> None:
    """Rounds the numbers of a network from four bytes to two (BF16), and drops the value head, which nothing reads."""
    import numpy as np

    content = file.read_bytes()
    start = 8 + int.from_bytes(content[:8], "little")
    header, numbers = json.loads(content[8:start]), np.frombuffer(content, "<u4", offset=start)
    parts, end = [], 0
    tensors = {"__metadata__": header.pop("__metadata__")}
    for name, tensor in header.items():
        if tensor["dtype"] == "F32" and not name.startswith("value."):
            begin, stop = (offset // 4 for offset in tensor["data_offsets"])
            bits = numbers[begin:stop]
            # Round to the nearest, ties to even.
            parts.append(((bits + 0x7FFF + (bits >> 16 & 1)) >> 16).astype("<u2").tobytes())
            tensors[name] = {"dtype": "BF16", "shape": tensor["shape"], "data_offsets": [end, end + len(parts[-1])]}
            end += len(parts[-1])
    text = json.dumps(tensors).encode()
    text += b" " * (-len(text) % 8)
    file.write_bytes(len(text).to_bytes(8, "little") + text + b"".join(parts))


def main() -> None:
    """Trains the missing networks, and films the obstacle course if requested."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(TRAINED))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--film", metavar="COMMAND", help="redraw the README's film with this command")
    arguments = parser.parse_args()
    pending = [name for name in arguments.names if not (NETWORKS / f"{name}.safetensors").is_file()]
    with ProcessPoolExecutor(arguments.jobs, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        for done in as_completed([pool.submit(train, name) for name in pending]):
            print(*done.result(), flush=True)
    if arguments.film:
        network = NETWORKS / "obstacle_course.safetensors"
        words = ["film", "obstacle_course#crowded", "--agent", f"net:{network}", "--index", "2", "--size", "176", "-o", FILM]
        subprocess.run([arguments.film, *words], check=True)


if __name__ == "__main__":
    main()
