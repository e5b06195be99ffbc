"""Worlds with an action table, and worlds for photographs, in which each step shows a photograph."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from channels import Channels
from clients import Launcher
from worlds import thing, world

#: Ahead at 10 m/s; turn right at 90 degrees per second; do nothing.
TABLE = [[10, 0, 0], [0, 90, 0], [0, 0, 0]]


@pytest.mark.parametrize("is_mid_session", [False, True])
def test_a_table_is_one_choice_among_its_rows(
    launcher: Launcher, channels: Channels, tmp_path: Path, is_mid_session: bool
) -> None:
    own = world(agent={"actions": {"discrete": TABLE}})
    if is_mid_session:
        client = launcher.start(channels=channels.all)
        client.reset()
        assert client.branches() == (), "no table yet"
        channels.reset.say("reset_environment", own)
    else:
        path = tmp_path / "own.json"
        path.write_text(json.dumps(own))
        client = launcher.start("--world", str(path))
    client.reset()
    assert client.branches() == (3,)
    moments = [client.choose(row).now.vector[1:4] for row in (0, 1, 2, 0)]
    right = np.deg2rad(9)
    expected = [(0, 1, 0), (0, 1, 9), (0, 1, 9), (np.sin(right), 1 + np.cos(right), 9)]
    assert np.allclose(moments, expected, atol=1e-5)
    assert client.close() == 0


def test_each_step_shows_a_photograph_and_the_last_one_ends_the_episode(launcher: Launcher, channels: Channels) -> None:
    own = world(
        thing(3, 4),
        thing(-5, 6),
        game_mode="collect_images",
        image_params={"zoom": 1.5, "yaw_subdivisions": 2, "vertical_subdivisions": 2},
    )
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", own)
    for _ in range(2):
        moment = client.reset()
        numbers = []
        while moment.end is None:
            numbers.append(int(moment.now.vector[0]))
            assert moment.now.segmentation.any(), "the object is in the picture"
            moment = client.step()
        assert numbers == [1, 1, 1, 1, 2, 2, 2, 2]
        assert moment.end.truncated
    assert client.close() == 0
