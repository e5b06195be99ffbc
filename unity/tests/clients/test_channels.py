"""L2Explorer's three channels: worlds and objects sent mid-session, reports about the world, and rejected messages."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from channels import Channels, RawChannel
from clients import Client, Launcher
from worlds import AHEAD, thing, world

#: Segmentation colour of objects without reward.
NEUTRAL = np.array([255, 178, 178], dtype=np.float32) / np.float32(255)


@pytest.fixture
def client(launcher: Launcher, channels: Channels) -> Client:
    """A client in an empty world of its own."""
    client = launcher.start("-logFile", "remarks.log", channels=channels.all)
    channels.reset.say("reset_environment", world())
    client.reset()
    channels.reset.take()
    return client


def test_a_reset_by_message_is_answered_ok(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    token = channels.reset.say("reset_environment", world())
    client.reset()
    answer = channels.reset.answer(token)
    assert sorted(answer) == ["action", "msg_time", "payload", "req_token", "token"], "all keys are present"
    assert (answer["action"], answer["payload"]) == ("ok", None)
    assert str(uuid.UUID(answer["token"])) == answer["token"] != token


def test_a_reset_by_message_also_works_with_a_step(client: Client, channels: Channels) -> None:
    before = client.step(AHEAD).now
    token = channels.reset.say("reset_environment", world(agent={"coordinates": [5, 6]}))
    moment = client.step(AHEAD)
    assert channels.reset.answer(token)["action"] == "ok"
    assert moment.now.vector.tolist() == [0, 5, 6, 0, 0, 0], "the action was meant for the old world"
    assert moment.now.agent_id == before.agent_id + 1


def test_object_created_mid_episode_is_visible_and_pays_when_touched(client: Client, channels: Channels) -> None:
    empty = client.step(AHEAD).now
    assert not (empty.segmentation == NEUTRAL).all(axis=2).any()
    channels.reset.say("object_create", thing(-4, 8), unique_name="onlooker")
    token = channels.reset.say("object_create", thing(0, 5, 3.5, reward_stimulus=["AgentCollide"]))
    moment = client.step(AHEAD).now
    assert [answer["action"] for answer in channels.reset.take() if answer["req_token"] == token] == ["ok"]
    assert (moment.segmentation == NEUTRAL).all(axis=2).any(), "the onlooker is visible at once"
    moments = [moment, *(client.step(AHEAD).now for _ in range(8))]
    paid = [(each.reward, each.vector[0]) for each in moments]
    assert sorted(paid, reverse=True) == [(3.5, 2)] + [(0, 0)] * 8, "number 2 is the second object"
    assert moments[-1].agent_id == empty.agent_id, "the episode continues"


def test_object_created_mid_episode_is_gone_in_the_next(client: Client, channels: Channels) -> None:
    start = client.reset().now
    channels.reset.say("object_create", thing(0, 5))
    assert not client.step().now.equals(start)
    assert client.reset().now.equals(start)


@pytest.mark.parametrize(
    ("channel", "action", "payload", "expected"),
    [
        ("reset", "object_create", thing(0, 5000), "coordinates"),
        ("reset", "object_create", {"coordinates": [0, 5]}, "class"),
        ("reset", "object_create", None, "payload: found none"),
        ("reset", "object_create", [1, 2], "payload"),
        ("reset", "reset_environment", world(max_steps=-1), "max_steps"),
        ("reset", "reset_environment", world(agent={"observation_size": 0}), "observation_size"),
        ("reset", "reset_enviroment", world(), 'did you mean "reset_environment"?'),
        ("state", "object_create", thing(0, 5), "expected it on the Reset channel"),
        ("debug", "reset_environment", world(), "expected it on the Reset channel"),
        ("reset", "get_observers", None, "expected it on the State channel"),
        ("state", "set_active_observers", {"state": ["agent_param"]}, 'did you mean "agent_params"?'),
        ("state", "set_active_observers", None, "state"),
        ("debug", "set_debug_categories", [{"category": "agent"}], "active"),
        ("debug", "save_screenshot", {"filename": 3}, "filename"),
        ("debug", "", None, "expected one of"),
    ],
)
def test_invalid_request_is_answered_by_an_error_and_changes_nothing(
    client: Client, channels: Channels, channel: str, action: str, payload: Any, expected: str
) -> None:
    before = client.step().now
    used = getattr(channels, channel)
    token = used.say(action, payload)
    after = client.step().now
    answer = used.answer(token)
    assert answer["action"] == "error" and expected in " ".join(answer["payload"])
    assert after.equals(before) and after.agent_id == before.agent_id
    assert client.close() == 0
    assert expected in Path("remarks.log").read_text(encoding="utf-8"), "logged because the original client ignores answers"


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "\0", '{"action": 3}', "[" * 5000])
def test_text_that_is_not_a_message_is_answered_by_an_error_without_a_token(
    client: Client, channels: Channels, text: str
) -> None:
    for channel in channels.all:
        channel.send_text(text)
    client.step()
    for channel in channels.all:
        (answer,) = channel.take()
        assert (answer["action"], answer["req_token"]) == ("error", "00000000-0000-0000-0000-000000000000")


@pytest.mark.parametrize("data", [b"", b"\x05", b"\x05\0\0\0abc", b"\xff\xff\xff\xffabc", b"\x01\0\0\0\xff"])
def test_bytes_without_a_valid_text_are_answered_by_an_error(client: Client, channels: Channels, data: bytes) -> None:
    channels.reset.send_bytes(data)
    client.step()
    (answer,) = channels.reset.take()
    assert answer["action"] == "error" and "message: found" in answer["payload"][0]


def test_a_thousand_messages_per_step_are_accepted_and_all_are_answered(client: Client, channels: Channels) -> None:
    tokens = [channels.reset.say("object_create", thing(number % 38 - 19, -15)) for number in range(1500)]
    channels.state.say("set_active_observers", {"state": ["objects"]})
    client.step()
    answers = channels.reset.take()
    assert [answer["req_token"] for answer in answers[:1000]] == tokens[:1000]
    assert [answer["action"] for answer in answers] == ["ok"] * 1000 + ["error"] * 500
    assert "more than 1000 in one go" in answers[-1]["payload"][0]
    (refused,) = channels.state.take()
    assert refused["action"] == "error"
    channels.state.say("set_active_observers", {"state": ["objects"]})
    client.step()
    assert len(channels.state.take()[-1]["payload"]["objects"]) == 1000


def test_answers_are_ascii_even_if_the_message_is_not(client: Client, channels: Channels) -> None:
    channels.reset.send_text(json.dumps({"action": "öffne_𝄞", "token": "schlüssel"}, ensure_ascii=False))
    spawn = {"action": "object_create", "unique_name": "Bäume", "payload": thing(0, 5)}
    channels.reset.send_text(json.dumps(spawn, ensure_ascii=False))
    channels.state.say("set_active_observers", {"state": ["objects"]})
    client.step()
    assert all(data.isascii() for channel in channels.all for data in (each[4:] for each in channel.received))
    refused, accepted = channels.reset.take()
    assert refused["req_token"] == "schlüssel" and "öffne_𝄞" in refused["payload"][0]
    assert accepted["action"] == "ok"
    report = channels.state.take()[-1]
    assert report["payload"]["objects"][0]["unique_name"] == "Bäume"


def test_observers_are_listed(client: Client, channels: Channels) -> None:
    token = channels.state.say("get_observers")
    client.step()
    answer = channels.state.answer(token)
    assert answer["action"] == "observer_list"
    assert answer["payload"] == {"state": ["agent_params", "environment_params", "objects", "game_mode"]}


@pytest.mark.parametrize("is_beside_action", [False, True], ids=["in the payload", "beside the action"])
def test_active_observers_report_the_world_after_each_step(client: Client, channels: Channels, is_beside_action: bool) -> None:
    parts = ["agent_params", "objects"]
    if is_beside_action:
        token = channels.state.say("set_active_observers", state=parts)
    else:
        token = channels.state.say("set_active_observers", {"state": parts})
    channels.reset.say("object_create", thing(0, 5, 2.0, destroy_stimulus=["AgentInteract"]), unique_name="cube")
    client.step()
    ok, first = channels.state.take()
    assert (ok["action"], ok["req_token"], first["action"]) == ("ok", token, "state")
    assert sorted(first["payload"]) == sorted(parts) and first["payload"]["objects"][0]["unique_name"] == "cube"
    for speed, turn in [(5.0, 0.0), (0.0, 30.0), (10.0, -90.0)]:
        seen = client.step((speed, turn, 0.0)).now.vector
        (report,) = channels.state.take()
        agent = report["payload"]["agent_params"]
        assert [*agent["coordinates"], agent["heading"]] == seen[1:4].tolist(), "to the last bit"
    channels.state.say("set_active_observers", {"state": []})
    client.step()
    assert [message["action"] for message in channels.state.take()] == ["ok"], "reports have stopped"


def test_debug_categories_are_listed_and_enable_debug_messages(client: Client, channels: Channels) -> None:
    token = channels.debug.say("get_debug_categories")
    client.step()
    answer = channels.debug.answer(token)
    assert answer["action"] == "debug_categories"
    names = ["agent", "communications", "worldmaker", "academy"]
    assert answer["payload"] == names
    token = channels.debug.say("set_debug_categories", [{"category": name, "active": True} for name in names])
    client.step()
    assert channels.debug.answer(token)["action"] == "ok"
    channels.reset.say("reset_environment", world(thing(0, 2.2, 1.0, reward_stimulus=["AgentCollide"]), max_steps=2))
    client.reset()
    client.step(AHEAD)
    client.step(AHEAD)
    remarks = [message["payload"] for message in channels.debug.take() if message["action"] == "debug_message"]
    assert {remark["category"] for remark in remarks} == {"agent", "communications", "academy"}
    assert all(sorted(remark) == ["category", "level", "message", "stack_trace"] for remark in remarks)
    assert any("reward 1" in remark["message"] for remark in remarks)


def test_the_originals_example_messages_are_understood(client: Client, channels: Channels, reference: Path) -> None:
    tests = json.loads((reference / "channel_messages.json").read_text(encoding="utf-8"))["tests"]
    assert len(tests) == 7
    answers = {
        "reset_environment": "ok",
        "object_create": "ok",
        "save_screenshot": "ok",
        "get_debug_categories": "debug_categories",
        "set_debug_categories": "ok",
        "get_observers": "observer_list",
        "set_active_observers": "ok",
    }
    for test in tests:
        message = test["message"]
        channel = getattr(channels, test["channel"].lower())
        channel.send_text(json.dumps({**message, "token": "mine", "msg_time": "2020-03-01T12:00:00"}))
        client.step()
        assert channel.answer("mine")["action"] == answers[message["action"]], message["action"]
    assert [path.name for path in Path("screenshots").iterdir()] == ["l2explorer_screenshot.png"]
    client.step()
    (report,) = channels.state.take()
    assert list(report["payload"]) == ["agent_params"]


def test_messages_on_unknown_channels_are_ignored_and_logged_once(launcher: Launcher) -> None:
    stranger = RawChannel("0a1b2c3d-0000-1111-2222-333344445555")
    client = launcher.start("-logFile", "remarks.log", channels=[stranger])
    client.reset()
    for _ in range(3):
        stranger.send_bytes(b"hello")
        client.step()
    assert stranger.received == []
    assert client.close() == 0
    log = Path("remarks.log").read_text(encoding="utf-8")
    assert log.count("0a1b2c3d-0000-1111-2222-333344445555") == 1
