"""Reads recorded episodes from a log, replays them, and renders them."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld._literals import CameraName, FilmModality, RendererName

PathLike = str | os.PathLike[str]


class Recording:
    """An episode, stored as its initial world and the action of each step.

    Made by ``env.recording()`` and :meth:`read`. A notebook shows it as a sheet of its frames.

    Attributes:
        experience: Its number in the log, or in its file.
        block: Its block.
        task, variant, seed, index: The origin of its world, if known.
        steps: Number of its steps.
        reward: Their total reward.
        ended_by: What ended it, in the log's words; ``None`` if nothing did.
        seconds_per_step: Simulated seconds in a step.
        recorded_by: The version of Driftworld that recorded it.
        actions: The actions: rows of the action table, int64 ``(steps,)``, or numbers, float64 ``(steps, 3)``.
    """

    experience: int
    block: int | None
    task: str | None
    variant: str | None
    seed: int | None
    index: int | None
    steps: int
    reward: float
    ended_by: str | None
    edits: int
    seconds_per_step: float
    recorded_by: str

    def __init__(self, handle: _native.RecordingHandle) -> None:
        self._handle = handle
        self.__dict__.update(handle.about())
        self.actions: NDArray[Any] = handle.actions()

    @classmethod
    def read(cls, log: PathLike, episode: int, *, worker: str | None = None) -> Recording:
        """Reads the recording of an episode.

        Args:
            log: The folder of a log, or a file of recordings.
            episode: The number of the episode: ``exp_num`` in the log.
            worker: The worker, if several have an episode with this number.

        Raises:
            DriftworldError: If it does not exist; :class:`CurriculumError` if it is damaged; :class:`MetricsError` if
                the log is damaged.
        """
        return cls(_native.read_recording(Path(log), episode, worker))

    def world(self) -> dict[str, Any]:
        """Its initial world."""
        return _native.parsed(self._handle.world())

    def frames(
        self,
        *,
        size: int = 240,
        view: CameraName = "agent",
        modality: FilmModality = "rgb",
        every: int = 1,
        captions: bool = False,
        renderer: RendererName = "cpu",
        assets: PathLike | tuple[PathLike, ...] = (),
    ) -> NDArray[np.uint8]:
        """Its frames, uint8 ``(frames, height, width, 3)``: the start, one for every ``every`` steps, and the end.

        Args:
            size: Pixels along each side of the agent's view, and of the map; 1 to 2048.
            view: The ``"agent"``'s view, the map from ``"above"``, or ``"both"`` side by side.
            modality: The modality of the agent's view: ``"rgb"``, ``"depth"`` or ``"segmentation"``.
            every: Number of steps per frame.
            captions: A line above each frame: time, return, carried object, events.
            renderer: As for :class:`DriftworldEnv`.
            assets: Paths of the asset libraries that it was recorded with.

        Raises:
            EnvError: If the replay differs from the recording.
            ValueError: If an option is wrong.
        """
        return self._handle.frames(_shown(size, view, modality, every, captions, renderer, assets))

    def save(
        self,
        file: PathLike,
        *,
        size: int = 240,
        view: CameraName = "both",
        modality: FilmModality = "rgb",
        every: int = 1,
        captions: bool = True,
        fps: float | None = None,
        renderer: RendererName = "cpu",
        assets: PathLike | tuple[PathLike, ...] = (),
    ) -> None:
        """Writes it as a film (``.gif``, ``.apng``), or as one image of the key frames (``.png``).

        Args:
            file: The file.
            size, view, modality, every, captions, renderer, assets: As for :meth:`frames`.
            fps: Frames per second; by default a film plays in simulated time.

        Raises:
            EnvError, ValueError: Like :meth:`frames`.
        """
        self._handle.write(Path(file), _shown(size, view, modality, every, captions, renderer, assets), fps)

    def __repr__(self) -> str:
        named = f"{self.task}#{self.variant}, " if self.variant else ""
        ended = f", ended by {self.ended_by}" if self.ended_by else ""
        return f"<Recording of episode {self.experience}: {named}{self.steps} steps, reward {self.reward:g}{ended}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Recording):
            return NotImplemented
        return bool(self._handle.__reduce__()[1] == other._handle.__reduce__()[1])

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return Recording, (self._handle,)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            sheet = Path(folder) / "episode.png"
            self.save(sheet, size=200)
            return sheet.read_bytes()


def _shown(
    size: int, view: str, modality: str, every: int, captions: bool, renderer: str, assets: Any
) -> dict[str, Any]:
    from driftworld.envs.options import library_bytes

    return {
        "size": size,
        "view": view,
        "modality": modality,
        "every": every,
        "captions": captions,
        "renderer": renderer,
        "libraries": [list(library) for library in library_bytes(assets)],
    }


def replay(
    log: PathLike, episode: int, file: PathLike | None = None, *, worker: str | None = None, **options: Any
) -> NDArray[np.uint8] | None:
    """Replays an episode of a recorded log, and renders it.

    Args:
        log: The folder of a log, or a file of recordings.
        episode: The number of the episode: ``exp_num`` in the log.
        file: Where to write it: ``.gif`` or ``.apng`` for a film, ``.png`` for a sheet.
        worker: The worker, if several have an episode with this number.
        options: As for :meth:`Recording.frames`, or with ``file`` for :meth:`Recording.save`.

    Returns:
        The frames, uint8 ``(frames, height, width, 3)``; ``None`` if they were written.

    Raises:
        EnvError: If the replay differs from the recording.
        DriftworldError: If there is no such episode, or its recording is damaged.
        ValueError: If an option is wrong.
    """
    recording = Recording.read(log, episode, worker=worker)
    if file is None:
        return recording.frames(**options)
    recording.save(file, **options)
    return None
