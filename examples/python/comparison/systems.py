"""The tasks of the comparison, as vector environments with images ``(num_envs, size, size, 3)`` and a few discrete
actions.

Each function imports only its own system, since each system is installed in a separate environment.
"""

from __future__ import annotations

import json
import os
import subprocess
import time
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
        system: The Python environment that it runs in.
        name: Its name in the system.
        about: The goal, in a few words.
        pays: The maximum reward of a success. An episode whose last step pays more than half of it is a success.
        frames: Engine steps per decision.
        make: Makes ``num_envs`` environments with images of ``size`` × ``size`` pixels.
    """

    system: str
    name: str
    about: str
    pays: float
    frames: int
    make: Callable[[int, int], VectorEnv[Any, Any, Any]]


def minigrid(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
    """MiniGrid's partial view as an image of 7 × 7 tiles, with a black border beyond them, and all seven actions."""
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
    """MiniWorld without a display, with OpenGL through EGL."""
    import pyglet

    pyglet.options["headless"] = True
    import miniworld  # noqa: F401

    name = "MiniWorld-OneRoomS6Fast-v0"
    return SyncVectorEnv([lambda: gym.make(name, obs_width=size, obs_height=size)] * num_envs)


class Doom(gym.Env[Any, Any]):
    """A ViZDoom scenario, with three of its buttons and 4 tics per decision. Its 160 × 120 images are subsampled."""

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
        return self._image(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Presses a button for 4 tics. The end of an episode has no new image, so the previous one is returned."""
        reward = self.game.make_action(self.rows[int(action)], 4)
        ended = self.game.is_episode_finished()
        success = ended and reward > self.pays / 2
        return self._image(), reward, success, ended and not success, {}

    def _image(self) -> Any:
        state = self.game.get_state()
        if state is not None:
            self.picture = state.screen_buffer[self.picks]
        return self.picture

    def close(self) -> None:
        """Stops the engine."""
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
    """One engine for each environment; each engine is a separate process."""
    return lambda num_envs, size: SyncVectorEnv([lambda: Doom(scenario, buttons.split(), pays, size)] * num_envs)


#: Start positions and goal are as in MiniGrid's room (more goals would slow down JAXenstein's rendering); size, steps,
#: turns, step limit and touch distance are as in MiniWorld's room, with cells of 1 m.
ROOM = "\n".join(["#" * 8, *["#SSSSSS#"] * 5, "#SSSSSG#", "#" * 8])
ROOM_TURN, ROOM_STEP, ROOM_TOUCH, ROOM_LIMIT, ROOM_ACTIONS = np.pi / 4, 0.7, 0.97, 50, 3


class Jaxenstein(VectorEnv[Any, Any, Any]):
    """A JAXenstein maze, batched by ``vmap``: one call of a compiled function steps all environments.

    As in ``SyncVectorEnv``, the step after the end of an episode starts the next one. Only returned images are rendered.
    """

    def __init__(self, maze: str, num_envs: int, size: int) -> None:
        # Restricts XLA to one thread; it reads the flags when it is first imported.
        os.environ |= {"JAX_PLATFORMS": "cpu", "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}
        import jax
        import jaxenstein
        from jax import numpy as jnp

        self.jax, self.num_envs = jax, num_envs
        num_actions = jaxenstein.NUM_ACTIONS
        if maze == "room":
            numbers = {"turn_angle": ROOM_TURN, "move_speed": ROOM_STEP, "goal_radius": ROOM_TOUCH}
            params = jaxenstein.EnvParams(**{key: jnp.float32(value) for key, value in numbers.items()})
            num_actions = ROOM_ACTIONS
            env = jaxenstein.RayMazeEnv.from_ascii(ROOM, params=params, episode_horizon=ROOM_LIMIT, img_h=size, img_w=size)
        else:
            env = jaxenstein.make_jaxenstein_env(maze, img_h=size, img_w=size)
        self.single_observation_space = gym.spaces.Box(0, 255, env.observation_shape, np.uint8)
        self.single_action_space = gym.spaces.Discrete(num_actions)
        self.observation_space = gym.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gym.vector.utils.batch_space(self.single_action_space, num_envs)

        def step(states: Any, ended: Any, key: Any, actions: Any) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any, Any]]:
            key, use = jax.random.split(key)
            _, fresh = jax.vmap(env.reset)(jax.random.split(use, num_envs))
            _, moved, rewards, done, infos = jax.vmap(env.step)(states, actions)
            states = jax.tree.map(lambda one, other: jnp.where(ended.reshape(-1, *[1] * (one.ndim - 1)), one, other), fresh, moved)
            terminated, done = infos["reached_goal"] & ~ended, done & ~ended
            seen = jax.vmap(env.render)(states), jnp.where(ended, 0, rewards), terminated, done & ~terminated
            return (states, done, key), seen

        # An ended environment starts a new episode, so its state does not matter.
        shapes = jax.eval_shape(jax.vmap(env.reset), jax.random.split(jax.random.key(0), num_envs))[1]
        self.states = jax.tree.map(lambda each: jnp.zeros(each.shape, each.dtype), shapes)
        self.function, self.compiled = step, jax.jit(step)
        start = time.process_time()
        self.reset(seed=0)
        #: Facts for the log: processor seconds of the first call, in which XLA compiles, JAX's version, and the commit.
        self.facts = {"compiling": round(time.process_time() - start, 2), "jax": jax.__version__, "commit": commit(jaxenstein)}

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode in all environments."""
        self.carried = self.states, np.ones(self.num_envs, dtype=bool), self.jax.random.key(seed or 0)
        return self.step(np.zeros(self.num_envs, dtype=np.int32))[0], {}

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Takes one decision in each environment, and waits for the results."""
        self.carried, seen = self.compiled(*self.carried, np.asarray(actions, dtype=np.int32))
        pictures, rewards, terminated, truncated = (np.array(each) for each in seen)
        return pictures, rewards.astype(np.float64), terminated, truncated, {}


def commit(package: Any) -> str:
    """The commit of the checkout that a package was imported from, if it is a clone."""
    clone = Path(package.__file__).parents[1] / ".git"
    if not clone.exists():
        return "unknown"
    command = ["git", "--git-dir", str(clone), "rev-parse", "--short=12", "HEAD"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def jaxenstein(maze: str) -> Callable[[int, int], VectorEnv[Any, Any, Any]]:
    """One of JAXenstein's mazes, with its five actions and step limit, or ``ROOM``."""
    return lambda num_envs, size: Jaxenstein(maze, num_envs, size)


def driftworld_miniworld(num_envs: int, size: int) -> VectorEnv[Any, Any, Any]:
    """MiniWorld's task in Driftworld, in the same loop as MiniWorld."""
    import driftworld  # noqa: F401

    name = "driftworld/MiniWorld-OneRoomS6Fast-v0"
    return SyncVectorEnv([lambda: gym.make(name, obs_width=size, obs_height=size)] * num_envs)


def driftworld_family(family: str, frames: int, rows: list[list[float]]) -> Callable[[int, int], VectorEnv[Any, Any, Any]]:
    """A Driftworld family in its native batch, on one thread."""

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


def rate_of_jaxenstein() -> Callable[[], int]:
    """32 decisions of 16 environments in one compiled call, as a learner written in JAX would run them."""
    envs, steps = Jaxenstein("my-way-home", 16, 32), 32
    table = np.random.default_rng(0).integers(int(envs.single_action_space.n), size=(steps, envs.num_envs), dtype=np.int32)
    compiled = envs.jax.jit(lambda carried, table: envs.jax.lax.scan(lambda last, actions: envs.function(*last, actions), carried, table))
    carried = envs.carried

    def work() -> int:
        nonlocal carried
        carried, seen = envs.jax.block_until_ready(compiled(carried, table))
        assert seen[0].shape == (steps, envs.num_envs, 32, 32, 3)
        return steps * envs.num_envs

    return work


def rate_of_driftworld() -> Callable[[], int]:
    """One Driftworld environment: colour, depth and classes at 160 × 120 in a room with a box, one engine step per
    decision.
    """
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


#: Rates that are measured outside a learner's loop, each with the function that makes its work.
RATES = {"vizdoom-depth": rate_of_doom, "driftworld-depth": rate_of_driftworld, "jaxenstein-rollouts": rate_of_jaxenstein}

_MAKE = {
    "minigrid": minigrid,
    "miniworld": miniworld,
    "jaxenstein-room": jaxenstein("room"),
    "jaxenstein-simple": jaxenstein("simple"),
    "driftworld-room": driftworld_miniworld,
    "vizdoom-house": vizdoom("my_way_home", "TURN_LEFT TURN_RIGHT MOVE_FORWARD", 1.0),
    "jaxenstein-house": jaxenstein("my-way-home"),
    "driftworld-house": driftworld_family("way_home", 5, [[0, -90, 0], [0, 90, 0], [4, 0, 0]]),
    "vizdoom-basic": vizdoom("basic", "MOVE_LEFT MOVE_RIGHT ATTACK", 100.0),
}
#: The tasks of ``tasks.json`` by log name.
TASKS = {
    name: Task(**said, make=_MAKE[name])
    for name, said in json.loads(Path(__file__).with_name("tasks.json").read_text(encoding="utf-8"))["tasks"].items()
}
