"""The native vector environment matches Gymnasium's own, bit for bit, in every autoreset mode."""

from __future__ import annotations

import copy
import gc
import pickle
import warnings
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference
from driftworld.envs.autoreset import AutoresetMode
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv
from gymnasiums_loops import spread
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

FIND = "driftworld/FindObjects-v0"
#: Gymnasium 1.0 has only one mode, and no masks.
HAS_MODES = hasattr(gym.vector, "AutoresetMode")
ANY_MODE = pytest.mark.parametrize("mode", AutoresetMode if HAS_MODES else [AutoresetMode.NEXT_STEP], ids=str)
NEEDS_MASKS = pytest.mark.skipif(not HAS_MODES, reason="Gymnasium 1.0 has no masks to compare with")


def native(env_id: str, num_envs: int, **options: Any) -> Any:
    return gym.make_vec(env_id, num_envs=num_envs, vectorization_mode="vector_entry_point", **options)


def sync(env_id: str, num_envs: int, mode: Any = None, **options: Any) -> Any:
    kwargs = {"autoreset_mode": mode} if mode is not None and HAS_MODES else {}
    return spread(gym.make_vec(env_id, num_envs=num_envs, vectorization_mode="sync", vector_kwargs=kwargs, **options))


def expect_same(left: Any, right: Any, place: str) -> None:
    difference = first_difference(left, right, place)
    assert difference is None, difference


def step_both(ours: Any, theirs: Any, steps: int, *, by_mask: bool = False) -> int:
    """Steps both with the same actions, expects equal results, and returns the number of ended episodes."""
    ends = 0
    theirs.action_space.seed(0)
    for number in range(steps):
        action = theirs.action_space.sample()
        one, other = ours.step(action), theirs.step(action)
        expect_same(one, other, f"step {number}")
        ended = one[2] | one[3]
        ends += int(ended.sum())
        if by_mask and ended.any():
            expect_same(
                ours.reset(options={"reset_mask": ended.copy()}),
                theirs.reset(options={"reset_mask": ended.copy()}),
                f"reset after step {number}",
            )
    return ends


@pytest.mark.parametrize("actions", ["normalized", "discrete"])
def test_each_task_matches_gymnasiums_loop(env_id: str, actions: str) -> None:
    options = {"size": 40, "actions": actions, "max_episode_steps": 7}
    ours, theirs = native(env_id, 3, **options), sync(env_id, 3, **options)
    expect_same(ours.reset(seed=4), theirs.reset(seed=4), "reset")
    assert step_both(ours, theirs, 40) > 5
    expect_same(ours.reset(), theirs.reset(), "reset without a seed")
    expect_same(ours.reset(seed=[9, 3, 9]), theirs.reset(seed=[9, 3, 9]), "reset with a list")


@ANY_MODE
def test_each_autoreset_mode_matches_gymnasium(mode: Any) -> None:
    # Episodes end in two ways: the goal is near, and there is a step limit.
    options = {"variant": "near", "size": 40, "modalities": ["rgb", "state"], "max_episode_steps": 6}
    ours, theirs = native(FIND, 4, autoreset_mode=mode, **options), sync(FIND, 4, mode, **options)
    assert ours.metadata["autoreset_mode"] is mode
    expect_same(ours.reset(seed=0), theirs.reset(seed=0), "reset")
    assert step_both(ours, theirs, 50, by_mask=mode is AutoresetMode.DISABLED) > 10


@NEEDS_MASKS
@ANY_MODE
def test_episodes_that_end_at_different_times_are_handled(mode: Any) -> None:
    # The goal is straight ahead of the agent: each episode ends at its own time, when the goal is reached.
    options = {"variant": "plain", "modalities": "state", "size": 16, "max_episode_steps": 60}
    ours, theirs = (
        native("driftworld/GetToGoal-v0", 3, autoreset_mode=mode, **options),
        sync("driftworld/GetToGoal-v0", 3, mode, **options),
    )
    world = gym.make("driftworld/GetToGoal-v0", variant="plain").unwrapped
    world.reset(seed=1)
    documents = []
    for distance in (4.0, 9.0, 14.0):
        document = copy.deepcopy(world.state())
        del document["progress"]
        east, north = document["objects"][0]["coordinates"]
        document["agent_params"].update(coordinates=[east - distance, north], heading=90.0)
        documents.append(document)
    for env in (ours, theirs):
        env.reset(seed=5)
        for index, document in enumerate(documents):
            env.reset(options={"reset_mask": np.arange(3) == index, "world": document})
    ends: set[int] = set()
    for number in range(30):
        action = np.tile(np.array([1.0, 0.0, 0.0], dtype=np.float32), (3, 1))
        one, other = ours.step(action), theirs.step(action)
        expect_same(one, other, f"step {number}")
        if one[2].any():
            ends.add(number)
        if mode is AutoresetMode.DISABLED and (one[2] | one[3]).any():
            for env in (ours, theirs):
                env.reset(options={"reset_mask": one[2] | one[3]})
    assert len(ends) > 1, "the episodes ended together"


def test_final_observation_belongs_to_the_ended_episode() -> None:
    options = {"modalities": "rgb", "size": 40, "max_episode_steps": 3}
    ours = native(FIND, 2, autoreset_mode="same_step", **options)
    alone = gym.make(FIND, modalities="rgb", size=40, disable_env_checker=True).unwrapped
    ours.reset(seed=6)
    alone.reset(seed=6)
    action = np.array([0.5, 0.1, 0.0], dtype=np.float32)
    for _ in range(3):
        observations, _, _, truncated, infos = ours.step(np.stack([action, action]))
        last, *_ = alone.step(action)
    assert truncated.all()
    assert np.array_equal(infos["final_obs"][0], last)
    assert not np.array_equal(observations[0], last)
    assert np.array_equal(observations[0], alone.reset()[0])
    assert infos["index"].tolist() == [1, 1]


def test_without_autoreset_an_ended_episode_cannot_continue() -> None:
    ours = native(FIND, 2, autoreset_mode="disabled", modalities="state", max_episode_steps=1)
    ours.reset(seed=0)
    ours.step(ours.action_space.sample())
    with pytest.raises(Exception, match="reset"):
        ours.step(ours.action_space.sample())


@pytest.mark.parametrize("context", ["spawn", "fork", "forkserver"])
@pytest.mark.filterwarnings("ignore:This process.*multi-threaded:DeprecationWarning")
def test_gymnasiums_processes_give_the_same_results(context: str) -> None:
    options = {"size": 40, "modalities": ["rgb", "state"], "max_episode_steps": 6}
    ours = native(FIND, 2, **options)
    theirs = gym.make_vec(FIND, num_envs=2, vectorization_mode="async", vector_kwargs={"context": context}, **options)
    try:
        expect_same(ours.reset(seed=2), theirs.reset(seed=driftworld.spread_seeds(2, 2)), "reset")
        assert step_both(ours, theirs, 20) >= 4
    finally:
        theirs.close()


@pytest.mark.filterwarnings("ignore:This process.*multi-threaded:DeprecationWarning")
def test_error_in_a_worker_keeps_its_fields() -> None:
    from driftworld import SpecError

    def make() -> Any:
        return gym.make("driftworld/World-v0", world={"objects": [{"shape": "cube"}]})

    with pytest.raises(SpecError) as caught:
        make()
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), vars(again)) == (SpecError, str(caught.value), vars(caught.value))
    with warnings.catch_warnings():
        # Gymnasium warns about each worker that it shuts down.
        warnings.simplefilter("ignore")
        envs = AsyncVectorEnv([lambda: gym.make(FIND, modalities="state")] * 2, context="fork")
        with pytest.raises(ValueError, match="colour"):
            envs.reset(options={"colour": "red"})
        envs.close(terminate=True)


def test_observations_are_copies_unless_views_are_requested() -> None:
    views, copies = native(FIND, 2, size=40, copy=False), native(FIND, 2, size=40)
    returned = {}
    for name, env in (("views", views), ("copies", copies)):
        returned[name], _ = env.reset(seed=0)
        returned[name + " before"] = {modality: array.copy() for modality, array in returned[name].items()}
        for _ in range(3):
            env.step(np.ones(env.action_space.shape, dtype=np.float32))
    assert first_difference(returned["copies"], returned["copies before"]) is None
    assert first_difference(returned["views"], returned["views before"]) is not None
    again, _ = views.reset(seed=0)
    assert all(np.shares_memory(again[name], returned["views"][name]) for name in again)


def test_views_outlive_their_environment() -> None:
    env = native(FIND, 2, size=40, modalities="rgb", copy=False)
    observations, _ = env.reset(seed=0)
    before = observations.copy()
    env.close()
    del env
    assert np.array_equal(observations, before)


def test_threads_and_files_are_released_with_the_environment() -> None:
    tasks, files = Path("/proc/self/task"), Path("/proc/self/fd")
    if not tasks.is_dir():
        pytest.skip("threads are counted in /proc")

    def count_open() -> tuple[int, int]:
        gc.collect()
        return len(list(tasks.iterdir())), len(list(files.iterdir()))

    before = count_open()
    for _ in range(20):
        envs = native(FIND, 4, modalities="state", size=16, num_threads=3)
        envs.reset(seed=0)
        envs.close()
        del envs
    assert count_open() == before


def test_observations_convert_to_other_libraries_without_a_copy() -> None:
    observations, _ = native(FIND, 2, size=40).reset(seed=0)
    for name, array in observations.items():
        assert np.shares_memory(np.from_dlpack(array), array), name


@pytest.mark.parametrize("num_threads", [1, 2, 8])
def test_number_of_threads_changes_nothing(num_threads: int) -> None:
    one, other = (native(FIND, 5, size=40, num_threads=threads, max_episode_steps=6) for threads in (1, num_threads))
    expect_same(one.reset(seed=0), other.reset(seed=0), "reset")
    step_both(one, other, 15)


def test_each_environment_may_have_its_own_variant() -> None:
    names = ["red", "dusk", "near"]
    ours = native(FIND, 3, modalities="state", size=40, info="full")
    infos = ours.reset(seed=0, options={"variants": names})[1]
    assert [each.partition("#")[2] for each in infos["variant_id"]] == names
    theirs = spread(
        SyncVectorEnv(
            [lambda name=name: gym.make(FIND, variant=name, modalities="state", size=40, info="full") for name in names]
        )
    )
    expect_same(infos, theirs.reset(seed=0)[1], "infos")
    constructed = native(FIND, 3, variants=names, modalities="state", size=40, info="full")
    expect_same(constructed.reset(seed=0), ours.reset(seed=0), "made with variants")
    assert [each.partition("#")[2] for each in ours.reset()[1]["variant_id"]] == names


def test_queue_is_distributed_round_robin() -> None:
    ours = native(FIND, 2, modalities="state", size=16, max_episode_steps=1, info="full")
    episode_infos = [ours.reset(seed=0, options={"queue": ["red", "blue", "green"]})[1]]
    for _ in range(6):
        _, _, _, truncated, infos = ours.step(ours.action_space.sample())
        if not truncated.any():
            episode_infos.append(infos)
    names = [name.partition("#")[2] for infos in episode_infos for name in infos["variant_id"]]
    assert names == ["red", "blue", "green", "red", "blue", "green", "red", "blue"]


def test_mask_resets_some_environments_only() -> None:
    ours = native(FIND, 3, modalities="state", size=40, autoreset_mode="disabled", info="full")
    ours.reset(seed=0)
    ours.step(np.ones(ours.action_space.shape, dtype=np.float32))
    before = [ours.state(env) for env in range(3)]
    infos = ours.reset(options={"reset_mask": np.array([False, True, False]), "variant": "dusk"})[1]
    assert infos["_index"].tolist() == [False, True, False]
    assert infos["variant_id"].tolist() == [None, "find_objects#dusk", None]
    assert [first_difference(before[env], ours.state(env)) is None for env in range(3)] == [True, False, True]


@pytest.mark.parametrize(
    "options, message",
    [
        ({"reset_mask": np.zeros(2, dtype=bool)}, "at least one True"),
        ({"reset_mask": np.ones(3, dtype=bool)}, "shape \\(2,\\)"),
        ({"reset_mask": [True, False]}, "bool array"),
        ({"variants": ["red"]}, "found 1, expected 2"),
        ({"queue": []}, "queue: found \\[\\]"),
        ({"colour": "red"}, "found 'colour', expected some of variant, index, world, queue, variants, reset_mask"),
    ],
    ids=str,
)
def test_invalid_reset_options_are_refused(options: dict[str, Any], message: str) -> None:
    ours = native(FIND, 2, modalities="state", size=16)
    ours.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        ours.reset(options=options)


def test_invalid_actions_and_seeds_are_refused_and_change_nothing() -> None:
    ours = native(FIND, 2, modalities="state", size=16)
    ours.reset(seed=0)
    before = ours.state(0)
    with pytest.raises(ValueError, match=r"found shape \(3, 3\), expected \(2, 3\)"):
        ours.step(np.zeros((3, 3)))
    with pytest.raises(Exception, match="action"):
        ours.step(np.full((2, 3), np.nan))
    with pytest.raises(ValueError, match="found 3 seeds, expected 2"):
        ours.reset(seed=[1, 2, 3])
    assert first_difference(before, ours.state(0)) is None
    discrete = native(FIND, 2, actions="discrete", modalities="state", size=16)
    discrete.reset(seed=0)
    with pytest.raises(Exception, match="99"):
        discrete.step(np.array([0, 99]))


@pytest.mark.parametrize("num_envs", [0, -1, 1 << 20])
def test_number_of_environments_out_of_range_is_refused(num_envs: int) -> None:
    with pytest.raises(Exception, match="num_envs|environments|65"):
        native(FIND, num_envs, size=16, modalities="state")


def test_copies_and_pickles_continue_like_the_original() -> None:
    ours = native(FIND, 3, size=40, max_episode_steps=5)
    ours.reset(seed=0, options={"queue": ["red", "blue"]})
    actions = [ours.action_space.sample() for _ in range(10)]
    for action in actions[:3]:
        ours.step(action)
    others = [copy.deepcopy(ours), pickle.loads(pickle.dumps(ours))]
    for number, action in enumerate(actions):
        expected = copy.deepcopy(ours.step(action))
        for other in others:
            expect_same(expected, other.step(action), f"step {number}")


def test_gymnasium_vector_wrappers_work() -> None:
    envs = native(FIND, 3, modalities="state", size=16, max_episode_steps=4)
    envs = gym.wrappers.vector.RecordEpisodeStatistics(gym.wrappers.vector.NormalizeObservation(envs))
    envs.reset(seed=0)
    lengths = []
    for _ in range(12):
        observations, *_, infos = envs.step(envs.action_space.sample())
        if "episode" in infos:
            lengths.extend(infos["episode"]["l"][infos["_episode"]].tolist())
    assert observations.shape == envs.observation_space.shape
    assert lengths == [4] * len(lengths) and len(lengths) >= 6


def test_render_returns_an_image_for_each() -> None:
    envs = native(FIND, 2, size=16, render_mode="rgb_array", render_size=(48, 64))
    envs.reset(seed=0)
    pictures = envs.render()
    assert [picture.shape for picture in pictures] == [(48, 64, 3)] * 2
    assert not np.array_equal(*pictures)


OPTIONS = st.fixed_dictionaries(
    {
        "variant": st.sampled_from(["default", "red", "near", "dusk", "interact", "held"]),
        "modalities": st.lists(
            st.sampled_from(["rgb", "depth", "segmentation", "class", "instance", "state"]), min_size=1, unique=True
        ),
        "size": st.tuples(st.integers(8, 48), st.integers(8, 48)),
        "depth": st.sampled_from(["uint8", "uint16", "float32"]),
        "actions": st.sampled_from(["normalized", "continuous", "discrete", [[5.0, 0.0, 0.0], [0.0, 90.0, 1.0]]]),
        "frame_skip": st.one_of(st.none(), st.integers(1, 3)),
        "max_steps": st.integers(2, 9),
        "task_label": st.sampled_from(["none", "info", "observation"]),
    }
)


@pytest.mark.parametrize("seed", [0, 1, 7, 2**31 - 1, 2**62])
def test_neighbouring_seeds_share_no_world(seed: int) -> None:
    ours = native(FIND, 32, modalities="state", size=8, max_episode_steps=1, autoreset_mode="same_step")
    seen: list[set[str]] = []
    for one in (seed, seed + 1):
        infos = ours.reset(seed=one)[1]
        assert infos["seed"].tolist() == driftworld.spread_seeds(one, 32)
        hashes = set(infos["world_hash"])
        for _ in range(3):
            hashes |= set(ours.step(ours.action_space.sample())[4]["world_hash"])
        seen.append(hashes)
    assert [len(hashes) for hashes in seen] == [128, 128] and not seen[0] & seen[1]
    # The first is the seed itself, as for a single environment; the others do not depend on the number of environments.
    assert driftworld.spread_seeds(seed, 1) == [seed]
    assert driftworld.spread_seeds(seed, 5) == driftworld.spread_seeds(seed, 32)[:5]


def test_step_limit_and_image_size_do_not_affect_objects() -> None:
    # Wandering objects have their own random numbers, which belong to the world and do not depend on how it is
    # observed.
    places = []
    for options in ({}, {"size": 16}, {"max_episode_steps": 9}, {"max_steps": 30}):
        envs = native("driftworld/MovingObject-v0", 2, modalities="state", **options)
        envs.reset(seed=0)
        still = np.zeros(envs.action_space.shape, dtype=envs.action_space.dtype)
        for _ in range(5):
            envs.step(still)
        places.append([each["coordinates"] for each in envs.state(1)["objects"]])
    assert all(place == places[0] for place in places)


@settings(max_examples=40, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(options=OPTIONS, seed=st.integers(0, 2**40), num_envs=st.integers(1, 4))
def test_vector_matches_single_environments_for_all_options(options: dict[str, Any], seed: int, num_envs: int) -> None:
    ours, theirs = native(FIND, num_envs, **options), sync(FIND, num_envs, **options)
    expect_same(ours.reset(seed=seed), theirs.reset(seed=seed), "reset")
    step_both(ours, theirs, 12)


@pytest.mark.parametrize("mode", ["next_step", "same_step", "disabled"])
@pytest.mark.parametrize("modalities", ["rgb", ["rgb", "state"]], ids=str)
def test_info_none_changes_nothing_else(mode: str, modalities: Any) -> None:
    options: dict[str, Any] = {"modalities": modalities, "size": 8, "actions": "discrete", "max_episode_steps": 3}
    label = {} if modalities == "rgb" else {"task_label": "observation"}
    with_infos, without = (
        gym.make_vec(FIND, 3, vectorization_mode="vector_entry_point", autoreset_mode=mode, info=info, **options, **label)
        for info in ("agent", "none")
    )
    seen, infos = without.reset(seed=2)
    assert first_difference(seen, with_infos.reset(seed=2)[0]) is None and infos == {}
    with_infos.unwrapped.set_next(variant="red")
    without.unwrapped.set_next(variant="red")
    for _ in range(7):
        *found, infos = without.step(np.zeros(3, dtype=np.int64))
        *expected, full_infos = with_infos.step(np.zeros(3, dtype=np.int64))
        assert first_difference(found, expected) is None
        ended = expected[2] | expected[3]
        if mode == "same_step" and ended.any():
            assert set(infos) == {"final_obs", "_final_obs"}
            assert first_difference(infos, {key: full_infos[key] for key in infos}) is None
        else:
            assert infos == {}
        if mode == "disabled" and ended.any():
            assert without.reset(options={"reset_mask": ended})[1] == {}
            with_infos.reset(options={"reset_mask": ended})
    assert [without.unwrapped.origin(env) for env in range(3)] == [with_infos.unwrapped.origin(env) for env in range(3)]
    alone = gym.make(FIND, info="none", **{name: value for name, value in options.items() if name != "max_episode_steps"})
    assert alone.reset(seed=2)[1] == alone.step(0)[-1] == {}


def test_info_none_is_refused_if_something_needs_infos() -> None:
    for label in ("info", "observation"):
        with pytest.raises(ValueError, match='info: found "none" with task_label'):
            gym.make(FIND, info="none", task_label=label, modalities="rgb")
    with pytest.raises(ValueError, match="a log records values from infos"):
        driftworld.Curriculum.design("find_objects#blue", learn=1, eval_episodes=1).environment(info="none")
