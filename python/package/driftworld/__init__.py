"""Driftworld: worlds, distances, curricula and first-person environments from typed task specs.

Importing the package only registers the environments with Gymnasium.
"""

from __future__ import annotations

from driftworld import _native
from driftworld.classes import segmentation_classes
from driftworld.curricula import Block, Curriculum, Experience
from driftworld.distances import Distance, DistanceMatrix, Order, distance, distance_matrix, order
from driftworld.envs import DriftworldEnv, DriftworldVectorEnv, register_envs, spread_seeds
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
from driftworld.experiments import elements
from driftworld.lifetimes import Agent, Summary, Transition
from driftworld.logs import Log, LogWriter, read_log, validate_log
from driftworld.recordings import Recording, replay
from driftworld.scores import Metrics, metrics, report
from driftworld.specs import Drift, TaskSpec, Variant, built_in_tasks, task_groups, validate, variant, variants
from driftworld.vector_lifetimes import VectorAgent, VectorTransition
from driftworld.workbench import Studio, studio

__version__: str = _native.__version__
__all__ = [
    "Agent",
    "Block",
    "Curriculum",
    "CurriculumError",
    "Distance",
    "DistanceMatrix",
    "Drift",
    "DriftworldEnv",
    "DriftworldError",
    "DriftworldVectorEnv",
    "EnvError",
    "Experience",
    "GeneratorError",
    "Log",
    "LogWriter",
    "Metrics",
    "MetricsError",
    "Order",
    "Recording",
    "SimilarityError",
    "SpecError",
    "Studio",
    "Summary",
    "TaskError",
    "TaskSpec",
    "Transition",
    "Variant",
    "VectorAgent",
    "VectorTransition",
    "__version__",
    "built_in_tasks",
    "distance",
    "distance_matrix",
    "elements",
    "metrics",
    "order",
    "read_log",
    "replay",
    "report",
    "segmentation_classes",
    "spread_seeds",
    "studio",
    "task_groups",
    "validate",
    "validate_log",
    "variant",
    "variants",
]

register_envs()
