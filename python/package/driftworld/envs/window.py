"""``Window``: pictures on a screen, through pygame. Nothing is drawn here."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


class Window:
    """A window that shows pictures at a given pace.

    Args:
        title: What it is called.
        fps: Pictures per second; showing one waits for its time.

    Raises:
        gymnasium.error.DependencyNotInstalled: Without pygame.
    """

    _open = 0

    def __init__(self, title: str, fps: int) -> None:
        try:
            import pygame
        except ImportError as error:
            from gymnasium.error import DependencyNotInstalled

            raise DependencyNotInstalled(
                'render_mode "human": found no pygame, expected it installed: pip install "./python[human]"'
            ) from error
        self._pygame = pygame
        Window._open += 1
        self._fps = fps
        # Only what shows pictures: sound would look for devices.
        pygame.display.init()
        pygame.display.set_caption(title)
        self._surface: pygame.Surface | None = None
        self._clock = pygame.time.Clock()

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Shows a picture, uint8 (height, width, 3)."""
        pygame = self._pygame
        height, width, _ = picture.shape
        if self._surface is None:
            self._surface = pygame.display.set_mode((width, height))
        self._surface.blit(pygame.surfarray.make_surface(picture.swapaxes(0, 1)), (0, 0))
        pygame.event.pump()
        self._clock.tick(self._fps)
        pygame.display.flip()

    def close(self) -> None:
        """Takes it off the screen."""
        Window._open -= 1
        # pygame has one screen for all windows.
        if Window._open == 0:
            self._pygame.display.quit()
