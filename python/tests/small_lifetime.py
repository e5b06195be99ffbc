"""Shared by the tests of curricula and lifetimes: a small curriculum with all kinds of blocks, two agents, and logs as
text.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from driftworld import Curriculum, Transition, read_log


class Circler:
    """Walks in circles, and stores its rewards."""

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
    """An agent that can be saved, and whose every action depends on everything that it has learned."""

    name = "pupil"

    def __init__(self) -> None:
        super().__init__()
        self.knowledge = 0.0
        self.chance = 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        turn = (self.knowledge * 37 + self.chance % 1000) % 180 - 90
        return np.array([8, turn, 0], dtype=np.float32)

    def learn(self, transition: Transition) -> None:
        super().learn(transition)
        self.knowledge = (self.knowledge * 3 + transition.reward + float(transition.next_observation.mean())) % 1000

    def begin(self, label: str | None, seed: int) -> None:
        super().begin(label, seed)
        self.chance = seed

    def save(self, path: Path) -> None:
        path.mkdir()
        (path / "knowledge.json").write_text(json.dumps(self.knowledge), encoding="utf-8")

    def load(self, path: Path) -> None:
        self.knowledge = json.loads((path / "knowledge.json").read_text(encoding="utf-8"))


#: Small and fast, with a limit of steps.
SMALL: dict[str, Any] = {"modalities": "rgb", "size": 8, "actions": "continuous"}


def small(max_steps: int = 40) -> Curriculum:
    """Blocks of all kinds: before deployment, a drift, evaluations."""

    def regime(variant: str, count: int, seed: int, **more: Any) -> dict[str, Any]:
        return {
            "task": "find_objects",
            "variant": variant,
            "count": count,
            "seed": seed,
            "max_steps": max_steps,
            **more,
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
    """A log's columns as text, which distinguishes numbers to the last bit, and NaN from missing values."""
    read = read_log(log).columns
    return {name: [repr(cell) for cell in read[name].tolist()] for name in columns or sorted(set(read) - {"timestamp"})}
