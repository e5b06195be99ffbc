"""The side channels that mlagents-envs itself provides: environment parameters, float properties, engine configuration."""

from __future__ import annotations

from pathlib import Path

import pytest
from mlagents_envs.side_channel.engine_configuration_channel import EngineConfigurationChannel
from mlagents_envs.side_channel.environment_parameters_channel import EnvironmentParametersChannel
from mlagents_envs.side_channel.float_properties_channel import FloatPropertiesChannel
from mlagents_envs.side_channel.side_channel import OutgoingMessage

from channels import Channels
from clients import Client, Launcher
from worlds import AHEAD, thing, world


@pytest.fixture
def parameters() -> EnvironmentParametersChannel:
    return EnvironmentParametersChannel()


@pytest.fixture
def client(launcher: Launcher, channels: Channels, parameters: EnvironmentParametersChannel) -> Client:
    """A client with a channel for parameters, in a world with one object."""
    client = launcher.start("-logFile", "remarks.log", channels=[*channels.all, parameters])
    channels.reset.say("reset_environment", world(thing(0, 15)))
    client.reset()
    return client


def sampler(name: str) -> OutgoingMessage:
    """A parameter that is to be sampled from a uniform distribution, as newer clients send it."""
    message = OutgoingMessage()
    message.write_string(name)
    for number in (1, 7, 0):
        message.write_int32(number)
    message.write_float32_list([0.1, 0.2])
    return message


def log() -> str:
    return Path("remarks.log").read_text(encoding="utf-8")


def test_a_parameter_takes_effect_at_the_next_reset(client: Client, parameters: EnvironmentParametersChannel) -> None:
    parameters.set_float_parameter("time_step", 0.02)
    assert client.step((5.0, 0.0, 0.0)).now.vector[2] == pytest.approx(0.5), "not yet"
    client.reset()
    assert client.step((5.0, 0.0, 0.0)).now.vector[2] == pytest.approx(0.1)


def test_a_parameter_takes_effect_in_the_reset_that_sends_it(
    client: Client, parameters: EnvironmentParametersChannel
) -> None:
    parameters.set_float_parameter("frame_skip", 4)
    client.reset()
    assert client.step((5.0, 0.0, 0.0)).now.vector[2] == pytest.approx(2)


def test_a_parameter_overrides_worlds_sent_by_messages(
    client: Client, channels: Channels, parameters: EnvironmentParametersChannel
) -> None:
    parameters.set_float_parameter("max_steps", 2)
    channels.reset.say("reset_environment", world(max_steps=50))
    client.reset()
    assert [client.step().end is not None for _ in range(4)] == [False, True, False, True]
    channels.reset.say("reset_environment", world(max_steps=0))
    client.reset()
    assert [client.step().end is not None for _ in range(4)] == [False, True, False, True], "the parameter persists"


def test_speed_limits_are_parameters(client: Client, parameters: EnvironmentParametersChannel) -> None:
    parameters.set_float_parameter("max_linear_speed", 2)
    parameters.set_float_parameter("max_angular_speed", 10)
    client.reset()
    vector = client.step((10.0, 90.0, 0.0)).now.vector
    assert vector[3] == pytest.approx(1) and vector[5] == pytest.approx(2, abs=1e-3)


@pytest.mark.parametrize(("name", "value"), [("field_of_view", 100), ("light_intensity", 0.2), ("supersampling", 3)])
def test_a_parameter_changes_the_picture(
    client: Client, parameters: EnvironmentParametersChannel, name: str, value: float
) -> None:
    before = client.reset().now
    parameters.set_float_parameter(name, value)
    after = client.reset().now
    assert (after.rgb != before.rgb).any() and after.rgb.shape == before.rgb.shape
    assert (after.rgb.mean() < before.rgb.mean() / 2) == (name == "light_intensity")


def test_invalid_parameters_are_ignored_and_logged(client: Client, parameters: EnvironmentParametersChannel) -> None:
    before = client.reset().now
    for _ in range(3):
        for name, value in [
            ("gravity", 9.8),
            ("frame_skip", 0.0),
            ("frame_skip", 1.5),
            ("max_steps", -1.0),
            ("time_step", float("nan")),
            ("field_of_view", float("inf")),
            ("field_of_vew", 50.0),
            ("", 1.0),
        ]:
            parameters.set_float_parameter(name, value)
        parameters.queue_message_to_send(sampler("time_step"))
        after = client.reset().now
    assert after.equals(before)
    assert client.step(AHEAD).now.vector[2] == pytest.approx(1)
    assert client.close() == 0
    remarks = log()
    for expected in [
        '"gravity" = 9.8: ignored',
        "frame_skip = 0: ignored",
        "frame_skip = 1.5: ignored",
        "max_steps = -1: ignored, expected a whole number from 0",
        "time_step = NaN: ignored",
        "field_of_view = inf: ignored",
        'did you mean "field_of_view"?',
        '"" = 1: ignored',
        '"time_step": found a sampler',
    ]:
        assert remarks.count(expected) == 1, (expected, remarks)


def test_an_invalid_value_keeps_the_previous_one(client: Client, parameters: EnvironmentParametersChannel) -> None:
    parameters.set_float_parameter("frame_skip", 3)
    parameters.set_float_parameter("frame_skip", -3)
    client.reset()
    assert client.step((5.0, 0.0, 0.0)).now.vector[2] == pytest.approx(1.5)


def test_float_properties_act_like_parameters(launcher: Launcher, channels: Channels) -> None:
    properties = FloatPropertiesChannel()
    client = launcher.start("-logFile", "remarks.log", channels=[*channels.all, properties])
    channels.reset.say("reset_environment", world())
    properties.set_property("Frame_Skip", 3)
    properties.set_property("gravity", 1)
    client.reset()
    assert client.step((5.0, 0.0, 0.0)).now.vector[2] == pytest.approx(1.5)
    assert client.close() == 0
    assert 'float property: "gravity" = 1: ignored' in log()


def test_the_engines_configuration_changes_nothing_and_is_logged(launcher: Launcher, channels: Channels) -> None:
    engine = EngineConfigurationChannel()
    client = launcher.start("-logFile", "remarks.log", channels=[*channels.all, engine])
    channels.reset.say("reset_environment", world(thing(0, 8)))
    client.reset()
    before = client.step(AHEAD).now
    engine.set_configuration_parameters(
        width=640, height=480, quality_level=5, time_scale=20.0, target_frame_rate=-1, capture_frame_rate=60
    )
    client.reset()
    assert client.step(AHEAD).now.equals(before)
    assert client.close() == 0
    remarks = log()
    assert [
        word in remarks for word in ("640 × 480", "quality level 5", "time scale 20", "frame rate -1", "rate 60")
    ] == [True] * 5
