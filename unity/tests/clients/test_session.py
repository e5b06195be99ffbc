"""Episodes from the client's side: the behaviour's spec, observations, rewards, and the end of an episode."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from channels import Channels
from clients import BEHAVIOR, GENERATION, REST, Launcher
from worlds import AHEAD, GRAB, thing, world


def test_a_client_gets_one_behaviour_with_three_continuous_actions(launcher: Launcher) -> None:
    client = launcher.start()
    client.reset()
    assert client.behaviors() == [BEHAVIOR]
    assert client.shapes() == [(84, 84, 3), (84, 84, 3), (84, 84, 3), (6,)]
    spec = client.spec()
    if GENERATION < (0, 17):
        assert spec.is_action_continuous() and spec.action_size == 3
    else:
        assert (spec.action_spec.continuous_size, spec.action_spec.discrete_branches) == (3, ())
        assert [each.name for each in spec.observation_specs] == ["depth", "rgb", "segmentation", "state"]


@pytest.mark.skipif(GENERATION < (0, 28), reason="older clients receive no properties of dimensions")
def test_newer_clients_get_the_dimension_properties_of_pictures(launcher: Launcher) -> None:
    from mlagents_envs.base_env import DimensionProperty as Property
    from mlagents_envs.base_env import ObservationType

    client = launcher.start()
    client.reset()
    equivariant, plain = Property.TRANSLATIONAL_EQUIVARIANCE, Property.NONE
    picture = (plain, equivariant, equivariant) if GENERATION >= (1, 0) else (equivariant, equivariant, plain)
    specs = client.spec().observation_specs
    assert [each.dimension_property for each in specs] == [picture] * 3 + [(plain,)]
    assert {each.observation_type for each in specs} == {ObservationType.DEFAULT}


def test_the_first_moment_shows_the_start_of_the_world(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(agent={"coordinates": [3, -4], "heading": 45}))
    moment = client.reset()
    assert moment.end is None and moment.now.reward == 0
    assert moment.now.vector.tolist() == [0, 3, -4, 45, 0, 0]
    for picture in moment.now.pictures:
        assert picture.shape == (32, 32, 3) and 0 <= picture.min() < picture.max() <= 1


def test_depth_is_grey_and_the_sky_is_far_and_black(launcher: Launcher) -> None:
    now = launcher.start().reset().now
    assert (now.depth[..., 0] == now.depth[..., 1]).all() and (now.depth[..., 0] == now.depth[..., 2]).all()
    assert now.depth[0, 0, 0] == 1 and now.segmentation[0, 0].tolist() == [0, 0, 0], "row 0 is on top"
    assert now.depth[-1, 0, 0] < 0.1 and now.segmentation[-1, 0].tolist() == [1, 1, 1], "the ground is near, and belongs to the map"


def test_the_agent_stays_the_same_for_five_hundred_steps(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world())
    start = client.reset().now
    rng = np.random.default_rng(0)
    for _ in range(500):
        moment = client.step(rng.uniform([-10, -90, 0], [10, 90, 1]))
        assert moment.end is None and moment.now.agent_id == start.agent_id
        assert np.isfinite(moment.now.vector).all() and (abs(moment.now.vector[1:3]) < 20).all()
    assert not moment.now.equals(start)


def test_the_state_vector_is_collected_x_y_heading_velocity(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world())
    client.reset()
    ahead = client.step((5.0, 0.0, 0.0)).now.vector
    assert ahead == pytest.approx([0, 0, 0.5, 0, 0, 5], abs=1e-5), "5 m/s for 0.1 s along +y"
    turned = client.step((0.0, 90.0, 0.0)).now.vector
    assert turned == pytest.approx([0, 0, 0.5, 9, 0, 0], abs=1e-5), "90 degrees/s for 0.1 s, to the right"


def test_a_step_without_an_action_leaves_the_agent_at_rest(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world())
    start = client.reset()
    client.env.step()
    assert client.moment().now.equals(start.now)


def test_an_object_that_is_touched_pays_once_for_each_contact(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    other = thing(15, 0)
    target = thing(0, 4, 7.0, reward_stimulus=["AgentCollide"])
    channels.reset.say("reset_environment", world(other, target))
    client.reset()
    moments = [client.step(AHEAD).now for _ in range(10)]
    paid = [(moment.reward, int(moment.vector[0])) for moment in moments]
    assert sorted(paid, reverse=True) == [(7, 2)] + [(0, 0)] * 9, "number 2 is the second object"
    for _ in range(5):
        client.step((-10.0, 0.0, 0.0))
    assert sum(client.step(AHEAD).now.reward for _ in range(10)) == 7, "a new contact pays again"


def test_an_object_that_is_interacted_with_pays_and_disappears(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    stimuli = {"reward_stimulus": ["AgentInteract"], "destroy_stimulus": ["AgentInteract"]}
    channels.reset.say("reset_environment", world(thing(0, 4, 100.0, **stimuli)))
    start = client.reset()
    moments = [client.step(AHEAD).now for _ in range(10)]
    assert {(moment.reward, moment.vector[0]) for moment in moments} == {(0, 0)}, "walking into it is not enough"
    assert moments[-1].vector[2] < 4, "the object blocks the way"
    taken = client.step(GRAB).now
    assert (taken.reward, taken.vector[0]) == (100, 1)
    assert client.step(GRAB).now.reward == 0
    cyan = np.array([0, 1, 1], dtype=np.float32)
    assert (start.now.segmentation == cyan).all(axis=2).any(), "the object is visible as one that pays"
    assert not (taken.segmentation == cyan).all(axis=2).any(), "the object is gone"


def test_an_object_with_a_negative_reward_costs(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(thing(0, 4, -2.5, reward_stimulus=["AgentCollide"])))
    client.reset()
    assert sum(client.step(AHEAD).now.reward for _ in range(10)) == -2.5


def test_the_last_step_brings_the_end_and_the_start_of_the_next_episode(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(max_steps=3))
    start = client.reset().now
    assert [client.step(AHEAD).end for _ in range(2)] == [None, None]
    last = client.step(AHEAD)
    assert last.end is not None and last.end.truncated
    assert last.end.agent_id == start.agent_id and last.end.vector[2] == pytest.approx(3, abs=1e-4)
    assert last.now.agent_id == start.agent_id + 1 and last.now.equals(start), "the same world, reset"
    assert last.now.reward == 0
    ends = [client.step(REST).end for _ in range(6)]
    assert [each and each.agent_id for each in ends] == [None, None, 2, None, None, 3]


def test_an_end_by_the_worlds_rules_is_not_a_truncation(launcher: Launcher) -> None:
    target = {"class": "geometric", "coordinates": [0, 3], "reward": 7, "reward_stimulus": ["AgentCollide"]}
    own = {
        "version": 1,
        "max_steps": 100,
        "rules": {"success": [{"return_at_least": 7}]},
        "objects": [target],
    }
    Path("own.json").write_text(json.dumps(own), encoding="utf-8")
    client = launcher.start("--world", "own.json")
    start = client.reset().now
    ends = [end for end in (client.step(AHEAD).end for _ in range(10)) if end]
    assert ends and not any(end.truncated for end in ends)
    assert (ends[0].agent_id, ends[0].reward, ends[0].vector[0]) == (start.agent_id, 7, 1)


def test_the_reward_of_the_last_step_is_in_its_terminal_step(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    target = thing(0, 1.8, 7.0, reward_stimulus=["AgentCollide"])
    channels.reset.say("reset_environment", world(target, max_steps=1))
    client.reset()
    last = client.step(AHEAD)
    assert last.end is not None
    assert (last.end.reward, last.end.vector[0], last.now.reward, last.now.vector[0]) == (7, 1, 0, 0)


def test_a_reset_mid_episode_gives_a_new_agent_in_the_same_world(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(thing(0, 4)))
    start = client.reset().now
    client.step(AHEAD)
    restarted = client.reset()
    assert restarted.end is None and restarted.now.equals(start) and restarted.now.agent_id == start.agent_id + 1


def test_the_world_of_an_option_is_used_until_a_message_sends_another(launcher: Launcher, channels: Channels) -> None:
    Path("own.json").write_text(json.dumps(world(agent={"coordinates": [7, 8]})), encoding="utf-8")
    client = launcher.start("--world", "own.json", channels=channels.all)
    assert client.reset().now.vector[1:3].tolist() == [7, 8]
    channels.reset.say("reset_environment", world())
    assert client.reset().now.vector[1:3].tolist() == [0, 0]
    assert client.reset().now.vector[1:3].tolist() == [0, 0]


def test_the_action_model_of_the_world_is_used(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(agent={"action_model": "bywaypoint"}))
    client.reset()
    for _ in range(20):
        there = client.step((3.0, -4.0, 0.0)).now.vector
    assert there[1:3] == pytest.approx([3, -4], abs=0.2)
    target = thing(6, 6, 5.0, reward_stimulus=["AgentInteract"], destroy_stimulus=["AgentInteract"])
    channels.reset.say("reset_environment", world(target, agent={"action_model": "onrails"}))
    client.reset()
    assert sum(client.step(REST).now.reward for _ in range(60)) == 5, "an agent on rails walks by itself"
    channels.reset.say("reset_environment", world(agent={"action_model": "none"}))
    start = client.reset().now
    assert client.step(AHEAD).now.equals(start)
