"""Arrays that vector environments return belong to the caller, who may keep and change them; on request they are read-only
views.
"""

from __future__ import annotations

import threading
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference
from gymnasiums_loops import spread
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

FIND = "driftworld/FindObjects-v0"
MODALITIES = ["rgb", "depth", "segmentation", "class", "instance", "state"]


def native(num_envs: int, **options: Any) -> Any:
    return gym.make_vec(FIND, num_envs, vectorization_mode="vector_entry_point", **{"size": 16, **options})


def sync(num_envs: int, **options: Any) -> Any:
    return spread(gym.make_vec(FIND, num_envs, vectorization_mode="sync", **{"size": 16, **options}))


def random_actions(envs: Any, steps: int) -> list[Any]:
    """Actions that change the image at every step."""
    envs.action_space.seed(3)
    return [envs.action_space.sample() for _ in range(steps)]


def store_observations(envs: Any, steps: int) -> list[tuple[Any, Any]]:
    """Pairs of observation and next observation, stored as returned, in a loop like CleanRL's."""
    pairs = []
    actions = random_actions(envs, steps)
    observation, _ = envs.reset(seed=1)
    for action in actions:
        next_observation, *_ = envs.step(action)
        pairs.append((observation, next_observation))
        observation = next_observation
    return pairs


@pytest.mark.parametrize("modalities", ["rgb", "state", MODALITIES], ids=str)
def test_stored_observations_equal_those_of_gymnasiums_loop(modalities: Any) -> None:
    options = {"modalities": modalities, "max_episode_steps": 7}
    ours, theirs = store_observations(native(3, **options), 30), store_observations(sync(3, **options), 30)
    assert first_difference(ours, theirs) is None
    if modalities == "rgb":
        assert not any(np.array_equal(*pair) for pair in ours)


@settings(max_examples=15, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(
    modalities=st.lists(st.sampled_from(MODALITIES), min_size=1, unique=True),
    mode=st.sampled_from(["next_step", "same_step"]),
    label=st.sampled_from(["none", "info", "observation"]),
    seed=st.integers(0, 2**40),
)
def test_writing_into_returned_arrays_changes_nothing(
    modalities: list[str], mode: str, label: str, seed: int
) -> None:
    options = {"modalities": modalities, "task_label": label, "autoreset_mode": mode, "max_episode_steps": 4}
    ours, other = native(2, **options), native(2, **options)

    def overwrite(result: Any) -> None:
        for part in result.values() if isinstance(result, dict) else result:
            if isinstance(part, dict):
                overwrite(part)
            elif isinstance(part, np.ndarray) and part.dtype != object:
                part[...] = part.dtype.type(1)

    for action in [None, *random_actions(ours, 9)]:
        left = ours.reset(seed=seed) if action is None else ours.step(action)
        right = other.reset(seed=seed) if action is None else other.step(action)
        assert first_difference(left, right) is None
        overwrite(right)


def test_views_are_equal_and_read_only() -> None:
    options = {"modalities": MODALITIES, "task_label": "observation"}
    views, copies = native(3, copy=False, **options), native(3, **options)
    seen, kept = views.reset(seed=0)[0], copies.reset(seed=0)[0]
    for action in random_actions(views, 5):
        assert first_difference(seen, kept) is None
        for name, array in seen.items():
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0
            with pytest.raises(ValueError, match="WRITEABLE"):
                array.flags.writeable = True
            assert name == "task" or not array[0].flags.writeable
        again, kept = views.step(action)[0], copies.step(action)[0]
        assert all(np.shares_memory(again[name], seen[name]) for name in seen)
        assert all(array.flags.writeable and array.flags.owndata for array in kept.values())
        seen = again
    one = native(2, modalities="rgb", copy=False)
    with pytest.raises(ValueError, match="read-only"):
        one.reset(seed=0)[0][...] = 0


def test_copy_must_be_a_boolean() -> None:
    with pytest.raises(ValueError, match="copy: found 'no', expected True or False"):
        native(2, copy="no")


def test_writing_into_a_returned_label_changes_nothing() -> None:
    envs = native(2, modalities=["state"], task_label="observation")
    observations, _ = envs.reset(seed=0, options={"variants": ["red", "blue"]})
    observations["task"] *= 0.5
    assert envs.step(envs.action_space.sample())[0]["task"].sum(axis=1).tolist() == [1.0, 1.0]


def test_second_thread_is_refused_with_a_message() -> None:
    envs = native(8, modalities="rgb", size=64)
    envs.reset(seed=0)
    action = envs.action_space.sample()
    envs.step(action)
    busy = threading.Thread(target=envs._members.batch.repeat, args=(300,))
    busy.start()
    messages: set[str] = set()
    while busy.is_alive():
        try:
            envs.step(action)
        except RuntimeError as error:
            messages.add(str(error))
    busy.join()
    assert len(messages) == 1
    assert "found it in use by another thread, expected one thread at a time" in messages.pop()


def test_threads_can_write_into_one_log(tmp_path: Any) -> None:
    class Slow(float):
        """A number that lets other threads run while it is read."""

        def __float__(self) -> float:
            threading.Event().wait(0.0001)
            return 1.0

    errors: list[BaseException] = []
    with driftworld.LogWriter(tmp_path / "log") as log:

        def write() -> None:
            try:
                for _ in range(50):
                    params = {"light": np.float64(0.5)}
                    log.write(block_num=0, exp_num=0, block_type="train", task_name="a_b", task_params=params, exp_status="incomplete", reward=Slow())
            except BaseException as error:  # noqa: BLE001 - any exception is a finding
                errors.append(error)

        threads = [threading.Thread(target=write) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert errors == [] and len(driftworld.read_log(tmp_path / "log")) == 200


@pytest.mark.learners
@pytest.mark.parametrize("modalities", ["rgb", ["rgb", "state"]], ids=str)
def test_sb3_replay_buffer_stores_the_observations(modalities: Any) -> None:
    pytest.importorskip("stable_baselines3", reason="tests its replay buffer")
    from stable_baselines3.common.buffers import DictReplayBuffer, ReplayBuffer

    steps, options = 20, {"modalities": modalities, "actions": "discrete", "size": 40}
    buffers = []
    for envs in (native(2, **options), sync(2, **options)):
        kind = DictReplayBuffer if isinstance(modalities, list) else ReplayBuffer
        buffer = kind(2 * steps, envs.single_observation_space, envs.single_action_space, device="cpu", n_envs=2)
        actions = random_actions(envs, steps)
        observation, _ = envs.reset(seed=1)
        for action in actions:
            next_observation, reward, terminated, truncated, _ = envs.step(action)
            buffer.add(observation, next_observation, action, reward, terminated | truncated, [{}, {}])
            observation = next_observation
        buffers.append(buffer)
    for name in ("observations", "next_observations"):
        left, right = (getattr(buffer, name) for buffer in buffers)
        assert first_difference(left, right, name) is None


@pytest.mark.learners
@pytest.mark.filterwarnings("ignore")
def test_rllib_runner_stores_the_observations() -> None:
    pytest.importorskip("ray.rllib", reason="tests its env runner")
    from ray.rllib.algorithms.ppo import PPOConfig
    from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
    from ray.rllib.env.single_agent_env_runner import SingleAgentEnvRunner
    from ray.tune.registry import register_env

    def make(config: dict[str, Any]) -> Any:
        return driftworld.DriftworldVectorEnv(**config)

    register_env("native", make)
    options = {"task": "find_objects", "modalities": "state", "actions": "discrete", "size": 16, "max_episode_steps": 8}
    config = (
        PPOConfig()
        .environment("native", env_config=options)
        .env_runners(num_envs_per_env_runner=3, gym_env_vectorize_mode=gym.VectorizeMode.VECTOR_ENTRY_POINT)
        .rl_module(model_config=DefaultModelConfig(fcnet_hiddens=[8]))
        .debugging(seed=4)
    )
    runner = SingleAgentEnvRunner(config=config)
    episodes = runner.sample(num_episodes=9, random_actions=True)
    assert len(episodes) >= 9
    for episode in episodes:
        seen = np.stack([np.asarray(each) for each in episode.get_observations()])
        assert len(seen) == len(episode) + 1
        info = episode.get_infos(0)
        alone = gym.make(FIND, modalities="state", actions="discrete", size=16, disable_env_checker=True).unwrapped
        first, _ = alone.reset(seed=int(info["seed"]), options={"index": int(info["index"])})
        replayed = [first, *(alone.step(int(action))[0] for action in episode.get_actions())]
        assert np.array_equal(seen, np.stack(replayed))
    runner.stop()


@pytest.mark.learners
@pytest.mark.parametrize("mode", ["next_step", "same_step"])
def test_gymnasium_wrapper_converts_everything_to_torch(mode: str) -> None:
    torch = pytest.importorskip("torch", reason="needs PyTorch")
    options = {"modalities": ["rgb", "state"], "max_episode_steps": 3, "task_label": "info", "autoreset_mode": mode}
    for copy in (True, False):
        plain, envs = native(2, info="full", **options), gym.wrappers.vector.NumpyToTorch(native(2, copy=copy, info="full", **options))
        wanted, found = plain.reset(seed=0), envs.reset(seed=0)
        assert found[1]["variant_id"].tolist() == wanted[1]["variant_id"].tolist()
        for action in random_actions(plain, 8):
            wanted, found = plain.step(action), envs.step(torch.tensor(action))
            for name in ("rgb", "state"):
                assert isinstance(found[0][name], torch.Tensor)
                assert np.array_equal(found[0][name].numpy(), wanted[0][name])
            assert found[4].keys() == wanted[4].keys()
            assert found[4]["is_success"].tolist() == wanted[4]["is_success"].tolist()
            if "final_obs" in wanted[4]:
                last, expected = found[4]["final_obs"][0]["rgb"], wanted[4]["final_obs"][0]["rgb"]
                assert np.array_equal(last.numpy(), expected)
    single = gym.wrappers.NumpyToTorch(gym.make(FIND, modalities="rgb", size=16, info="full"))
    observation, info = single.reset(seed=0)
    assert isinstance(observation, torch.Tensor) and info["variant_id"] == "find_objects#default"


@pytest.mark.parametrize("modalities", ["rgb", ["rgb", "state"]], ids=str)
def test_step_writes_into_the_callers_arrays(modalities: Any) -> None:
    options = {"modalities": modalities, "max_episode_steps": 3, "autoreset_mode": "same_step"}
    ours, theirs = native(2, **options), native(2, **options)
    first = theirs.reset(seed=3)[0]
    ours.reset(seed=3)
    # Rows of a buffer, as in a learner.
    if isinstance(first, dict):
        rows = [{kind: np.zeros_like(array) for kind, array in first.items()} for _ in range(5)]
    else:
        rows = list(np.zeros((5, *first.shape), first.dtype))
    actions = random_actions(ours, len(rows))
    expected = []
    for row, action in zip(rows, actions):
        written = ours.step(action, out=row)
        assert written[0] is row
        expected.append(theirs.step(action))
        assert first_difference(written[1:], expected[-1][1:]) is None
    assert first_difference(rows, [observations for observations, *_ in expected]) is None
    before = ours.state(0)
    for wrong in (np.zeros((1, 2), np.float32), {}, {"rgb": np.zeros((2, 16, 16, 3), np.uint8)}):
        with pytest.raises(ValueError, match="out: found arrays that do not match the observations"):
            ours.step(actions[0], out=wrong)
    locked = rows[0]["rgb"] if isinstance(rows[0], dict) else rows[0]
    locked.flags.writeable = False
    with pytest.raises(ValueError, match="^out: found (rgb|the array) read-only, expected writable arrays"):
        ours.step(actions[0], out=rows[0])
    assert first_difference(before, ours.state(0)) is None
