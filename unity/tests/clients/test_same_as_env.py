"""Compares clients with our Gymnasium environment: the same actions in the same worlds give the same bits.

These tests are skipped if the Python package is not installed.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from channels import Channels
from clients import Client, Floats, Launcher, Seen
from worlds import thing, world

pytest.importorskip("gymnasium", reason="compares with the package driftworld, which needs gymnasium")
driftworld = pytest.importorskip("driftworld", reason="compares with the package driftworld, which is not installed")
import gymnasium as gym

#: The colours of categories: sky, map, building, then objects with a positive, zero and negative reward.
COLORS = np.array(
    [(0, 0, 0), (255, 255, 255), (178, 255, 178), (0, 255, 255), (255, 178, 178), (255, 0, 255)], dtype=np.uint8
)

STIMULI = {"reward_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentInteract"]}

#: A world with objects of all kinds, many of them in the agent's path.
OWN = world(
    *(thing(x, y, reward, **STIMULI) for x, y, reward in [(0, 4, 1.5), (3, 3, -2.0), (-3, 2, 0.0), (2, -5, 4.0)]),
    *(thing(x, y, x / 4, **STIMULI) for x in range(-16, 17, 8) for y in range(-15, 16, 6) if abs(x) + abs(y) > 6),
    {"class": "building", "model": "1", "coordinates": [12, 9]},
    {"class": "tree", "model": "3", "coordinates": [-6, 7], "color": [0.1, 0.5, 0.2]},
    thing(-5, -4, 3.0, motion_model="random_waypoint", speed=3, reward_stimulus=["AgentCollide"]),
    thing(6, 6, 0.5, reward_stimulus=["AgentInRange"], range_stimulus_distance=3),
    max_steps=120,
    agent={"observation_size": 48},
)


def actions() -> Iterator[Floats]:
    """Five hundred actions: forwards in curves, sometimes backwards or out of range, so that the agent touches many objects."""
    rng = np.random.default_rng(7)
    for step in range(500):
        action = rng.uniform([-3, -20, 0], [14, 20, 1])
        action[1] += 80 * np.sin(step / 11)
        yield action.astype(np.float32)


def converted(original: Path) -> str:
    """A reset file of L2Explorer, converted by the command `driftworld convert`."""
    command = [sys.executable, "-m", "driftworld", "convert", str(original), "--l2explorer"]
    return subprocess.run(command, check=True, capture_output=True, encoding="utf-8").stdout


def to_floats(levels: npt.NDArray[np.uint8]) -> Floats:
    """8-bit levels as the floats that clients return."""
    return levels.astype(np.float32) / np.float32(255)


def check(seen: Seen, observation: dict[str, Any]) -> None:
    """Asserts that all four observations are equal, bit for bit."""
    assert (seen.depth == to_floats(observation["depth"].repeat(3, axis=2))).all()
    assert (seen.rgb == to_floats(observation["rgb"])).all()
    assert (seen.segmentation == to_floats(COLORS[observation["segmentation"][..., 0]])).all()
    assert seen.vector.dtype == np.float32 and (seen.vector[1:] == observation["state"]).all()


def compare(client: Client, environment: Any) -> tuple[int, list[float]]:
    """Takes the same actions in both; returns the number of finished episodes, and the rewards other than 0."""
    observation, _ = environment.reset(seed=0)
    check(client.reset().now, observation)
    episodes, rewards = 0, []
    for action in actions():
        moment = client.step(action)
        observation, reward, terminated, truncated, info = environment.step(action)
        seen = moment.end or moment.now
        check(seen, observation)
        assert seen.reward == np.float32(reward)
        collected = [event["object"] + 1 for event in info["events"] if event["reward"] or event["destroyed"]]
        assert seen.vector[0] == (collected or [0])[-1]
        assert (moment.end is not None) == (terminated or truncated) and seen.truncated == truncated
        if moment.end:
            episodes += 1
            observation, _ = environment.reset()
            check(moment.now, observation)
        if reward:
            rewards.append(reward)
    environment.close()
    return episodes, rewards


def environment(world: str, **options: Any) -> Any:
    modalities = ["depth", "rgb", "segmentation", "state"]
    return gym.make("driftworld/World-v0", world=world, modalities=modalities, actions="continuous", **options)


def test_in_an_example_world_of_the_original(launcher: Launcher, channels: Channels, reference: Path) -> None:
    original = reference / "map_findobjects_0.json"
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", json.loads(original.read_text(encoding="utf-8")))
    episodes, _ = compare(client, environment(converted(original)))
    assert episodes == 1, "an episode has 300 steps"


def test_in_a_world_where_much_happens(launcher: Launcher, channels: Channels) -> None:
    path = Path("own.json")
    path.write_text(json.dumps(OWN), encoding="utf-8")
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", OWN)
    episodes, rewards = compare(client, environment(converted(path)))
    assert episodes == 4
    assert len(rewards) >= 8 and len(set(rewards)) >= 4, "the world must have many events to compare"


@pytest.mark.parametrize("task", ["find_objects#red", "moving_object", "scavenger_hunt"])
def test_in_a_world_of_a_built_in_task(launcher: Launcher, task: str) -> None:
    sample = driftworld.variant(task).sample_json(5, 0) if "#" in task else None
    text = sample or driftworld.TaskSpec.load(task).variant().sample_json(5, 0)
    Path("own.json").write_text(text, encoding="utf-8")
    compare(launcher.start("--world", "own.json"), environment(text))


def test_with_an_object_created_by_a_message(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    new = thing(1, 3, 2.5, reward_stimulus=["AgentCollide"])
    channels.reset.say("reset_environment", OWN | {"objects": []})
    channels.reset.say("object_create", new)
    Path("own.json").write_text(json.dumps(OWN | {"objects": [new]}), encoding="utf-8")
    twin = environment(converted(Path("own.json")))
    observation, _ = twin.reset(seed=0)
    check(client.reset().now, observation)
    for action in list(actions())[:100]:
        observation, reward, *_ = twin.step(action)
        seen = client.step(action).now
        check(seen, observation)
        assert seen.reward == np.float32(reward)
    twin.close()


def test_float_depth_equals_the_environments_depth_in_metres(launcher: Launcher, channels: Channels) -> None:
    path = Path("own.json")
    path.write_text(json.dumps(OWN), encoding="utf-8")
    client = launcher.start("--raw-observations", channels=channels.all)
    channels.reset.say("reset_environment", OWN)
    twin = environment(converted(path), depth="float32")
    observation, _ = twin.reset(seed=0)
    seen = client.reset().now
    for action in list(actions())[:100]:
        white_at_100_m = np.clip(observation["depth"] / np.float32(100), 0, 1)
        assert (seen.depth == white_at_100_m).all() and white_at_100_m.dtype == np.float32
        assert (seen.rgb == to_floats(observation["rgb"])).all()
        observation, *_ = twin.step(action)
        seen = client.step(action).now
    twin.close()
