"""What all learners share: borders of tasks, random numbers of their own, saving, and what they report. Learning is ``ppo.py``."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from driftworld.learners.export import write_network
from driftworld.learners.networks import PatchNetwork


class Learner:
    """The part of a learner that does not depend on how it learns.

    Its life is cut into tasks where ``borders`` says so. A continual method overrides :meth:`begin_task`, :meth:`end_task` and
    :meth:`method_state`.

    Args:
        num_actions: Rows of the table of actions.
        num_envs: Environments that it acts in.
        seed: Of the weights, the actions and the minibatches, from 0.
        size: Side of the images in pixels, a multiple of 8.
        policy: Actions in evaluations: ``"sampled"`` from the policy, or ``"greedy"``, the likeliest. Learning samples.
        borders: Where a task ends: ``"none"``, nowhere; ``"labels"``, where the label of a learning experience changes, so that a
            block of mixed labels has many borders; ``"blocks"``, at each learning block after an evaluation, and after
            :meth:`load_state_dict`. ``None`` is the method's own.

    Attributes:
        network: Of ``torch``.
        decisions: Decisions learned from, over all environments.
        task_decisions: Those since the last border.
        updates: Steps of the optimiser.
        seconds: Processor seconds spent in acting while learning, in learning, and at borders.
        task: Label of the task that is learned, if it has one.
        tasks: Tasks begun. Without borders there is one.

    Raises:
        ValueError: If ``policy``, ``borders`` or ``size`` is none of those above.
    """

    name = "learner"
    #: What ``borders=None`` stands for.
    own_borders = "none"

    def __init__(
        self, num_actions: int, num_envs: int, *, seed: int = 0, size: int = 32, policy: str = "sampled", borders: str | None = None
    ) -> None:  # fmt: skip
        known = {"policy": ("sampled", "greedy"), "borders": ("none", "labels", "blocks")}
        self.num_actions, self.num_envs, self.seed, self.size = num_actions, num_envs, seed, size
        self.policy, self.borders = policy, borders or self.own_borders
        for option, values in known.items():
            if getattr(self, option) not in values:
                raise ValueError(f"{option}: found {getattr(self, option)!r}, expected one of {', '.join(values)}")
        self.network = self.fresh_network()
        self.shuffles = torch.Generator().manual_seed(seed)
        self.chances = [np.random.default_rng(seed) for _ in range(num_envs)]
        self.labels: list[str | None] = [None] * num_envs
        self.frozen, self._resumes = False, False
        self.task: str | None = None
        self.tasks = self.decisions = self.task_decisions = self.updates = 0
        self.seconds = 0.0

    def make_network(self) -> nn.Module:
        """A network; it is drawn from torch's global generator, which is seeded before and restored afterwards."""
        return PatchNetwork(self.num_actions, self.size)

    def fresh_network(self, *more: int) -> nn.Module:
        """A network as at the start of a life; numbers behind the seed draw another one."""
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(int(np.random.SeedSequence([self.seed, *more]).generate_state(1)[0]))
            return self.make_network()

    def begin_task(self, label: str | None) -> None:
        """Called before the first experience of each task, the first one included."""

    def end_task(self, label: str | None) -> None:
        """Called where a task ends, before :meth:`begin_task`, when everything in it has been learned from."""

    def method_state(self) -> dict[str, Any]:
        """What the method keeps, in tensors, numbers, texts, lists and dictionaries; saved, and counted as memory."""
        return {}

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Takes back what :meth:`method_state` gave."""

    def finish_rollout(self) -> None:
        """Learns from what has not been learned from."""

    def forget_rollout(self) -> None:
        """Forgets the steps that were learned from last."""

    def begin(self, env: int, label: str | None, seed: int) -> None:
        """Called before an experience: its actions are drawn from its own seed. A task may end, and another one begin.

        Raises:
            ValueError: If borders are where labels change, and there is none; or if there are more environments than ``num_envs``.
        """
        if env >= self.num_envs:
            raise ValueError(
                f"{self.name}: found environment number {env}, expected at most {self.num_envs - 1}; pass run_vector num_envs={self.num_envs}"
            )
        self.chances[env] = np.random.default_rng([seed, self.seed])
        self.labels[env] = label
        if self.frozen:
            return
        if self.borders == "labels" and label is None:
            raise ValueError(
                f"{self.name}: found an experience without a label, expected one that names its task; design the curriculum with "
                'task_label="info", or pass borders="blocks" or "none"'
            )
        resumes, self._resumes = self._resumes, False
        is_border = {"none": False, "labels": label != self.task, "blocks": resumes}[self.borders]
        if self.tasks and not is_border:
            return
        began = time.process_time()
        if self.tasks:
            self.finish_rollout()
            self.end_task(self.task)
            self.forget_rollout()
        self.task, self.tasks, self.task_decisions = label, self.tasks + 1, 0
        self.begin_task(label)
        self.seconds += time.process_time() - began

    def freeze(self, frozen: bool) -> None:
        """Whether it is being evaluated."""
        self._resumes = self._resumes or (self.frozen and not frozen)
        self.frozen = frozen

    def images(self, observations: Any) -> torch.Tensor:
        """Images ``(num_envs, size, size, 3)``, bytes, from observations that are images or have them as ``"rgb"``.

        Raises:
            ValueError: If they are of another shape.
        """
        found = observations["rgb"] if isinstance(observations, Mapping) else observations
        expected = (self.num_envs, self.size, self.size, 3)
        if found.shape != expected:
            raise ValueError(
                f'{self.name}: found observations {found.shape}, expected {expected}; run it with modalities="rgb", size={self.size} and '
                f"num_envs={self.num_envs}"
            )
        return torch.from_numpy(found)

    def state_dict(self) -> dict[str, Any]:
        """All that it is between two experiences: :meth:`load_state_dict` makes another one go on to the same bits."""
        counts = ("task", "tasks", "decisions", "task_decisions", "updates", "seconds")
        return {
            "network": self.network.state_dict(), "shuffles": self.shuffles.get_state(),
            "counts": {name: getattr(self, name) for name in counts}, "method": self.method_state(),
        }  # fmt: skip

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Becomes what :meth:`state_dict` gave. The learner must have been made with the same arguments."""
        self.network.load_state_dict(state["network"])
        self.shuffles.set_state(state["shuffles"])
        vars(self).update(state["counts"])
        # A run that goes on with a learning block says nothing of the evaluation before it.
        self._resumes = True
        self.load_method_state(state["method"])

    def save(self, path: Path) -> None:
        """Writes :meth:`state_dict` into a file."""
        torch.save(self.state_dict(), path)

    def load(self, path: Path) -> None:
        """Reads what :meth:`save` wrote: tensors and plain values, no code."""
        self.load_state_dict(torch.load(path, weights_only=True))

    def export(
        self, path: str | PathLike[str], *, actions: Sequence[Sequence[float]], frame_skip: int | None = None, interact: bool = True
    ) -> None:  # fmt: skip
        """Writes the network in the format safetensors, for ``--agent net:FILE`` of the command.

        Args:
            path: The file to write.
            actions: The table of actions that it was trained with.
            frame_skip: The time steps for which each was held; one step of the world if ``None``.
            interact: Whether it could interact.

        Raises:
            ValueError: If it acts by more than a :class:`PatchNetwork`, or the table has not ``num_actions`` rows of three numbers.
        """
        write_network(self, path, actions, frame_skip, interact)

    def digest(self) -> str:
        """SHA-256 of :meth:`state_dict` without the seconds: equal where two learners are equal to the bit."""
        state = self.state_dict()
        del state["counts"]["seconds"]
        print = hashlib.sha256()
        for name, value in leaves(state):
            print.update(f"{name}\n".encode())
            print.update(value.numpy().tobytes() if isinstance(value, torch.Tensor) else repr(value).encode())
        return print.hexdigest()

    def report(self) -> dict[str, Any]:
        """What a paper says of a learner.

        Returns:
            ``learner``, ``policy``, ``borders``, ``seed``, ``decisions``, ``updates``, ``tasks``; ``seconds`` of the processor;
            ``memory_bytes`` of all that it keeps; and ``method_bytes``, the part of the continual method.
        """
        kept = self.state_dict()
        return {
            "learner": self.name, "policy": self.policy, "borders": self.borders, "seed": self.seed, "decisions": self.decisions,
            "updates": self.updates, "tasks": self.tasks, "seconds": round(self.seconds, 3),
            "memory_bytes": memory(kept), "method_bytes": memory(kept["method"]),
        }  # fmt: skip


def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values within nested dictionaries and lists, each with its path."""
    if isinstance(value, (Mapping, list, tuple)):
        pairs = value.items() if isinstance(value, Mapping) else enumerate(value)
        for key, each in pairs:
            yield from leaves(each, f"{name}/{key}")
    else:
        yield name, value


def memory(value: Any) -> int:
    """Bytes of the tensors in it."""
    return sum(each.nbytes for _, each in leaves(value) if isinstance(each, torch.Tensor))
