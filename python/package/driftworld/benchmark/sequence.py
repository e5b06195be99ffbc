"""Sequences of tasks: their order, length, observations and actions. Each is a JSON file in ``sequences/``."""

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

#: Offset of world indices for a task that recurs: more than the number of worlds that a task is learned in.
_WORLDS_APART = 10**9


@dataclass(frozen=True)
class Sequence:
    """A sequence of tasks, with the settings that all learners of a table share.

    Attributes:
        name: The file's name without its extension.
        about: What it is for, in a sentence.
        tasks: Variants, in the order in which they are learned.
        decisions: Number of decisions to learn from in each task.
        evaluations: Number of worlds in which each task is evaluated after each task.
        num_envs: Number of environments used in parallel for learning.
        options: Options of the environments.
        scale: For each task the rewards that map to 0 and 1: those of a random agent that acts as rarely as the
            learners, and of the planner.
        learners: Arguments of learners that differ from the defaults, by learner name.
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
        """The sequence with this name, or from a file.

        Raises:
            ValueError: If it does not exist, or its file is wrong.
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
        """The names of the sequences that come with Driftworld."""
        return sorted(each.name.removesuffix(".json") for each in _FILES.iterdir() if each.name.endswith(".json"))

    def curriculum(self, seed: int, split: str = "test") -> Curriculum:
        """The lifetime for a seed, with its own worlds. ``split="validation"`` makes one for tuning, which shares no
        world with the others.
        """
        designed = Curriculum.design(
            *dict.fromkeys(self.tasks), name=f"{self.name}_{seed}", form="condensed", order="named", learn=self.decisions,
            eval_episodes=self.evaluations, task_label="info", seed=seed, split=split, worlds=0,  # type: ignore[arg-type]
        )  # fmt: skip
        evaluation, *blocks = designed.scenario["blocks"]
        regimes = {f"{regime['task']}#{regime['variant']}": regime for block in blocks[::2] for regime in block["regimes"]}
        lifetime = [evaluation]
        for place, task in enumerate(self.tasks):
            # A task that occurs again is learned in different worlds.
            again = self.tasks[:place].count(task) * _WORLDS_APART
            regime = {**regimes[task], "steps": self.decisions, "first_index": regimes[task]["first_index"] + again}
            lifetime += [{"type": "learning", "regimes": [regime]}, evaluation]
        return Curriculum.from_dict({**designed.scenario, "blocks": lifetime})

    @staticmethod
    def logged(task: str) -> str:
        """The name of a task in logs."""
        return task.replace("_", "").replace("#", "_")

    def scaled(self, task: str, reward: Any) -> Any:
        """Rewards of a task, scaled to 0 for the random agent and 1 for the planner."""
        low, high = self.scale[task]
        return (np.asarray(reward, dtype=float) - low) / (high - low)

    def prints(self, task: str) -> dict[str, str]:
        """Hashes of a task's first worlds and first 100 frames, as stored in :attr:`frozen`."""
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
        """Describes each task whose worlds or frames have changed since the sequence was frozen, one sentence each."""
        wrong = []
        for task, frozen in self.frozen.items():
            found = self.prints(task)
            for what, print in frozen.items():
                if found[what] != print:
                    wrong.append(f"{task}: found different {what}, expected those that the sequence {self.name} was frozen with")
        return wrong
