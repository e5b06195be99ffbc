"""`set_next` during an episode takes effect from the next episode on, in single and in vector environments."""

from __future__ import annotations

from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference
from gymnasium.error import Error

FIND = "driftworld/FindObjects-v0"
OPTIONS: dict[str, Any] = {"size": 8, "modalities": ["rgb", "state"], "actions": "discrete", "info": "full"}
VARIANTS = ["red", "blue", "dusk", "near"]


def make_envs(num_envs: int, mode: str, **options: Any) -> Any:
    return gym.make_vec(
        FIND,
        num_envs,
        vectorization_mode="vector_entry_point",
        autoreset_mode=mode,
        max_episode_steps=4,
        **{**OPTIONS, **options},
    ).unwrapped


def random_arguments(rng: np.random.Generator) -> dict[str, Any]:
    """Random arguments of `set_next` for one environment."""
    match rng.integers(4):
        case 0:
            return {"variant": str(rng.choice(VARIANTS))}
        case 1:
            return {"index": int(rng.integers(100))}
        case 2:
            return {"queue": [str(name) for name in rng.choice(VARIANTS, 3)]}
        case _:
            seed = int(rng.integers(100))
            return {"world": driftworld.variant("find_objects#red").sample(seed), "variant": str(rng.choice(VARIANTS))}


@pytest.mark.parametrize("mode", ["next_step", "same_step"])
@pytest.mark.parametrize("seed", range(3))
def test_set_next_in_a_vector_environment_equals_single_environments(mode: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    envs = make_envs(3, mode)
    alone = [gym.make(FIND, max_episode_steps=4, **OPTIONS) for _ in range(3)]
    envs.reset(seed=seed)
    for env, own in zip(alone, driftworld.spread_seeds(seed, 3)):
        env.reset(seed=own)
    ended = [False] * 3
    for _ in range(40):
        env = int(rng.integers(3))
        arguments = random_arguments(rng)
        queue = arguments.pop("queue", None)
        mask = np.arange(3) == env
        envs.set_next(**{name: [value] for name, value in arguments.items()}, queue=queue, mask=mask)
        alone[env].unwrapped.set_next(**arguments, queue=queue)  # type: ignore[attr-defined]
        actions = rng.integers(0, envs.single_action_space.n, 3)
        observations, rewards, terminated, truncated, _ = envs.step(actions)
        for env, (one, action) in enumerate(zip(alone, actions)):
            if mode == "next_step" and ended[env]:
                observation, ended[env] = one.reset()[0], False
                assert rewards[env] == 0.0
            else:
                observation, reward, *flags, _ = one.step(action)
                assert (rewards[env], [terminated[env], truncated[env]]) == (reward, flags)
                ended[env] = any(flags)
                if mode == "same_step" and ended[env]:
                    observation = one.reset()[0]
            assert first_difference({kind: seen[env] for kind, seen in observations.items()}, observation) is None
            assert envs.origin(env) == one.unwrapped.origin()  # type: ignore[attr-defined]


def test_current_episodes_continue_and_requests_persist() -> None:
    envs, plain = make_envs(4, "same_step"), make_envs(4, "same_step")
    envs.reset(seed=1)
    plain.reset(seed=1)
    envs.set_next(variant=["dusk", None, "blue"], mask=np.array([True, True, True, False]))
    envs.set_next(variant="red", mask=np.zeros(4, dtype=bool))
    actions = np.zeros(4, dtype=np.int64)
    for _ in range(3):
        assert first_difference(envs.step(actions)[:4], plain.step(actions)[:4]) is None
    for _ in range(2):
        for _ in range(4):
            envs.step(actions)
        assert [envs.origin(env)["variant_id"].partition("#")[2] for env in range(4)] == [
            "dusk",
            "default",
            "blue",
            "default",
        ]


@pytest.mark.parametrize(
    "arguments",
    [
        {"variant": "rde"},
        {"variant": ["red", "rde"]},
        {"variant": ["red"]},
        {"index": -1},
        {"index": [1, -1]},
        {"world": {"objects": 3}},
        {"variant": "red", "queue": ["red"]},
        {"queue": []},
        {"mask": [True, False]},
        {"variant": "red", "mask": np.ones(3, dtype=bool)},
    ],
    ids=str,
)
def test_invalid_requests_change_nothing(arguments: dict[str, Any]) -> None:
    envs = make_envs(2, "same_step")
    envs.reset(seed=5)
    with pytest.raises((ValueError, TypeError, Error, driftworld.TaskError)):
        envs.set_next(**arguments)
    envs.reset()
    assert [envs.origin(env)["variant_id"] for env in range(2)] == ["find_objects#default"] * 2
    assert [envs.origin(env)["index"] for env in range(2)] == [1, 1]


def test_labels_include_the_initial_variants() -> None:
    task = driftworld.TaskSpec.load("get_to_goal")
    own = [variant.id for variant in driftworld.TaskSpec.load("find_objects").variants]
    options: dict[str, Any] = {"modalities": "rgb", "size": 8, "actions": "discrete", "interact": False}
    others = [task.variant("plain"), task.variant("soft"), None, task.variant("plain")]
    for modalities, label in (("rgb", "observation"), ("rgb", "info"), (["rgb"], "observation")):
        envs = make_envs(4, "same_step", variants=others, **{**options, "modalities": modalities, "task_label": label})
        observations, infos = envs.reset(seed=0)
        # The labels of initial variants from elsewhere follow the task's own.
        expected = [len(own) + 1, len(own) + 2, len(own), len(own) + 1]
        if isinstance(modalities, list):
            assert observations["task"].argmax(axis=1).tolist() == expected
            assert observations["task"].sum(axis=1).tolist() == [1.0] * 4
        else:
            assert infos["task_label"].tolist() == expected


def test_removed_word_is_refused_with_its_replacement() -> None:
    with pytest.raises(ValueError, match='task_label: found "obs": removed in 0.3; use "observation"'):
        gym.make(FIND, task_label="obs")


def test_with_a_mask_each_environment_gets_its_own_queue() -> None:
    envs, alone = make_envs(4, "next_step"), gym.make(FIND, max_episode_steps=4, **OPTIONS)
    envs.reset(seed=0)
    queue = ["red", "dusk", "near"]
    envs.reset(options={"queue": queue, "reset_mask": np.arange(4) >= 2})
    for _ in range(6):
        _, info = alone.reset(options={"queue": queue} if _ == 0 else None)
        assert [envs.origin(env)["variant_id"] for env in (2, 3)] == [info["variant_id"]] * 2
        for _ in range(5):
            envs.step(np.zeros(4, dtype=np.int64))


def test_first_observation_of_one_environment_has_its_label() -> None:
    envs = make_envs(2, "next_step", variant="near", task_label="observation")
    envs.reset(seed=0)
    first, info = envs.reset_one(1, options={"variant": "red"})
    assert first["task"].argmax() == envs._members.label_number(1) and info["variant_id"] == "find_objects#red"


@pytest.mark.learners
def test_sb3_learns_another_variant_without_a_reset() -> None:
    pytest.importorskip("stable_baselines3", reason="tests the Stable-Baselines3 adapter")
    from driftworld.adapters.sb3 import make_vec_env
    from stable_baselines3 import PPO

    options = {"modalities": "rgb", "size": 36, "actions": "discrete", "max_episode_steps": 8, "info": "full"}
    envs = make_vec_env(FIND, 2, seed=0, **options)
    model = PPO("MlpPolicy", envs, n_steps=16, batch_size=16, n_epochs=1, seed=0, device="cpu")
    model.learn(32)
    envs.set_options([{"variant": "red"}, {"variant": "blue"}])
    started: list[list[str]] = [[], []]

    def note(variables: dict[str, Any], _: Any) -> bool:
        for env in np.flatnonzero(variables["dones"]):
            started[env].append(envs.unwrapped.reset_infos[env]["variant_id"])
        return True

    model.learn(128, reset_num_timesteps=False, callback=lambda variables, options: note(variables, options))
    assert [set(names) for names in started] == [{"find_objects#red"}, {"find_objects#blue"}]
    with pytest.raises(ValueError, match="set_options: found 'varaint'"):
        envs.set_options({"varaint": "red"})
    for few in ([], [{}], [{}] * 3):
        with pytest.raises(ValueError, match=f"set_options: found a list of {len(few)}, expected"):
            envs.set_options(few)
    # One invalid request among several changes nothing, and is not applied again.
    envs.set_options({"variant": "near"})
    with pytest.raises(driftworld.errors.TaskError, match="nope"):
        envs.set_options([{"variant": "red"}, {"variant": "nope"}])
    envs.reset()
    assert envs.env_method("origin")[0]["variant_id"] == "find_objects#near"
    # Like a single environment, each gets the queue from its start.
    envs.set_options([{"queue": ["red", "dusk"]}] * 2)
    envs.reset()
    assert [origin["variant_id"] for origin in envs.env_method("origin")] == ["find_objects#red"] * 2


@pytest.mark.learners
def test_sb3_issue_1790_options_reach_the_reset_that_ends_an_episode() -> None:
    # https://github.com/DLR-RM/stable-baselines3/issues/1790: if episodes end at each step, options only reach an
    # explicit reset; the reset within `step` drops them.
    pytest.importorskip("stable_baselines3", reason="the linked issue is about Stable-Baselines3")
    from driftworld.adapters.sb3 import make_vec_env

    envs = make_vec_env(FIND, 2, seed=0, max_episode_steps=1, **OPTIONS)
    envs.reset()
    actions = np.zeros(2, dtype=np.int64)

    def started() -> list[tuple[str, int]]:
        return [(info["variant_id"].partition("#")[2], info["index"]) for info in envs.unwrapped.reset_infos]

    assert started() == [("default", 0)] * 2
    envs.set_options({"variant": "dusk", "index": 7})
    assert envs.step(actions)[2].all() and started() == [("dusk", 7)] * 2
    # A variant persists until replaced; an index applies to one episode.
    assert envs.step(actions)[2].all() and started() == [("dusk", 8)] * 2
    envs.set_options([{"variant": "red"}, {}])
    assert envs.step(actions)[2].all() and started() == [("red", 9), ("dusk", 9)]
    envs.set_options({"variant": "near"})
    envs.reset()
    assert [variant for variant, _ in started()] == ["near"] * 2


@pytest.mark.learners
@pytest.mark.filterwarnings("ignore")
def test_rllib_runner_continues_with_another_variant() -> None:
    pytest.importorskip("ray.rllib", reason="the env runner is RLlib's")
    from ray.rllib.algorithms.ppo import PPOConfig
    from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
    from ray.rllib.env.single_agent_env_runner import SingleAgentEnvRunner
    from ray.tune.registry import register_env

    register_env("native", lambda config: driftworld.DriftworldVectorEnv(**config))
    options = {**OPTIONS, "task": "find_objects", "modalities": "state", "max_episode_steps": 4}
    config = (
        PPOConfig()
        .environment("native", env_config=options)
        .env_runners(num_envs_per_env_runner=2, gym_env_vectorize_mode=gym.VectorizeMode.VECTOR_ENTRY_POINT)
        .rl_module(model_config=DefaultModelConfig(fcnet_hiddens=[8]))
    )
    runner = SingleAgentEnvRunner(config=config)
    runner.sample(num_timesteps=4, random_actions=True, force_reset=True)
    runner.env.unwrapped.set_next(variant=["red", "blue"])
    episodes = runner.sample(num_timesteps=40, random_actions=True)
    started = [episode.get_infos(0)["variant_id"] for episode in episodes if episode.t_started == 0 and len(episode) == 4]
    assert set(started) == {"find_objects#red", "find_objects#blue"}
    runner.stop()
