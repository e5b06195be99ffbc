"""Rendered images for people: the agent's view, the world from above, or both. Observations do not use this module."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld._literals import CameraName

CAMERAS: tuple[CameraName, ...] = get_args(CameraName)


class Camera:
    """The viewpoint and size of rendered images.

    Args:
        name: ``"agent"``, ``"above"``, or ``"both"``: the agent's view with a square view from above beside it.
        size: Height and width in pixels, each 1 to 4096.
    """

    def __init__(self, name: str, size: Any) -> None:
        if name not in CAMERAS:
            raise ValueError(f"camera: found {name!r}, expected one of {', '.join(CAMERAS)}")
        try:
            height, width = (int(side) for side in size)
        except (TypeError, ValueError):
            height, width = 0, 0
        if not (1 <= height <= 4096 and 1 <= width <= 4096):
            raise ValueError(f"render_size: found {size!r}, expected (height, width), each 1 to 4096 pixels")
        self._name = name
        self._size = (height, width)

    def picture(self, batch: _native.Batch, env: int) -> NDArray[np.uint8]:
        """An image of one environment, uint8 (height, width, 3); with ``"both"`` as wide as width and height
        together.
        """
        height, width = self._size
        if self._name != "both":
            return batch.picture(env, height, width, self._name == "above")
        seen, above = batch.picture(env, height, width, False), batch.picture(env, height, height, True)
        return np.concatenate([seen, above], axis=1)
