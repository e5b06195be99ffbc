"""A single environment follows Gymnasium's rules, with every supported version of Gymnasium."""

from __future__ import annotations

import copy
import hashlib
import json
import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from conftest import TASKS
from driftworld._equality import first_difference
from driftworld.errors import DriftworldError, EnvError, SpecError, TaskError
from gymnasium.utils.env_checker import check_env

FIND = "driftworld/FindObjects-v0"
TABLE = [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 90.0, 0.0]]
#: Rows for waypoint actions: positions to go to.
WAYPOINTS = [[3.0, 4.0, 0.0], [-3.0, 4.0, 0.0], [0.0, 0.0, 1.0]]
MODALITIES = ["rgb", "depth", "segmentation", "class", "instance", "state"]


def bare(env_id: str, **options: Any) -> Any:
    return gym.make(env_id, disable_env_checker=True, **options).unwrapped


def walk(env: Any, seed: int | None, steps: int = 12) -> list[Any]:
    """Results of a reset and of the first steps; every call takes the same random actions."""
    env.action_space.seed(7)
    results = [env.reset(seed=seed)]
    for _ in range(steps):
        results.append(env.step(env.action_space.sample()))
        if results[-1][2] or results[-1][3]:
            break
    return results


def run_python(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs a program in a separate interpreter."""
    import os

    return subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=200,
        check=False,
    )


def test_every_task_has_its_own_id() -> None:
    named = {
        gym.spec(env_id).kwargs["task"]: env_id
        for env_id in gym.registry
        if env_id.startswith("driftworld/") and "task" in gym.spec(env_id).kwargs
    }
    all_tasks = [task for tasks in driftworld.task_groups().values() for task in tasks]
    assert sorted(named) == sorted(all_tasks) and sorted(driftworld.built_in_tasks()) == sorted(TASKS.values())
    for task, env_id in named.items():
        assert env_id == f"driftworld/{task.title().replace('_', '')}-v0"
    driftworld.validate("key_corridor")


@pytest.mark.parametrize(
    ("misspelt", "meant"), [("modalites", "modalities"), ("max_step", "max_steps"), ("framskip", "frame_skip")]
)
def test_misspelt_option_suggests_the_closest(misspelt: str, meant: str) -> None:
    constructors = [
        lambda: gym.make(FIND, **{misspelt: 3}),
        lambda: gym.make_vec(FIND, num_envs=2, vectorization_mode="vector_entry_point", **{misspelt: 3}),
        lambda: driftworld.DriftworldEnv("find_objects", **{misspelt: 3}),
        lambda: driftworld.DriftworldVectorEnv("find_objects", num_envs=2, **{misspelt: 3}),
    ]
    for make in constructors:
        with pytest.raises(TypeError, match=f"found the option '{misspelt}', expected one of .*did you mean '{meant}'"):
            make()
    with pytest.raises(TypeError, match="found the option 'zzz', expected one of task, [^;]*$"):
        driftworld.DriftworldEnv("find_objects", zzz=1)


def test_options_of_a_subclass_are_checked() -> None:
    class Own(driftworld.DriftworldEnv):
        def __init__(self, colour: str, **options: Any) -> None:
            super().__init__("find_objects", **options)
            self.colour = colour

    assert Own(colour="red", size=16, modalities="rgb").colour == "red"
    with pytest.raises(TypeError, match="sizes"):
        Own(colour="red", sizes=16)


def test_every_variant_of_every_task_passes_gymnasiums_check(task_variant: tuple[str, str]) -> None:
    env_id, variant = task_variant
    # Half of the variants with each kind of actions: the check takes longer than all else here.
    is_odd = driftworld.TaskSpec.load(TASKS[env_id]).variant_names().index(variant) % 2
    actions: Any = WAYPOINTS if variant == "waypoints" else ("normalized", "discrete")[is_odd]
    # pyproject.toml turns warnings into errors.
    check_env(bare(env_id, variant=variant, actions=actions, size=40, render_mode="rgb_array", render_size=(48, 64)))


@pytest.mark.parametrize(
    "options",
    [
        *({"modalities": name} for name in MODALITIES),
        {"modalities": MODALITIES},
        {"modalities": ["depth"], "depth": "float32"},
        {"modalities": "depth", "depth": "uint16"},
        {"actions": TABLE},
        {"actions": "normalized", "interact": False},
        {"actions": "discrete", "interact": True},
        {"size": (36, 48)},
        {"frame_skip": 4},
        {"supersampling": 2},
        {"task_label": "observation"},
        {"task_label": "info"},
        {"drift": {"to": "dusk", "episodes": 3, "schedule": "cosine", "switch": "mixture"}},
        {"render_mode": "rgb_array", "camera": "both"},
    ],
    ids=str,
)
def test_every_option_passes_gymnasiums_check(options: dict[str, Any]) -> None:
    check_env(bare(FIND, **{"render_mode": "rgb_array", "size": 40, **options}))


def test_custom_task_and_world_pass_gymnasiums_check(world_file: Path, task_file: Path) -> None:
    check_env(bare("driftworld/World-v0", world=str(world_file), render_mode="rgb_array"))
    check_env(bare("driftworld/World-v0", world=json.loads(world_file.read_text()), render_mode="rgb_array"))
    check_env(bare("driftworld/Task-v0", task=f"{task_file}#landmarks", render_mode="rgb_array"))


def test_continuous_actions_use_physical_units_and_cause_only_that_warning() -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check_env(bare(FIND, actions="continuous", size=40, render_mode="rgb_array"))
    assert all("symmetric and normalized" in str(warning.message) for warning in caught)
    assert bare(FIND, actions="continuous").action_space.high[1] > 1.0


def test_spaces_are_as_documented() -> None:
    spaces = bare(FIND, modalities=MODALITIES, size=(40, 50), actions="discrete").observation_space.spaces
    found = {name: (space.dtype.name, space.shape) for name, space in spaces.items()}
    assert found == {
        "rgb": ("uint8", (40, 50, 3)),
        "depth": ("uint8", (40, 50, 1)),
        "segmentation": ("uint8", (40, 50, 1)),
        "class": ("uint16", (40, 50, 1)),
        "instance": ("uint32", (40, 50, 1)),
        "state": ("float32", spaces["state"].shape),
    }
    assert bare(FIND, modalities="rgb").observation_space == gym.spaces.Box(0, 255, (84, 84, 3), np.uint8)
    assert bare(FIND, interact=False).action_space == gym.spaces.Box(-1.0, 1.0, (2,), np.float32)
    assert bare(FIND, actions=TABLE).action_space == gym.spaces.Discrete(3)


def test_depth_formats_agree() -> None:
    images = {}
    for depth in ("float32", "uint16", "uint8"):
        images[depth], _ = bare(FIND, modalities="depth", depth=depth).reset(seed=4)
    metres = images["float32"]
    assert 0 < metres.min() < 30
    np.testing.assert_allclose(images["uint16"], np.clip(metres * 1000, 0, 65535), atol=1.0)
    np.testing.assert_allclose(images["uint8"], np.clip(metres * 2.55, 0, 255), atol=1.0)


def test_seed_starts_at_world_0_and_resets_advance() -> None:
    env = bare(FIND, variant="red", modalities="state", info="full")
    variant = driftworld.variant("find_objects#red")
    origins = []
    for seed in (11, None, None, 11, None, 12):
        _, info = env.reset(seed=seed)
        origins.append((info["seed"], info["index"]))
        assert info["variant_id"] == "find_objects#red"
        assert info["task_id"] == "find_objects"
        # The environment's options are applied to the sampled world.
        sampled = variant.sample(info["seed"], info["index"])
        assert sampled["objects"] == env.state()["objects"]
    assert origins == [(11, 0), (11, 1), (11, 2), (11, 0), (11, 1), (12, 0)]


def test_unseeded_environment_draws_a_seed_and_keeps_it() -> None:
    env, other = bare(FIND, modalities="state"), bare(FIND, modalities="state")
    first, second = env.reset()[1], env.reset()[1]
    assert (second["seed"], second["index"]) == (first["seed"], 1)
    assert other.reset()[1]["seed"] != first["seed"]


def test_reset_to_an_index_continues_from_it() -> None:
    env = bare(FIND, modalities="state")
    assert env.reset(seed=3, options={"index": 40})[1]["index"] == 40
    assert env.reset()[1]["index"] == 41
    info = env.reset(options={"index": 7})[1]
    assert (info["seed"], info["index"]) == (3, 7)
    again = bare(FIND, modalities="state")
    again.reset(seed=3, options={"index": 7})
    assert again.reset(options={"index": 7})[1]["world_hash"] == info["world_hash"]


def test_variant_persists_and_queue_cycles() -> None:
    env = bare(FIND, modalities="state", info="full")

    def ids(resets: int, **options: Any) -> list[str]:
        infos = [env.reset(options=options)[1]] + [env.reset()[1] for _ in range(resets - 1)]
        return [info["variant_id"].partition("#")[2] for info in infos]

    assert ids(2, variant="dusk") == ["dusk", "dusk"]
    assert ids(5, queue=["red", "blue"]) == ["red", "blue", "red", "blue", "red"]
    assert ids(2, variant="green") == ["green", "green"]


def test_given_world_lasts_one_episode(world_file: Path) -> None:
    env = bare(FIND, modalities="state", info="full")
    env.reset(seed=1)
    given = env.reset(options={"world": world_file})[1]
    from_text = env.reset(options={"world": world_file.read_text()})[1]
    from_dict = env.reset(options={"world": json.loads(world_file.read_text())})[1]
    assert given["world_hash"] == from_text["world_hash"] == from_dict["world_hash"]
    assert env.reset()[1]["variant_id"] == "find_objects#default"


def test_restored_state_continues_bit_for_bit(env_id: str) -> None:
    env, other = bare(env_id, size=40), bare(env_id, size=40)
    walk(env, 5, steps=6)
    other.reset(options={"world": env.state()})
    actions = [env.action_space.sample() for _ in range(10)]
    for action in actions:
        left, right = env.step(action), other.step(action)
        assert first_difference(left[:4], right[:4]) is None
        if left[2] or left[3]:
            break


def test_steps_report_events_and_success(small: dict[str, Any]) -> None:
    # In this variant objects are near, so the agent soon touches some.
    env = bare(FIND, variant="near", **small)
    seen: list[dict[str, Any]] = []
    env.action_space.seed(0)
    for seed in range(12):
        env.reset(seed=seed)
        for _ in range(60):
            _, _, terminated, truncated, info = env.step(np.array([1.0, 0.2, 1.0], dtype=np.float32))
            assert isinstance(info["is_success"], bool)
            seen.extend(info["events"])
            if terminated or truncated:
                break
    assert seen, "no event in 12 episodes"
    assert {key for event in seen for key in event} == {"object", "tag", "stimulus", "reward", "destroyed", "effect"}
    assert any(event["reward"] > 0 for event in seen)


def test_success_is_reported_at_the_goal() -> None:
    env = bare("driftworld/GetToGoal-v0", modalities="state", size=16)
    env.reset(seed=0)
    world = env.state()
    del world["progress"]
    east, north = world["objects"][0]["coordinates"]
    world["agent_params"].update(coordinates=[east - 4.0, north], heading=90.0)
    env.reset(options={"world": world})
    for _ in range(40):
        _, _, terminated, truncated, info = env.step(np.array([1.0, 0.0, 0.0], dtype=np.float32))
        if terminated or truncated:
            break
    assert terminated and not truncated
    assert info["is_success"] is True


def test_step_limit_truncates() -> None:
    env = bare(FIND, modalities="state", max_steps=3)
    env.reset(seed=0)
    flags = [env.step(np.zeros(3, dtype=np.float32))[2:4] for _ in range(3)]
    assert flags == [(False, False), (False, False), (False, True)]
    with pytest.raises(EnvError):
        env.step(np.zeros(3, dtype=np.float32))


@pytest.mark.parametrize("label, expected", [("none", False), ("info", True)])
def test_label_is_given_only_if_requested(label: str, expected: bool) -> None:
    env = bare(FIND, variant="red", modalities="state", task_label=label)
    assert ("task_label" in env.reset(seed=0)[1]) is expected
    assert ("task_label" in env.step(env.action_space.sample())[4]) is expected


def test_label_in_the_observation_is_one_hot() -> None:
    env = bare(FIND, variant="red", modalities=["state"], task_label="observation")
    names = [variant.name for variant in driftworld.TaskSpec.load("find_objects").variants]
    observation, _ = env.reset(seed=0)
    assert observation["task"].sum() == 1.0
    assert observation["task"].argmax() == names.index("red")


def test_drift_ends_at_its_target() -> None:
    env = bare(FIND, modalities="state", drift={"to": "dusk", "episodes": 4}, info="full")
    infos = [env.reset(seed=0)[1], *(env.reset()[1] for _ in range(5))]
    alone = bare(FIND, variant="dusk", modalities="state", info="full").reset(seed=0, options={"index": 5})[1]
    assert infos[5]["world_hash"] == alone["world_hash"]
    assert len({info["variant_id"] for info in infos}) > 2


def test_copies_and_pickles_continue_like_the_original(env_id: str) -> None:
    env = bare(env_id, size=40)
    walk(env, 2, steps=5)
    for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        assert first_difference(env.state(), other.state()) is None
    others = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    action = env.action_space.sample()
    expected = env.step(action)
    for other in others:
        assert first_difference(expected[:4], other.step(action)[:4]) is None
        assert first_difference(walk(env, 9), walk(other, 9)) is None


def test_spec_survives_json(env_id: str) -> None:
    env = gym.make(env_id, variant="default", actions="discrete", size=40, modalities=["rgb"])
    spec = gym.envs.registration.EnvSpec.from_json(env.spec.to_json())
    again = gym.make(spec)
    assert first_difference(walk(env.unwrapped, 3), walk(again.unwrapped, 3)) is None


def test_unknown_values_are_refused_with_the_known_ones() -> None:
    with pytest.raises(ValueError, match="modalities: found 'sound', expected one of rgb, depth"):
        bare(FIND, modalities=["sound"])
    with pytest.raises(ValueError, match="actions: found 'jump', expected one of task, normalized"):
        bare(FIND, actions="jump")
    with pytest.raises(ValueError, match="renderer: found 'gl', expected one of cpu, gpu, auto"):
        bare(FIND, renderer="gl")
    with pytest.raises(TypeError, match="colour"):
        bare(FIND, colour="red")
    with pytest.raises(DriftworldError, match="rde.*red"):
        bare(FIND, variant="rde")
    with pytest.raises(TaskError, match="find_object"):
        bare("driftworld/Task-v0", task="find_object")
    with pytest.raises(SpecError, match="bywaypoint, whose actions are positions"):
        bare(FIND, variant="waypoints", actions="discrete")
    with pytest.raises(ValueError, match="neither task nor world"):
        bare("driftworld/Task-v0")


@pytest.mark.parametrize(
    "options, message",
    [
        ({"colour": "red"}, "options: found 'colour', expected some of variant, index, world, queue"),
        ({"index": -1}, "index: found -1"),
        ({"index": "two"}, "index: found 'two'"),
        ({"queue": []}, "queue: found \\[\\]"),
        ({"queue": "red"}, "queue: found 'red'"),
        ({"variant": "red", "queue": ["red"]}, "expected one of them"),
        ({"world": "no/such/file.json"}, "world: found no file"),
        ({"variant": 3}, "variant: found 3"),
    ],
    ids=str,
)
def test_invalid_reset_options_are_refused_and_change_nothing(options: dict[str, Any], message: str) -> None:
    env = bare(FIND, modalities="state", info="full")
    before = env.reset(seed=3)[1]
    with pytest.raises((ValueError, TypeError, OSError), match=message):
        env.reset(options=options)
    after = env.reset()[1]
    assert (after["variant_id"], after["seed"], after["index"]) == (before["variant_id"], 3, 1)


@pytest.mark.parametrize("action", [np.zeros(2), np.zeros((3, 1)), [0.0, float("nan"), 0.0], "north"], ids=str)
def test_invalid_action_is_refused_and_changes_nothing(action: Any) -> None:
    env = bare(FIND, modalities="state")
    env.reset(seed=0)
    before = env.state()
    with pytest.raises((ValueError, EnvError)):
        env.step(action)
    assert first_difference(before, env.state()) is None


def test_invalid_world_is_refused_with_its_position(tmp_path: Path) -> None:
    path = tmp_path / "wrong.json"
    path.write_text('{\n  "objects": [{"shape": "cube", "colour": "red"}]\n}')
    with pytest.raises(SpecError) as caught:
        bare("driftworld/World-v0", world=path)
    assert "wrong.json:2:" in str(caught.value)
    assert caught.value.line == 2
    assert caught.value.pointer is not None


def test_gymnasium_imports_the_module_by_name() -> None:
    program = (
        "import gymnasium; print(gymnasium.make('driftworld:driftworld/FindObjects-v0').reset(seed=1)[1]['index'])"
    )
    done = run_python(program)
    assert (done.stdout, done.stderr) == ("0\n", "")


def test_import_starts_no_thread_and_loads_no_large_package() -> None:
    large = ["torch", "pandas", "pygame", "matplotlib", "stable_baselines3", "ray", "minari", "scipy"]
    program = f"import sys, threading, driftworld; print([name for name in {large} if name in sys.modules], threading.active_count())"
    done = run_python(program)
    assert (done.stdout, done.stderr) == ("[] 1\n", "")


LEAK = """
import resource, sys
import gymnasium, driftworld
env = gymnasium.make("driftworld/FindObjects-v0", variant="near", modalities="rgb", size=40, disable_env_checker=True).unwrapped
def peak(): return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
action = env.action_space.sample()
for _ in range(1500):
    env.reset(seed=1); env.step(action)
before = peak()
for number in range(10_000):
    env.reset(seed=number % 7); env.step(action)
print(peak() - before)
"""


def test_ten_thousand_resets_leak_nothing() -> None:
    pytest.importorskip("resource", reason="needs the Unix module resource")
    done = run_python(LEAK)
    assert done.returncode == 0, done.stderr
    # One image of 40 x 40 x 3 bytes kept at each reset would be 47,000 KiB.
    assert int(done.stdout) < 12_000, f"{done.stdout} KiB more"


def test_closed_environment_can_be_closed_again() -> None:
    env = gym.make(FIND, render_mode="rgb_array")
    env.reset(seed=0)
    env.close()
    env.close()


def test_window_shows_the_rendered_image(monkeypatch: pytest.MonkeyPatch) -> None:
    pygame = pytest.importorskip("pygame", reason="needs pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = bare(FIND, render_mode="human", size=40, render_size=(48, 64))
    env.metadata["render_fps"] = 1000
    picture = bare(FIND, render_mode="rgb_array", size=40, render_size=(48, 64))
    env.reset(seed=1)
    picture.reset(seed=1)
    assert env.render() is None
    shown = pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)
    assert np.array_equal(shown, picture.render())
    env.close()


def test_images_have_the_requested_size() -> None:
    # For "both", the view from above is a square beside the agent's view.
    for camera, width in (("agent", 90), ("above", 90), ("both", 150)):
        env = bare(FIND, render_mode="rgb_array", render_size=(60, 90), camera=camera)
        env.reset(seed=0)
        picture = env.render()
        assert picture.shape == (60, width, 3)
        assert picture.dtype == np.uint8
        assert picture.std() > 5


def test_keyboard_actions_are_in_the_action_space() -> None:
    for options in ({}, {"interact": False}, {"actions": "continuous"}):
        env = bare(FIND, **options)
        keys = env.get_keys_to_action()
        assert all(action in env.action_space for action in keys.values())
        assert keys[("w",)][0] == env.action_space.high[0]
    with pytest.raises(ValueError, match="normalized"):
        bare(FIND, actions="discrete").get_keys_to_action()


def test_gymnasium_wrappers_work(small: dict[str, Any], tmp_path: Path) -> None:
    env = gym.make(FIND, max_episode_steps=5, render_mode="rgb_array", **{**small, "modalities": "rgb"})
    env = gym.wrappers.RecordEpisodeStatistics(gym.wrappers.FrameStackObservation(env, 3))
    observation, _ = env.reset(seed=0)
    assert observation.shape == (3, 40, 40, 3)
    truncated = False
    while not truncated:
        observation, _, _, truncated, info = env.step(env.action_space.sample())
    assert info["episode"]["l"] == 5
    env.close()


def test_human_rendering_wraps_rgb_array(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygame", reason="HumanRendering needs pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gym.wrappers.HumanRendering(gym.make(FIND, render_mode="rgb_array", size=40, render_size=(48, 64)))
    env.reset(seed=0)
    env.step(env.action_space.sample())
    env.close()


def test_videos_are_recorded(tmp_path: Path) -> None:
    pytest.importorskip("moviepy", reason="RecordVideo writes through moviepy")
    env = gym.make(FIND, render_mode="rgb_array", size=40, render_size=(48, 64), max_episode_steps=4)
    env = gym.wrappers.RecordVideo(env, str(tmp_path / "videos"), disable_logger=True)
    env.reset(seed=0)
    truncated = False
    while not truncated:
        *_, truncated, _ = env.step(env.action_space.sample())
    env.close()
    assert list((tmp_path / "videos").glob("*.mp4"))


@pytest.mark.parametrize("seed", [0, 7, 2**63 - 1, 2**63, 2**64, 3**200])
def test_any_whole_number_from_0_is_a_seed(seed: int) -> None:
    env, envs = gym.make(FIND, size=8), gym.make_vec(FIND, num_envs=2, size=8)
    info = env.reset(seed=seed)[1]
    folded = int.from_bytes(hashlib.sha256(f"{seed:x}".encode()).digest()[:8], "big") % 2**63
    assert info["seed"] == (seed if seed < 2**63 else folded)
    assert env.unwrapped.np_random_seed == seed
    again = env.reset(seed=env.unwrapped.np_random_seed)[1]
    assert again["world_hash"] == info["world_hash"]
    for given in (seed, [seed, 0]):
        infos = envs.reset(seed=given)[1]
        assert infos["world_hash"][0] == info["world_hash"] and infos["seed"][0] == info["seed"]
        assert envs.unwrapped.np_random_seed[0] == seed
    assert driftworld.spread_seeds(seed, 1) == [info["seed"]]
    unseeded = gym.make(FIND, size=8)
    unseeded.reset()
    unseeded.reset(seed=unseeded.unwrapped.np_random_seed)


def test_spec_has_the_step_limit_of_the_options() -> None:
    assert gym.make(FIND, max_steps=9).spec.max_episode_steps == 9
    assert gym.make(FIND, max_steps=9, max_episode_steps=4).spec.max_episode_steps == 4
    assert gym.make(FIND).spec.max_episode_steps is None
    assert gym.make(FIND, max_steps=0).spec.max_episode_steps is None
    assert gym.make_vec(FIND, num_envs=2, max_steps=9).spec.max_episode_steps == 9
    again = gym.make(gym.make(FIND, max_steps=3, size=8).spec)
    again.reset(seed=0)
    assert [again.step(again.action_space.sample())[3] for _ in range(3)] == [False, False, True]


def test_vector_has_an_origin_for_each_environment() -> None:
    envs = gym.make_vec(FIND, num_envs=2, size=8, render_mode="rgb_array").unwrapped
    with pytest.raises(gym.error.ResetNeeded, match="render: found environments that have not been reset"):
        envs.render()
    infos = envs.reset(seed=3)[1]
    assert [envs.origin(env)["world_hash"] for env in range(2)] == infos["world_hash"].tolist()
    assert [each["seed"] for each in envs.call("origin")] == infos["seed"].tolist()
    with pytest.raises(IndexError, match="origin: found environment 2, expected 0 to 1"):
        envs.origin(2)
