"""``Learner``, the common base of all learners: task borders, random numbers, saving and reports."""

from __future__ import annotations

import hashlib
import inspect
import re
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import nn

from driftworld._plain import described
from driftworld.learners.export import write_network
from driftworld.learners.networks import PatchNetwork

if TYPE_CHECKING:
    from typing_extensions import Self


class Learner:
    """The part of a learner that does not depend on the learning algorithm.

    ``borders`` determines where one task ends and the next begins. A continual method overrides :meth:`begin_task`,
    :meth:`end_task` and :meth:`method_state`.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        seed: The seed of weights, actions and minibatches, from 0.
        size: Side of the images in pixels, a multiple of 8.
        policy: Actions in evaluations: ``"sampled"`` from the policy, or ``"greedy"``, the likeliest. Learning samples.
        borders: Where a task ends: ``"none"``, nowhere; ``"labels"``, where the label of a learning experience changes,
            so that a block of mixed labels has many borders; ``"blocks"``, at each learning block after an evaluation,
            and after :meth:`load_state_dict`. ``None`` is the method's default.

    Attributes:
        network: The ``torch`` network.
        decisions: Decisions learned from, over all environments.
        task_decisions: Decisions since the last border.
        updates: Optimiser steps.
        seconds: Processor seconds spent in acting while learning, in learning, and at borders.
        task: Label of the current task, if it has one.
        tasks: Number of tasks started; 1 without borders.
        made_with: The constructor's arguments, and the numeric and string constants of a method's class, by name: a log
            can only be resumed with the same ones.

    Raises:
        ValueError: If ``policy``, ``borders`` or ``size`` is not one of those above; or if the method overrides
            :meth:`begin_task` or :meth:`end_task`, and there are no borders by default.
    """

    name = "learner"
    #: The meaning of ``borders=None``.
    own_borders = "none"
    made_with: dict[str, Any]

    def __init_subclass__(cls, **options: Any) -> None:
        """Names a method after its class, unless it has a name, and warns about methods named almost like hooks."""
        super().__init_subclass__(**options)
        inherited = [name for name in dir(cls.__mro__[1]) if name[0] != "_"]
        for name in [name for name, each in vars(cls).items() if callable(each) and name[0] != "_" and name not in inherited]:
            for similar in get_close_matches(name, inherited, 1, 0.85):
                warnings.warn(f"{cls.__name__}: found a method {name}, which the learner does not call; did you mean {similar}?", stacklevel=2)
        if "name" not in vars(cls):
            cls.name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()

    def __new__(cls, *arguments: Any, **options: Any) -> Self:
        """Makes it, and notes the arguments."""
        learner = super().__new__(cls)
        learner.made_with = _arguments(cls, arguments, options)
        return learner

    def __init__(
        self, num_actions: int, num_envs: int, *, seed: int = 0, size: int = 32, policy: str = "sampled", borders: str | None = None
    ) -> None:  # fmt: skip
        known = {"policy": ("sampled", "greedy"), "borders": ("none", "labels", "blocks")}
        self.num_actions, self.num_envs, self.seed, self.size = num_actions, num_envs, seed, size
        self.policy, self.borders = policy, borders or self.own_borders
        for option, values in known.items():
            if getattr(self, option) not in values:
                raise ValueError(f"{option}: found {getattr(self, option)!r}, expected one of {', '.join(values)}")
        unused = [hook for hook in ("begin_task", "end_task") if getattr(type(self), hook) is not getattr(Learner, hook)]
        if unused and borders is None and self.borders == "none":
            raise ValueError(
                f'{self.name}: found {unused[-1]} without borders, so that no task ever ends, expected own_borders = "labels" or "blocks" in '
                'the class, or borders="labels", "blocks" or "none" among the arguments'
            )
        self.network = self.fresh_network()
        self.shuffles = torch.Generator().manual_seed(seed)
        self.chances = [np.random.default_rng(seed) for _ in range(num_envs)]
        self.labels: list[str | None] = [None] * num_envs
        self.frozen, self._resumes = False, False
        self.task: str | None = None
        self.tasks = self.decisions = self.task_decisions = self.updates = 0
        self.seconds = 0.0

    def make_network(self) -> nn.Module:
        """Makes a network; it is drawn from torch's global generator, which is seeded before and restored
        afterwards.
        """
        return PatchNetwork(self.num_actions, self.size)

    def fresh_network(self, *more: int) -> nn.Module:
        """A network as at the start of a lifetime; further numbers extend the seed and draw a different one."""
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(int(np.random.SeedSequence([self.seed, *more]).generate_state(1)[0]))
            return self.make_network()

    def begin_task(self, label: str | None) -> None:
        """Called before the first experience of each task, including the first task."""

    def end_task(self, label: str | None) -> None:
        """Called at the end of a task, before :meth:`begin_task`, when everything in it has been learned from. Not called
        for the last task of a lifetime.
        """

    def method_state(self) -> dict[str, Any]:
        """The method's own state, in tensors, numbers, strings, lists and dictionaries; it is saved, and counted as
        memory.
        """
        return {}

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Restores the result of :meth:`method_state`."""

    def finish_rollout(self) -> None:
        """Learns from the steps that have not been learned from yet."""

    def forget_rollout(self) -> None:
        """Discards the steps that were learned from last."""

    def begin(self, env: int, label: str | None, seed: int) -> None:
        """Called before an experience, whose seed determines its actions. A task may end here, and another begin.

        Raises:
            ValueError: If ``borders`` is ``"labels"`` and the label is missing; or if there are more environments than
                ``num_envs``.
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
        """Sets whether the learner is being evaluated."""
        self._resumes = self._resumes or (self.frozen and not frozen)
        self.frozen = frozen

    def images(self, observations: Any) -> torch.Tensor:
        """Images ``(num_envs, size, size, 3)``, bytes, from image observations or from their entry ``"rgb"``.

        Raises:
            ValueError: If the images have a different shape.
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
        """The complete state between two experiences: a learner that loads it continues identically, bit for bit."""
        counts = ("task", "tasks", "decisions", "task_decisions", "updates", "seconds")
        return {
            "network": self.network.state_dict(), "shuffles": self.shuffles.get_state(),
            "counts": {name: getattr(self, name) for name in counts}, "method": self.method_state(),
        }  # fmt: skip

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Restores the result of :meth:`state_dict`. The learner must have been made with the same arguments."""
        self.network.load_state_dict(state["network"])
        self.shuffles.set_state(state["shuffles"])
        vars(self).update(state["counts"])
        # A run resumed within a learning block does not report the evaluation before it.
        self._resumes = True
        self.load_method_state(state["method"])

    def save(self, path: Path) -> None:
        """Writes :meth:`state_dict` to a file. Warns if the method keeps something that is not in it."""
        if unsaved := self._unsaved():
            warnings.warn(
                f"{self.name}: found {', '.join(unsaved)}, but no method_state: a resumed run would lose this state; return it from "
                "method_state, and restore it in load_method_state",
                stacklevel=2,
            )
        torch.save(self.state_dict(), path)

    def _unsaved(self) -> list[str]:
        """Attributes of a method without ``method_state`` that hold something other than an argument."""
        ours = [kind for kind in type(self).__mro__ if kind.__module__.startswith("driftworld.")]
        if any("method_state" in vars(kind) for kind in type(self).__mro__ if kind not in ours):
            return []
        functions = (getattr(each, "__wrapped__", each) for kind in ours for each in vars(kind).values())
        known = {name for each in functions if hasattr(each, "__code__") for name in each.__code__.co_names} | set(self.made_with)
        kept = (list, dict, set, np.ndarray, np.random.Generator, torch.Tensor, torch.Generator, torch.optim.Optimizer, nn.Module)
        return sorted(name for name, value in vars(self).items() if name not in known and isinstance(value, kept))

    def load(self, path: Path) -> None:
        """Loads a file written by :meth:`save`: tensors and plain values, no code."""
        self.load_state_dict(torch.load(path, weights_only=True))

    def export(
        self, path: str | PathLike[str], *, actions: Sequence[Sequence[float]], frame_skip: int | None = None, interact: bool = True
    ) -> None:  # fmt: skip
        """Writes the network in the safetensors format, for ``--agent net:FILE`` of the command.

        Args:
            path: The file to write.
            actions: The action table that it was trained with.
            frame_skip: Time steps for which each action was held; ``None`` for one step of the world.
            interact: Whether the agent could interact.

        Raises:
            ValueError: If the learner acts by more than a :class:`PatchNetwork`, or the table does not have
                ``num_actions`` rows of three numbers.
        """
        write_network(self, path, actions, frame_skip, interact)

    def digest(self) -> str:
        """SHA-256 of :meth:`state_dict` without the seconds: equal if two learners are bit-identical."""
        state = self.state_dict()
        del state["counts"]["seconds"]
        print = hashlib.sha256()
        for name, value in leaves(state):
            print.update(f"{name}\n".encode())
            print.update(value.numpy().tobytes() if isinstance(value, torch.Tensor) else repr(value).encode())
        return print.hexdigest()

    def report(self) -> dict[str, Any]:
        """The learner's details, for a paper.

        Returns:
            ``learner``, ``policy``, ``borders``, ``seed``, ``decisions``, ``updates``, ``tasks``; processor
            ``seconds``; ``memory_bytes`` of the whole state; and ``method_bytes``, the continual method's part of it.
        """
        kept = self.state_dict()
        return {
            "learner": self.name, "policy": self.policy, "borders": self.borders, "seed": self.seed, "decisions": self.decisions,
            "updates": self.updates, "tasks": self.tasks, "seconds": round(self.seconds, 3),
            "memory_bytes": memory(kept), "method_bytes": memory(kept["method"]),
        }  # fmt: skip


def _arguments(kind: type, arguments: tuple[Any, ...], options: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a learner, with the defaults of its class and of those that it passes ``**options`` on to."""
    own = [inspect.signature(vars(each)["__init__"]) for each in kind.__mro__ if "__init__" in vars(each) and each is not object]
    named = ([name for name, each in signature.parameters.items() if each.kind is each.POSITIONAL_OR_KEYWORD] for signature in own)
    names = next(names[1:] for names in named if len(names) > 1)
    given = {
        name: parameter.default
        for signature in reversed(own)
        for name, parameter in signature.parameters.items()
        if parameter.default is not parameter.empty
    }
    known = {name for signature in own for name, each in signature.parameters.items() if each.kind is not each.VAR_KEYWORD}
    # Other classes may take options of their own out of ``**options``.
    for name in options.keys() - known if kind.__module__.startswith("driftworld.") else ():
        similar = "".join(f"; did you mean {word}?" for word in get_close_matches(name, known, 1))
        raise TypeError(f"{kind.__name__}: found an option {name}, expected some of {', '.join(sorted(known - {'self'}))}{similar}")
    given |= {**dict(zip(names, arguments, strict=False)), **options}
    for each in reversed(kind.__mro__):
        # A method's own constants, such as a strength.
        if not each.__module__.startswith("driftworld."):
            given |= {name: value for name, value in vars(each).items() if name[0] != "_" and isinstance(value, (int, float, str))}
    return {name: described(value) for name, value in given.items() if value is not None}


def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values within nested dictionaries and lists, each with its path."""
    if isinstance(value, (Mapping, list, tuple)):
        pairs = value.items() if isinstance(value, Mapping) else enumerate(value)
        for key, each in pairs:
            yield from leaves(each, f"{name}/{key}")
    else:
        yield name, value


def memory(value: Any) -> int:
    """Size of the tensors in a value, in bytes."""
    return sum(each.nbytes for _, each in leaves(value) if isinstance(each, torch.Tensor))
