"""Trains single-task experts, and one PPO on their tasks in turn: what does it retain, and what transfers?

The task is `two_skies.json` beside this file: by day blue cubes pay and red ones cost; in the evening it is the other
way round. The sky is the learner's only cue, and one policy could solve both. The learner trains on day, evening, day,
evening; before and after each block it is frozen and evaluated on both.

    python examples/python/experts_and_sequential_ppo.py               # experts, lifetime, scores and the report
    python examples/python/experts_and_sequential_ppo.py --seeds 1 2 3 4 5 --results   # also writes to results/
    python examples/python/experts_and_sequential_ppo.py --quick       # only checks that it runs

The loop is `Curriculum.run_vector`: it runs the blocks, freezes the learner, checks that evaluations do not change it,
and writes the log. The learner is `driftworld.learners.PPO`; `replay_ppo.py` uses `CLEAR` instead. Needs PyTorch (`pip
install torch`).
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import torch
from driftworld.learners import PPO, Settings
from record import T_95, Record, Watch, result_folder
from torch import nn

TASK = os.path.relpath(Path(__file__).with_name("two_skies.json"))
VARIANTS = ("day", "evening")
ORDER = ("day", "evening", "day", "evening")
# Speed in m/s, turn rate in degrees per second, interact: straight ahead, two curves, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
OPTIONS: dict[str, Any] = {
    "modalities": "rgb", "size": 64, "actions": ACTIONS, "interact": False, "frame_skip": 5, "max_steps": 60,
}  # fmt: skip


class Network(nn.Module):
    """Two convolutions, a layer of 128, and two heads: action logits and value."""

    def __init__(self) -> None:
        super().__init__()
        self.trunk = nn.Sequential(
            nn.Conv2d(3, 16, 8, stride=4), nn.ReLU(),
            nn.Conv2d(16, 32, 4, stride=2), nn.ReLU(),
            nn.Flatten(),
            nn.Linear(32 * 6 * 6, 128), nn.ReLU(),
        )  # fmt: skip
        self.policy, self.value = nn.Linear(128, len(ACTIONS)), nn.Linear(128, 1)
        for module in self.modules():
            if isinstance(module, (nn.Conv2d, nn.Linear)):
                nn.init.orthogonal_(module.weight, 0.01 if module is self.policy else 2**0.5)
                nn.init.zeros_(module.bias)

    def forward(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-probabilities of the actions and values of images, `(n, 64, 64, 3)` bytes."""
        features = self.trunk(images.permute(0, 3, 1, 2).float() / 255.0)
        return torch.log_softmax(self.policy(features), dim=-1), self.value(features).squeeze(-1)


class Learner(PPO):
    """PPO of `driftworld.learners` with the network above, carried over from block to block.

    Args:
        seed: The seed of network, actions and minibatches.
        num_envs: Number of environments.
        policy: Actions in evaluations: `"sampled"` from the policy, or `"greedy"`, the most probable ones.
        length: Steps of each environment between updates.
        **options: Options of the method.
    """

    #: PPO's passes over a rollout, about four optimiser steps each.
    epochs = 4

    def __init__(self, seed: int, num_envs: int, policy: str = "sampled", length: int = 64, **options: Any) -> None:
        # An object pays or costs 100 points.
        settings = Settings(rollout=length, epochs=self.epochs, learning_rate=5e-4, entropy=0.01, reward_scale=0.01)
        super().__init__(len(ACTIONS), num_envs, seed=seed, size=64, policy=policy, settings=settings, **options)

    def make_network(self) -> nn.Module:
        """Two convolutions instead of patches."""
        return Network()


def scenario(
    order: tuple[str, ...], seed: int, arguments: argparse.Namespace, evaluated: tuple[str, ...] = VARIANTS
) -> dict[str, Any]:
    """A scenario with learning blocks in the given order, each between evaluations in worlds that are not learned from."""

    def regime(variant: str, count: int, seed: int, first: int = 0) -> dict[str, Any]:
        return {"task": TASK, "variant": variant, "count": count, "seed": seed, "first_index": first}

    evaluation = {
        "type": "evaluation",
        "regimes": [regime(variant, arguments.evaluate, seed + 1000) for variant in evaluated],
    }
    blocks: list[dict[str, Any]] = [evaluation] if evaluated else []
    for place, variant in enumerate(order):
        # A variant's worlds continue where its last block ended.
        first = order[:place].count(variant) * arguments.learn
        blocks.append({"type": "learning", "regimes": [regime(variant, arguments.learn, seed, first)]})
        blocks += [evaluation] if evaluated else []
    plan = {"version": 1, "name": "_".join(["two_skies", *order]), "blocks": blocks}
    driftworld.validate(plan, "scenario", check=True)
    return plan


def lifetime(learner: Learner, plan: dict[str, Any], folder: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Runs a scenario and logs every experience, unless its finished log exists; returns the duration of the run and the
    results of its blocks.
    """
    agent, record_file = folder.name, folder.with_suffix(".json")
    made_with = {"scenario": plan, "policy": learner.policy, "num_envs": arguments.num_envs}
    if record_file.exists() and not arguments.again:
        done: dict[str, Any] = json.loads(record_file.read_text(encoding="utf-8"))
        if done["made_with"] == made_with and "results" in done:
            print(f"{agent}: found in {folder}, not run again (--again reruns it)")
            return done
    shutil.rmtree(folder, ignore_errors=True)
    watch = Watch()
    learner.name = agent
    curriculum = driftworld.Curriculum.from_dict(plan)
    summary = curriculum.run_vector(learner, folder, num_envs=arguments.num_envs, **OPTIONS)
    results = blocks_of(summary, folder)
    for row in results:
        print(f"{agent}: block {row['block']} {row['kind']:10} {row['variant']}: reward {row['reward']:6.1f}", flush=True)
    done = {
        "made_with": made_with, "seconds": round(watch.seconds, 1), "load_before": watch.load, "results": results,
        "optimiser_steps": learner.updates,
    }  # fmt: skip
    record_file.write_text(json.dumps(done, indent=2) + "\n", encoding="utf-8")
    return done


def blocks_of(summary: driftworld.Summary, folder: Path) -> list[dict[str, Any]]:
    """The result of each regime: the mean reward of its last 200 experiences, its success rate, and the number of
    experiences learned from up to its end.
    """
    log = driftworld.read_log(folder)
    results, learned, first = [], 0, 0
    for regime in summary.regimes:
        rewards = log["reward"][first : first + regime["experiences"]]
        first += regime["experiences"]
        learned += regime["experiences"] * (regime["kind"] == "learning")
        results.append({
            "block": regime["block"], "kind": regime["kind"], "variant": regime["variant"].partition("#")[2],
            "experiences": learned, "reward": round(float(np.mean(rewards[-200:])), 1),
            "success": round(regime["success_rate"], 3),
        })  # fmt: skip
    return results


def parse_arguments(program: str, text: str) -> argparse.Namespace:
    """Parses the command line of this example and of `replay_ppo.py`."""
    parser = argparse.ArgumentParser(description=text.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="seeds, one lifetime each (default: 1)")
    parser.add_argument("--learn", type=int, default=1536, help="experiences of a learning block (default: 1536)")
    parser.add_argument(
        "--evaluate", type=int, default=128, help="experiences of each variant in an evaluation block (default: 128)"
    )
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument(
        "--policy", choices=["sampled", "greedy"], default="sampled", help="how the policy acts in evaluations (default: sampled)"
    )
    parser.add_argument("--threads", type=int, default=2, help="number of PyTorch threads")
    parser.add_argument("--logs", type=Path, default=Path("logs/two_skies"), help="folder for the logs")
    parser.add_argument("--again", action="store_true", help="rerun lifetimes that have a finished log")
    parser.add_argument(
        "--results", nargs="?", const=result_folder(program), metavar="FOLDER", help="record the result"
    )
    parser.add_argument("--quick", action="store_true", help="run a few experiences, to check that it works")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.learn, arguments.evaluate, arguments.num_envs, arguments.threads = 16, 8, 8, 1
    torch.set_num_threads(arguments.threads)
    return arguments


MakeLearner = Callable[[int, int, str], Learner]


def run_experts(name: str, make: MakeLearner, arguments: argparse.Namespace) -> dict[Path, dict[str, Any]]:
    """Trains experts with the same learner, one for each variant and seed, with as much experience of the variant as the
    lifetime gets, and evaluates them in the same worlds as the lifetime. Returns the results by log folder.
    """
    lifetimes = {}
    for seed in arguments.seeds:
        for variant in VARIANTS:
            folder = arguments.logs / f"expert_{name}_{variant}_{seed}"
            order = tuple(block for block in ORDER if block == variant)
            plan = scenario(order, seed, arguments, evaluated=(variant,))
            lifetimes[folder] = lifetime(make(seed, arguments.num_envs, arguments.policy), plan, folder, arguments)
    return lifetimes


def run_lifetimes(name: str, make: MakeLearner, arguments: argparse.Namespace) -> dict[Path, dict[str, Any]]:
    """Runs a lifetime over all variants for each seed; returns the results by log folder."""
    lifetimes = {}
    for seed in arguments.seeds:
        folder, plan = arguments.logs / f"{name}_{seed}", scenario(ORDER, seed, arguments)
        lifetimes[folder] = lifetime(make(seed, arguments.num_envs, arguments.policy), plan, folder, arguments)
    return lifetimes


def evaluations(lifetimes: Mapping[Path, dict[str, Any]], label: str = "") -> list[dict[str, Any]]:
    """A row for each lifetime, variant and evaluation; nothing is averaged."""
    return [
        {
            "run": f"{row['variant']}{label}" + ("" if len(lifetimes) == 1 else f", {folder.name.rpartition('_')[2]}"),
            "experiences": row["experiences"],
            "reward": row["reward"],
            "success": row["success"],
        }
        for folder, done in lifetimes.items()
        for row in sorted(done["results"], key=lambda row: row["variant"])
        if row["kind"] == "evaluation"
    ]


def levels(experts: Mapping[Path, dict[str, Any]]) -> dict[str, float]:
    """The experts' rewards in their last evaluation, averaged over seeds."""
    earned: dict[str, list[float]] = {}
    for done in experts.values():
        earned.setdefault(f"expert, {done['results'][-1]['variant']}", []).append(done["results"][-1]["reward"])
    return {f"{name} (n = {len(each)})": round(float(np.mean(each)), 1) for name, each in earned.items()}


def scores_table(**agents: driftworld.Metrics) -> list[dict[str, Any]]:
    """A row for each metric and a column for each agent, with the mean over its lifetimes and, if there are several, its
    95 % interval.
    """
    names = list(next(iter(agents.values())).lifetime)

    def value(scores: driftworld.Metrics, name: str) -> str:
        number = scores.lifetime[name]
        if number is None:
            return "none"
        each = np.array([one[name] for one in scores.lifetimes if one[name] is not None], dtype=float)
        if not 2 <= len(each) <= len(T_95) + 1:
            return f"{number:.3f}"
        return f"{number:.3f} ± {T_95[len(each) - 2] * each.std(ddof=1) / len(each) ** 0.5:.3f}"

    return [{"metric": name} | {agent: value(scores, name) for agent, scores in agents.items()} for name in names]


def show(rows: list[dict[str, Any]]) -> None:
    """Prints a table."""
    for row in [dict.fromkeys(rows[0], ""), *rows]:
        cells = [str(cell or name) for name, cell in row.items()]
        print("  ".join(f"{cell:<{26 if place == 0 else 16}}" for place, cell in enumerate(cells)).rstrip())


def main() -> None:
    """Runs the experts, then the lifetimes, then scores them."""
    arguments = parse_arguments(__file__, __doc__ or "")
    experts = run_experts("sequential", Learner, arguments)
    lifetimes = run_lifetimes("sequential_ppo", Learner, arguments)
    scores = driftworld.metrics(list(lifetimes), ste=list(experts))
    table = scores_table(sequential=scores)
    show(table)
    page = driftworld.report(list(lifetimes), ste=list(experts), title="A sequential PPO under two skies")
    (arguments.logs / "sequential_ppo.html").write_text(page, encoding="utf-8")
    print(f"the report is {arguments.logs / 'sequential_ppo.html'}")
    if arguments.results:
        runs = [*experts.values(), *lifetimes.values()]
        Record(
            title="Experts, and a sequential PPO",
            text=f"By day blue cubes pay and red ones cost, in the evening it is the other way round. One PPO learns {', '.join(ORDER)} in turn, "
            f"{arguments.learn} experiences each, and is evaluated on both before and after each block ({arguments.evaluate} worlds each, {arguments.policy} "
            f"policy); experts are the same learner with the same experience of one variant alone, evaluated in the same worlds. "
            f"{sample_size_note(arguments.seeds)} The curve shows the evaluations.",
            settings={**vars(arguments), **OPTIONS, "optimiser_steps": [done["optimiser_steps"] for done in lifetimes.values()]},
            variants=[f"{TASK}#{variant}" for variant in VARIANTS], seeds=arguments.seeds,
            curve=evaluations(lifetimes), lines=levels(experts), table=table, axes=("experiences", "reward"),
            labels=("experiences learned from", "reward in evaluations, each lifetime"),
            seconds=sum(done["seconds"] for done in runs), load_before=runs[0]["load_before"],
            files={"curriculum.json": runs[-1]["made_with"]["scenario"], "two_skies.json": driftworld.TaskSpec.load(TASK).to_dict(), "scores.json": scores.lifetimes},
        ).write(arguments.results)  # fmt: skip


def sample_size_note(seeds: list[int]) -> str:
    """States the number of lifetimes, and what can be concluded from them."""
    if len(seeds) == 1:
        return "One lifetime (n = 1): results for this seed need not hold for others, and differences may be due to chance."
    return f"n = {len(seeds)} lifetimes, each with its own worlds and network."


if __name__ == "__main__":
    main()
