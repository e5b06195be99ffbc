"""``Window``: shows images on the screen, through pygame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


class Window:
    """A window that shows images at a given rate.

    Args:
        title: Its title.
        fps: Images per second; :meth:`show` waits accordingly.

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
                'render_mode "human": found no pygame, expected it installed: pip install "pygame>=2.1.3"'
            ) from error
        self._pygame = pygame
        Window._open += 1
        self._fps = fps
        # Initialises the display only: sound would search for devices.
        pygame.display.init()
        pygame.display.set_caption(title)
        self._surface: pygame.Surface | None = None
        self._clock = pygame.time.Clock()

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Shows an image, uint8 (height, width, 3)."""
        pygame = self._pygame
        height, width, _ = picture.shape
        if self._surface is None:
            self._surface = pygame.display.set_mode((width, height))
        self._surface.blit(pygame.surfarray.make_surface(picture.swapaxes(0, 1)), (0, 0))
        pygame.event.pump()
        self._clock.tick(self._fps)
        pygame.display.flip()

    def close(self) -> None:
        """Closes the window."""
        Window._open -= 1
        # pygame has one display for all windows.
        if Window._open == 0:
            self._pygame.display.quit()
