"""Curricula of Syllabus choose variants of Driftworld's environments, without changes to Syllabus."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from driftworld import TaskError

pytestmark = [pytest.mark.learners, pytest.mark.filterwarnings("ignore")]
CEILINGS = {"red": 100.0, "blue": 50.0, "dusk": 200.0}


@pytest.fixture(autouse=True)
def syllabus() -> Any:
    """The library. NumPy's error handling, which it changes, is restored afterwards."""
    before = np.geterr()
    yield pytest.importorskip("syllabus.curricula", reason="needs Syllabus: pip install syllabus-rl matplotlib scipy")
    np.seterr(**before)


def make_env() -> Any:
    from driftworld.adapters.syllabus import DriftworldTaskEnv

    env = gym.make("driftworld/FindObjects-v0", modalities="rgb", size=8, actions="discrete", max_steps=6, info="full")
    return DriftworldTaskEnv(env, CEILINGS)


def test_task_is_a_variant_and_its_completion_a_share_of_the_ceiling(monkeypatch: pytest.MonkeyPatch) -> None:
    env = make_env()
    assert (env.task_space.tasks, env.variants) == ([0, 1, 2], list(CEILINGS))
    _, info = env.reset(new_task=2, seed=5)
    assert (info["variant_id"], info["task"], info["task_completion"]) == ("find_objects#dusk", 2, 0.0)
    rewards = iter([-10.0, 60.0, 50.0, 300.0])
    step = env.env.step

    def scripted_step(action: Any) -> Any:
        observation, _, *more = step(action)
        return observation, next(rewards), *more

    monkeypatch.setattr(env.env, "step", scripted_step)
    assert [env.step(0)[4]["task_completion"] for _ in range(4)] == [0.0, 0.25, 0.5, 1.0]
    # A change takes effect in the next episode.
    env.change_task(1)
    assert env.task == 2
    assert env.reset()[1]["variant_id"] == "find_objects#blue"
    with pytest.raises(ValueError, match="task: found 3, expected 0 to 2"):
        env.reset(new_task=3)
    with pytest.raises(TaskError):
        type(env)(env.env, {"rde": 1.0})
    with pytest.raises(ValueError, match="above 0"):
        type(env)(env.env, {"red": 0.0})


def run_episodes(curriculum: Any, episodes: int, update: Any = None) -> list[str]:
    """Runs ``episodes`` episodes chosen by a curriculum, in Syllabus's wrapper; returns their variants."""
    from syllabus.core import GymnasiumSyncWrapper, make_multiprocessing_curriculum

    shared = make_multiprocessing_curriculum(curriculum, timeout=20)
    env = GymnasiumSyncWrapper(make_env(), curriculum.task_space, shared.components, batch_size=4)
    played = []
    try:
        for _ in range(episodes):
            _, info = env.reset()
            played.append(info["variant_id"].partition("#")[2])
            ended = False
            while not ended:
                _, reward, terminated, truncated, info = env.step(int(env.action_space.sample()))
                ended = terminated or truncated
                if update is not None:
                    update(reward, ended, info["task"])
    finally:
        shared.stop()
    return played


def test_prioritized_level_replay_runs_unchanged() -> None:
    import torch
    from syllabus.curricula import CentralPrioritizedLevelReplay

    env = make_env()
    curriculum = CentralPrioritizedLevelReplay(
        env.task_space, num_steps=6, num_processes=1, task_sampler_kwargs_dict={"strategy": "value_l1", "replay_schedule": "fixed"}
    )

    def update(reward: float, ended: bool, task: int) -> None:
        # In "blue" the values are wrong, so its priority rises.
        value = torch.full((1, 1), 100.0 * (task == 1))
        sample = {"value": value, "next_value": value, "rew": [reward], "dones": [ended], "tasks": [task]}
        curriculum.update(sample)

    played = run_episodes(curriculum, 30, update)
    assert set(played) == set(CEILINGS)
    assert curriculum._sample_distribution()[1] == max(curriculum._sample_distribution())


def test_learning_progress_runs_with_its_distribution_as_a_list() -> None:
    import torch
    from syllabus.core import Evaluator, GymnasiumEvaluationWrapper
    from syllabus.curricula import LearningProgress

    class Listed(LearningProgress):  # type: ignore[misc, unused-ignore]
        """A workaround: since NumPy 1.25 the sampling of syllabus-rl 0.7 cannot compare an array with an empty list."""

        def _sample_distribution(self) -> list[float]:
            return list(super()._sample_distribution())

    class Random(Evaluator):
        def _get_action(self, state: Any, recurrent_state: Any = None, done: Any = None) -> Any:
            return torch.from_numpy(self.eval_envs.action_space.sample()), recurrent_state, {}

    env = make_env()
    envs = gym.vector.SyncVectorEnv([lambda: GymnasiumEvaluationWrapper(make_env(), task_space=env.task_space) for _ in range(3)])
    evaluator = Random(torch.nn.Linear(1, 1), task_space=env.task_space, eval_envs=envs, copy_agent=False)
    curriculum = Listed(evaluator, env.task_space, eval_interval=4, eval_eps=3, continuous_progress=True)
    assert set(run_episodes(curriculum, 12)) <= set(CEILINGS)
    assert np.isclose(sum(curriculum._sample_distribution()), 1.0)
