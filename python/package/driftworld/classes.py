"""Class numbers of the class segmentation, the images of modality ``class``."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike

from driftworld import _native
from driftworld.envs.options import library_bytes


def segmentation_classes(assets: str | PathLike[str] | Iterable[str | PathLike[str]] = ()) -> dict[str, int]:
    """The number of each class in images of modality ``class``: the same in every world, in ascending order.

    Built-in classes have the numbers 1 to 29, and those of libraries follow from 32 on in the order of their names; a
    library's models of a built-in class have that class's number. In addition, 0 means no object, and 31 any unknown
    class.

    Args:
        assets: Paths of asset libraries, as an environment takes them.

    Raises:
        EnvError: For a file that is not an asset library.

    >>> segmentation_classes()["barrel"]
    2
    """
    return dict(_native.class_numbers(library_bytes(assets)))
