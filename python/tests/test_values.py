"""Copies and pickles are independent: later changes by the caller, or to files, do not affect them."""

from __future__ import annotations

import copy
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from driftworld import Curriculum
from driftworld._equality import first_difference
from driftworld.envs import DriftworldEnv, DriftworldVectorEnv

SMALL: dict[str, Any] = {"modalities": ["rgb", "state"], "size": 16}
COPIERS: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
}
EACH_COPIER = pytest.mark.parametrize("copier", COPIERS.values(), ids=COPIERS)


class Own(DriftworldEnv):
    """A subclass with its own constructor arguments."""

    def __init__(self, scale: float, *, name: str) -> None:
        super().__init__("find_objects#red", **SMALL)
        self.scale, self.name = scale, name

    def step(self, action: Any) -> Any:
        observation, reward, *rest = super().step(action)
        return observation, self.scale * reward, *rest


class OwnVector(DriftworldVectorEnv):
    """A vector subclass with its own constructor arguments."""

    def __init__(self, names: list[str]) -> None:
        super().__init__("find_objects", len(names), variants=names, **SMALL)
        self.names = names


def expect_same_steps(one: Any, other: Any, steps: int = 6) -> None:
    one.action_space.seed(0)
    for number in range(steps):
        action = one.action_space.sample()
        assert first_difference(one.step(action), other.step(action), f"step {number}") is None
    assert first_difference(one.reset(), other.reset(), "reset") is None
    assert first_difference(one.reset(seed=8), other.reset(seed=8), "reset with a seed") is None


@EACH_COPIER
def test_subclass_with_its_own_arguments_continues(copier: Callable[[Any], Any]) -> None:
    env = Own(2.0, name="mine")
    env.reset(seed=3)
    other = copier(env)
    assert type(other) is Own and (other.scale, other.name) == (2.0, "mine")
    expect_same_steps(env, other)
    envs = OwnVector(["red", "dusk"])
    envs.reset(seed=3)
    other = copier(envs)
    assert type(other) is OwnVector and other.names == ["red", "dusk"]
    expect_same_steps(envs, other)


@EACH_COPIER
def test_changing_a_world_later_changes_no_copy(copier: Callable[[Any], Any]) -> None:
    world = driftworld.variant("find_objects#red").sample(seed=1)
    env = DriftworldEnv(world=world, **SMALL)
    env.reset(seed=0)
    world["max_steps"] = 5
    world["objects"].clear()
    other = copier(env)
    assert other.state()["max_steps"] == env.state()["max_steps"] != 5
    expect_same_steps(env, other)


@EACH_COPIER
def test_changed_or_missing_files_change_no_copy(copier: Callable[[Any], Any], task_file: Path, world_file: Path) -> None:
    task = DriftworldEnv(f"{task_file}#landmarks", **SMALL)
    world = DriftworldVectorEnv(num_envs=2, world=world_file, **SMALL)
    for env in (task, world):
        env.reset(seed=0)
    document = json.loads(task_file.read_text(encoding="utf-8"))
    task_file.write_text(json.dumps({**document, "variants": {}}), encoding="utf-8")
    world_file.unlink()
    for env in (task, world):
        expect_same_steps(env, copier(env))


@EACH_COPIER
def test_changing_options_later_changes_no_copy(copier: Callable[[Any], Any]) -> None:
    drift = {"to": "dusk", "episodes": 3}
    table = [[10.0, 0.0, 0.0], [0.0, 90.0, 0.0]]
    env = DriftworldEnv("find_objects#red", drift=drift, actions=table, modalities=["state"], size=16)
    env.reset(seed=0)
    drift["to"] = "blue"
    table.append([1.0, 1.0, 1.0])
    other = copier(env)
    assert other.action_space == env.action_space
    expect_same_steps(env, other)


@EACH_COPIER
def test_copies_have_their_own_random_generators(copier: Callable[[Any], Any]) -> None:
    envs = DriftworldVectorEnv("find_objects", 2, modalities="state", size=16)
    envs.reset()
    expected = copier(envs)
    other = copier(envs)
    # Draws from the original's generators have no effect on its copies.
    [generator.integers(9) for generator in envs.np_random]
    envs.reset(seed=77)
    expect_same_steps(other, expected)


def test_copy_of_an_unstarted_environment_is_unstarted() -> None:
    import gymnasium

    env = copy.deepcopy(DriftworldVectorEnv("find_objects", 2, modalities="state", size=16))
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(env.action_space.sample())
    env.reset(seed=0)
    env.step(env.action_space.sample())


@EACH_COPIER
def test_long_queue_is_copied_with_its_position(copier: Callable[[Any], Any]) -> None:
    envs = DriftworldVectorEnv("find_objects", 3, modalities="state", size=16, max_episode_steps=1)
    queue = ["red", "blue", "green", "dusk", "near"] * 1000
    envs.reset(seed=0, options={"queue": queue})
    action = envs.action_space.sample()
    for _ in range(4):
        envs.step(action)
    queue.clear()
    expect_same_steps(envs, copier(envs), steps=9)


def scenario(folder: Path) -> Curriculum:
    document = {
        "name": "own",
        "blocks": [
            {"type": "learning", "regimes": [{"task": "own_task.json", "variant": "landmarks", "count": 2, "seed": 1}]},
            {"type": "evaluation", "regimes": [{"task": "a", "variant": "b", "world": "world.json", "count": 1}]},
        ],
    }
    return Curriculum.from_dict(document, folder=folder)


def worlds(curriculum: Curriculum) -> list[Any]:
    return [experience.world() for block in curriculum for experience in block]


def test_curriculum_keeps_its_tasks_and_worlds(task_file: Path, world_file: Path) -> None:
    mine, again = scenario(task_file.parent), scenario(task_file.parent)
    assert mine == again and hash(mine) == hash(again) and mine != mine.scenario
    before = worlds(mine)
    document = json.loads(task_file.read_text(encoding="utf-8"))
    document["description"] = "another"
    task_file.write_text(json.dumps(document), encoding="utf-8")
    assert scenario(task_file.parent) != mine
    task_file.unlink()
    world_file.unlink()
    for copier in COPIERS.values():
        other = copier(mine)
        assert other == mine and worlds(other) == before and other.scenario == mine.scenario
        assert other.blocks == mine.blocks


def test_curricula_are_equal_if_their_contents_are() -> None:
    one, other = (Curriculum.design("find_objects#blue", "find_objects#red", seed=0) for _ in range(2))
    assert one == other and len({one, other}) == 1
    assert one != Curriculum.design("find_objects#blue", "find_objects#red", seed=1)
    assert Curriculum.from_dict(one.to_dict()) == one
    assert one[0] in one and one.index(one[1]) == 1


def test_curriculum_runs_as_loaded(task_file: Path, world_file: Path) -> None:
    class Still:
        """Does nothing."""

        def act(self, observation: Any, info: Any) -> Any:
            return np.zeros(3, dtype=np.float32)

        def learn(self, transition: Any) -> None: ...

        def freeze(self, frozen: bool) -> None: ...

    mine = scenario(task_file.parent)
    task_file.unlink()
    world_file.unlink()
    summary = mine.run(Still(), modalities=["state"], size=16, max_steps=2, interact=True)
    assert summary.finished and summary.experiences == 3
