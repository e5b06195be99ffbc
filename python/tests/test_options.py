"""Options of environments and resets: valid ones take effect, and invalid ones change nothing."""

from __future__ import annotations

from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest

FIND = "driftworld/FindObjects-v0"
SMALL: dict[str, Any] = {"modalities": ["state"], "size": 36}


def env_of(env_id: str = FIND, **options: Any) -> Any:
    return gym.make(env_id, disable_env_checker=True, **{**SMALL, **options}).unwrapped


def vector(num_envs: int = 2, env_id: str = FIND, **options: Any) -> Any:
    return gym.make_vec(env_id, num_envs, vectorization_mode="vector_entry_point", **{**SMALL, **options})


@pytest.mark.parametrize("variant", ["red", "find_objects#red", driftworld.variant("find_objects#red")])
def test_drift_starts_with_the_variant_in_every_form(variant: Any) -> None:
    env = env_of(variant=variant, drift={"to": "dusk", "episodes": 3}, info="full")
    ids = [env.reset(seed=0)[1]["variant_id"], env.reset()[1]["variant_id"], env.reset()[1]["variant_id"]]
    assert ids[0] == "find_objects#red" and ids[2] == "find_objects#dusk" and ids[1] not in (ids[0], ids[2])


def test_none_in_variants_means_the_tasks_variant() -> None:
    envs = vector(3, "driftworld/Task-v0", task="find_objects#blue", variants=[None, "red", "find_objects#dusk"], info="full")
    _, infos = envs.reset(seed=0)
    assert list(infos["variant_id"]) == ["find_objects#blue", "find_objects#red", "find_objects#dusk"]


def test_every_initial_variant_has_a_label() -> None:
    env = env_of(task_label="info")
    assert env.reset(seed=0)[1]["task_label"] >= 0
    seen = env_of(task_label="observation")
    assert seen.reset(seed=0)[0]["task"].sum() == 1.0
    assert seen.observation_space.contains(seen.reset()[0])


def test_failed_reset_changes_nothing() -> None:
    env = env_of(variant="blue", info="full")
    env.reset(seed=5)
    for wrong in (
        {"seed": -1, "options": {"variant": "red"}},
        {"options": {"variant": "rde"}},
        {"options": {"variant": "red", "index": -1}},
        {"options": {"variant": "red", "world": {"objects": 3}}},
    ):
        with pytest.raises((ValueError, gym.error.Error)):
            env.reset(**wrong)
    _, info = env.reset()
    assert (info["variant_id"], info["seed"], info["index"]) == ("find_objects#blue", 5, 1)
    envs = vector()
    envs.reset(seed=5)
    with pytest.raises(ValueError):
        envs.reset(seed=[50, -1])
    _, infos = envs.reset()
    assert infos["seed"].tolist() == driftworld.spread_seeds(5, 2) and infos["index"].tolist() == [1, 1]


def test_additional_step_limit_acts_like_gymnasiums_time_limit() -> None:
    """It truncates even if the world ends in the same step, and is not part of the worlds."""
    options = {"env_id": "driftworld/GetToGoal-v0", "modalities": ["state"]}
    alone = env_of(**options)
    alone.reset(seed=3)
    toward = np.array([1.0, 0.3, 0.0], dtype=np.float32)
    steps, terminated, truncated = 0, False, False
    while not (terminated or truncated):
        _, _, terminated, truncated, _ = alone.step(toward)
        steps += 1
    limited = vector(1, max_episode_steps=steps, **options)
    limited.reset(seed=3)
    for _ in range(steps):
        _, _, last_terminated, last_truncated, _ = limited.step(toward[None])
    assert last_truncated[0] and last_terminated[0] == terminated
    assert limited.state(0)["max_steps"] == alone.state()["max_steps"]


@pytest.mark.parametrize("limit", [0, -2, 1.5, "many"])
def test_invalid_step_limit_is_refused(limit: Any) -> None:
    with pytest.raises(ValueError, match="max_episode_steps: found"):
        vector(max_episode_steps=limit)


def test_minus_one_means_no_limit() -> None:
    envs = vector(1, max_episode_steps=-1, max_steps=3)
    envs.reset(seed=0)
    ends = [bool(envs.step(envs.action_space.sample())[3][0]) for _ in range(3)]
    assert ends == [False, False, True]


def test_variants_with_different_actions_are_refused() -> None:
    env = env_of(actions="continuous")
    for variant in ("slow", "waypoints"):
        with pytest.raises(ValueError, match="found actions of numbers in"):
            env.reset(options={"variant": variant})
    # Normalised actions suit all of them.
    env_of().reset(options={"variant": "waypoints"})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"size": 64.0}, "size: found 64.0"),
        ({"modalities": 3}, "modalities: found 3, expected one of rgb"),
        ({"modalities": []}, "modalities: found"),
        ({"interact": "yes"}, "interact: found 'yes'"),
        ({"actions": [["a", 1, 2]]}, "actions: found"),
        ({"actions": [[float("nan"), 1, 2]]}, "actions: found"),
        ({"drift": "dusk"}, "drift: found 'dusk'"),
        ({"drift": {"to": "dusk", "episodes": 0}}, "drift.episodes: found 0"),
        ({"frame_skip": -1}, "frame_skip: found -1, expected a whole number in 0.."),
        ({"camera": "behind"}, "camera: found 'behind'"),
        ({"render_size": 640}, "render_size: found 640"),
    ],
)
def test_wrong_option_is_named_with_its_value(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as error:
        env_of(**options)
    assert str(error.value).startswith(message)


def test_numpy_numbers_are_accepted() -> None:
    env = env_of(interact=np.bool_(False), frame_skip=np.int64(2), drift={"to": "dusk", "episodes": np.int64(5)})
    assert env.action_space.shape == (2,)


def test_threads_are_limited_to_the_number_of_environments() -> None:
    envs = vector(2, num_threads=100_000)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match="num_threads: found -1"):
        vector(num_threads=-1)


def test_closing_one_window_leaves_the_others_open() -> None:
    pytest.importorskip("pygame", reason="windows are pygame's")
    first, second = env_of(render_mode="human"), env_of(render_mode="human")
    first.reset(seed=0)
    second.reset(seed=0)
    first.close()
    second.step(second.action_space.sample())
    second.close()


def test_keyboard_is_refused_for_waypoint_actions() -> None:
    with pytest.raises(ValueError, match="found actions that are rows or places"):
        env_of(variant="waypoints").get_keys_to_action()
