"""PPO that rehearses: the sequential learner with experience replay in the manner of CLEAR, beside the one without.

After Rolnick et al. 2019 (arXiv:1811.11682): a reservoir keeps a fair sample of everything that was ever lived; beside each
update from new experience stands one from as much of the old, by V-trace, and *cloning* holds policy and values near what they
were at that time. Nothing tells the learner where one task ends and another begins. Network, worlds, curriculum, counts and
steps of the optimiser are those of `experts_and_sequential_ppo.py`, whose logs this one is compared with; what is not there yet is
lived first. Its experts rehearse as well: a comparison with them is about the order of tasks, not about the learner.

    python examples/python/replay_ppo.py               # lifetimes, scores and the report that compares
    python examples/python/replay_ppo.py --seeds 1 2 3 4 5 --results     # what can be written down in results/
    python examples/python/replay_ppo.py --quick       # does it run?

Needs PyTorch (`pip install torch`).
"""

from __future__ import annotations

from typing import Any

import driftworld
import numpy as np
import torch
from experts_and_sequential_ppo import (
    DISCOUNT,
    OPTIONS,
    TASK,
    VARIANTS,
    Learner,
    Rollout,
    evaluations,
    levels,
    live_experts,
    live_lifetimes,
    minibatches,
    parse_arguments,
    said_of,
    scores_table,
    show,
)
from record import Record


class Reservoir:
    """A fair sample of all stretches of experience ever offered (Vitter's algorithm R), each `length` steps of one environment."""

    def __init__(self, capacity: int, seed: int) -> None:
        self.capacity, self.offered = capacity, 0
        self.stretches: list[dict[str, torch.Tensor]] = []
        self.chance = np.random.default_rng(seed)

    def offer(self, rollout: Rollout) -> None:
        """Offers every environment's stretch of a rollout."""
        for env in range(rollout.rewards.shape[1]):
            if not rollout.counts[:, env].any():
                continue
            self.offered += 1
            place = len(self.stretches)
            if place == self.capacity:
                place = int(self.chance.integers(self.offered))
                if place >= self.capacity:
                    continue
            stretch = {name: value[:, env].clone() for name, value in vars(rollout).items()}
            self.stretches[place : place + 1] = [stretch]

    def draw(self, count: int) -> dict[str, torch.Tensor]:
        """Stretches drawn with replacement, `(length, count, …)`."""
        chosen = [self.stretches[place] for place in self.chance.integers(len(self.stretches), size=count)]
        return {name: torch.stack([stretch[name] for stretch in chosen], dim=1) for name in chosen[0]}


class ReplayLearner(Learner):
    """PPO on what is new, V-trace and cloning on what is old: three passes over the one, and as many steps as a fourth on the other."""

    passes = 3

    def __init__(self, seed: int, num_envs: int, policy: str = "sampled", length: int = 64, capacity: int = 256) -> None:
        super().__init__(seed, num_envs, policy, length)
        self.reservoir = Reservoir(capacity, seed)

    def update(self, rollout: Rollout) -> None:
        """As PPO does, with one pass less; in its place steps from the reservoir, each from eight stretches."""
        super().update(rollout)
        self.reservoir.offer(rollout)
        for _ in minibatches(rollout.counts, self.shuffles):
            self.step(self.replay_loss(self.reservoir.draw(8)))

    def kept(self) -> dict[str, Any]:
        """With the reservoir."""
        reservoir = self.reservoir
        chance = reservoir.chance.bit_generator.state
        return super().kept() | {"reservoir": (reservoir.offered, reservoir.stretches, chance)}

    def take(self, kept: dict[str, Any]) -> None:
        """With the reservoir."""
        super().take(kept)
        self.reservoir.offered, self.reservoir.stretches, self.reservoir.chance.bit_generator.state = kept["reservoir"]

    def replay_loss(
        self, old: dict[str, torch.Tensor], policy_cloning: float = 0.1, value_cloning: float = 0.05
    ) -> torch.Tensor:
        """The loss on old experience; means over the steps that count.

        The weights of cloning are not the paper's, whose losses are sums and whose learner is not PPO.
        """
        length, count = old["rewards"].shape
        log_policy, values = self.network(old["images"].flatten(0, 1))
        log_policy, values = log_policy.view(length + 1, count, -1)[:-1], values.view(length + 1, count)
        action = old["actions"].unsqueeze(-1)
        log_prob = log_policy.gather(-1, action).squeeze(-1)
        log_ratio = log_prob - old["log_policy"].gather(-1, action).squeeze(-1)
        target, advantage = v_trace(old, values.detach(), log_ratio.detach())
        entropy = -(log_policy.exp() * log_policy).sum(-1)
        clone_policy = (old["log_policy"].exp() * (old["log_policy"] - log_policy)).sum(-1)
        clone_value = (values[:-1] - old["values"][:-1]).square()
        loss = (
            0.5 * (values[:-1] - target).square() - advantage * log_prob - 0.01 * entropy
            + policy_cloning * clone_policy + value_cloning * clone_value
        )  # fmt: skip
        return loss[old["counts"]].mean()


def v_trace(
    old: dict[str, torch.Tensor], values: torch.Tensor, log_ratio: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """V-trace targets and policy-gradient advantages (Espeholt et al. 2018, eq. 1), ratios cut off at 1; `(length, count)` each."""
    ratio = log_ratio.exp().clamp(max=1.0)
    goes_on, bootstraps = ~old["ended"], ~old["terminated"]
    # Of an episode that ran out of time there is no later observation: what its last one was worth then stands in its place.
    following = torch.where(old["ended"], old["last_values"], values[1:])
    targets, advantages = torch.zeros_like(ratio), torch.zeros_like(ratio)
    later = torch.zeros_like(ratio[0])
    for t in reversed(range(len(ratio))):
        surprise = ratio[t] * (old["rewards"][t] + DISCOUNT * following[t] * bootstraps[t] - values[t])
        # `later` is how far the next step's target lies above its value; nothing of it crosses the end of an episode.
        carried = later * goes_on[t]
        advantages[t] = ratio[t] * (
            old["rewards"][t] + DISCOUNT * (following[t] + carried) * bootstraps[t] - values[t]
        )
        later = surprise + DISCOUNT * ratio[t] * carried
        targets[t] = values[t] + later
    return targets, advantages


def main() -> None:
    """The lifetimes with replay, and what they are compared with."""
    arguments = parse_arguments(__file__, __doc__ or "")
    ordinary, experts = live_experts("sequential", Learner, arguments), live_experts("replay", ReplayLearner, arguments)
    without = live_lifetimes("sequential_ppo", Learner, arguments)
    lived = live_lifetimes("replay_ppo", ReplayLearner, arguments)
    compared = driftworld.metrics(list(lived), against=list(without), ste=list(experts))
    table = scores_table(
        replay=driftworld.metrics(list(lived), ste=list(experts)),
        sequential=driftworld.metrics(list(without), ste=list(ordinary)),
    )
    show(table)
    page = driftworld.report(list(lived), against=list(without), ste=list(experts), title="PPO with experience replay")
    (arguments.logs / "replay_ppo.html").write_text(page, encoding="utf-8")
    print(f"the report is {arguments.logs / 'replay_ppo.html'}")
    if arguments.results:
        runs = list(lived.values())
        steps = {"replay": [run["optimiser_steps"] for run in runs], "sequential": [run["optimiser_steps"] for run in without.values()]}
        Record(
            title="PPO with experience replay",
            text="The learner, the worlds and the curriculum of `experts_and_sequential_ppo.py`, with a reservoir of 256 stretches of 64 steps "
            "in the manner of CLEAR, and as many steps of the optimiser. Each learner is compared with experts of its own kind. "
            f"Evaluations by the {arguments.policy} policy. {said_of(arguments.seeds)} The curve is of the evaluations; the time is that of the "
            "lifetimes with replay alone.",
            settings={**vars(arguments), **OPTIONS, "optimiser_steps": steps}, variants=[f"{TASK}#{variant}" for variant in VARIANTS], seeds=arguments.seeds,
            curve=evaluations(lived, ", replay") + evaluations(without, ", sequential"), lines=levels(experts), table=table, axes=("experiences", "reward"),
            labels=("experiences learned from", "reward in evaluations, each lifetime"),
            seconds=sum(done["seconds"] for done in runs), load_before=runs[0]["load_before"],
            files={"two_skies.json": driftworld.TaskSpec.load(TASK).to_dict(), "curriculum.json": runs[0]["made_with"]["scenario"], "scores.json": compared.lifetimes, "improvement.json": compared.improvement},
        ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
