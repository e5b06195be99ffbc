"""Driftworld: typed task specs to worlds, distances, curricula, and first-person environments.

Importing it registers the environments with Gymnasium and does nothing else.
"""

from __future__ import annotations

from driftworld import _native
from driftworld.envs import DriftworldEnv, DriftworldVectorEnv, register_envs
from driftworld.errors import (
    CurriculumError,
    DriftworldError,
    EnvError,
    GeneratorError,
    MetricsError,
    SimilarityError,
    SpecError,
    TaskError,
)

__version__: str = _native.__version__
__all__ = [
    "CurriculumError",
    "DriftworldEnv",
    "DriftworldError",
    "DriftworldVectorEnv",
    "EnvError",
    "GeneratorError",
    "MetricsError",
    "SimilarityError",
    "SpecError",
    "TaskError",
    "__version__",
]

register_envs()
