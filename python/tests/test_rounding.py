"""The caller's rounding mode, which other libraries may change, affects no result and is left unchanged."""

from __future__ import annotations

import ctypes
import json
import platform
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld._equality import first_difference

pytestmark = pytest.mark.skipif(
    platform.system() != "Linux" or platform.machine() != "x86_64", reason="rounds by the C library of Linux on x86-64"
)

#: Downward, upward, towards 0.
MODES = [0x400, 0x800, 0xC00]
ROOT = Path(__file__).parents[2]


@contextmanager
def rounding(mode: int) -> Any:
    maths = ctypes.CDLL("libm.so.6")
    before = maths.fegetround()
    maths.fesetround(mode)
    try:
        assert maths.fegetround() == mode
        yield
        assert maths.fegetround() == mode, "the caller's rounding mode was not restored"
    finally:
        maths.fesetround(before)


#: Inputs are created in the usual mode, because NumPy and Python's JSON follow the thread's rounding mode.
ACTION = np.array([0.7, 0.31, 0.0], dtype=np.float32)
DOCUMENT = json.loads((ROOT / "examples" / "tasks" / "get_to_goal.json").read_text(encoding="utf-8"))


def run_envs(num_envs: int, num_threads: int) -> Any:
    envs = gym.make_vec(
        "driftworld/FindObjects-v0",
        num_envs,
        vectorization_mode="vector_entry_point",
        modalities=["rgb", "depth", "state"],
        depth="float32",
        size=16,
        num_threads=num_threads,
    )
    seen = [envs.reset(seed=3)[0]]
    actions = np.tile(ACTION, (num_envs, 1))
    seen += [envs.step(actions)[:2] for _ in range(20)]
    return seen, [envs.unwrapped.state(env) for env in range(num_envs)]


def fresh_task() -> Any:
    task = driftworld.TaskSpec.from_dict({**DOCUMENT, "name": "rounded"})
    return [variant.sample(1, 2) for variant in task.variants]


WORK: dict[str, Callable[[], Any]] = {
    "worlds": fresh_task,
    "one environment": lambda: run_envs(1, 1),
    "several threads": lambda: run_envs(4, 2),
    "many environments": lambda: run_envs(33, 2),
    "distances": lambda: [
        float(driftworld.distance("find_objects#blue", "find_objects#dusk", by=by, worlds=worlds))
        for by, worlds in (("parameters", None), ("worlds", 2), ("pictures", 1), ("dynamics", 1), ("behavior", 1))
    ],
    "a matrix": lambda: np.asarray(driftworld.distance_matrix("find_objects")).tolist(),
    "a drift": lambda: driftworld.Drift(driftworld.variant("find_objects#blue"), driftworld.variant("find_objects#dusk"))
    .at(0.3)
    .sample(4),
}


@pytest.mark.parametrize("name", WORK)
def test_numbers_do_not_depend_on_the_callers_rounding(name: str) -> None:
    expected = WORK[name]()
    for mode in MODES:
        with rounding(mode):
            found = WORK[name]()
        assert first_difference(expected, found) is None, hex(mode)
