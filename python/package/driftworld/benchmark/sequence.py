"""Sequences of tasks: what is learned in which order, for how long, seen and acted how. Each is a JSON file of ``sequences/``."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from driftworld.curricula import Curriculum

_FILES = files("driftworld.benchmark") / "sequences"

#: More worlds than a task is learned in.
_WORLDS_APART = 10**9


@dataclass(frozen=True)
class Sequence:
    """What all learners of a table have in common.

    Attributes:
        name: Of the file, without its ending.
        about: What it is for, in a sentence.
        tasks: Variants, in the order in which they are learned.
        decisions: How many are learned from in each task.
        evaluations: Worlds of each task after each task.
        num_envs: Environments that learn at the same time.
        options: Of the environments.
        scale: For each task the rewards that count 0 and 1: a random agent's that acts as rarely as the learners do, and the planner's.
        learners: Arguments of learners, by name, where they are not the defaults.
        frozen: For each task a hash of its first worlds, and of its first frames.
    """

    name: str
    about: str
    tasks: list[str]
    decisions: int
    evaluations: int
    num_envs: int
    options: dict[str, Any]
    scale: dict[str, tuple[float, float]] = field(default_factory=dict)
    learners: dict[str, dict[str, Any]] = field(default_factory=dict)
    frozen: dict[str, dict[str, str]] = field(default_factory=dict)

    @classmethod
    def load(cls, name: str) -> Sequence:
        """The sequence of this name, or of a file.

        Raises:
            ValueError: If there is none, or its file is wrong.
        """
        own = _FILES / f"{name}.json"
        path = Path(name)
        if not own.is_file() and not path.is_file():
            raise ValueError(f"sequence: found {name!r}, expected a file or one of {', '.join(cls.names())}")
        text = (own if own.is_file() else path).read_text(encoding="utf-8")
        try:
            return cls(name=path.stem, **json.loads(text))
        except (TypeError, json.JSONDecodeError) as error:
            raise ValueError(f"{name}: {error}; expected the keys of driftworld.benchmark.Sequence") from error

    @staticmethod
    def names() -> list[str]:
        """Those that come with Driftworld."""
        return sorted(each.name.removesuffix(".json") for each in _FILES.iterdir() if each.name.endswith(".json"))

    def curriculum(self, seed: int, split: str = "test") -> Curriculum:
        """The lifetime of a seed: its worlds are its own. With ``split="validation"``, one to tune in, which shares no world with others."""
        designed = Curriculum.design(
            *dict.fromkeys(self.tasks), name=f"{self.name}_{seed}", form="condensed", order="named", learn=self.decisions,
            eval_episodes=self.evaluations, task_label="info", seed=seed, split=split, worlds=0,  # type: ignore[arg-type]
        )  # fmt: skip
        evaluation, *blocks = designed.scenario["blocks"]
        regimes = {f"{regime['task']}#{regime['variant']}": regime for block in blocks[::2] for regime in block["regimes"]}
        lifetime = [evaluation]
        for place, task in enumerate(self.tasks):
            # A task that comes again is learned in other worlds.
            again = self.tasks[:place].count(task) * _WORLDS_APART
            regime = {**regimes[task], "steps": self.decisions, "first_index": regimes[task]["first_index"] + again}
            lifetime += [{"type": "learning", "regimes": [regime]}, evaluation]
        return Curriculum.from_dict({**designed.scenario, "blocks": lifetime})

    @staticmethod
    def logged(task: str) -> str:
        """What logs call a task."""
        return task.replace("_", "").replace("#", "_")

    def scaled(self, task: str, reward: Any) -> Any:
        """Rewards of a task, 0 at the random agent's and 1 at the planner's."""
        low, high = self.scale[task]
        return (np.asarray(reward, dtype=float) - low) / (high - low)

    def prints(self, task: str) -> dict[str, str]:
        """A hash of the first worlds and the first 100 frames of a task: what :attr:`frozen` has."""
        env = gymnasium.make("driftworld/Task-v0", task=task, info="full", disable_env_checker=True, **self.options)
        env.action_space.seed(0)
        observation, info = env.reset(seed=0)
        worlds, frames = hashlib.sha256(info["world_hash"].encode()), hashlib.sha256()
        for _ in range(100):
            frames.update(np.ascontiguousarray(observation).tobytes())
            observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
            if terminated or truncated:
                observation, info = env.reset()
                worlds.update(info["world_hash"].encode())
        env.close()
        return {"worlds": worlds.hexdigest(), "frames": frames.hexdigest()}

    def check(self) -> list[str]:
        """Tasks whose worlds or frames are not what they were when the sequence was frozen, each in a sentence."""
        wrong = []
        for task, frozen in self.frozen.items():
            found = self.prints(task)
            for what, print in frozen.items():
                if found[what] != print:
                    wrong.append(f"{task}: found other {what} than those that the sequence {self.name} was frozen with")
        return wrong
