"""The tasks of the comparison as vector environments of one shape: pictures ``(num_envs, size, size, 3)`` and a few actions.

Each function imports its own system alone, since each system is installed in an environment of its own.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import SyncVectorEnv, VectorEnv


@dataclass(frozen=True)
class Task:
    """A task of a system.

    Attributes:
        system: The environment of Python that it runs in.
        name: As the system calls it.
        about: What is to be done, in a few words.
        pays: What a success pays at most. An episode whose last step pays more than half of it is a success.
        frames: Steps of the engine in a decision.
        make: Makes ``num_envs`` environments with pictures of ``size`` pixels a side.
    """

    system: str
    name: str
    about: str
    pays: float
    frames: int
    make: Callable[[int, int], VectorEnv[Any, Any, Any]]


def minigrid(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
    """MiniGrid's partial view as a picture: 7 × 7 tiles, and a black border where they do not fill it. All seven actions."""
    import minigrid  # noqa: F401
    from minigrid.wrappers import ImgObsWrapper, RGBImgPartialObsWrapper

    tile = size // 7

    def one() -> gym.Env[Any, Any]:
        seen = ImgObsWrapper(RGBImgPartialObsWrapper(gym.make("MiniGrid-Empty-Random-6x6-v0"), tile_size=tile))
        space = gym.spaces.Box(0, 255, (size, size, 3), np.uint8)
        rest = size - 7 * tile
        return gym.wrappers.TransformObservation(seen, lambda image: np.pad(image, ((0, rest), (0, rest), (0, 0))), space)

    return SyncVectorEnv([one] * num_envs)


def miniworld(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
    """MiniWorld without a display: OpenGL by EGL."""
    import pyglet

    pyglet.options["headless"] = True
    import miniworld  # noqa: F401

    name = "MiniWorld-OneRoomS6Fast-v0"
    return SyncVectorEnv([lambda: gym.make(name, obs_width=size, obs_height=size)] * num_envs)


class Doom(gym.Env[Any, Any]):
    """A scenario of ViZDoom, with three of its buttons, 4 tics a decision. Every so many pixels of 160 × 120 are the picture."""

    def __init__(self, scenario: str, buttons: list[str], pays: float, size: int) -> None:
        self.game, self.pays = doom(scenario, buttons), pays
        self.rows = [[row == button for button in range(3)] for row in range(3)]
        self.picks = np.ix_(np.arange(size) * 120 // size, np.arange(size) * 160 // size)
        self.observation_space = gym.spaces.Box(0, 255, (size, size, 3), np.uint8)
        self.action_space = gym.spaces.Discrete(3)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        if seed is not None:
            self.game.set_seed(seed)
        self.game.new_episode()
        return self._seen(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Presses a button for 4 tics. When an episode has ended, its last picture is the one before."""
        reward = self.game.make_action(self.rows[int(action)], 4)
        ended = self.game.is_episode_finished()
        success = ended and reward > self.pays / 2
        return self._seen(), reward, success, ended and not success, {}

    def _seen(self) -> Any:
        state = self.game.get_state()
        if state is not None:
            self.picture = state.screen_buffer[self.picks]
        return self.picture

    def close(self) -> None:
        """Ends the engine."""
        self.game.close()


def doom(scenario: str, buttons: list[str], depth_and_labels: bool = False) -> Any:
    """A running engine of ViZDoom without a window, 160 × 120 pixels in colour."""
    import vizdoom

    game = vizdoom.DoomGame()
    game.load_config(os.path.join(vizdoom.scenarios_path, f"{scenario}.cfg"))
    game.set_screen_resolution(vizdoom.ScreenResolution.RES_160X120)
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    game.set_depth_buffer_enabled(depth_and_labels)
    game.set_labels_buffer_enabled(depth_and_labels)
    game.set_window_visible(False)
    game.set_available_buttons([getattr(vizdoom.Button, button) for button in buttons])
    game.init()
    return game


def vizdoom(scenario: str, buttons: str, pays: float) -> Callable[[int, int], VectorEnv[Any, Any, Any]]:
    """An engine, a process of its own, for each environment."""
    return lambda num_envs, size: SyncVectorEnv([lambda: Doom(scenario, buttons.split(), pays, size)] * num_envs)


def driftworld_miniworld(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
    """MiniWorld's task by the id of ours, in the same loop as MiniWorld."""
    import driftworld  # noqa: F401

    name = "driftworld/MiniWorld-OneRoomS6Fast-v0"
    return SyncVectorEnv([lambda: gym.make(name, obs_width=size, obs_height=size)] * num_envs)


def driftworld_family(family: str, frames: int, rows: list[list[float]]) -> Callable[[int, int], VectorEnv[Any, Any, Any]]:
    """A family of ours in its native batch, on one thread."""

    def make(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
        from driftworld.envs import DriftworldVectorEnv

        return DriftworldVectorEnv(
            family, num_envs, num_threads=1, modalities="rgb", size=size, actions=rows, frame_skip=frames, interact=False
        )

    return make


def rate_of_doom() -> Callable[[], int]:
    """One engine alone, without Gymnasium: colour, depth and labels at 160 × 120 in ``basic``, the fastest of its scenarios."""
    game = doom("basic", ["MOVE_LEFT", "MOVE_RIGHT", "ATTACK"], depth_and_labels=True)
    rows = [[row == button for button in range(3)] for row in range(3)]

    def work() -> int:
        for row in rows * 20:
            if game.is_episode_finished():
                game.new_episode()
            state = game.get_state()
            assert state.depth_buffer.shape == state.labels_buffer.shape == (120, 160)
            game.make_action(row)
        return 60

    return work


def rate_of_driftworld() -> Callable[[], int]:
    """One of ours alone: colour, depth and classes at 160 × 120 in a room with a box, a step of the engine for each decision."""
    from driftworld.envs import DriftworldVectorEnv

    envs = DriftworldVectorEnv(
        "one_room", 1, num_threads=1, modalities=["rgb", "depth", "class"], size=(120, 160), frame_skip=1, interact=False,
        actions=[[0, -90, 0], [0, 90, 0], [4, 0, 0]],
    )  # fmt: skip
    envs.reset(seed=0)

    def work() -> int:
        for action in range(60):
            envs.step(np.array([action % 3]))
        return 60

    return work


#: Rates of one environment with more than a picture: what makes them.
RATES = {"vizdoom-depth": rate_of_doom, "driftworld-depth": rate_of_driftworld}

_MAKE = {
    "minigrid": minigrid,
    "miniworld": miniworld,
    "driftworld-room": driftworld_miniworld,
    "vizdoom-house": vizdoom("my_way_home", "TURN_LEFT TURN_RIGHT MOVE_FORWARD", 1.0),
    "driftworld-house": driftworld_family("way_home", 5, [[0, -90, 0], [0, 90, 0], [4, 0, 0]]),
    "vizdoom-basic": vizdoom("basic", "MOVE_LEFT MOVE_RIGHT ATTACK", 100.0),
}
#: The tasks of ``tasks.json`` by the names of their logs.
TASKS = {
    name: Task(**said, make=_MAKE[name])
    for name, said in json.loads(Path(__file__).with_name("tasks.json").read_text(encoding="utf-8"))["tasks"].items()
}
