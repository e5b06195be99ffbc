"""Measures which elements of the decision process the variants of a task change.

The experiment and its results are those of ``driftworld elements``. ``docs/similarity.md`` explains elements.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from driftworld import _native
from driftworld._literals import ImageKind
from driftworld.specs import TaskSpec


def elements(
    task: str | os.PathLike[str] | TaskSpec,
    a: str | None = None,
    b: str | None = None,
    *,
    modalities: Iterable[ImageKind] | None = None,
    worlds: int = 32,
    seed: int = 0,
    steps: int = 100,
    assets: str | os.PathLike[str] | None = None,
) -> dict[str, Any]:
    """Measures which elements of the decision process variants change, and compares them with the task's declarations.

    Every variant is compared with the first that the task declares, or ``a`` with ``b``.

    Args:
        task: A task, its built-in name such as ``"find_objects"``, or its path.
        a: A variant of the task, to compare with ``b``.
        b: Another variant of the task.
        modalities: The learner's images, such as ``["rgb", "depth"]``; by default those that the worlds ask for.
        worlds: Number of pairs of worlds to try, 1 to 1,000.
        seed: The seed of the worlds.
        steps: Maximum number of steps in an episode, 1 to 100,000.
        assets: An asset library with classes that the task uses.

    Returns:
        A dictionary with ``task``, ``base`` (the variant that the others are compared with), ``worlds``, ``seed``,
        ``steps`` and ``variants``: a list of dictionaries with ``variant``, ``parameters`` (in which it differs),
        ``declared`` (letters), ``measured`` (each with ``element`` and ``witness``), ``contradictions`` (each with
        ``element`` and ``message``), ``idle`` (parameters that made no difference), ``proof`` (the extent of the
        experiment) and ``verdict`` (``"sound"``, ``"idle"`` or ``"contradicted"``).

    Raises:
        TaskError: If there is no such task or variant, or a world cannot be drawn.
        TypeError: If one variant is given without the other.
    """
    if (a is None) != (b is None):
        raise TypeError("elements: found one variant, expected none or two: elements(task, a, b)")
    options = dict(locals())
    del options["task"]
    return _native.elements(task if isinstance(task, TaskSpec) else TaskSpec.load(task), options)
