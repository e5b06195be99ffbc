"""``DriftworldEnv``: a single environment, which is a native batch of one."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from driftworld import _native
from driftworld._literals import CameraName, RenderMode
from driftworld.envs.conversion import teach_conversions
from driftworld.envs.info import of_step
from driftworld.envs.members import Members
from driftworld.envs.options import EnvOptions, Options, refuse_unknown, shows_options
from driftworld.envs.origin import Home
from driftworld.envs.picture import Camera
from driftworld.envs.window import Window
from driftworld.recordings import Recording

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack


class DriftworldEnv(gymnasium.Env[Any, Any]):
    """A first-person world of a task. Only one thread may use it at a time.

    Args:
        task: A built-in name or a path, with or without ``#variant``; a task spec or a variant.
        world: The path of a world, its JSON, or a dictionary, in place of a task.
        variant: The variant to start with; by default the one after ``#``, else the one with all defaults.
        modalities: The modalities of observations: ``"rgb"`` alone is a ``Box``, a list such as ``["rgb", "depth"]`` a
            ``Dict``. Available are ``rgb`` uint8 (h, w, 3); ``depth`` (h, w, 1); ``segmentation`` uint8 (h, w, 1),
            reward categories; ``class`` uint16 and ``instance`` uint32 (h, w, 1); ``state`` float32 (n,). By default
            those that the task asks for, as a ``Dict``.
        blank: With ``modalities``: images that a variant does not ask for are 0 instead of drawn, so that variants with
            different images share one space.
        size: Pixels along each side, or (height, width); by default the task's.
        depth: ``"uint8"``, grey from 0 at the camera to 255 at 100 m; ``"uint16"``, millimetres; ``"float32"``, metres.
        actions: ``"task"``, rows of the task's table if it has one, else numbers in −1..1; ``"normalized"``, −1..1;
            ``"continuous"``, in m/s and °/s; ``"discrete"``, rows of the built-in table; or a table of rows (speed in
            m/s, turn rate in °/s, interact if above 0.5); ``None`` for exactly the task's actions.
        interact: Whether the agent can interact; by default as in the task.
        frame_skip: Time steps for which each action is held; by default the task's.
        max_steps: Steps after which an episode is truncated, 0 for never; by default the task's.
        supersampling: Samples per pixel along each side, 1 to 4; more is smoother and slower.
        renderer: ``"cpu"``, ``"gpu"``, or ``"auto"`` for a graphics card if there is one.
        drift: A drift to another variant, such as ``{"to": "dusk", "episodes": 500, "schedule": "cosine"}``.
        task_label: Whether the agent gets the label of its variant: ``"none"``; in ``"info"``, a number; or in the
            ``"observation"``, as ``"task"``, one-hot (in the info instead if the observation is a single image).
        info: ``"agent"``: infos name task and variant only if there is a ``task_label``. ``"full"``: always, for
            records. ``"none"``: infos are empty, which saves time in large batches; with the autoreset mode
            ``"same_step"`` they still have ``final_obs``.
        assets: Paths of asset libraries (``driftworld assets pack``).
        render_mode: ``"rgb_array"``, ``"human"`` or ``None``.
        render_size: Height and width of rendered images.
        camera: What is rendered: the ``"agent"``'s view, the world from ``"above"``, or ``"both"``.

    Raises:
        SpecError: If the task or an option is wrong, with pointer, line and column.
        TaskError: If there is no such task or variant.
        ValueError: For an unknown value of an option.
        TypeError: For an unknown option.
        EnvError: If a graphics card is requested and none works.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 10}

    def __new__(cls, *args: Any, **options: Any) -> Self:
        """Refuses unknown options before Python does, to suggest the intended one."""
        refuse_unknown(cls, options)
        return super().__new__(cls)

    @shows_options
    def __init__(
        self,
        task: Any = None,
        *,
        world: Any = None,
        variant: Any = None,
        render_mode: RenderMode | None = None,
        render_size: tuple[int, int] = (480, 640),
        camera: CameraName = "agent",
        **options: Unpack[EnvOptions],
    ) -> None:
        refuse_unknown(DriftworldEnv, options)
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode: found {render_mode!r}, expected None, human or rgb_array")
        self._spec: EnvSpec | None = None
        self.render_mode = render_mode
        self._camera = Camera(camera, render_size)
        home = Home(task, world, variant)
        self._members = Members(
            home, home.sources(1, None, options.get("drift")), Options.read(options), "disabled", num_threads=1
        )
        self.observation_space = self._members.observation_space
        self.action_space = self._members.action_space
        fps = 1.0 / self._members.layout["seconds_per_step"]
        self.metadata = {**type(self).metadata, "render_fps": max(1, round(fps))}
        self._window: Window | None = None

    @property
    def spec(self) -> EnvSpec | None:  # type: ignore[override]
        """The spec of ``gymnasium.make``; its ``max_episode_steps`` is the step limit set by the options."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = self._members.limited(spec)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode.

        Args:
            seed: Starts with world 0 under this seed, a whole number from 0; one of 2⁶³ or more is folded by a hash,
                whose result is in ``info["seed"]`` (docs/python.md). Without a seed, continues with the next world
                under the current seed. An environment that never had a seed draws one from ``np_random``.
            options: ``"variant"``, a name; ``"queue"``, a list of variants, one for each episode in turn, cycling; both
                stay in effect until replaced. ``"index"``, the number of the world. ``"world"``, a world (path, JSON,
                dictionary) for this episode only, such as one from :meth:`state`.

        Returns:
            The first observation, and the info: ``seed``, ``index``, ``world_hash`` (of the world as drawn, before
            options are applied), ``events`` and ``is_success``; ``task_id`` and ``variant_id`` with a ``task_label`` or
            ``info="full"``.
        """
        teach_conversions()
        members = self._members
        prepared = members.checked(options or {}, many=False)
        super().reset(seed=seed)
        if seed is None and not members.has_seed[0]:
            seed = int(self.np_random.integers(2**32))
        members.take(prepared, 0, seed)
        members.batch.reset()
        members.has_begun[0] = True
        info = members.reset_info(0)
        if self.render_mode == "human":
            self.render()
        return members.observation(0), info

    def set_next(self, *, variant: Any = None, index: int | None = None, world: Any = None, queue: Any = None) -> None:
        """Sets the next episode, like ``options`` of :meth:`reset` but in advance; the current one continues.

        Args:
            variant: From the next episode on: a name, or a :class:`driftworld.Variant`.
            index: The number of the next world. A reset with a ``seed`` still starts at world 0.
            world: A world for the next episode only: a path, JSON, a dictionary.
            queue: Instead of ``variant``: a list of variants, one for each episode in turn, cycling.

        Raises:
            ValueError, TaskError, SpecError: Like :meth:`reset`; nothing is changed then.
        """
        self._members.set_next([0], {"variant": variant, "index": index, "world": world, "queue": queue})

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Executes one action of the agent.

        Args:
            action: An element of the action space. Numbers outside it are clipped.

        Returns:
            Observation, reward, terminated, truncated, and the info: ``events``, a tuple of dictionaries with
            ``object``, ``tag``, ``stimulus``, ``reward``, ``destroyed`` and ``effect`` (None, or what a door, switch or
            thing did: ``opened``, ``closed``, ``switched``, ``picked_up``, ``put_down``); ``is_success``, whether the
            episode has ended successfully; and ``ended_by``: None until it has ended, then ``"all_collected"``,
            ``"touch"``, ``"opened"``, ``"carried"``, ``"delivered"``, ``"return"``, ``"energy"``, ``"zone"`` or
            ``"time"``; also None if a step limit truncated it, such as Gymnasium's own.

        Raises:
            EnvError: After the end of an episode, or for an invalid action.
            gymnasium.error.ResetNeeded: Before the first reset.
        """
        members = self._members
        if not members.has_begun[0]:
            raise ResetNeeded("step: found an environment that has not been reset, expected a call of reset() first")
        reward, terminated, truncated, success, eventful = members.step_one(action)
        info: dict[str, Any] = {}
        if members.has_infos:
            events = members.batch.events(0) if eventful else ()
            info = of_step(events, success, members.ended_by(0) if terminated or truncated else None)
        if members.label_in_info:
            info["task_label"] = members.label_number(0)
        observation = members.observation(0)
        if self.render_mode == "human":
            self.render()
        return observation, reward, terminated, truncated, info

    def render(self) -> NDArray[np.uint8] | None:  # type: ignore[override]
        """The image, uint8 (height, width, 3); with ``"human"``, shows it in a window."""
        if self.render_mode is None:
            gymnasium.logger.warn('render: found no render_mode, expected gym.make(…, render_mode="rgb_array")')
            return None
        picture = self._camera.picture(self._members.batch, 0)
        if self.render_mode == "rgb_array":
            return picture
        if self._window is None:
            self._window = Window("Driftworld", self.metadata["render_fps"])
        self._window.show(picture)
        return None

    def state(self) -> dict[str, Any]:
        """The current world as a document: a reset to it (``options={"world": …}``) continues identically to the last
        bit.
        """
        return _native.parsed(self._members.batch.state(0))

    def record(self, records: bool = True) -> None:
        """Starts or stops recording; :meth:`recording` returns the result."""
        self._members.batch.record(records)

    def recording(self) -> Recording:
        """The recording of the episode so far; between a reset and the first step, that of the previous episode.

        Raises:
            RuntimeError: Unless :meth:`record` was called.
        """
        return Recording(self._members.recording(0))

    def _repr_png_(self) -> bytes | None:
        """Image for notebooks: the agent's view, and the world from above."""
        if not self._members.has_begun[0]:
            return None
        return _native.png(Camera("both", (240, 240)).picture(self._members.batch, 0))

    def origin(self) -> dict[str, Any]:
        """The origin of the world, for records and not for agents: ``task_id``, ``variant_id``, ``seed``, ``index``,
        ``world_hash``.
        """
        return self._members.origin(0)

    def warnings(self) -> list[str]:
        """Suspicious parts of the world: an unknown class, a switch without a door, a key behind its own door. Remarks
        about its document start with a JSON pointer.
        """
        return self._members.batch.warnings(0)

    def get_keys_to_action(self) -> dict[tuple[str, ...], Any]:
        """Keys for :func:`gymnasium.utils.play.play`: W and S move, A and D turn, the space bar interacts.

        Raises:
            ValueError: Unless actions are ``"normalized"`` or ``"continuous"``: a table has no row for standing still.
        """
        return keys_to_action(self.action_space, self._members.layout)

    def close(self) -> None:
        """Closes the window, if there is one. The environment's memory is freed when nothing refers to it any more."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def __getstate__(self) -> dict[str, Any]:
        kept = {name: value for name, value in self.__dict__.items() if name not in ("_members", "_window")}
        # Copied even for a shallow copy: otherwise both copies would draw from it in turn.
        kept["_np_random"] = copy.deepcopy(self._np_random)
        return {"kept": kept, "members": self._members.written()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Bypasses `__init__`: a subclass has its own, with unknown arguments.
        self.__dict__.update(state["kept"])
        self._window = None
        self._members = Members.again(state["members"])


def keys_to_action(space: gymnasium.Space[Any], layout: Mapping[str, Any]) -> dict[tuple[str, ...], Any]:
    """The result of :meth:`DriftworldEnv.get_keys_to_action` for actions of this space in worlds of this layout."""
    if not isinstance(space, gymnasium.spaces.Box) or layout["action_model"] == "bywaypoint":
        raise ValueError(
            'get_keys_to_action: found actions that are rows or places, expected speeds; use actions="normalized" in a '
            "variant that moves by velocity"
        )
    moves = {"w": (0, 1.0), "s": (0, -0.5), "a": (1, -1.0), "d": (1, 1.0), " ": (2, 1.0)}
    keys: dict[tuple[str, ...], Any] = {}
    for along in ((), ("w",), ("s",)):
        for turn in ((), ("a",), ("d",)):
            for act in ((), (" ",)):
                pressed = along + turn + act
                action = np.zeros(space.shape, dtype=np.float32)
                for key in pressed:
                    axis, share = moves[key]
                    if axis < len(action):
                        action[axis] = share * space.high[axis]
                if pressed:
                    keys[pressed] = action
    return keys
