"""Single-task experts, and one PPO that meets their tasks one after the other: what does it keep, what carries over?

The task is `two_skies.json` beside this file: by day blue cubes pay and red ones cost, in the evening it is the other way round.
The sky shows which it is, and nothing else tells the learner; one policy could do both. It lives day, evening, day, evening, and
is frozen and evaluated in both before and after each block.

    python examples/python/experts_and_sequential_ppo.py               # experts, lifetime, scores and the report
    python examples/python/experts_and_sequential_ppo.py --results     # what is written down in results/
    python examples/python/experts_and_sequential_ppo.py --quick       # does it run?

What `replay_ppo.py` changes is `Learner.learn` alone. Needs PyTorch (`pip install torch`).
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import torch
from record import Record, Watch, folder_of
from torch import nn

TASK = os.path.relpath(Path(__file__).with_name("two_skies.json"))
VARIANTS = ("day", "evening")
ORDER = ("day", "evening", "day", "evening")
# Speed in m/s, turn rate in degrees per second, interact: ahead, two bends, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
OPTIONS: dict[str, Any] = {
    "modalities": "rgb", "size": 64, "actions": ACTIONS, "interact": False, "frame_skip": 5, "max_steps": 60,
}  # fmt: skip
DISCOUNT = 0.98


class Network(nn.Module):
    """Two convolutions, a layer of 128, and two heads: logits of the actions, and the value."""

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


class Rollout:
    """What the environments lived through in `length` steps, `(length, num_envs, …)`; images and values one more."""

    def __init__(self, length: int, num_envs: int) -> None:
        self.images = torch.zeros((length + 1, num_envs, 64, 64, 3), dtype=torch.uint8)
        self.values = torch.zeros((length + 1, num_envs))
        self.log_policy = torch.zeros((length, num_envs, len(ACTIONS)))
        self.actions = torch.zeros((length, num_envs), dtype=torch.long)
        self.rewards = torch.zeros((length, num_envs))
        self.terminated = torch.zeros((length, num_envs), dtype=torch.bool)
        self.ended = torch.zeros((length, num_envs), dtype=torch.bool)
        # False for the step after an end, which ignores its action, and for environments whose share is done.
        self.counts = torch.zeros((length, num_envs), dtype=torch.bool)

    def advantages(self, trace: float = 0.95) -> torch.Tensor:
        """Generalised advantages; `values[t + 1]` is, under NEXT_STEP, of an episode's true last observation."""
        advantages = torch.zeros_like(self.rewards)
        later = torch.zeros_like(self.rewards[0])
        for t in reversed(range(len(self.rewards))):
            surprise = self.rewards[t] + DISCOUNT * self.values[t + 1] * ~self.terminated[t] - self.values[t]
            later = surprise + DISCOUNT * trace * later * ~self.ended[t]
            advantages[t] = later
        return advantages


class Learner:
    """PPO that goes on from block to block with the same network and optimiser."""

    def __init__(self, seed: int) -> None:
        torch.manual_seed(seed)
        self.network = Network()
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=5e-4, eps=1e-5)

    @torch.no_grad()
    def policy(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Actions drawn from the policy, its log-probabilities, and the values."""
        log_policy, value = self.network(images)
        return torch.distributions.Categorical(logits=log_policy).sample(), log_policy, value

    def learn(self, rollout: Rollout) -> None:
        """Three passes of PPO over a rollout."""
        advantages = rollout.advantages()
        for _ in range(3):
            for part in minibatches(rollout.counts):
                self.step(self.loss(rollout, advantages, part))

    def loss(self, rollout: Rollout, advantages: torch.Tensor, part: torch.Tensor, clip: float = 0.2) -> torch.Tensor:
        """PPO's loss over some steps of a rollout."""
        target = (advantages + rollout.values[:-1]).flatten()[part]
        advantage = advantages.flatten()[part]
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        action = rollout.actions.flatten()[part, None]
        before = rollout.log_policy.flatten(0, 1)[part].gather(1, action).squeeze(1)
        log_policy, value = self.network(rollout.images[:-1].flatten(0, 1)[part])
        ratio = (log_policy.gather(1, action).squeeze(1) - before).exp()
        gain = torch.min(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean()
        entropy = -(log_policy.exp() * log_policy).sum(-1).mean()
        return 0.5 * (value - target).square().mean() - gain - 0.01 * entropy

    def step(self, loss: torch.Tensor) -> None:
        """One step of the optimiser."""
        self.optimizer.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        nn.utils.clip_grad_norm_(self.network.parameters(), 0.5)
        self.optimizer.step()


def minibatches(counts: torch.Tensor, size: int = 512) -> Iterator[torch.Tensor]:
    """The steps that count, by their place in the flattened rollout, shuffled and dealt out in parts of about one size.

    None is much smaller than the others: the deviation of a single advantage is no number, and one such step would make the
    whole network none.
    """
    places = counts.flatten().nonzero().squeeze(-1)
    if len(places) > 1:
        yield from places[torch.randperm(len(places))].tensor_split(max(1, round(len(places) / size)))


class Lives:
    """A vector environment in which the experiences of a block are lived: each world of its range, once."""

    def __init__(self, num_envs: int, length: int = 64) -> None:
        self.envs = gym.make_vec(
            "driftworld/Task-v0", num_envs, vectorization_mode="vector_entry_point", task=TASK, **OPTIONS
        )
        self.num_envs, self.length = num_envs, length

    def live(self, learner: Learner, regime: dict[str, Any], learning: bool) -> Iterator[dict[str, Any]]:
        """Lives a regime's experiences, each environment a share of them, all at the same time; the numbers of each as it ends."""
        count, first = regime["count"], regime["first_index"]
        if count % self.num_envs:
            raise ValueError(f"count: found {count}, expected a multiple of the {self.num_envs} environments")
        share = count // self.num_envs
        observation, info = self.envs.reset(
            seed=[regime["seed"]] * self.num_envs,
            options={"variant": regime["variant"], "index": [first + env * share for env in range(self.num_envs)]},
        )
        world, left = info["index"].copy(), np.full(self.num_envs, share)
        reward, steps = np.zeros(self.num_envs), np.zeros(self.num_envs, dtype=np.int64)
        just_ended = np.zeros(self.num_envs, dtype=bool)
        image = torch.tensor(observation)
        while left.any():
            rollout = Rollout(self.length, self.num_envs)
            for t in range(self.length):
                counts = ~just_ended & (left > 0)
                action, rollout.log_policy[t], rollout.values[t] = learner.policy(image)
                rollout.images[t], rollout.actions[t], rollout.counts[t] = image, action, torch.tensor(counts)
                observation, pay, terminated, truncated, info = self.envs.step(action.numpy())
                image = torch.tensor(observation)
                rollout.rewards[t] = torch.tensor(pay / 100.0)  # an object pays 100, or costs as much
                rollout.terminated[t] = torch.tensor(terminated)
                just_ended = terminated | truncated
                rollout.ended[t] = torch.tensor(just_ended)
                reward, steps = reward + pay * counts, steps + counts
                for env in np.flatnonzero(just_ended & counts):
                    yield {
                        "reward": reward[env], "success": float(info["is_success"][env]),
                        "episode_step_count": int(steps[env]), "truncated": float(truncated[env]), "world_index": int(world[env]),
                    }  # fmt: skip
                    reward[env], steps[env] = 0.0, 0
                    left[env], world[env] = left[env] - 1, world[env] + 1
                if not left.any():
                    break
            if learning:
                rollout.images[t + 1], rollout.values[t + 1] = image, learner.policy(image)[2]
                learner.learn(rollout)


def scenario(order: tuple[str, ...], seed: int, arguments: argparse.Namespace, evaluate: bool = True) -> dict[str, Any]:
    """Learning blocks in an order; evaluations of all variants around each, on worlds that are not learned from."""

    def regime(variant: str, count: int, seed: int, first: int = 0) -> dict[str, Any]:
        return {"task": TASK, "variant": variant, "count": count, "seed": seed, "first_index": first}

    evaluation = {
        "type": "evaluation",
        "regimes": [regime(variant, arguments.evaluate, seed + 1000) for variant in VARIANTS],
    }
    blocks: list[dict[str, Any]] = [evaluation] if evaluate else []
    for place, variant in enumerate(order):
        # The worlds of a variant go on where its last block left off.
        first = order[:place].count(variant) * arguments.learn
        blocks.append({"type": "learning", "regimes": [regime(variant, arguments.learn, seed, first)]})
        blocks += [evaluation] if evaluate else []
    plan = {"version": 1, "name": "_".join(["two_skies", *order]), "blocks": blocks}
    driftworld.validate(plan, "scenario", check=True)
    return plan


COLUMNS = ["reward", "success", "episode_step_count", "truncated", "world_index"]


def lifetime(learner: Learner, plan: dict[str, Any], folder: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Lives a scenario and logs every experience, or finds it lived; what its blocks came to, and how long they took."""
    agent, kept = folder.name, folder.with_suffix(".json")
    if kept.exists() and not arguments.again:
        done: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8"))
        if done["scenario"] == plan:
            print(f"{agent}: found in {folder}, not lived again (--again does)")
            return done
    shutil.rmtree(folder, ignore_errors=True)
    watch, lives = Watch(), Lives(arguments.num_envs)
    told: list[dict[str, Any]] = []
    learned = experience = 0
    info = {"scenario_type": "custom", "agent": agent, "scenario": plan}
    with driftworld.LogWriter(folder, COLUMNS, scenario_info=info) as log:
        for number, block in enumerate(plan["blocks"]):
            learning = block["type"] == "learning"
            for regime in block["regimes"]:
                rewards: list[float] = []
                for numbers in lives.live(learner, regime, learning):
                    log.write(
                        block_num=number, exp_num=experience, block_type="train" if learning else "test",
                        task_name=f"twoskies_{regime['variant']}",
                        task_params={key: regime[key] for key in ("task", "variant", "seed")}, **numbers,
                    )  # fmt: skip
                    experience += 1
                    rewards.append(numbers["reward"])
                learned += len(rewards) * learning
                told.append({
                    "block": number, "learning": learning, "variant": regime["variant"], "experiences": learned,
                    "reward": round(float(np.mean(rewards[-200:])), 1),
                })  # fmt: skip
                print(
                    f"{agent}: block {number} {block['type']:10} {regime['variant']}: reward {told[-1]['reward']:6.1f}",
                    flush=True,
                )
    done = {"scenario": plan, "seconds": round(watch.seconds, 1), "load_before": watch.load, "told": told}
    kept.write_text(json.dumps(done, indent=2) + "\n", encoding="utf-8")
    return done


def parse_arguments(program: str, text: str) -> argparse.Namespace:
    """What this example and `replay_ppo.py` may be told."""
    parser = argparse.ArgumentParser(description=text.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="a lifetime each (default: 1)")
    parser.add_argument("--learn", type=int, default=1536, help="experiences of a learning block (default: 1536)")
    parser.add_argument(
        "--evaluate", type=int, default=128, help="of each variant in an evaluation block (default: 128)"
    )
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument("--threads", type=int, default=2, help="of PyTorch")
    parser.add_argument("--logs", type=Path, default=Path("logs/two_skies"), help="where the lifetimes are logged")
    parser.add_argument("--again", action="store_true", help="live also what is in the logs already")
    parser.add_argument(
        "--results", nargs="?", const=folder_of(program), metavar="FOLDER", help="write the result down"
    )
    parser.add_argument("--quick", action="store_true", help="a few experiences, to see that it runs")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.learn, arguments.evaluate, arguments.num_envs = 16, 8, 8
    torch.set_num_threads(arguments.threads)
    return arguments


def live_experts(arguments: argparse.Namespace) -> dict[Path, dict[str, Any]]:
    """An expert for each variant and seed, with as much experience as the lifetime's blocks of it; where they are logged."""
    lived = {}
    for seed in arguments.seeds:
        for variant in VARIANTS:
            folder = arguments.logs / f"expert_{variant}_{seed}"
            lived[folder] = lifetime(
                Learner(seed),
                scenario(tuple(block for block in ORDER if block == variant), seed, arguments, evaluate=False),
                folder,
                arguments,
            )
    return lived


def live_lifetimes(
    name: str, learner: Callable[[int], Learner], arguments: argparse.Namespace
) -> dict[Path, dict[str, Any]]:
    """A lifetime over all variants for each seed; where they are logged."""
    lived = {}
    for seed in arguments.seeds:
        folder = arguments.logs / f"{name}_{seed}"
        lived[folder] = lifetime(learner(seed), scenario(ORDER, seed, arguments), folder, arguments)
    return lived


def evaluations(lived: dict[Path, dict[str, Any]], label: str = "") -> list[dict[str, Any]]:
    """A row for each variant and evaluation: its reward, the mean over lifetimes."""
    told = [row for done in lived.values() for row in done["told"] if not row["learning"]]
    places = sorted({(row["variant"], row["experiences"]) for row in told})
    return [
        {
            "run": f"{variant}{label}",
            "experiences": experiences,
            "reward": round(
                float(
                    np.mean(
                        [
                            row["reward"]
                            for row in told
                            if (row["variant"], row["experiences"]) == (variant, experiences)
                        ]
                    )
                ),
                1,
            ),
        }
        for variant, experiences in places
    ]


def levels(experts: dict[Path, dict[str, Any]]) -> dict[str, float]:
    """What the experts earned in their last 200 experiences of learning, mean over seeds."""
    earned: dict[str, list[float]] = {}
    for done in experts.values():
        earned.setdefault(f"expert, {done['told'][-1]['variant']}", []).append(done["told"][-1]["reward"])
    return {name: round(float(np.mean(rewards)), 1) for name, rewards in earned.items()}


def scores_table(**agents: driftworld.Metrics) -> list[dict[str, Any]]:
    """A row for each metric, a column for each agent: the mean over its lifetimes."""
    names = list(next(iter(agents.values())).lifetime)

    def value(scores: driftworld.Metrics, name: str) -> str:
        number = scores.lifetime[name]
        return "none" if number is None else f"{number:.3f}"

    return [{"metric": name} | {agent: value(scores, name) for agent, scores in agents.items()} for name in names]


def show(rows: list[dict[str, Any]]) -> None:
    """Prints a table."""
    for row in [dict.fromkeys(rows[0], ""), *rows]:
        cells = [str(cell or name) for name, cell in row.items()]
        print("  ".join(f"{cell:<{26 if place == 0 else 16}}" for place, cell in enumerate(cells)).rstrip())


def main() -> None:
    """Experts first, then the lifetimes, then the scores."""
    arguments = parse_arguments(__file__, __doc__ or "")
    experts = live_experts(arguments)
    lived = live_lifetimes("sequential_ppo", Learner, arguments)
    scores = driftworld.metrics(list(lived), ste=list(experts))
    table = scores_table(sequential=scores)
    show(table)
    page = driftworld.report(list(lived), ste=list(experts), title="A sequential PPO under two skies")
    (arguments.logs / "sequential_ppo.html").write_text(page, encoding="utf-8")
    print(f"the report is {arguments.logs / 'sequential_ppo.html'}")
    if arguments.results:
        everything = [*experts.values(), *lived.values()]
        Record(
            title="Experts, and a sequential PPO",
            text=f"By day blue cubes pay and red ones cost, in the evening it is the other way round. One PPO lives {', '.join(ORDER)}, "
            f"{arguments.learn} experiences each, and is evaluated in both around each block; experts have the same experience of one variant "
            "alone, and their levels are what they earned in their last 200. The curve is of the evaluations.",
            settings={**vars(arguments), **OPTIONS}, variants=[f"{TASK}#{variant}" for variant in VARIANTS], seeds=arguments.seeds,
            curve=evaluations(lived), lines=levels(experts), table=table, axes=("experiences", "reward"),
            labels=("experiences learned from", "reward in evaluations, mean over lifetimes"),
            seconds=sum(done["seconds"] for done in everything), load_before=everything[0]["load_before"],
            files={"curriculum.json": everything[-1]["scenario"], "two_skies.json": driftworld.TaskSpec.load(TASK).to_dict(), "scores.json": scores.lifetimes, "report.html": page},
        ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
