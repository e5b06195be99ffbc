"""An agent that acts differently when an evaluation is repeated is refused, whatever its rewards."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from conftest import ROOT
from driftworld import Curriculum, CurriculumError

#: Every built-in task and example world, by name or path.
TASKS = [*driftworld.built_in_tasks(), *map(str, sorted((ROOT / "examples" / "worlds").glob("*.json")))]


#: Number of lifetimes: one in each task, four with DRIFTWORLD_FULL=1.
LIFETIMES = len(TASKS) * (4 if os.environ.get("DRIFTWORLD_FULL") == "1" else 1)


class Uniform:
    """Draws its actions from the seed of the experience: correctly frozen."""

    def begin(self, label: str | None, seed: int) -> None:
        self.rng = np.random.default_rng(seed)

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        return self.rng.uniform(-1, 1, 3).astype(np.float32)

    def learn(self, transition: Any) -> None: ...

    def freeze(self, frozen: bool) -> None: ...


class FromNumpy(Uniform):
    """Draws from NumPy's global generator."""

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        return np.random.uniform(-1, 1, 3).astype(np.float32)


class FromTorch(Uniform):
    """Draws from torch's global generator."""

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        import torch

        return (torch.rand(3) * 2 - 1).numpy()


class Normaliser(Uniform):
    """Updates a running mean of its observations, also in evaluations."""

    count, mean = 0, 0.0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        self.count += 1
        self.mean += (float(np.mean(observation)) - self.mean) / self.count
        return np.full(3, np.tanh(self.mean / 255), dtype=np.float32)


CALLS = [0]


class Counter(Uniform):
    """Keeps a counter outside the agent."""

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        CALLS[0] += 1
        return np.full(3, np.sin(CALLS[0]), dtype=np.float32)


class Many:
    """A vector agent made of one agent per environment."""

    def __init__(self, kind: type[Uniform], num_envs: int) -> None:
        self.agents = [kind() for _ in range(num_envs)]

    def begin(self, env: int, label: str | None, seed: int) -> None:
        self.agents[env].begin(label, seed)

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        rows = zip(self.agents, observations, infos["active"], strict=True)
        return np.stack([agent.act(row, {}) if active else np.zeros(3, np.float32) for agent, row, active in rows])

    def learn(self, transition: Any) -> None: ...

    def freeze(self, frozen: bool) -> None: ...


def run(kind: type[Uniform], name: str, seed: int, num_envs: int | None, **options: Any) -> Any:
    variant = driftworld.TaskSpec.load(name).variant_names()[0]
    regime = {"task": name, "variant": variant, "count": 5, "seed": seed, "max_steps": 6}
    curriculum = Curriculum.from_dict({"name": "frozen", "blocks": [{"type": "evaluation", "regimes": [regime]}]})
    small = {"modalities": "rgb", "size": 8, "actions": "normalized", "interact": True, **options}
    if num_envs is None:
        return curriculum.run(kind(), **small)
    return curriculum.run_vector(Many(kind, num_envs), num_envs=num_envs, **small)


@pytest.mark.parametrize("num_envs", [None, 2], ids=["run", "run_vector"])
@pytest.mark.parametrize(
    "kind", [FromNumpy, pytest.param(FromTorch, marks=pytest.mark.learners), Normaliser, Counter]
)
def test_unfrozen_agent_is_refused_in_every_lifetime(kind: type[Uniform], num_envs: int | None) -> None:
    if kind is FromTorch:
        pytest.importorskip("torch", reason="the generator is its")
    np.random.seed(3)
    for lifetime in range(LIFETIMES):
        name = TASKS[lifetime % len(TASKS)]
        with pytest.raises(CurriculumError, match=r"block 0: found a different action in step \d+ of experience \d") as refused:
            run(kind, name, lifetime, num_envs)
        assert refused.value.code == "curriculum/not-frozen"


@pytest.mark.parametrize("num_envs", [None, 2], ids=["run", "run_vector"])
@pytest.mark.parametrize("name", TASKS, ids=lambda name: Path(name).stem)
def test_frozen_agent_is_never_refused(name: str, num_envs: int | None) -> None:
    for seed in range(2):
        assert run(Uniform, name, seed, num_envs).finished
    assert run(FromNumpy, name, 0, num_envs, check_frozen=False).finished


@pytest.mark.parametrize("num_envs", [None, 2], ids=["run", "run_vector"])
def test_refused_lifetime_is_refused_again_and_resumes_with_a_frozen_agent(tmp_path: Path, num_envs: int | None) -> None:
    curriculum = Curriculum.design("find_objects#blue", "find_objects#red", learn=1, eval_episodes=2, seed=0)

    def run_with(kind: type[Uniform]) -> Any:
        agent = kind() if num_envs is None else Many(kind, num_envs)
        agent.name = "one"  # type: ignore[union-attr]
        run = curriculum.run if num_envs is None else lambda agent, **more: curriculum.run_vector(agent, num_envs=2, **more)
        return run(agent, log=tmp_path / "log", modalities="rgb", size=8, max_steps=6)  # type: ignore[operator]

    for _ in range(3):
        with pytest.raises(CurriculumError, match="block 0: found a different action"):
            run_with(FromNumpy)
    assert run_with(Uniform).finished
