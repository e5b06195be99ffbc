"""Runs the executable with ML-Agents' own Gym wrapper, which is not specific to L2Explorer."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import mlagents_envs
import numpy as np
import pytest

from channels import Channels
from clients import TIMEOUT_SECS, Launcher
from worlds import world

pytest.importorskip("gym", reason="the wrapper needs gym")


@pytest.fixture
def wrapper(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The wrapper's module (since client 1.0), without its package, which accesses the network on import."""
    folder = Path(mlagents_envs.__file__).parent / "envs"
    if not (folder / "unity_gym_env.py").is_file():
        pytest.skip("older clients have no wrapper")
    package = ModuleType("mlagents_envs.envs")
    package.__path__ = [str(folder)]
    monkeypatch.setitem(sys.modules, "mlagents_envs.envs", package)
    return importlib.import_module("mlagents_envs.envs.unity_gym_env")


@pytest.mark.filterwarnings("ignore:.*Box bound precision lowered")
@pytest.mark.parametrize("uint8", [False, True])
def test_the_wrapper_runs_episodes(launcher: Launcher, channels: Channels, wrapper: Any, uint8: bool) -> None:
    client = launcher.start(channels=channels.all)
    channels.reset.say("reset_environment", world(max_steps=5))
    env = wrapper.UnityToGymWrapper(client.env, uint8_visual=uint8, allow_multiple_obs=True)
    assert env.action_space.shape == (3,)
    for _ in range(3):
        observations = env.reset()
        assert [each.shape for each in observations] == [(3, 32, 32)] * 3 + [(6,)]
        assert observations[0].dtype == (np.uint8 if uint8 else np.float32)
        ended = [env.step(env.action_space.sample())[2] for _ in range(5)]
        assert ended == [False] * 4 + [True]
    env.close()
    assert client.process.wait(TIMEOUT_SECS) == 0
