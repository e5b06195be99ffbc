"""Pictures as PNG files and as floats, in sizes that change."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from mlagents_envs.exception import UnityCommunicatorStoppedException

from channels import Channels
from clients import Launcher, code_and_errors
from worlds import AHEAD, thing, world

THINGS = (thing(0, 6, 1.0), thing(2, 8), thing(-2, 5, -1.0))


def test_floats_equal_the_png_files_except_for_finer_depth(launcher: Launcher) -> None:
    seen = []
    for options in ([], ["--raw-observations"]):
        channels = Channels()
        client = launcher.start(*options, channels=channels.all)
        channels.reset.say("reset_environment", world(*THINGS))
        client.reset()
        seen.append([client.step((4.0, 20.0, 0.0)).now for _ in range(20)])
    for png, floats in zip(*seen):
        assert (floats.rgb == png.rgb).all()
        assert (floats.segmentation == png.segmentation).all()
        assert (floats.vector == png.vector).all()
        assert floats.depth.shape == png.depth.shape and 0 <= floats.depth.min() < floats.depth.max() <= 1
        assert abs(floats.depth - png.depth).max() <= 1 / 510 + 1e-6, "half a level of grey"
        assert len(np.unique(floats.depth)) > len(np.unique(png.depth)), "floats have more levels"


def test_size_change_mid_session_changes_shapes_and_pictures(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    for size in (32, 20, 100, 1, 32):
        channels.reset.say("reset_environment", world(*THINGS, agent={"observation_size": size}))
        moment = client.reset()
        assert client.shapes() == [(size, size, 3)] * 3 + [(6,)]
        assert [picture.shape for picture in moment.now.pictures] == [(size, size, 3)] * 3
        later = client.step(AHEAD).now
        assert [picture.shape for picture in later.pictures] == [(size, size, 3)] * 3


def test_size_can_change_with_a_step(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    client.reset()
    channels.reset.say("reset_environment", world(*THINGS))
    assert client.step().now.rgb.shape == (32, 32, 3)
    assert client.shapes()[0] == (32, 32, 3)


def test_pictures_too_large_for_a_message_end_the_session_with_advice(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start_in_editor_mode("--raw-observations", channels=channels.all)
    client.reset()
    channels.reset.say("reset_environment", world(agent={"observation_size": 400}))
    with pytest.raises(UnityCommunicatorStoppedException):
        client.reset()
    code, errors = code_and_errors(client.process)
    assert code == 1 and "leave out --raw-observations" in errors


def test_pictures_that_would_not_fit_at_the_end_of_an_episode_are_refused_at_its_start(
    launcher: Launcher, channels: Channels
) -> None:
    client = launcher.start_in_editor_mode("--raw-observations", channels=channels.all)
    channels.reset.say("reset_environment", world(agent={"observation_size": 250}))
    assert client.reset().now.rgb.shape == (250, 250, 3), "one set of pictures fits"
    channels.reset.say("reset_environment", world(max_steps=2, agent={"observation_size": 250}))
    with pytest.raises(UnityCommunicatorStoppedException):
        client.reset()
    code, errors = code_and_errors(client.process)
    assert code == 1 and "reset to a smaller observation_size" in errors


def test_pictures_need_not_be_square(launcher: Launcher) -> None:
    size = {"observation_width": 40, "observation_size": 24}
    own = {"version": 1, "agent_params": size, "objects": list(THINGS)}
    Path("own.json").write_text(json.dumps(own), encoding="utf-8")
    png, floats = (
        launcher.start("--world", "own.json", *options).reset().now for options in ([], ["--raw-observations"])
    )
    for seen in (png, floats):
        assert [picture.shape for picture in seen.pictures] == [(24, 40, 3)] * 3
    assert (png.rgb == floats.rgb).all() and (png.segmentation == floats.segmentation).all()
    assert (png.segmentation[0] == 0).all() and (png.segmentation[-1] == 1).all(), "row 0 is on top: the sky"
