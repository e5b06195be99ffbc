"""Driftworld: typed task specs to worlds, distances, curricula, and first-person environments."""

from __future__ import annotations

from driftworld import _native
from driftworld.errors import DriftworldError

__version__: str = _native.__version__
__all__ = ["DriftworldError", "__version__"]
