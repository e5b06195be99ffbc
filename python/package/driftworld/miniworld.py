"""MiniWorld's published environments, under ids such as ``driftworld/MiniWorld-Hallway-v0``: its actions, images,
rewards and limits, with worlds of Driftworld's task families.

``miniworld.json`` describes each by MiniWorld's name: Driftworld's ``task`` and ``variant``, what is ``laid`` over
the task's document (a value for each JSON pointer, null to remove one), the step limit ``steps`` (0 for none), the number
of MiniWorld's ``actions``, what ``pays``, and whether steps are ``fast``. ``like`` copies all entries of another name.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field, replace
from enum import IntEnum
from pathlib import Path
from typing import Any, Literal

import numpy as np
from gymnasium import spaces

from driftworld._native import TaskSpec
from driftworld.envs.single import DriftworldEnv

__all__ = ["Actions", "MiniWorldEnv", "names", "task"]


class Actions(IntEnum):
    """MiniWorld's actions and their numbers.

    The space of an environment has the first 3, 4, 5 or all of them; steps accept any.
    """

    turn_left = 0
    turn_right = 1
    move_forward = 2
    move_back = 3
    pickup = 4
    drop = 5
    toggle = 6
    done = 7


#: Seconds, metres per second and degrees per second of a step, for normal and fast steps: 0.15 m or 15°, and 0.7 m or
#: 45°.
_STEPS = {False: (0.2, 0.75, 75.0), True: (0.5, 1.4, 90.0)}
#: State features, in this order: three numbers for the carried object, the energy, and the share of steps left.
_FEATURES = ["carrying", "energy", "steps_left"]


@dataclass(frozen=True)
class _Published:
    """One of MiniWorld's environments: an entry of ``miniworld.json``."""

    task: str
    steps: int
    actions: int
    pays: Literal["success", "pickups", "health", "sign", "nothing"]
    variant: str | None = None
    fast: bool = False
    laid: dict[str, Any] = field(default_factory=dict)

    def rows(self) -> list[list[float]]:
        """All of MiniWorld's actions as rows of an action table: speed, turn rate, and whether to interact."""
        _, speed, turn = _STEPS[self.fast]
        handles = [0.0, 0.0, float(self.actions > Actions.pickup)]
        still = [0.0, 0.0, 0.0]
        return [[0.0, -turn, 0.0], [0.0, turn, 0.0], [speed, 0.0, 0.0], [-speed, 0.0, 0.0], handles, handles, still, still]


def _published() -> dict[str, _Published]:
    found: dict[str, _Published] = {}
    for name, entry in json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8")).items():
        like = found.get(entry.pop("like", ""))
        laid = {**(like.laid if like else {}), **entry.pop("laid", {})}
        found[name] = replace(like, laid=laid, **entry) if like else _Published(laid=laid, **entry)
    return found


_PUBLISHED = _published()


def names() -> list[str]:
    """MiniWorld's names, such as ``"Hallway"``; ``driftworld/MiniWorld-Hallway-v0`` is the id."""
    return list(_PUBLISHED)


def task(name: str) -> TaskSpec:
    """The task spec for one of MiniWorld's environments: one of Driftworld's families, with MiniWorld's sizes.

    Args:
        name: Such as ``"Hallway"``.

    Raises:
        ValueError: If MiniWorld has no such environment.
    """
    if name not in _PUBLISHED:
        raise ValueError(f"name: found {name!r}, expected one of {', '.join(_PUBLISHED)}")
    published = _PUBLISHED[name]
    document = TaskSpec.load(published.task).to_dict()
    document["name"] = f"miniworld_{name.lower()}"
    agent = {"agent_height": 1.5, "time_step": _STEPS[published.fast][0], "state_features": _FEATURES}
    document["world"]["agent_params"].update(agent)
    for pointer, value in published.laid.items():
        _lay(document, pointer, value)
    return TaskSpec.from_dict(document, f"MiniWorld-{name}")


def _lay(document: Any, pointer: str, value: Any) -> None:
    """Sets the value at a pointer, which may be one past the end of a list; None removes it."""
    *way, last = pointer.split("/")[1:]
    for key in way:
        document = document[int(key) if isinstance(document, list) else key]
    if isinstance(document, list):
        document[int(last) : int(last) + 1] = [value]
    elif value is None:
        del document[last]
    else:
        document[last] = value


class MiniWorldEnv(DriftworldEnv):
    """One of MiniWorld's environments, by name: with its spaces, steps, rewards and episode ends.

    Args:
        name: Such as ``"Hallway"``.
        obs_width: Pixels of an observation from left to right.
        obs_height: Pixels from top to bottom.
        variant: A variant of the family, such as ``"dusk"``, instead of the one that represents MiniWorld's
            environment.
        render_mode: ``"rgb_array"``, ``"human"`` or ``None``.
        view: What is rendered: the ``"agent"``'s view, or the world from the ``"top"``.
        window_width: Pixels of a rendered image from left to right.
        window_height: Pixels from top to bottom.

    Attributes:
        actions: MiniWorld's names of its actions.
        max_episode_steps: Steps after which an episode is truncated; infinite for none.

    Raises:
        ValueError: If MiniWorld has no such environment, or for an unknown value of an option.
        TaskError: If the family has no such variant.
    """

    actions = Actions

    def __init__(
        self,
        name: str,
        *,
        obs_width: int = 80,
        obs_height: int = 60,
        variant: str | None = None,
        render_mode: Literal["human", "rgb_array"] | None = None,
        view: Literal["agent", "top"] = "agent",
        window_width: int = 800,
        window_height: int = 600,
    ) -> None:
        if view not in ("agent", "top"):
            raise ValueError(f"view: found {view!r}, expected agent or top")
        spec = task(name)
        self._published = _PUBLISHED[name]
        super().__init__(
            spec,
            variant=variant or self._published.variant,
            modalities=["rgb", "state"],
            size=(obs_height, obs_width),
            actions=self._published.rows(),
            max_steps=self._published.steps,
            render_mode=render_mode,
            render_size=(window_height, window_width),
            camera="above" if view == "top" else "agent",
        )
        self.max_episode_steps = self._published.steps or math.inf
        self._carries, self._steps = False, 0
        self.action_space = spaces.Discrete(self._published.actions)
        image: spaces.Space[Any] = spaces.Box(0, 255, (obs_height, obs_width, 3), np.uint8)
        is_sign = self._published.pays == "sign"
        self.observation_space = spaces.Dict({"obs": image, "goal": spaces.Discrete(2)}) if is_sign else image

    @property
    def step_count(self) -> int:
        """Steps since the start of the episode; without a limit, since the last reset."""
        return self._steps

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode, like :meth:`driftworld.DriftworldEnv.reset`."""
        seen, info = super().reset(seed=seed, options=options)
        return self._shown(seen), info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Executes one action of the agent, like :meth:`driftworld.DriftworldEnv.step`, with MiniWorld's rewards."""
        # Driftworld has one action for both; in MiniWorld, this one has no effect now.
        if action == (Actions.pickup if self._carries else Actions.drop):
            action = Actions.done
        seen, _, terminated, truncated, info = super().step(action)
        shown = self._shown(seen)
        # In MiniWorld a success in the last step both terminates and truncates an episode.
        truncated = truncated or self.step_count >= self.max_episode_steps
        pays, reward = self._published.pays, 0.0
        if pays == "success" and info["is_success"]:
            reward = 1.0 - 0.2 * self.step_count / self.max_episode_steps
        elif pays == "pickups":
            reward = float(sum(event["destroyed"] for event in info["events"]))
        elif pays == "health":
            info["health"] = float(seen["state"][3])
            reward = -100.0 if terminated else 2.0
        elif pays == "sign":
            reward = (1.0 if info["is_success"] else -1.0) if terminated else 0.0
            terminated = terminated or action == Actions.move_back
        return shown, reward, terminated, truncated, info

    def _shown(self, seen: dict[str, Any]) -> Any:
        """The observation of a MiniWorld agent; also updates the state that the rules need."""
        state, limit = seen["state"], self._published.steps
        self._carries = bool(state[0] > 0)
        self._steps = round((1.0 - float(state[4])) * limit) if limit else self._members.batch.episode_steps(0)
        return {"obs": seen["rgb"], "goal": 0} if self._published.pays == "sign" else seen["rgb"]
