"""Regimes with a budget of decisions run the experiences that an independent computation expects, even after a kill."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driftworld import Curriculum, SpecError, read_log
from small_lifetime import SMALL, Circler, Pupil, rows
from test_vector_lifetimes import Many


class Stroller(Circler):
    """Walks at random, seeded by the experience."""

    def begin(self, label: str | None, seed: int) -> None:
        self.random = np.random.default_rng(seed)

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        return np.array([9, self.random.uniform(-60, 60), 0], dtype=np.float32)


def scenario(budgets: dict[str, int], **block: Any) -> dict[str, Any]:
    """A scenario with episodes of different lengths, because lava ends them."""
    regimes = [
        {"task": "lava_crossing", "variant": variant, "count": 50, "steps": steps, "seed": 3, "max_steps": 9 + 8 * place}
        for place, (variant, steps) in enumerate(budgets.items())
    ]
    evaluated = [{"task": "lava_crossing", "variant": variant, "count": 2, "max_steps": 9} for variant in budgets]
    evaluation = {"type": "evaluation", "regimes": evaluated}
    blocks = [{"type": "learning", "regimes": regimes, **block}, evaluation, {"type": "learning", "regimes": regimes[:1]}]
    return {"name": "budgets", "blocks": [*blocks, evaluation]}


def expected(curriculum: Curriculum, lengths: dict[int, int], num_envs: int) -> set[int]:
    """The numbers of the experiences that should run, from a simulation of the environments step by step."""
    run: set[int] = set()
    for block in curriculum:
        waiting, left, spent = list(block), [0] * num_envs, {}
        regimes: list[int] = [-1] * num_envs
        while True:
            for env in range(num_envs):
                while left[env] == 0 and waiting:
                    now = waiting.pop(0)
                    if now.steps is None or spent.get(now.regime, 0) < now.steps:
                        run.add(now.number)
                        left[env], regimes[env] = lengths[now.number], now.regime
            if not any(left):
                break
            for env in range(num_envs):
                if left[env]:
                    left[env] -= 1
                    spent[regimes[env]] = spent.get(regimes[env], 0) + 1
    return run


@pytest.mark.parametrize("mix", ["in_order", "shuffled"])
@pytest.mark.parametrize("num_envs", [1, 2, 5])
def test_budget_runs_the_expected_experiences(tmp_path: Path, num_envs: int, mix: str) -> None:
    budgets = {"lava": 40 + 7 * num_envs, "middle": 61}
    curriculum = Curriculum.from_dict(scenario(budgets, mix=mix))
    summary = curriculum.run_vector(Many(num_envs, Stroller), tmp_path / "log", num_envs=num_envs, **SMALL)
    assert summary.finished
    columns = read_log(tmp_path / "log").columns
    numbers, steps = columns["exp_num"].tolist(), columns["episode_step_count"].astype(int).tolist()
    lengths = dict(zip(numbers, steps, strict=True))
    assert set(numbers) == expected(curriculum, lengths, num_envs)
    assert numbers == sorted(numbers) and len(set(steps)) > 1
    for regime, budget in enumerate(budgets.values()):
        learned = [lengths[each.number] for each in curriculum[0] if each.regime == regime and each.number in lengths]
        # The last experiences start before the budget is spent.
        assert budget <= sum(learned) < budget + num_envs * max(learned)


@pytest.mark.parametrize("budget", range(21, 105, 12))
@pytest.mark.parametrize("num_envs", [2, 3])
def test_log_contains_every_learned_step(tmp_path: Path, num_envs: int, budget: int) -> None:
    """This holds even if all environments end in the same step."""
    curriculum = Curriculum.from_dict(scenario({"lava": budget, "middle": budget}))
    agents = Many(num_envs, Stroller)
    assert curriculum.run_vector(agents, tmp_path / "log", num_envs=num_envs, **SMALL).finished
    columns = read_log(tmp_path / "log").columns
    assert agents.steps == columns["episode_step_count"][columns["block_type"] == "train"].astype(int).sum()


def test_one_vector_environment_equals_a_single_one(tmp_path: Path) -> None:
    curriculum = Curriculum.from_dict(scenario({"lava": 50, "middle": 33}))
    curriculum.run(Pupil(), tmp_path / "one", **SMALL)
    curriculum.run_vector(Many(1, Pupil), tmp_path / "many", num_envs=1, **SMALL)
    assert rows(tmp_path / "one") == rows(tmp_path / "many")


@pytest.mark.parametrize("num_envs", [1, 3])
def test_budget_resumes_after_a_kill(tmp_path: Path, num_envs: int) -> None:
    curriculum = Curriculum.from_dict(scenario({"lava": 70, "middle": 64}))

    class Shared(Many):
        """The agents share their knowledge, which affects every action."""

        def __init__(self) -> None:
            super().__init__(num_envs, Pupil)

        def act(self, observations: Any, infos: dict[str, Any]) -> Any:
            known = sum(agent.knowledge for agent in self.agents)
            turns = [(known * 37 + agent.seed % 1000) % 180 - 90 for agent in self.agents]
            return np.array([[8, turn, 0] for turn in turns], dtype=np.float32)

        def save(self, path: Path) -> None:
            path.write_text(json.dumps([agent.knowledge for agent in self.agents]), encoding="utf-8")

        def load(self, path: Path) -> None:
            for agent, knowledge in zip(self.agents, json.loads(path.read_text(encoding="utf-8")), strict=True):
                agent.knowledge = knowledge

    curriculum.run_vector(Shared(), tmp_path / "whole", num_envs=num_envs, **SMALL)
    whole = rows(tmp_path / "whole")
    for place in range(1, len(whole["exp_num"]) - 1, 2):
        log, left = tmp_path / f"log{place}", iter(range(place))
        watch = lambda *_, left=left: next(left, None) is not None
        assert not curriculum.run_vector(Shared(), log, num_envs=num_envs, watch=watch, **SMALL).finished
        assert curriculum.run_vector(Shared(), log, num_envs=num_envs, **SMALL).finished
        assert rows(log) == whole


def test_budget_applies_to_learning_only() -> None:
    wrong = scenario({"lava": 50})
    wrong["blocks"][1]["regimes"][0]["steps"] = 5
    with pytest.raises(SpecError, match="/blocks/1/regimes/0/steps.*: found 5, expected no step budget in an evaluation or a drift"):
        Curriculum.from_dict(wrong)
