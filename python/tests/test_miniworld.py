"""Environments with MiniWorld's names have MiniWorld's spaces, steps, rewards and limits, as published in MiniWorld 2.1.0."""

from __future__ import annotations

import math
import pickle
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld.miniworld import Actions, MiniWorldEnv, names, task
from gymnasium.utils.env_checker import check_env

#: By MiniWorld's name: the number of actions, and the step limit.
PUBLISHED = {
    "CollectHealth": (8, 1000),
    "FourRooms": (3, 250),
    "Hallway": (3, 250),
    "Maze": (3, 1536),
    "MazeS2": (3, 96),
    "MazeS3": (3, 216),
    "MazeS3Fast": (3, 300),
    "OneRoom": (3, 180),
    "OneRoomS6": (3, 100),
    "OneRoomS6Fast": (3, 50),
    "PickupObjects": (5, 400),
    "PutNext": (8, 250),
    "RoomObjects": (8, math.inf),
    "Sidewalk": (3, 150),
    "Sign": (4, 20),
    "TMaze": (3, 280),
    "TMazeLeft": (3, 280),
    "TMazeRight": (3, 280),
    "ThreeRooms": (3, 400),
    "WallGap": (3, 300),
    "YMaze": (3, 280),
    "YMazeLeft": (3, 280),
    "YMazeRight": (3, 280),
}
#: Environments in which an earlier success pays more, and nothing can be carried.
BOXES = [name for name, (actions, _) in PUBLISHED.items() if actions == 3 and name != "ThreeRooms"]
FAST = {"MazeS3Fast", "OneRoomS6Fast", "Sign"}


def make(name: str, **options: Any) -> Any:
    return gym.make(f"driftworld/MiniWorld-{name}-v0", disable_env_checker=True, **options).unwrapped


def start_in_the_open(env: Any, name: str, objects: dict[str, list[tuple[float, float]]] | None = None) -> None:
    """Starts an episode on open ground: the agent faces north, and objects of each tag are at the given positions."""
    world = task(name).variant().sample(seed=0)
    world["environment_params"] = {}
    world["agent_params"].update(coordinates=[0, 0], heading=0)
    placed = []
    for tag, places in (objects or {}).items():
        found = [one for one in world["objects"] if one["tag"] == tag]
        placed += [
            {**one, "coordinates": list(pose), "heading": 0} for one, pose in zip(found, places, strict=False)
        ]
    world["objects"] = placed
    env.reset(options={"world": world})


def pose(env: Any) -> tuple[float, float, float]:
    agent = env.state()["agent_params"]
    return (*agent["coordinates"], agent["heading"])


def test_every_published_name_has_an_id() -> None:
    assert sorted(names()) == sorted(PUBLISHED)
    ids = [env_id for env_id in gym.registry if env_id.startswith("driftworld/MiniWorld-")]
    assert sorted(ids) == sorted(f"driftworld/MiniWorld-{name}-v0" for name in PUBLISHED)


@pytest.mark.parametrize("name", PUBLISHED)
def test_spaces_and_limits_match_the_published_ones(name: str) -> None:
    env, (actions, limit) = make(name), PUBLISHED[name]
    image = gym.spaces.Box(0, 255, (60, 80, 3), np.uint8)
    shown = gym.spaces.Dict(obs=image, goal=gym.spaces.Discrete(2)) if name == "Sign" else image
    assert (env.observation_space, env.action_space) == (shown, gym.spaces.Discrete(actions))
    assert env.max_episode_steps == limit
    assert [action.name for action in env.actions] == [action.name for action in Actions] and len(Actions) == 8


@pytest.mark.parametrize("name", PUBLISHED)
def test_every_id_passes_gymnasiums_check(name: str) -> None:
    check_env(make(name, render_mode="rgb_array", window_width=64, window_height=48))


@pytest.mark.parametrize("name", PUBLISHED)
def test_steps_are_as_long_as_miniworlds(name: str) -> None:
    env = make(name)
    metres, turns = (0.7, 2) if name in FAST else (0.15, 6)
    start_in_the_open(env, name)
    for _ in range(8):
        env.step(Actions.move_forward)
    assert pose(env) == pytest.approx((0, 8 * metres, 0), abs=1e-5)
    for _ in range(turns):
        env.step(Actions.turn_right)
    assert pose(env) == pytest.approx((0, 8 * metres, 90), abs=1e-4)
    if name != "Sign":
        env.step(Actions.move_back)
        assert pose(env) == pytest.approx((-metres, 8 * metres, 90), abs=1e-4)
    for _ in range(turns):
        env.step(Actions.turn_left)
    assert pose(env)[2] % 360 == pytest.approx(0, abs=1e-4)
    before = pose(env)
    for action in [] if name == "Sign" else [Actions.pickup, Actions.drop, Actions.toggle, Actions.done]:
        env.step(action)
    assert pose(env) == before


@pytest.mark.parametrize("name", BOXES)
def test_box_pays_by_the_steps_taken(name: str) -> None:
    env, limit = make(name), PUBLISHED[name][1]
    tag = "red" if "YMaze" in name or "TMaze" in name else "goal"
    # Idles first, by turning back and forth; the last case succeeds in the last step allowed.
    for idle in (0, 12, int(limit) - 4):
        start_in_the_open(env, name, {tag: [(0, 4 * (0.7 if name in FAST else 0.15) + 0.75)]})
        rewards = [env.step(step % 2)[1] for step in range(idle - idle % 2)]
        ended, steps = False, len(rewards)
        while not ended:
            _, reward, ended, truncated, info = env.step(Actions.move_forward)
            rewards.append(reward)
            steps += 1
        assert info["is_success"] and steps == env.step_count and truncated == (steps == limit)
        assert reward == pytest.approx(1 - 0.2 * steps / limit, abs=1e-12) and set(rewards[:-1]) <= {0.0}


@pytest.mark.parametrize("name", sorted(set(PUBLISHED) - {"CollectHealth", "RoomObjects"}))
def test_step_limit_truncates_without_reward(name: str) -> None:
    env = make(name)
    env.reset(seed=0)
    for step in range(1, PUBLISHED[name][1] + 1):
        _, reward, terminated, truncated, _ = env.step(step % 2)
        assert (reward, terminated, truncated) == (0, False, step == PUBLISHED[name][1])


@pytest.mark.parametrize("name", ["RoomObjects", "ThreeRooms"])
def test_environment_without_rewards_never_terminates(name: str) -> None:
    env = make(name)
    env.reset(seed=1)
    env.action_space.seed(1)
    ends = [env.step(env.action_space.sample())[1:4] for _ in range(399)]
    assert set(ends) == {(0.0, False, False)}


def test_street_ends_an_episode_without_reward() -> None:
    env = make("Sidewalk")
    world = task("Sidewalk").variant().sample(seed=0)
    world["agent_params"].update(coordinates=[1, -6], heading=90)
    env.reset(options={"world": world})
    steps = [env.step(Actions.move_forward)[1:4] for _ in range(4)]
    assert steps == [(0, False, False)] * 3 + [(0, True, False)]


def test_each_picked_up_object_pays_one() -> None:
    env = make("PickupObjects")
    start_in_the_open(env, "PickupObjects", {"gems": [(0, 1.2 + 1.8 * number) for number in range(5)]})
    env.step(Actions.move_forward)
    assert env.step(Actions.drop)[1] == 0
    rewards: list[float] = []
    ended = False
    while not ended:
        rewards += [env.step(Actions.move_forward)[1]]
        _, reward, ended, truncated, _ = env.step(Actions.pickup)
        rewards += [reward]
    assert sum(rewards) == 5 and rewards[-1] == 1 and not truncated


def test_health_runs_out_in_fifty_steps_and_a_box_restores_it() -> None:
    env = make("CollectHealth")
    start_in_the_open(env, "CollectHealth", {"boxes": [(0, 1.2)]})
    for step in range(1, 31):
        _, reward, terminated, _, info = env.step(Actions.turn_left if step % 2 else Actions.turn_right)
        assert (reward, terminated, info["health"]) == (2, False, 100 - 2 * step)
    assert env.step(Actions.pickup)[4]["health"] == 100
    for step in range(1, 51):
        _, reward, terminated, _, info = env.step(Actions.turn_left)
        assert (reward, terminated, info["health"]) == ((-100, True, 0) if step == 50 else (2, False, 100 - 2 * step))


def test_object_is_carried_to_another() -> None:
    env = make("PutNext")
    start_in_the_open(env, "PutNext", {"ball": [(0, 1)], "barrel_of_balls": [(0, 4)]})

    def step(*actions: Actions) -> tuple[float, bool, list[str]]:
        results = [env.step(action) for action in actions]
        return (
            results[-1][1],
            results[-1][2],
            [event["effect"] for one in results for event in one[4]["events"] if event["effect"]],
        )

    assert step(Actions.drop) == (0, False, [])  # nothing is carried
    assert step(Actions.pickup) == (0, False, ["picked_up"])
    assert step(Actions.pickup, Actions.toggle, Actions.done) == (0, False, [])  # it stays carried
    assert step(*[Actions.move_forward] * 12) == (0, False, [])
    reward, terminated, effects = step(Actions.drop)
    assert (reward, terminated, effects) == (pytest.approx(1 - 0.2 * 18 / 250), True, ["put_down"])


@pytest.mark.parametrize(("tag", "pays"), [("left", 1), ("right", -1)])
def test_sign_names_the_object_that_pays(tag: str, pays: int) -> None:
    env = make("Sign")
    seeds = iter(range(100))
    # The sign OX names the left object.
    world = next(found for seed in seeds if "OX" in str(found := task("Sign").variant("words").sample(seed=seed)))
    side = next(one for one in world["objects"] if one["tag"] == tag)["coordinates"]
    world["agent_params"].update(coordinates=[side[0], side[1] - 3], heading=0)
    seen, _ = env.reset(options={"world": world})
    assert seen["goal"] == 0 and seen["obs"].shape == (60, 80, 3)
    ended = False
    while not ended:
        _, reward, ended, _, _ = env.step(Actions.move_forward)
    assert reward == pays
    env.reset(seed=0)
    assert env.step(3)[1:4] == (0, True, False)  # the action that ends an episode


@pytest.mark.parametrize("name", PUBLISHED)
def test_worlds_of_every_variant_can_be_drawn(name: str) -> None:
    spec = task(name)
    for variant in spec.variants:
        driftworld.validate(spec.sample(variant.name, seed=5), "world", check=True)
        assert len(variant.sample_many(seed=5, count=20)) == 20


def test_variants_of_the_family_are_options() -> None:
    env = make("Hallway", variant="brick")
    _, info = env.reset(seed=0, options={"variant": "dusk"})
    assert env.origin()["variant_id"] == "miniworld_hallway#dusk" and info["seed"] == 0
    with pytest.raises(driftworld.TaskError, match='found variant "nowhere", expected one of plain'):
        make("Hallway", variant="nowhere")


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ValueError, match="name: found 'Halway', expected one of Hallway"):
        MiniWorldEnv("Halway")
    with pytest.raises(ValueError, match="view: found 'side', expected agent or top"):
        make("Hallway", view="side")
    with pytest.raises(TypeError, match="found the option 'obs_widht', .*did you mean 'obs_width'"):
        make("Hallway", obs_widht=3)


def test_images_have_the_requested_sizes() -> None:
    env = make("Hallway", obs_width=30, obs_height=20, render_mode="rgb_array", view="top")
    assert env.reset(seed=0)[0].shape == (20, 30, 3) and env.render().shape == (600, 800, 3)


def test_copy_continues_like_the_original() -> None:
    env = make("PutNext")
    start_in_the_open(env, "PutNext", {"ball": [(0, 1)], "barrel_of_balls": [(0, 9)]})
    env.step(Actions.pickup)
    other = pickle.loads(pickle.dumps(env))
    for one in (env, other):
        one.step(Actions.pickup)
        assert (one.step_count, one.state()["progress"]["carried"]) == (2, [0])
    assert (env.step(Actions.move_forward)[0] == other.step(Actions.move_forward)[0]).all()


def test_saved_world_keeps_its_step_count() -> None:
    env, other = make("Hallway"), make("Hallway")
    start_in_the_open(env, "Hallway", {"goal": [(0, 1.95)]})
    for step in range(10):
        env.step(step % 2)
    other.reset(options={"world": env.state()})
    ended = False
    while not ended:
        _, reward, ended, *_ = other.step(Actions.move_forward)
    assert other.step_count == 18 and reward == pytest.approx(1 - 0.2 * 18 / 250)


def test_several_environments_step_in_gymnasiums_loop() -> None:
    envs = gym.make_vec("driftworld/MiniWorld-OneRoomS6Fast-v0", num_envs=3)
    envs.reset(seed=0)
    observations, rewards, *_ = envs.step(envs.action_space.sample())
    assert observations.shape == (3, 60, 80, 3) and rewards.shape == (3,)
