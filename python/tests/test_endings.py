"""Infos say why an episode ended, in single and vector environments; puzzles continue from a state bit for bit."""

from __future__ import annotations

import copy
import json
import re
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference
from driftworld.envs.autoreset import AutoresetMode

WORLD = "driftworld/World-v0"
FAST: dict[str, Any] = {"size": 16, "modalities": ["rgb", "state"]}
HAS_MODES = hasattr(gym.vector, "AutoresetMode")


def thing(kind: str, tag: str, place: list[float], **keys: Any) -> dict[str, Any]:
    return {"class": kind, "tag": tag, "coordinates": place, **keys}


COIN = {"reward": 5.0, "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"]}
KEY = thing("key", "key", [0.0, 1.2], portable={})
GATE = thing("door", "gate", [0.0, 3.0], scale=2.0, door={})
LAVA = {"disc": {"center": [0.0, 6.0], "radius": 2.0}, "ends": "failure"}
BOX = thing("barrel", "box", [3.0, 1.0])

#: For each value of `ended_by`, a world in which an agent that runs ahead and interacts ends the episode in this way, and
#: whether that is a success.
WORLDS: dict[str, tuple[dict[str, Any], bool]] = {
    "all_collected": (
        {"objects": [thing("barrel", "coin", [0, 4], **COIN)], "rules": {"success": ["all_collected"]}},
        True,
    ),
    "touch": ({"objects": [thing("barrel", "goal", [0, 4])], "rules": {"success": [{"touch": "goal"}]}}, True),
    "opened": ({"objects": [GATE], "rules": {"failure": [{"opened": "gate"}]}}, False),
    "carried": ({"objects": [KEY], "rules": {"success": [{"carried": "key"}]}}, True),
    "delivered": (
        {"objects": [KEY, BOX], "rules": {"success": [{"delivered": {"tag": "key", "to": "box", "within": 5.0}}]}},
        True,
    ),
    "return": ({"rules": {"step_reward": -1, "failure": [{"return_at_most": -4}]}}, False),
    "energy": (
        {"agent_params": {"energy": {"start": 1, "per_second": -2}}, "rules": {"failure": ["out_of_energy"]}},
        False,
    ),
    "zone": ({"environment_params": {"zones": [LAVA]}}, False),
    "steps": ({"max_steps": 7}, False),
    "time": ({"max_seconds": 0.6}, False),
}


def world(change: dict[str, Any]) -> dict[str, Any]:
    document = copy.deepcopy(change)
    document["environment_params"] = {"map_size": [20, 20], **document.get("environment_params", {})}
    agent = {"carry_limit": 1, "agent_width": 0.6, "state_features": ["position", "heading", "carrying", "energy"]}
    document["agent_params"] = {**agent, **document.get("agent_params", {})}
    return document


def single(change: dict[str, Any], **options: Any) -> Any:
    return gym.make(WORLD, disable_env_checker=True, world=world(change), **FAST, **options).unwrapped


def vector(num_envs: int, change: dict[str, Any], **options: Any) -> Any:
    return gym.make_vec(
        WORLD, num_envs=num_envs, vectorization_mode="vector_entry_point", world=world(change), **FAST, **options
    )


def expected_reason(name: str) -> str | None:
    """The `ended_by` of infos: `None` for a step limit, which may also be a wrapper's."""
    return None if name == "steps" else name


@pytest.mark.parametrize("name", WORLDS)
def test_info_says_why_an_episode_ended(name: str) -> None:
    change, is_success = WORLDS[name]
    env = single(change)
    for _ in range(2):
        assert env.reset(seed=0)[1]["ended_by"] is None
        reasons = []
        for _ in range(60):
            _, _, terminated, truncated, info = env.step(np.array([1.0, 0.0, 1.0], dtype=np.float32))
            reasons.append(info["ended_by"])
            if terminated or truncated:
                break
        assert (terminated or truncated) and info["is_success"] is is_success
        assert reasons == [None] * (len(reasons) - 1) + [expected_reason(name)]
        assert truncated is (name in ("steps", "time")), "only limits truncate episodes"


@pytest.mark.parametrize("mode", AutoresetMode if HAS_MODES else [AutoresetMode.NEXT_STEP], ids=str)
@pytest.mark.parametrize("name", ["touch", "carried", "zone", "steps", "time"])
def test_vector_info_says_why_each_episode_ended(name: str, mode: Any) -> None:
    envs = vector(3, WORLDS[name][0], autoreset_mode=mode)
    info = envs.reset(seed=0)[1]
    assert list(info["ended_by"]) == [None] * 3 and info["_ended_by"].all()
    # The first agent runs, the second stands still, and the third starts to run later.
    ends: list[set[str | None]] = [set(), set(), set()]
    for number in range(60):
        speeds = [1.0, 0.0, float(number > 3)]
        actions = np.array([[speed, 0.0, speed] for speed in speeds], dtype=np.float32)
        _, _, terminated, truncated, info = envs.step(actions)
        ended = terminated | truncated
        reasons = info["final_info"]["ended_by"] if mode == AutoresetMode.SAME_STEP and ended.any() else info["ended_by"]
        for env in range(3):
            if ended[env]:
                ends[env].add(reasons[env])
            else:
                assert info["ended_by"][env] is None
        if mode == AutoresetMode.DISABLED and ended.any():
            envs.reset(options={"reset_mask": ended})
    running = {expected_reason(name)}
    waiting = running if name in ("steps", "time") else set()
    assert ends == [running, waiting, running]


def test_gymnasiums_step_limit_sets_no_ended_by() -> None:
    env = gym.make(WORLD, disable_env_checker=True, max_episode_steps=3, world=world(WORLDS["touch"][0]), **FAST)
    env.reset(seed=0)
    for _ in range(3):
        _, _, terminated, truncated, info = env.step(np.zeros(3, dtype=np.float32))
    assert truncated and not terminated and info["ended_by"] is None


def puzzle(seconds: float) -> dict[str, Any]:
    """A locked door, its key in front of the agent, and energy that is half spent after ``seconds``."""
    leaf = thing("door", "gate", [0.0, 3.0], scale=2.0, door={"key": "key", "closes_after": 2.5})
    walls = [[[-10, 2.85], [-1, 2.85], [-1, 3.15], [-10, 3.15]], [[1, 2.85], [10, 2.85], [10, 3.15], [1, 3.15]]]
    return {
        "environment_params": {"walls": [{"polygon": polygon} for polygon in walls]},
        "agent_params": {"energy": {"start": 100, "per_second": -50 / seconds, "most": 100}, "max_linear_speed": 4},
        "objects": [leaf, KEY, thing("barrel", "goal", [0.0, 5.0], **COIN)],
        "rules": {"success": [{"touch": "goal"}], "failure": ["out_of_energy"]},
        "seed": 5,
    }


def walk_until_the_door_opens(env: Any) -> int:
    """Walks ahead, interacting, until the door is open; returns the number of steps."""
    for number in range(1, 40):
        info = env.step(np.array([0.5, 0.0, 1.0], dtype=np.float32))[4]
        if any(event["effect"] == "opened" for event in info["events"]):
            return number
    raise AssertionError("the door was not opened")


@pytest.mark.parametrize("seed", range(4))
def test_puzzle_continues_from_its_state_bit_for_bit(seed: int) -> None:
    env = single(puzzle(1000.0))
    env.reset(seed=seed)
    steps = walk_until_the_door_opens(env)
    env = single(puzzle(steps * env.state()["agent_params"].get("time_step", 0.1)))
    env.reset(seed=seed)
    assert walk_until_the_door_opens(env) == steps
    state = json.loads(json.dumps(env.state()))
    progress = state["progress"]
    assert progress["objects"][0]["open"] is True and progress["carried"] == [1]
    assert progress["energy"] == pytest.approx(50.0, abs=1e-6)

    again = single(puzzle(1000.0))
    again.reset(options={"world": state})
    assert first_difference(env.state(), again.state()) is None
    assert first_difference(env._members.observation(0), again._members.observation(0)) is None
    rng = np.random.default_rng(seed)
    for number in range(400):
        # With seed 0 the agent runs to the goal, otherwise it wanders.
        action = [1.0, 0.0, 0.0] if seed == 0 else [rng.uniform(-0.5, 1), rng.uniform(-1, 1), rng.integers(2)]
        one, other = (each.step(np.array(action, dtype=np.float32)) for each in (env, again))
        assert first_difference(one, other) is None, number
        assert first_difference(env.state(), again.state()) is None, number
        if one[2] or one[3]:
            break
    assert one[4]["ended_by"] in ({"touch"} if seed == 0 else {"touch", "energy"})
    assert (one[1], one[4]["is_success"]) == ((5.0, True) if seed == 0 else (one[1], one[4]["ended_by"] == "touch"))


def test_every_documented_ended_by_has_a_world() -> None:
    documented = set(re.findall(r'``"(\w+)"``', driftworld.DriftworldEnv.step.__doc__ or ""))
    assert documented == {expected_reason(name) for name in WORLDS} - {None}
