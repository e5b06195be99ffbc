"""Play a task yourself, with the keyboard, in a window.

    python examples/python/play.py --task scavenger_hunt --variant landmarks

Needs `pip install "./python[human]"`.
"""

from __future__ import annotations

import argparse
import os
from typing import Any

import driftworld  # noqa: F401 - registers the environments
import gymnasium
import numpy as np

KEYS = "W forward, S back, A left, D right, space acts, Esc ends"


def main() -> None:
    """Opens the window, and returns when the player quits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--task",
        default="find_objects",
        help="a built-in task or a path (default: %(default)s)",
    )
    parser.add_argument(
        "--variant",
        help="one of its variants (`driftworld tasks show TASK` lists them)",
    )
    parser.add_argument("--seed", type=int, default=0, help="seed of the worlds (default: %(default)s)")
    parser.add_argument(
        "--camera",
        default="both",
        choices=["agent", "above", "both"],
        help="the view to show",
    )
    parser.add_argument("--quick", action="store_true", help="run without a display, and end after 20 steps")
    arguments = parser.parse_args()
    if arguments.quick:
        os.environ["SDL_VIDEODRIVER"] = "dummy"
    play(
        arguments.task,
        arguments.variant,
        seed=arguments.seed,
        camera=arguments.camera,
        max_steps=20 if arguments.quick else None,
    )


def play(task: str, variant: str | None, *, seed: int, camera: str, max_steps: int | None) -> None:
    """Lets a person play; returns when they quit, or after `max_steps` steps."""
    import pygame
    from gymnasium.utils.play import play as gymnasium_play

    env = Episodes(
        gymnasium.make(
            "driftworld/Task-v0",
            task=task,
            variant=variant,
            render_mode="rgb_array",
            render_size=(480, 960 if camera == "both" else 640),
            camera=camera,
            disable_env_checker=True,
        ),
        max_steps,
    )
    print(f"{task}: {KEYS}")
    pygame.display.init()
    pygame.display.set_caption(f"Driftworld {task}: {KEYS}")
    gymnasium_play(env, seed=seed, noop=np.zeros(env.action_space.shape, dtype=np.float32))
    env.close()
    print(f"{env.num_episodes} episodes ended, {env.num_steps} steps")


class Episodes(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Prints events, moves on to the next world after an episode, and closes the window after the last step."""

    def __init__(self, env: gymnasium.Env[Any, Any], max_steps: int | None) -> None:
        super().__init__(env)
        self.num_episodes = 0
        self.num_steps = 0
        self._max_steps = max_steps
        self._return = 0.0
        self._index: int | None = None
        self._length = 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode. Gymnasium's `play` resets twice before the first step, with the same seed every time."""
        if self._index is None:
            observation, info = self.env.reset(seed=seed, options=options)
        else:
            index = self._index if self._length == 0 else self._index + 1
            observation, info = self.env.reset(options={"index": index})
        if self._index != info["index"]:
            variant = self.unwrapped.origin()["variant_id"]  # type: ignore[attr-defined]
            print(f"world {info['index']} of {variant}")
        self._index = info["index"]
        self._return = 0.0
        self._length = 0
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Takes a step, and prints its events."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self.num_steps += 1
        self._length += 1
        self._return += float(reward)
        for event in info["events"]:
            print(f"  {event['tag'] or 'object ' + str(event['object'])}: {event['reward']:+g}")
        if terminated or truncated:
            self.num_episodes += 1
            print(f"  over: return {self._return:.1f}, {'success' if info['is_success'] else 'no success'}")
        if self.num_steps == self._max_steps:
            import pygame

            pygame.event.post(pygame.event.Event(pygame.QUIT))
        return observation, reward, terminated, truncated, info


if __name__ == "__main__":
    main()
