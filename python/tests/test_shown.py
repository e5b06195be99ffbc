"""Observations and actions have the forms that the task defines, even if its variants differ in them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from driftworld import Curriculum, DriftworldEnv, DriftworldVectorEnv, TaskSpec, Transition

SIZE = 24
ALL = ("rgb", "depth", "segmentation", "class", "instance")


def _task(**agent: Any) -> dict[str, Any]:
    """A task whose parameter selects the modalities, with a variant for each choice."""
    choices = [["rgb"], ["depth"], ["class", "rgb"], ["instance", "segmentation"], []]
    shown = {"role": "variant", "type": "json", "affects": ["O"], "choices": choices, "default": ["rgb"]}
    may_interact = {"role": "variant", "type": "boolean", "affects": ["A"], "choices": [True, False], "default": True}
    return {
        "name": "shows",
        "parameters": {"shown": shown, "may": may_interact},
        "world": {
            "max_steps": 3,
            "environment_params": {"map_size": [20, 20]},
            "agent_params": {"modalities": {"param": "shown"}, "interact": {"param": "may"}, "observation_size": SIZE, **agent},
            "objects": [{"class": "cube", "coordinates": [0, 4]}],
        },
        "variants": {**{f"v{number}": {"shown": choice} for number, choice in enumerate(choices)}, "no_hand": {"may": False}},
    }


@pytest.fixture
def task(tmp_path: Path) -> str:
    path = tmp_path / "shows.json"
    path.write_text(json.dumps(_task()))
    return str(path)


@pytest.mark.parametrize(
    ("variant", "expected"),
    [("blue", ["rgb", "depth"]), ("rgb_only", ["rgb"]), ("depth_only", ["depth"]), ("with_class", ["rgb", "class"])],
)
def test_observation_has_the_variants_modalities(variant: str, expected: list[str]) -> None:
    env = DriftworldEnv("find_objects", variant=variant, size=SIZE)
    observation, _ = env.reset(seed=3)
    assert set(observation) == {*expected, "state"}
    everything = DriftworldEnv("find_objects", variant=variant, size=SIZE, modalities=ALL).reset(seed=3)[0]
    for kind in expected:
        np.testing.assert_array_equal(observation[kind], everything[kind])
        assert observation[kind].any()


def test_batch_has_all_variants_modalities_and_each_fills_its_own(task: str) -> None:
    names = [f"v{number}" for number in range(5)]
    own = _task()["parameters"]["shown"]["choices"]
    envs = DriftworldVectorEnv(task, num_envs=5, variants=names, actions="normalized")
    everything = DriftworldVectorEnv(task, num_envs=5, variants=names, modalities=[*ALL, "state"], actions="normalized")
    assert set(envs.single_observation_space.spaces) == {*ALL, "state"}  # type: ignore[attr-defined]
    (found, _), (full, _) = envs.reset(seed=1), everything.reset(seed=1)
    for _ in range(8):
        for env, modalities in enumerate(own):
            for kind in ALL:
                expected = full[kind][env] if kind in modalities else np.zeros_like(full[kind][env])
                np.testing.assert_array_equal(found[kind][env], expected)
        actions = np.tile([1.0, 0.3, 0.0], (5, 1))
        found, full = envs.step(actions)[0], everything.step(actions)[0]
    assert all(full[kind].any() for kind in ("rgb", "depth"))


def test_blank_gives_all_variants_one_space(task: str) -> None:
    env = DriftworldEnv(task, modalities=["rgb", "depth", "class", "instance", "segmentation"], blank=True)
    for name, modalities in [("v0", {"rgb"}), ("v1", {"depth"}), ("v2", {"class", "rgb"}), ("v4", set[str]())]:
        observation, _ = env.reset(seed=2, options={"variant": name})
        assert {kind for kind, image in observation.items() if image.any()} == modalities
        assert env.observation_space.contains(observation)


def test_variant_with_other_modalities_is_refused_with_advice(task: str) -> None:
    env = DriftworldEnv(task)
    with pytest.raises(ValueError, match="found images of depth, expected some of rgb, state, .*blank=True"):
        env.reset(seed=0, options={"variant": "v1"})
    with pytest.raises(ValueError, match="blank: found True without modalities"):
        DriftworldEnv(task, blank=True)


def test_worlds_without_modalities_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "shows.json"
    path.write_text(json.dumps(_task(state_features=[])))
    with pytest.raises(ValueError, match="modalities: found worlds that show nothing, expected some of rgb"):
        DriftworldEnv(str(path), variant="v4")


def test_actions_are_the_tasks_rows_or_numbers_of_one_width(task: str, tmp_path: Path) -> None:
    assert DriftworldEnv(task).action_space == gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)
    assert DriftworldEnv(task, variant="no_hand").action_space == gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32)
    # The third number has an effect only if the agent may interact.
    env = DriftworldEnv(task)
    env.reset(seed=0, options={"variant": "no_hand"})
    env.step(np.array([1.0, 0.0, 1.0], dtype=np.float32))
    envs = DriftworldVectorEnv(task, num_envs=2, variants=["no_hand", "v0"])
    assert envs.single_action_space.shape == (3,)
    table = tmp_path / "rows.json"
    table.write_text(json.dumps(_task(actions={"discrete": [[1, 0, 0], [0, 90, 0]]})))
    assert DriftworldEnv(str(table)).action_space == gymnasium.spaces.Discrete(2)
    assert DriftworldEnv(str(table), actions="normalized").action_space.shape == (3,)


class _Watcher:
    """Acts at random and records its images and their variants."""

    def __init__(self, space: gymnasium.Space[Any]) -> None:
        self.space = space
        self.variant = ""
        self.shown: set[tuple[str, frozenset[str]]] = set()

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        self.variant = info.get("variant_id", self.variant)
        kinds = frozenset(kind for kind, image in observation.items() if kind != "state" and image.any())
        self.shown.add((self.variant, kinds))
        return self.space.sample()

    def learn(self, transition: Transition) -> None:
        pass

    def freeze(self, frozen: bool) -> None:
        pass


class _Watchers(_Watcher):
    """Like `_Watcher`, for many environments."""

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        num_envs = len(observations["state"])
        for env in np.flatnonzero(infos["active"]):
            super().act({kind: images[env] for kind, images in observations.items()}, {})
        return np.stack([self.space.sample() for _ in range(num_envs)])


def _curriculum(*variants: str) -> Curriculum:
    regimes = [{"task": "find_objects", "variant": variant, "count": 2, "seed": 5} for variant in variants]
    for regime in regimes:
        regime["max_steps"] = 4
    return Curriculum.from_dict({"name": "shown", "blocks": [{"type": "evaluation", "regimes": regimes}]})


MODALITIES = {"blue": {"rgb", "depth"}, "rgb_only": {"rgb"}, "depth_only": {"depth"}, "with_class": {"rgb", "class"}}


def test_lifetime_over_modalities_shows_each_variant_its_own() -> None:
    curriculum = _curriculum("rgb_only", "blue", "depth_only", "with_class")
    env = curriculum.environment(size=SIZE)
    assert set(env.observation_space.spaces) == {"rgb", "depth", "class", "state"}  # type: ignore[attr-defined]
    alone, together = _Watcher(env.action_space), _Watchers(env.action_space)
    curriculum.run(alone, check_frozen=False, size=SIZE, info="full")
    assert alone.shown == {(f"find_objects#{variant}", frozenset(kinds)) for variant, kinds in MODALITIES.items()}
    curriculum.run_vector(together, num_envs=3, check_frozen=False, size=SIZE)  # type: ignore[arg-type]
    assert {kinds for _, kinds in together.shown} == {frozenset(kinds) for kinds in MODALITIES.values()}


@pytest.mark.parametrize("first", ["no_interact", "blue"])
def test_lifetime_with_and_without_interaction_uses_the_wider_actions(first: str) -> None:
    curriculum = _curriculum(first, "no_interact", "blue", "interact", "waypoints", "slow")
    space = curriculum.environment(size=SIZE).action_space
    assert space.shape == (3,)
    summary = curriculum.run(_Watcher(space), check_frozen=False, size=SIZE, info="full")
    assert summary.finished and summary.experiences == 12


def test_warnings_are_about_the_current_world() -> None:
    world = {
        "environment_params": {"map_size": [20, 20]},
        "objects": [{"class": "switch", "coordinates": [2, 2], "switch": {"target": "nothing"}}],
    }
    assert DriftworldEnv(world=world).warnings() == [
        '/objects/0/switch/target: no door has the tag "nothing"; the switch has no effect'
    ]
    del world["objects"]
    assert DriftworldEnv(world=world).warnings() == []


def test_state_features_do_not_matter_without_the_state() -> None:
    foraging = TaskSpec.load("foraging").variant("plenty")
    envs = DriftworldVectorEnv("find_objects#red", 2, modalities="rgb", size=16)
    envs.reset(seed=0)
    seen, _ = envs.reset(seed=1, options={"variants": [foraging] * 2})
    own, _ = DriftworldVectorEnv("foraging#plenty", 2, modalities="rgb", size=16).reset(seed=1)
    np.testing.assert_array_equal(seen, own)
    with pytest.raises(ValueError, match="found state_features"):
        envs = DriftworldVectorEnv("find_objects#red", 2, modalities=["rgb", "state"], size=16)
        envs.reset(options={"variants": [foraging] * 2})


def test_instruction_is_last_in_the_state_and_matches_the_drawn_values() -> None:
    env = DriftworldEnv("fetch#four", modalities=["rgb", "state"], size=16)
    colors = {"red": (1, 0, 0), "blue": (0, 0, 1), "gold": (1, 215 / 255, 0), "limegreen": (50 / 255, 205 / 255, 50 / 255)}
    instructions = set()
    for seed in range(12):
        observation, _ = env.reset(seed=seed)
        instruction = observation["state"][-4:]
        assert sorted(instruction) == [0, 0, 0, 1]
        assert env.observation_space.contains(observation)
        pays = next(each for each in env.unwrapped.state()["objects"] if each.get("reward", 0) > 0)
        assert tuple(pays["color"]) == list(colors.values())[int(instruction.argmax())]
        instructions.add(int(instruction.argmax()))
    assert len(instructions) > 1
    with pytest.raises(ValueError, match="found instruction_len 0, expected 4"):
        env.reset(options={"variant": TaskSpec.load("thin_ice").variant("lake")})
