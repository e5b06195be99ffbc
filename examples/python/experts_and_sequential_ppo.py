"""Single-task experts, and one PPO that meets their tasks one after the other: what does it keep, what carries over?

The task is `two_skies.json` beside this file: by day blue cubes pay and red ones cost, in the evening it is the other way round.
The sky shows which it is, and nothing else tells the learner; one policy could do both. It lives day, evening, day, evening, and
is frozen and evaluated in both before and after each block.

    python examples/python/experts_and_sequential_ppo.py               # experts, lifetime, scores and the report
    python examples/python/experts_and_sequential_ppo.py --seeds 1 2 3 4 5 --results   # what can be written down in results/
    python examples/python/experts_and_sequential_ppo.py --quick       # does it run?

The loop is `Curriculum.run_vector`: it lives the blocks, freezes the learner, checks that evaluations change nothing, and logs.
What `replay_ppo.py` changes is `Learner.update` alone. Needs PyTorch (`pip install torch`).
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import torch
from record import T_95, Record, Watch, folder_of
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
        # What the last observation of an episode is worth, where one ended there.
        self.last_values = torch.zeros((length, num_envs))
        self.log_policy = torch.zeros((length, num_envs, len(ACTIONS)))
        self.actions = torch.zeros((length, num_envs), dtype=torch.long)
        self.rewards = torch.zeros((length, num_envs))
        self.terminated = torch.zeros((length, num_envs), dtype=torch.bool)
        self.ended = torch.zeros((length, num_envs), dtype=torch.bool)
        # False where an environment has no experience: near the end of a block.
        self.counts = torch.zeros((length, num_envs), dtype=torch.bool)

    def advantages(self, trace: float = 0.95) -> torch.Tensor:
        """Generalised advantages. What ran out of time is bootstrapped from its last observation, what terminated is not."""
        advantages = torch.zeros_like(self.rewards)
        later = torch.zeros_like(self.rewards[0])
        following = torch.where(self.ended, self.last_values, self.values[1:])
        for t in reversed(range(len(self.rewards))):
            surprise = self.rewards[t] + DISCOUNT * following[t] * ~self.terminated[t] - self.values[t]
            later = surprise + DISCOUNT * trace * later * ~self.ended[t]
            advantages[t] = later
        return advantages


class Learner:
    """PPO that goes on from block to block with the same network and optimiser: a `driftworld.VectorAgent`.

    Actions are drawn from the number that each experience begins with and from the learner's own seed, minibatches from a
    generator of learning's own. So evaluations take nothing from learning's chance: how often one looks changes nothing that
    is learned, and a lifetime's first block is the block of its expert.

    Args:
        seed: Of the network, the actions and the minibatches.
        num_envs: How many environments it lives in.
        policy: How it acts in evaluations: `"sampled"` from its policy, or `"greedy"`, the likeliest action.
        length: Steps of each environment between updates.
    """

    #: Passes of PPO over a rollout, about four steps of the optimiser each.
    passes = 4

    def __init__(self, seed: int, num_envs: int, policy: str = "sampled", length: int = 64) -> None:
        self.seed, self.policy, self.frozen = seed, policy, False
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            self.network = Network()
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=5e-4, eps=1e-5)
        self.shuffles = torch.Generator().manual_seed(seed)
        self.chances = [np.random.default_rng(seed) for _ in range(num_envs)]
        self.rollout, self.time = Rollout(length, num_envs), 0
        self.updates = 0

    def begin(self, env: int, label: str | None, seed: int) -> None:
        """Before an experience: its actions are drawn from its own number."""
        self.chances[env] = np.random.default_rng([seed, self.seed])

    def freeze(self, frozen: bool) -> None:
        """Whether it is being evaluated."""
        self.frozen = frozen

    @torch.no_grad()
    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        """Actions for all environments, `(num_envs,)`; in learning they are noted with what led to them."""
        images = torch.from_numpy(observations)
        log_policy, values = self.network(images)
        if self.frozen and self.policy == "greedy":
            return log_policy.argmax(dim=-1).numpy()
        drawn = torch.tensor([chance.random() for chance in self.chances])
        actions = (log_policy.exp().cumsum(dim=-1) < drawn[:, None]).sum(dim=-1).clamp(max=len(ACTIONS) - 1)
        if not self.frozen:
            rollout, t = self.rollout, self.time
            rollout.images[t], rollout.values[t], rollout.log_policy[t] = images, values, log_policy
            rollout.actions[t] = actions
        return actions.numpy()

    @torch.no_grad()
    def learn(self, transition: driftworld.VectorTransition) -> None:
        """Notes a step; when the rollout is full, learns from it. One that is not goes on in the next block of learning."""
        rollout, t = self.rollout, self.time
        rollout.rewards[t] = torch.from_numpy(transition.rewards / 100.0)  # an object pays 100, or costs as much
        rollout.terminated[t] = torch.from_numpy(transition.terminated)
        rollout.ended[t] = torch.from_numpy(transition.terminated | transition.truncated)
        rollout.counts[t] = torch.from_numpy(transition.active)
        images = torch.from_numpy(transition.next_observations)
        self.time += 1
        is_full = self.time == len(rollout.rewards)
        if transition.truncated.any() or is_full:
            rollout.last_values[t] = self.network(images)[1]
        if is_full:
            rollout.images[-1], rollout.values[-1] = images, rollout.last_values[t]
            with torch.enable_grad():
                self.update(rollout)
            self.time = 0

    def update(self, rollout: Rollout) -> None:
        """Passes of PPO over a rollout."""
        advantages = rollout.advantages()
        for _ in range(self.passes):
            for part in minibatches(rollout.counts, self.shuffles):
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
        self.updates += 1
        self.optimizer.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        nn.utils.clip_grad_norm_(self.network.parameters(), 0.5)
        self.optimizer.step()

    def kept(self) -> dict[str, Any]:
        """All that it is, as `save` keeps it."""
        return {
            "network": self.network.state_dict(), "optimizer": self.optimizer.state_dict(),
            "shuffles": self.shuffles.get_state(), "rollout": vars(self.rollout), "time": self.time, "updates": self.updates,
        }  # fmt: skip

    def save(self, path: Path) -> None:
        """Keeps it: a lifetime that was interrupted goes on with the same call."""
        torch.save(self.kept(), path)

    def load(self, path: Path) -> None:
        """Brings it back."""
        self.take(torch.load(path))

    def take(self, kept: dict[str, Any]) -> None:
        """Becomes what was kept."""
        self.network.load_state_dict(kept["network"])
        self.optimizer.load_state_dict(kept["optimizer"])
        self.shuffles.set_state(kept["shuffles"])
        vars(self.rollout).update(kept["rollout"])
        self.time, self.updates = kept["time"], kept["updates"]


def minibatches(
    counts: torch.Tensor, chance: torch.Generator | None = None, size: int = 512
) -> Iterator[torch.Tensor]:
    """The steps that count, by their place in the flattened rollout, shuffled and dealt out in parts of about one size.

    None is much smaller than the others: the deviation of a single advantage is no number, and one such step would make the
    whole network none.
    """
    places = counts.flatten().nonzero().squeeze(-1)
    if len(places) > 1:
        yield from places[torch.randperm(len(places), generator=chance)].tensor_split(max(1, round(len(places) / size)))


def scenario(
    order: tuple[str, ...], seed: int, arguments: argparse.Namespace, evaluated: tuple[str, ...] = VARIANTS
) -> dict[str, Any]:
    """Learning blocks in an order; evaluations around each, on worlds that are not learned from."""

    def regime(variant: str, count: int, seed: int, first: int = 0) -> dict[str, Any]:
        return {"task": TASK, "variant": variant, "count": count, "seed": seed, "first_index": first}

    evaluation = {
        "type": "evaluation",
        "regimes": [regime(variant, arguments.evaluate, seed + 1000) for variant in evaluated],
    }
    blocks: list[dict[str, Any]] = [evaluation] if evaluated else []
    for place, variant in enumerate(order):
        # The worlds of a variant go on where its last block left off.
        first = order[:place].count(variant) * arguments.learn
        blocks.append({"type": "learning", "regimes": [regime(variant, arguments.learn, seed, first)]})
        blocks += [evaluation] if evaluated else []
    plan = {"version": 1, "name": "_".join(["two_skies", *order]), "blocks": blocks}
    driftworld.validate(plan, "scenario", check=True)
    return plan


def lifetime(learner: Learner, plan: dict[str, Any], folder: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Lives a scenario and logs every experience, or finds it lived; what its blocks came to, and how long they took."""
    agent, kept = folder.name, folder.with_suffix(".json")
    made_with = {"scenario": plan, "policy": learner.policy, "num_envs": arguments.num_envs}
    if kept.exists() and not arguments.again:
        done: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8"))
        if done["made_with"] == made_with:
            print(f"{agent}: found in {folder}, not lived again (--again does)")
            return done
    shutil.rmtree(folder, ignore_errors=True)
    watch = Watch()
    learner.name = agent
    curriculum = driftworld.Curriculum.from_dict(plan)
    summary = curriculum.run_vector(learner, folder, num_envs=arguments.num_envs, **OPTIONS)
    told = blocks_of(summary, folder)
    for row in told:
        print(f"{agent}: block {row['block']} {row['kind']:10} {row['variant']}: reward {row['reward']:6.1f}", flush=True)
    done = {
        "made_with": made_with, "seconds": round(watch.seconds, 1), "load_before": watch.load, "told": told,
        "optimiser_steps": learner.updates,
    }  # fmt: skip
    kept.write_text(json.dumps(done, indent=2) + "\n", encoding="utf-8")
    return done


def blocks_of(summary: driftworld.Summary, folder: Path) -> list[dict[str, Any]]:
    """What each regime came to: its mean reward, of learning that of its last 200 experiences, and how many were learned from."""
    log = driftworld.read_log(folder)
    told, learned, first = [], 0, 0
    for regime in summary.regimes:
        rewards = log["reward"][first : first + regime["experiences"]]
        first += regime["experiences"]
        learned += regime["experiences"] * (regime["kind"] == "learning")
        told.append({
            "block": regime["block"], "kind": regime["kind"], "variant": regime["variant"].partition("#")[2],
            "experiences": learned, "reward": round(float(np.mean(rewards[-200:])), 1),
            "success": round(regime["success_rate"], 3),
        })  # fmt: skip
    return told


def parse_arguments(program: str, text: str) -> argparse.Namespace:
    """What this example and `replay_ppo.py` may be told."""
    parser = argparse.ArgumentParser(description=text.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="a lifetime each (default: 1)")
    parser.add_argument("--learn", type=int, default=1536, help="experiences of a learning block (default: 1536)")
    parser.add_argument(
        "--evaluate", type=int, default=128, help="of each variant in an evaluation block (default: 128)"
    )
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument(
        "--policy", choices=["sampled", "greedy"], default="sampled", help="how it acts in evaluations (default: sampled)"
    )
    parser.add_argument("--threads", type=int, default=2, help="of PyTorch")
    parser.add_argument("--logs", type=Path, default=Path("logs/two_skies"), help="where the lifetimes are logged")
    parser.add_argument("--again", action="store_true", help="live also what is in the logs already")
    parser.add_argument(
        "--results", nargs="?", const=folder_of(program), metavar="FOLDER", help="write the result down"
    )
    parser.add_argument("--quick", action="store_true", help="a few experiences, to see that it runs")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.learn, arguments.evaluate, arguments.num_envs, arguments.threads = 16, 8, 8, 1
    torch.set_num_threads(arguments.threads)
    return arguments


MakeLearner = Callable[[int, int, str], Learner]


def live_experts(name: str, make: MakeLearner, arguments: argparse.Namespace) -> dict[Path, dict[str, Any]]:
    """Experts of the same learner, one for each variant and seed, with as much experience as the lifetime's blocks of it.

    They are evaluated where the lifetime is. Returns where they are logged.
    """
    lived = {}
    for seed in arguments.seeds:
        for variant in VARIANTS:
            folder = arguments.logs / f"expert_{name}_{variant}_{seed}"
            order = tuple(block for block in ORDER if block == variant)
            plan = scenario(order, seed, arguments, evaluated=(variant,))
            lived[folder] = lifetime(make(seed, arguments.num_envs, arguments.policy), plan, folder, arguments)
    return lived


def live_lifetimes(name: str, make: MakeLearner, arguments: argparse.Namespace) -> dict[Path, dict[str, Any]]:
    """A lifetime over all variants for each seed; where they are logged."""
    lived = {}
    for seed in arguments.seeds:
        folder, plan = arguments.logs / f"{name}_{seed}", scenario(ORDER, seed, arguments)
        lived[folder] = lifetime(make(seed, arguments.num_envs, arguments.policy), plan, folder, arguments)
    return lived


def evaluations(lived: Mapping[Path, dict[str, Any]], label: str = "") -> list[dict[str, Any]]:
    """A row for each lifetime, variant and evaluation: none is averaged away."""
    return [
        {
            "run": f"{row['variant']}{label}" + ("" if len(lived) == 1 else f", {folder.name.rpartition('_')[2]}"),
            "experiences": row["experiences"],
            "reward": row["reward"],
            "success": row["success"],
        }
        for folder, done in lived.items()
        for row in sorted(done["told"], key=lambda row: row["variant"])
        if row["kind"] == "evaluation"
    ]


def levels(experts: Mapping[Path, dict[str, Any]]) -> dict[str, float]:
    """What the experts earned when they were last evaluated, mean over seeds."""
    earned: dict[str, list[float]] = {}
    for done in experts.values():
        earned.setdefault(f"expert, {done['told'][-1]['variant']}", []).append(done["told"][-1]["reward"])
    return {f"{name} (n = {len(each)})": round(float(np.mean(each)), 1) for name, each in earned.items()}


def scores_table(**agents: driftworld.Metrics) -> list[dict[str, Any]]:
    """A row for each metric, a column for each agent: the mean over its lifetimes, of several with an interval of 95 %."""
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
    """Experts first, then the lifetimes, then the scores."""
    arguments = parse_arguments(__file__, __doc__ or "")
    experts = live_experts("sequential", Learner, arguments)
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
            f"{arguments.learn} experiences each, and is evaluated in both around each block ({arguments.evaluate} worlds each, {arguments.policy} "
            f"policy); experts are the same learner with the same experience of one variant alone, evaluated in the same worlds. "
            f"{said_of(arguments.seeds)} The curve is of the evaluations.",
            settings={**vars(arguments), **OPTIONS, "optimiser_steps": [done["optimiser_steps"] for done in lived.values()]},
            variants=[f"{TASK}#{variant}" for variant in VARIANTS], seeds=arguments.seeds,
            curve=evaluations(lived), lines=levels(experts), table=table, axes=("experiences", "reward"),
            labels=("experiences learned from", "reward in evaluations, each lifetime"),
            seconds=sum(done["seconds"] for done in everything), load_before=everything[0]["load_before"],
            files={"curriculum.json": everything[-1]["made_with"]["scenario"], "two_skies.json": driftworld.TaskSpec.load(TASK).to_dict(), "scores.json": scores.lifetimes},
        ).write(arguments.results)  # fmt: skip


def said_of(seeds: list[int]) -> str:
    """How many lifetimes there are, and what that carries."""
    if len(seeds) == 1:
        return "One lifetime (n = 1): what it shows of this seed need not hold for another, and no difference can be told from luck."
    return f"n = {len(seeds)} lifetimes, each with worlds and a network of its own."


if __name__ == "__main__":
    main()
