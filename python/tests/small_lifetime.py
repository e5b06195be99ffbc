"""Helpers for tests of curricula and lifetimes: a small curriculum with all kinds of blocks, two agents, and logs as
text.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from driftworld import Curriculum, Transition, read_log


class Circler:
    """Walks in circles, and records its calls and rewards."""

    name = "circler"

    def __init__(self) -> None:
        self.learned: list[float] = []
        self.frozen: list[bool] = []
        self.begun: list[tuple[str | None, int]] = []
        self.seen: list[Any] = []

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        self.seen.append((observation, info))
        return np.array([5, 45, 0], dtype=np.float32)

    def learn(self, transition: Transition) -> None:
        assert not self.frozen[-1]
        self.learned.append(transition.reward)

    def freeze(self, frozen: bool) -> None:
        self.frozen.append(frozen)

    def begin(self, label: str | None, seed: int) -> None:
        self.begun.append((label, seed))


class Pupil(Circler):
    """Can be saved. Each action depends on everything learned so far."""

    name = "pupil"

    def __init__(self) -> None:
        super().__init__()
        self.knowledge = 0.0
        self.seed = 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        turn = (self.knowledge * 37 + self.seed % 1000) % 180 - 90
        return np.array([8, turn, 0], dtype=np.float32)

    def learn(self, transition: Transition) -> None:
        super().learn(transition)
        self.knowledge = (self.knowledge * 3 + transition.reward + float(transition.next_observation.mean())) % 1000

    def begin(self, label: str | None, seed: int) -> None:
        super().begin(label, seed)
        self.seed = seed

    def save(self, path: Path) -> None:
        path.mkdir()
        (path / "knowledge.json").write_text(json.dumps(self.knowledge), encoding="utf-8")

    def load(self, path: Path) -> None:
        self.knowledge = json.loads((path / "knowledge.json").read_text(encoding="utf-8"))


#: Options that make steps cheap.
SMALL: dict[str, Any] = {"modalities": "rgb", "size": 8, "actions": "continuous"}


def small(max_steps: int = 40) -> Curriculum:
    """A curriculum with all kinds of blocks: pre-deployment, learning with and without drift, evaluation."""

    def regime(variant: str, count: int, seed: int, **extra: Any) -> dict[str, Any]:
        return {
            "task": "find_objects",
            "variant": variant,
            "count": count,
            "seed": seed,
            "max_steps": max_steps,
            **extra,
        }

    def evaluation() -> dict[str, Any]:
        return {"type": "evaluation", "regimes": [regime("blue", 2, 1), regime("red", 1, 1)]}

    return Curriculum.from_dict(
        {
            "name": "small",
            "blocks": [
                {"type": "learning", "phase": "pre_deployment", "regimes": [regime("blue", 2, 5)]},
                evaluation(),
                {"type": "learning", "regimes": [regime("blue", 2, 2), regime("red", 3, 2, drift={"to": "dusk"})]},
                evaluation(),
                {"type": "learning", "regimes": [regime("red", 3, 3)]},
                evaluation(),
            ],
        }
    )


def rows(log: Path, columns: list[str] | None = None) -> dict[str, list[str]]:
    """A log's columns as text, so that numbers are compared bit for bit, and NaN differs from missing values."""
    read = read_log(log).columns
    return {name: [repr(cell) for cell in read[name].tolist()] for name in columns or sorted(set(read) - {"timestamp"})}
