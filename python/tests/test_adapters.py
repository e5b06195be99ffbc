"""Tests of the adapters, with the real libraries where they are installed."""

from __future__ import annotations

import importlib
import subprocess
import sys
import types
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference

FIND = "driftworld/FindObjects-v0"
SMALL = {"size": 40, "modalities": "rgb", "actions": "discrete"}
PACKAGES = {
    "sb3": "stable_baselines3",
    "pufferlib": "pufferlib",
    "minari": "minari",
    "syllabus": "syllabus",
}


@pytest.mark.parametrize("name, package", PACKAGES.items())
def test_missing_library_error_says_what_to_install(
    name: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Including its submodules, which other tests may have imported.
    for part in [package, *(each for each in sys.modules if each.startswith(f"{package}."))]:
        monkeypatch.setitem(sys.modules, part, None)
    monkeypatch.delitem(sys.modules, f"driftworld.adapters.{name}", raising=False)
    with pytest.raises(ImportError, match=f"found no {package}, expected version .*pip install"):
        importlib.import_module(f"driftworld.adapters.{name}")


def dummy_vec_env(seed: int, num_envs: int, **options: Any) -> Any:
    from stable_baselines3.common.vec_env import DummyVecEnv

    envs = DummyVecEnv([lambda: gym.make(FIND, **options)] * num_envs)
    # The library itself would add 0, 1, 2 and so on to the seed.
    envs._seeds = list(driftworld.spread_seeds(seed, num_envs))
    return envs


@pytest.mark.learners
@pytest.mark.parametrize("modalities", ["rgb", ["rgb", "state"]], ids=str)
def test_sb3_vector_environment_matches_its_own_loop(modalities: Any) -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import DriftworldVecEnv

    options = {**SMALL, "modalities": modalities}
    ours = DriftworldVecEnv(FIND, 3, max_episode_steps=5, **options)
    theirs = dummy_vec_env(4, 3, max_episode_steps=5, **options)
    ours.seed(4)
    assert first_difference(ours.reset(), theirs.reset()) is None
    assert first_difference(ours.reset_infos, theirs.reset_infos) is None
    rng = np.random.default_rng(0)
    for number in range(14):
        actions = rng.integers(0, theirs.action_space.n, 3)
        left, right = ours.step(actions), theirs.step(actions)
        # Gymnasium's own step limit sets this entry; here the world has the limit.
        for info in right[3]:
            info.setdefault("TimeLimit.truncated", False)
        assert first_difference(left, right, f"step {number}") is None
        assert first_difference(ours.reset_infos, theirs.reset_infos) is None
    assert [type(each).__name__ for each in left[3]] == ["dict"] * 3


@pytest.mark.learners
def test_sb3_observations_are_copies() -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import DriftworldVecEnv

    envs = DriftworldVecEnv(FIND, 2, **SMALL)
    first = envs.reset()
    before = first.copy()
    for _ in range(3):
        envs.step(np.ones(2, dtype=np.int64))
    assert np.array_equal(first, before)


@pytest.mark.learners
def test_sb3_options_apply_to_all_or_to_each() -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import DriftworldVecEnv

    envs = DriftworldVecEnv(FIND, 3, render_mode="rgb_array", render_size=(24, 32), info="full", **SMALL)
    envs.seed(3)
    envs.set_options([{"variant": "red"}, {}, {"variant": "dusk"}])
    envs.reset()
    found = [(info["variant_id"].partition("#")[2], info["seed"], info["index"]) for info in envs.reset_infos]
    first, second, third = driftworld.spread_seeds(3, 3)
    assert found == [("red", first, 0), ("default", second, 0), ("dusk", third, 0)]
    envs.set_options({"variant": "near"})
    envs.reset()
    assert [info["variant_id"].partition("#")[2] for info in envs.reset_infos] == ["near"] * 3
    assert [each["version"] for each in envs.env_method("state", indices=[0, 2])] == [1, 1]
    assert envs.env_is_wrapped(gym.Wrapper) == [False] * 3
    assert [image.shape for image in envs.get_images()] == [(24, 32, 3)] * 3
    assert envs.render().shape == (48, 64, 3)
    with pytest.raises(AttributeError):
        envs.get_attr("nothing")
    with pytest.raises(RuntimeError, match="a call of step_async first"):
        envs.step_wait()
    with pytest.raises(ValueError, match="autoreset_mode"):
        DriftworldVecEnv(FIND, 2, autoreset_mode="disabled")
    envs.close()
    envs.close()


def stepped_pair(num_envs: int = 3, **options: Any) -> tuple[Any, Any]:
    """The adapter, and Stable-Baselines3's loop over single environments, after three steps with equal seeds and
    actions.
    """
    from driftworld.adapters.sb3 import DriftworldVecEnv

    options = {**SMALL, "info": "full", "render_mode": "rgb_array", "render_size": (24, 32), "max_steps": 9, **options}
    ours, theirs = DriftworldVecEnv(FIND, num_envs, **options), dummy_vec_env(4, num_envs, **options)
    ours.seed(4)
    for envs in (ours, theirs):
        envs.reset()
        for _ in range(3):
            envs.step(np.arange(num_envs))
    return ours, theirs


#: Methods of single environments with their arguments, to be called in turn.
CALLS: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = [
    ("state", (), {}),
    ("origin", (), {}),
    ("warnings", (), {}),
    ("render", (), {}),
    ("record", (), {}),
    ("recording", (), {}),
    ("get_wrapper_attr", ("action_space",), {}),
    ("has_wrapper_attr", ("spec",), {}),
    ("has_wrapper_attr", ("nothing",), {}),
    ("reset", (), {"options": {"variant": "blue"}}),
    ("reset", (), {"seed": 2**63 + 5}),
    ("reset", (), {"options": {"queue": ["red", "dusk"]}}),
    ("reset", (), {"options": {"index": 4}}),
    ("reset", (), {"seed": 3, "options": {"variant": "red"}}),
    ("reset", (), {}),
    ("record", (False,), {}),
    ("state", (), {}),
]
#: Attributes of single environments.
ATTRIBUTES = ["action_space", "observation_space", "metadata", "render_mode", "np_random_seed"]


def result_or_error(envs: Any, method: str, *args: Any, **kwargs: Any) -> Any:
    """A method's results; for an error, its type."""
    try:
        return envs.env_method(method, *args, **kwargs)
    except (AttributeError, RuntimeError, TypeError, ValueError, gym.error.Error) as error:
        return type(error)


@pytest.mark.learners
@pytest.mark.parametrize("indices", [None, 1, -1, [0], [2, 0], [], range(3), [1, 1]], ids=str)
def test_sb3_contract_matches_single_environments(indices: Any) -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    ours, theirs = stepped_pair()
    for name, args, kwargs in CALLS:
        found = [result_or_error(envs, name, *args, indices=indices, **kwargs) for envs in (ours, theirs)]
        assert first_difference(*found, f"{name}{args}{kwargs}") is None
        assert first_difference(*[result_or_error(envs, "state") for envs in (ours, theirs)], f"all after {name}") is None
        assert first_difference(*[result_or_error(envs, "recording") for envs in (ours, theirs)], f"all after {name}") is None
        steps = [envs.step(np.arange(3))[:3] for envs in (ours, theirs)]
        assert first_difference(*steps, f"the step after {name}") is None
    for name in ATTRIBUTES:
        assert ours.get_attr(name, indices) == theirs.get_attr(name, indices), name
        assert ours.has_attr(name) and theirs.has_attr(name)
    for left, right in zip(ours.get_attr("spec", indices), theirs.get_attr("spec", indices), strict=True):
        assert (left.id, left.kwargs, left.max_episode_steps) == (right.id, right.kwargs, right.max_episode_steps)
    assert ours.has_attr("num_envs") == theirs.has_attr("num_envs") is False
    assert ours.env_is_wrapped(gym.wrappers.FlattenObservation, indices) == theirs.env_is_wrapped(
        gym.wrappers.FlattenObservation, indices
    )
    for envs in (ours, theirs):
        envs.set_attr("mine", 1)
        envs.set_attr("mine", [7], indices)
    assert ours.get_attr("mine") == theirs.get_attr("mine")
    for left, right in zip(ours.get_attr("unwrapped", indices), theirs.get_attr("unwrapped", indices), strict=True):
        assert left.state() == right.state()
    assert first_difference(ours.get_images(), theirs.get_images()) is None
    assert first_difference(ours.render(), theirs.render()) is None
    for bad in (3, [0, 3]):
        for envs in (ours, theirs):
            with pytest.raises(IndexError):
                envs.env_method("state", indices=bad)


@pytest.mark.learners
def test_sb3_refuses_calls_without_effect_or_for_some_environments_only() -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    ours, _ = stepped_pair()
    for option in ("frame_skip", "variant", "max_steps", "modalities", "size", "actions", "task", "render_mode", "drift"):
        for indices in (None, [0]):
            with pytest.raises(ValueError, match=rf"set_attr\('{option}'\): .*set_options"):
                ours.set_attr(option, 4, indices)
    for name in ("action_space", "observation_space", "spec", "state", "reset", "np_random", "unwrapped", "metadata"):
        with pytest.raises(ValueError, match="found a built-in attribute"):
            ours.set_attr(name, None)
    for method, args in (("step", (1,)), ("close", ())):
        with pytest.raises(RuntimeError, match="of all at once"):
            ours.env_method(method, *args, indices=[0])
    assert ours.env_method("close") == [None] * 3


@pytest.mark.learners
def test_sb3_monitor_counts_from_a_partial_reset() -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import make_vec_env

    envs = make_vec_env(FIND, num_envs=3, seed=0, max_steps=8, **SMALL)
    envs.reset()
    lengths: list[int] = []
    for number in range(16):
        if number == 3:
            envs.env_method("reset", indices=[0], options={"variant": "blue"})
        infos = envs.step(np.ones(3, dtype=np.int64))[3]
        lengths += [info["episode"]["l"] for info in infos if "episode" in info]
    assert lengths == [8] * len(lengths) and len(lengths) == 5


@pytest.mark.learners
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::UserWarning")
@pytest.mark.parametrize("algorithm", ["PPO", "DQN"])
def test_sb3_learns_on_it(algorithm: str, tmp_path: Path) -> None:
    sb3 = pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import make_vec_env
    from stable_baselines3.common.evaluation import evaluate_policy

    envs = make_vec_env(FIND, num_envs=2, seed=0, max_episode_steps=12, monitor_dir=str(tmp_path / "monitor"), **SMALL)
    options = {"n_steps": 16, "batch_size": 16} if algorithm == "PPO" else {"buffer_size": 200, "learning_starts": 16}
    model = getattr(sb3, algorithm)("CnnPolicy", envs, seed=0, device="cpu", **options)
    before = [parameter.detach().clone() for parameter in model.policy.parameters()]
    model.learn(64)
    assert any(not old.equal(new) for old, new in zip(before, model.policy.parameters(), strict=True))
    assert len(model.ep_info_buffer) >= 4
    assert model.ep_info_buffer[0]["l"] == 12
    mean, _ = evaluate_policy(model, envs, n_eval_episodes=2)
    envs.close()
    assert np.isfinite(mean)
    assert len((tmp_path / "monitor.monitor.csv").read_text().splitlines()) > 5


@pytest.mark.learners
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("actions", ["normalized", "discrete"])
def test_sb3_check_passes_without_warnings(env_id: str, actions: str) -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from stable_baselines3.common.env_checker import check_env

    for modalities in ("rgb", ["rgb", "depth", "segmentation", "state"]):
        check_env(gym.make(env_id, actions=actions, modalities=modalities).unwrapped)


@pytest.mark.learners
def test_torch_takes_observations_without_copying() -> None:
    torch = pytest.importorskip("torch", reason="needs PyTorch")
    envs = gym.make_vec(FIND, num_envs=2, vectorization_mode="vector_entry_point", size=40)
    observations, _ = envs.reset(seed=0)
    for name, array in observations.items():
        tensor = torch.from_dlpack(array)
        assert tensor.data_ptr() == array.ctypes.data, name
        assert tuple(tensor.shape) == array.shape
    tensor = torch.from_dlpack(observations["rgb"])
    before = tensor.clone()
    envs.step(np.ones(envs.action_space.shape, dtype=np.float32))
    assert tensor.equal(before), "the step wrote into an array that was returned before"


@pytest.mark.learners
# Minari does not find the package in a checkout that is on the path but not installed.
@pytest.mark.filterwarnings("ignore:Package driftworld is not installed:UserWarning")
@pytest.mark.parametrize("modalities", ["rgb", ["rgb", "state"]], ids=str)
def test_minari_reads_back_recorded_episodes(modalities: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    minari = pytest.importorskip("minari", reason="needs Minari")
    from driftworld.adapters.minari import collect

    options = {**SMALL, "modalities": modalities, "max_steps": 6}
    env = gym.make(FIND, **options)
    collect(env, "driftworld/find-objects/test-v0", episodes=3, seed=8, queue=["red", "blue"])
    dataset = minari.load_dataset("driftworld/find-objects/test-v0")
    metadata = list(dataset.storage.get_episode_metadata(range(3)))
    assert [each["variant_id"] for each in metadata] == ["find_objects#red", "find_objects#blue", "find_objects#red"]
    assert [(each["world_seed"], each["world_index"]) for each in metadata] == [(8, 0), (8, 1), (8, 2)]
    again = dataset.recover_environment()
    for episode, recorded in zip(dataset.iterate_episodes(), metadata, strict=True):
        observation, info = again.reset(
            seed=int(recorded["world_seed"]),
            options={"variant": recorded["variant_id"].partition("#")[2], "index": int(recorded["world_index"])},
        )
        assert info["world_hash"] == recorded["world_hash"]
        replayed = [observation] + [again.step(int(action))[0] for action in episode.actions]
        for number, each in enumerate(replayed):
            if isinstance(each, dict):
                kept: Any = {name: array[number] for name, array in episode.observations.items()}
            else:
                kept = episode.observations[number]
            assert first_difference(kept, each, f"observation {number}") is None
        assert sum(episode.rewards) == pytest.approx(recorded["episode_return"])


class PufferStandIn:
    """A stand-in for PufferLib's `PufferEnv`, following its documentation: it checks the class's attributes and
    provides buffers.
    """

    def __init__(self, buf: Any = None) -> None:
        assert isinstance(self.single_observation_space, gym.spaces.Box)
        assert isinstance(self.single_action_space, (gym.spaces.Discrete, gym.spaces.MultiDiscrete, gym.spaces.Box))
        assert not hasattr(self, "observation_space")
        if buf is None:
            shape = (self.num_agents, *self.single_observation_space.shape)
            buf = {
                "observations": np.zeros(shape, self.single_observation_space.dtype),
                "rewards": np.zeros(self.num_agents, np.float32),
                "terminals": np.zeros(self.num_agents, bool),
                "truncations": np.zeros(self.num_agents, bool),
                "masks": np.ones(self.num_agents, bool),
            }
        for name, array in buf.items():
            setattr(self, name, array)


@pytest.fixture
def puffer(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The adapter with PufferLib itself if it is installed, else with a stand-in that follows its documentation."""
    if importlib.util.find_spec("pufferlib") is None:
        library = types.ModuleType("pufferlib")
        library.PufferEnv = PufferStandIn  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, "pufferlib", library)
    monkeypatch.delitem(sys.modules, "driftworld.adapters.pufferlib", raising=False)
    module = importlib.import_module("driftworld.adapters.pufferlib")
    yield module.DriftworldPuffer
    sys.modules.pop("driftworld.adapters.pufferlib", None)


def test_puffer_buffers_match_the_environments(puffer: Any) -> None:
    options = {"size": 40, "actions": "discrete", "max_episode_steps": 5}
    ours = puffer(FIND, 3, **options)
    theirs = gym.make_vec(
        FIND,
        num_envs=3,
        vectorization_mode="vector_entry_point",
        modalities="rgb",
        autoreset_mode="same_step",
        **options,
    )
    observations, infos = ours.reset(seed=2)
    buffers = {name: getattr(ours, name) for name in ("observations", "rewards", "terminals", "truncations")}
    assert infos == []
    assert np.array_equal(observations, theirs.reset(seed=2)[0])
    episode_infos = []
    for number in range(12):
        actions = np.array([number % 3, 1, 2], dtype=np.int32)
        found, expected = ours.step(actions), theirs.step(actions)
        for name, one, other in zip(buffers, found, expected, strict=False):
            assert one is buffers[name]
            assert np.array_equal(one, other.astype(one.dtype)), name
        episode_infos.extend(found[4])
    assert len(episode_infos) == 6
    assert {info["episode_length"] for info in episode_infos} == {5}
    assert set(episode_infos[0]) == {"variant_id", "episode_return", "episode_length", "is_success"}
    assert puffer(FIND, 1, seed=2).reset()[0].shape[0] == 1


def test_puffer_writes_into_given_buffers(puffer: Any) -> None:
    space = gym.make(FIND, modalities="rgb", size=40).observation_space
    given = {
        "observations": np.zeros((2, *space.shape), np.uint8),
        "rewards": np.zeros(2, np.float32),
        "terminals": np.zeros(2, bool),
        "truncations": np.zeros(2, bool),
        "masks": np.zeros(2, bool),
        "actions": np.zeros((2, 3), np.float32),
    }
    ours = puffer(FIND, 2, given, size=40)
    ours.reset(seed=0)
    assert given["observations"].any() and given["masks"].all()


def test_puffer_refuses_more_than_one_array(puffer: Any) -> None:
    with pytest.raises(ValueError, match="expected a single modality for PufferLib"):
        puffer(FIND, 1, modalities=["rgb", "state"])


def test_importing_the_package_imports_no_adapter() -> None:
    program = "import sys, driftworld; sys.exit(any(name.startswith('driftworld.adapters') for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
