"""Curricula that run in many environments at once write the same log as in a single one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driftworld import Curriculum, CurriculumError, Transition, VectorAgent, VectorTransition, read_log, validate_log
from small_lifetime import SMALL, Pupil, rows, small
from test_lifetimes import QUARRY


class Looker:
    """Turns according to its observations and its seed, and learns nothing. One per environment acts like a single one."""

    name = "looker"

    def __init__(self) -> None:
        self.seed = 0

    def begin(self, label: str | None, seed: int) -> None:
        self.seed = seed

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        turn = (int(observation.sum()) * 31 + self.seed % 1009) % 180 - 90
        return np.array([8, turn, 0], dtype=np.float32)

    def learn(self, transition: Transition) -> None:
        pass

    def freeze(self, frozen: bool) -> None:
        pass


class Many:
    """A vector agent made of one agent per environment."""

    def __init__(self, num_envs: int, make: Any) -> None:
        self.agents = [make() for _ in range(num_envs)]
        self.name = self.agents[0].name
        self.steps = 0
        self.infos: list[dict[str, Any]] = []

    def begin(self, env: int, label: str | None, seed: int) -> None:
        self.agents[env].begin(label, seed)

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        self.infos.append(infos)
        return np.stack([agent.act(observations[env], infos) for env, agent in enumerate(self.agents)])

    def learn(self, transition: VectorTransition) -> None:
        self.steps += int(transition.active.sum())
        assert not transition.rewards[~transition.active].any()
        assert not (transition.terminated | transition.truncated)[~transition.active].any()
        for env in np.flatnonzero(transition.active):
            self.agents[env].learn(
                Transition(
                    transition.observations[env],
                    transition.actions[env],
                    float(transition.rewards[env]),
                    bool(transition.terminated[env]),
                    bool(transition.truncated[env]),
                    transition.next_observations[env],
                    {},
                )
            )

    def freeze(self, frozen: bool) -> None:
        for agent in self.agents:
            agent.freeze(frozen)

    def save(self, path: Path) -> None:
        if hasattr(self.agents[0], "save"):
            self.agents[0].save(path)

    def load(self, path: Path) -> None:
        self.agents[0].load(path)


def test_one_vector_environment_logs_the_same_as_run(tmp_path: Path) -> None:
    curriculum, alone, many = small(), Pupil(), Many(1, Pupil)
    assert isinstance(many, VectorAgent)
    summary = curriculum.run(alone, tmp_path / "run", **SMALL)
    found = curriculum.run_vector(many, tmp_path / "vector", num_envs=1, **SMALL)
    assert rows(tmp_path / "vector") == rows(tmp_path / "run")
    assert validate_log(tmp_path / "vector")["valid"]
    assert many.agents[0].knowledge == alone.knowledge != 0
    assert many.agents[0].frozen == alone.frozen and many.agents[0].begun == alone.begun
    assert found.regimes == summary.regimes and found.steps == summary.steps


@pytest.mark.parametrize("num_envs", [2, 3, 8])
def test_evaluations_do_not_depend_on_the_number_of_environments(tmp_path: Path, num_envs: int) -> None:
    regimes = [
        {"task": "get_to_goal", "variant": name, "count": 7, "seed": 4, "max_steps": 300} for name in ("plain", "held")
    ]
    blocks = [{"type": kind, "regimes": regimes} for kind in ("evaluation", "learning", "evaluation")]
    curriculum = Curriculum.from_dict({"name": "many", "blocks": blocks})
    curriculum.run(Looker(), tmp_path / "run", **SMALL)
    many = Many(num_envs, Looker)
    curriculum.run_vector(many, tmp_path / "vector", num_envs=num_envs, **SMALL)
    # The agent does not learn, so rewards are the same in learning blocks too, and so is the order of the rows.
    assert rows(tmp_path / "vector") == rows(tmp_path / "run")
    log = read_log(tmp_path / "vector")
    assert len({str(reward) for reward in log["reward"]}) >= 3
    learned = [steps for steps, kind in zip(log["episode_step_count"], log["block_type"], strict=True) if kind == "train"]
    assert many.steps == sum(learned)


@pytest.mark.parametrize("finished", [1, 4, 6, 9, 12, 16])
def test_stopped_run_resumes_as_if_uninterrupted(tmp_path: Path, finished: int) -> None:
    class Class:
        """One learner for three environments."""

        name = "class"

        def __init__(self) -> None:
            self.pupil = Pupil()
            self.seeds = [0] * 3

        def begin(self, env: int, label: str | None, seed: int) -> None:
            self.seeds[env] = seed

        def act(self, observations: Any, infos: dict[str, Any]) -> Any:
            turns = [(self.pupil.knowledge * 37 + seed % 1000) % 180 - 90 for seed in self.seeds]
            return np.array([[8, turn, 0] for turn in turns], dtype=np.float32)

        def learn(self, transition: VectorTransition) -> None:
            seen = float(transition.next_observations[transition.active].mean())
            self.pupil.knowledge = (self.pupil.knowledge * 3 + transition.rewards.sum() + seen) % 1000

        def freeze(self, frozen: bool) -> None:
            pass

        def save(self, path: Path) -> None:
            self.pupil.save(path)

        def load(self, path: Path) -> None:
            self.pupil.load(path)

    curriculum, undisturbed, second = small(), Class(), Class()
    curriculum.run_vector(undisturbed, tmp_path / "whole", num_envs=3, **SMALL)
    stopped = curriculum.run_vector(
        Class(), tmp_path / "log", num_envs=3, watch=lambda experience, reward: experience.number + 1 < finished, **SMALL
    )
    assert (stopped.experiences, stopped.finished) == (finished, False)
    assert curriculum.run_vector(second, tmp_path / "log", num_envs=3, **SMALL).finished
    assert rows(tmp_path / "log") == rows(tmp_path / "whole")
    assert second.pupil.knowledge == undisturbed.pupil.knowledge != 0
    with pytest.raises(CurriculumError, match="/made_from/num_envs"):
        curriculum.run_vector(Class(), tmp_path / "log", num_envs=4, **SMALL)


def test_agent_changed_by_evaluations_is_refused() -> None:
    class Counter(Looker):
        begun = 0

        def begin(self, label: str | None, seed: int) -> None:
            self.begun += 1

        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            return np.array([self.begun, 20 * (self.begun % 3), 0], dtype=np.float32)

    regimes = [{"task": "get_to_goal", "variant": "soft", "count": 6, "seed": 1, "max_steps": 30}]
    curriculum = Curriculum.from_dict({"name": "frozen", "blocks": [{"type": "evaluation", "regimes": regimes}]})
    with pytest.raises(CurriculumError, match="block 0: found a different action in step 1 of experience"):
        curriculum.run_vector(Many(3, Counter), num_envs=3, **SMALL)
    assert curriculum.run_vector(Many(3, Counter), num_envs=3, check_frozen=False, **SMALL).finished


@pytest.mark.parametrize("label", ["none", "info", "observation"])
def test_infos_match_those_of_run(label: str) -> None:
    curriculum = Curriculum.design("find_objects#blue", "find_objects#red", learn=3, eval_episodes=3, task_label=label)
    options = {**SMALL, "modalities": ["rgb"], "max_steps": 2}

    class Listener(Looker):
        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            return np.zeros(3, dtype=np.float32)

    class Seeing(Many):
        seen: list[Any]

        def act(self, observations: Any, infos: dict[str, Any]) -> Any:
            self.infos.append(infos)
            self.seen = [*getattr(self, "seen", []), observations]
            return np.zeros((2, 3), dtype=np.float32)

        def learn(self, transition: VectorTransition) -> None:
            pass

    many, full = Seeing(2, Listener), Seeing(2, Listener)
    curriculum.run_vector(many, num_envs=2, **options)
    curriculum.run_vector(full, num_envs=2, info="full", **options)
    wanted = {"active", "is_success", *(["task_label"] if label == "info" else [])}
    assert {key for infos in many.infos for key in infos} == wanted
    assert {"events", "variant_id", "task_id", "seed", "index", "world_hash"} <= set(full.infos[0])
    numbers = {"find_objects#blue": 0, "find_objects#red": 1}
    for infos, seen in zip(full.infos, full.seen, strict=True):
        named = [numbers[name] for name, active in zip(infos["variant_id"], infos["active"], strict=True) if active]
        if label == "info":
            assert infos["task_label"][infos["active"]].tolist() == named
        if label == "observation":
            assert seen["task"].argmax(axis=1)[infos["active"]].tolist() == named
    if label == "observation":
        # Single images have no room for the label: its numbers are in the infos.
        many.infos.clear()
        curriculum.run_vector(many, num_envs=2, **{**options, "modalities": "rgb"})
        assert all("task_label" in infos for infos in many.infos)


def test_undrawable_worlds_are_skipped(tmp_path: Path) -> None:
    task = tmp_path / "quarry.json"
    task.write_text(json.dumps(QUARRY), encoding="utf-8")
    curriculum = Curriculum.design(f"{task}#low", f"{task}#high", drift="linear", learn=21, eval_episodes=1, worlds=0)
    options: dict[str, Any] = {"modalities": "rgb", "size": 8}
    with pytest.raises(CurriculumError, match=r"quarry#low\.\.high at progress 0\.45"):
        curriculum.run_vector(Many(4, Looker), num_envs=4, **options)
    summary = curriculum.run_vector(Many(4, Looker), tmp_path / "vector", num_envs=4, skip_undrawable=True, **options)
    assert summary.finished and summary.skipped == 3 and summary.experiences == 22
    curriculum.run(Looker(), tmp_path / "run", skip_undrawable=True, **options)
    assert rows(tmp_path / "vector") == rows(tmp_path / "run")


def test_invalid_agent_is_refused() -> None:
    with pytest.raises(TypeError, match="without act, learn, freeze"):
        small().run_vector(object(), num_envs=2, **SMALL)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="num_envs: found 0"):
        small().run_vector(Many(1, Looker), num_envs=0, **SMALL)
