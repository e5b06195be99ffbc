"""PPO with experience replay in the style of CLEAR, compared with the same sequential learner without replay.

After Rolnick et al. 2019 (arXiv:1811.11682): a reservoir keeps a uniform sample of all past experience; each update
from new experience is paired with one from the same amount of old experience, by V-trace, and *cloning* keeps policy
and values close to what they were when the old experience was collected. The learner does not know where one task ends
and another begins. Network, worlds, curriculum, counts and optimiser steps are those of
`experts_and_sequential_ppo.py`, whose logs are used for comparison; missing ones are made first. The experts here use
replay too, so a comparison with them shows the effect of the order of tasks, not of the learner.

    python examples/python/replay_ppo.py               # lifetimes, scores and a report that compares them
    python examples/python/replay_ppo.py --seeds 1 2 3 4 5 --results     # also write the record into results/
    python examples/python/replay_ppo.py --quick       # only checks that it runs

Needs PyTorch (`pip install torch`).
"""

from __future__ import annotations

import driftworld
from driftworld.learners import CLEAR
from experts_and_sequential_ppo import (
    OPTIONS,
    TASK,
    VARIANTS,
    Learner,
    evaluations,
    levels,
    parse_arguments,
    run_experts,
    run_lifetimes,
    sample_size_note,
    scores_table,
    show,
)
from record import Record


class ReplayLearner(Learner, CLEAR):
    """PPO on new experience, V-trace and cloning on old: three passes over the new experience and, in place of the fourth,
    as many optimiser steps on the old.
    """

    epochs = 3

    def __init__(self, seed: int, num_envs: int, policy: str = "sampled", length: int = 64, capacity: int = 256) -> None:
        super().__init__(seed, num_envs, policy, length, capacity=capacity)


def main() -> None:
    """Runs the lifetimes with replay and those without, and compares them."""
    arguments = parse_arguments(__file__, __doc__ or "")
    plain_experts, experts = run_experts("sequential", Learner, arguments), run_experts("replay", ReplayLearner, arguments)
    without = run_lifetimes("sequential_ppo", Learner, arguments)
    with_replay = run_lifetimes("replay_ppo", ReplayLearner, arguments)
    compared = driftworld.metrics(list(with_replay), against=list(without), ste=list(experts))
    table = scores_table(
        replay=driftworld.metrics(list(with_replay), ste=list(experts)),
        sequential=driftworld.metrics(list(without), ste=list(plain_experts)),
    )
    show(table)
    page = driftworld.report(list(with_replay), against=list(without), ste=list(experts), title="PPO with experience replay")
    (arguments.logs / "replay_ppo.html").write_text(page, encoding="utf-8")
    print(f"the report is {arguments.logs / 'replay_ppo.html'}")
    if arguments.results:
        runs = list(with_replay.values())
        steps = {"replay": [run["optimiser_steps"] for run in runs], "sequential": [run["optimiser_steps"] for run in without.values()]}
        Record(
            title="PPO with experience replay",
            text="The learner, the worlds and the curriculum of `experts_and_sequential_ppo.py`, with a reservoir of 256 stretches of 64 steps "
            "in the style of CLEAR, and the same number of optimiser steps. "
            "Each learner is compared with experts of its own kind. "
            f"Evaluations by the {arguments.policy} policy. {sample_size_note(arguments.seeds)} The curve shows the evaluations; the time is that of the "
            "lifetimes with replay alone.",
            settings={**vars(arguments), **OPTIONS, "optimiser_steps": steps}, variants=[f"{TASK}#{variant}" for variant in VARIANTS], seeds=arguments.seeds,
            curve=evaluations(with_replay, ", replay") + evaluations(without, ", sequential"), lines=levels(experts), table=table, axes=("experiences", "reward"),
            labels=("experiences learned from", "reward in evaluations, each lifetime"),
            seconds=sum(done["seconds"] for done in runs), load_before=runs[0]["load_before"],
            files={"two_skies.json": driftworld.TaskSpec.load(TASK).to_dict(), "curriculum.json": runs[0]["made_with"]["scenario"], "scores.json": compared.lifetimes, "improvement.json": compared.improvement},
        ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
