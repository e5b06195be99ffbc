"""Class numbers of the class segmentation are the same in every world."""

from __future__ import annotations

import driftworld
import numpy as np
import pytest


def seen(*classes: str) -> set[int]:
    objects = [{"class": name, "coordinates": [3.0 * k - 3.0, 8.0]} for k, name in enumerate(classes)]
    env = driftworld.DriftworldEnv(world={"max_steps": 5, "objects": objects}, modalities="class", size=64)
    observation, _ = env.reset(seed=0)
    return {int(number) for number in np.unique(observation)}


def test_class_has_the_same_number_in_every_world() -> None:
    numbers = driftworld.segmentation_classes()
    assert list(numbers.values()) == list(range(1, 30))
    assert seen("barrel", "tree") == {0, numbers["barrel"], numbers["tree"]}
    assert seen("rock", "barrel") == {0, numbers["rock"], numbers["barrel"]}
    with pytest.raises(driftworld.SpecError, match='found the unknown class "dragon"'):
        seen("dragon")


def test_file_that_is_not_a_library_is_refused(tmp_path) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "town.assets"
    path.write_bytes(b"no library")
    with pytest.raises(driftworld.EnvError):
        driftworld.segmentation_classes(path)
