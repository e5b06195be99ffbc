"""Runs an agent through a curriculum in a single environment, and logs each experience.

The log has the columns of ``driftworld run``.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import math
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast, runtime_checkable

import gymnasium
import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld._files import write_whole
from driftworld._html import table
from driftworld._plain import plain
from driftworld.envs import DriftworldEnv
from driftworld.envs.options import EnvOptions, Options, coverings, widest_action
from driftworld.errors import CurriculumError
from driftworld.frozen import Frozenness

if TYPE_CHECKING:
    from driftworld.curricula import Experience


#: The file in the folder of an agent's saves that identifies their lifetime.
LIFETIME_FILE = "lifetime.json"


@dataclass(frozen=True, slots=True)
class Transition:
    """One step, as given to ``learn``.

    Attributes:
        observation: The observation before the step.
        action: The action.
        reward: Its reward.
        terminated: Whether an event ended the episode.
        truncated: Whether a step limit ended it.
        next_observation: The observation after the step.
        info: The info of the step.
    """

    observation: Any
    action: Any
    reward: float
    terminated: bool
    truncated: bool
    next_observation: Any
    info: dict[str, Any]


@runtime_checkable
class Agent(Protocol):
    """An agent that can run through a curriculum.

    Besides these three methods an agent may have

    - ``name``, its name in logs; by default the class's name;
    - ``begin(label, seed)``, called before each experience with the name of its variant if the scenario reveals it,
      else ``None``, and the seed of its random numbers: unless ``paired_chance`` is used, it differs between blocks, so
      that it does not identify a world;
    - ``policy``, how it chooses its actions in evaluations, such as ``"sampled"`` or ``"greedy"``; it is recorded in
      the log;
    - ``made_with``, its settings as a dictionary, such as ``{"seed": 1, "learning_rate": 0.001}``; also recorded; a
      log is only resumed with the same ones;
    - ``save(path)`` and ``load(path)``: ``save`` is called after each learning block, with a path where nothing exists;
      ``load`` when a log is resumed, with the path of the last save.
    """

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Returns an action for an observation; ``info`` comes from the last reset or step.

        It has ``is_success``, ``ended_by``, and ``task_label`` if the scenario reveals it; with ``info="full"`` also
        the other entries and the world's origin.
        """

    def learn(self, transition: Transition) -> None:
        """Learns from a step; only called in learning blocks."""

    def freeze(self, frozen: bool) -> None:
        """Called before the first block, and before each block in which learning is switched on or off.

        A frozen agent must behave identically in the same world with the same seed: some evaluations of each block are
        repeated at its end, and a lifetime in which the agent behaves differently is refused. Keep running statistics,
        memories and random numbers of evaluations separate from those of learning, and draw the random numbers from the
        seed that ``begin`` gets.
        """


@dataclass(frozen=True)
class Summary:
    """The results of a lifetime.

    Attributes:
        experiences: Number of experiences run, including those of earlier runs.
        skipped: Number of experiences skipped because their worlds cannot be drawn.
        left_out: The first 100 skipped experiences: dictionaries with ``experience``, ``block``, ``variant``,
            ``progress`` and ``reason``.
        steps: Total steps of the experiences run.
        finished: Whether the whole curriculum was run.
        ended_by: Number of experiences by what ended them, in the log's words: ``touch``, ``zone``, ``steps``, …;
            ``unknown`` if the log does not have it.
        regimes: One dictionary for each regime started: ``block``, ``kind``, ``variant``, ``experiences``, ``skipped``,
            ``mean_reward`` and ``success_rate``.
        log: The folder of the log, if one was written.
        resumed: Number of experiences that were in the log before; if that is all of them, nothing was run.
    """

    experiences: int
    steps: int
    finished: bool
    regimes: list[dict[str, Any]]
    log: Path | None
    skipped: int = 0
    left_out: list[dict[str, Any]] = field(default_factory=list)
    ended_by: dict[str, int] = field(default_factory=dict)
    resumed: int = field(default=0, compare=False)

    def _repr_html_(self) -> str:
        head = ("variant", "block", "kind", "experiences", "mean reward", "success")
        rows = [
            (
                regime["variant"],
                str(regime["block"]),
                regime["kind"],
                str(regime["experiences"]),
                f"{regime['mean_reward']:.1f}",
                f"{regime['success_rate']:.0%}",
            )
            for regime in self.regimes
        ]
        return table(head, rows, f"{self.experiences} experiences, {self.steps} steps{self._from_before('; ')}")

    def __str__(self) -> str:
        rows = [("block", "kind", "variant", "experiences", "mean reward", "success")]
        for regime in self.regimes:
            numbers = (str(regime["experiences"]), f"{regime['mean_reward']:.1f}", f"{regime['success_rate']:.0%}")
            rows.append((str(regime["block"]), regime["kind"], regime["variant"], *numbers))
        widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        lines = [
            "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
        ]
        return "\n".join(lines) + self._from_before("\n")

    def _from_before(self, separator: str) -> str:
        """How much of it an earlier run had logged, in words after a separator; nothing for a new log."""
        if self.resumed == 0:
            return ""
        if self.resumed < self.experiences + self.skipped:
            return f"{separator}resumed {self.log} after {self.resumed} experiences"
        return f"{separator}nothing was run: {self.log} is already finished; for another lifetime, pass another folder"


class Lifetime:
    """A run of a curriculum.

    Args:
        plan: The plan of the curriculum.
        agent: The agent.
        log: The folder of the log; by default the log is discarded.
        resume: Resume the log in the folder if there is one.
        check_frozen: Repeat some evaluations of each block, and refuse an agent that behaves differently.
        record: Record each experience in addition to logging its row.
    """

    def __init__(
        self,
        plan: _native.Plan,
        agent: Any,
        log: str | PathLike[str] | None,
        resume: bool,
        check_frozen: bool,
        record: bool,
    ) -> None:
        missing = [name for name in ("act", "learn", "freeze") if not callable(getattr(agent, name, None))]
        if missing:
            found = f"{type(agent).__name__} without {', '.join(missing)}"
            raise TypeError(f"agent: found {found}, expected act, learn and freeze; see driftworld.Agent")
        self._plan, self._agent = plan, agent
        self._log = None if log is None else Path(log)
        self._resume, self._check_frozen, self._record = resume, check_frozen, record
        # Saves are kept beside the log, because a log contains only rows.
        self._saves = None if self._log is None else _beside(self._log)
        self._description = ""

    def live(self, made_with: Mapping[str, Any], rollout: Callable[[Callable[[int], None]], Rollout]) -> Summary:
        """Runs the curriculum from the first experience that is not in the log to the last.

        Args:
            made_with: Settings besides the plan that affect the lifetime, by name; a log can only be resumed with the
                same ones.
            rollout: Makes the :class:`Rollout`, given a function that saves the agent after a number of experiences.
        """
        with ExitStack() as stack:
            folder = self._log or Path(stack.enter_context(tempfile.TemporaryDirectory())) / "log"
            # Made first, so that no log is started if an option is wrong.
            running = rollout(self._save)
            stack.callback(running.close)
            policy = getattr(self._agent, "policy", None)
            settings = getattr(self._agent, "made_with", None)
            notes = {**made_with, **({} if policy is None else {"policy": str(policy)})}
            notes |= {} if settings is None else {"agent": noted(settings)}
            for what, print in notes.items():
                self._plan.add_fingerprint(what, print)
            name = str(getattr(self._agent, "name", type(self._agent).__name__))
            journal = _native.Journal(folder, self._plan, name, self._resume, self._record)
            stack.callback(journal.close)
            if journal.records:
                running.record()
            done = len(journal)
            self._own_saves(done, {"scenario": self._plan.scenario(), "agent": name, **notes})
            try:
                result = journal.run(self._plan, running, self._load(done), self._check_frozen)
            except CurriculumError as error:
                # Otherwise the same call would resume after the refused block.
                if error.code == "curriculum/not-frozen":
                    journal.withdraw_block()
                raise
        return Summary(**result, log=self._log, resumed=done)

    def _own_saves(self, done: int, lifetime: dict[str, Any]) -> None:
        """Makes sure that the saves beside the log belong to this lifetime: those of a different one are removed."""
        if self._saves is None:
            return
        self._description = json.dumps(lifetime, sort_keys=True, indent=2)
        file = self._saves / LIFETIME_FILE
        if done > 0 and file.is_file() and file.read_text(encoding="utf-8") == self._description:
            return
        for path in [file, self._saves / "unfinished", *(path for _, path in self._saved())]:
            _remove(path)

    def _save(self, done: int) -> None:
        """Saves the agent after ``done`` experiences, then removes older saves."""
        if self._saves is None or not hasattr(self._agent, "save"):
            return
        self._saves.mkdir(parents=True, exist_ok=True)
        write_whole(self._saves / LIFETIME_FILE, self._description.encode())
        # Renamed when complete: a save named by a number is never partial.
        unfinished = self._saves / "unfinished"
        _remove(unfinished)
        self._agent.save(unfinished)
        if unfinished.exists():
            path = self._saves / f"{done:08d}"
            _remove(path)
            unfinished.rename(path)
        for number, path in self._saved():
            if number < done:
                _remove(path)

    def _saved(self) -> list[tuple[int, Path]]:
        """The agent's saves, each with its number of experiences, in order."""
        if self._saves is None or not self._saves.is_dir():
            return []
        paths = [path for path in self._saves.iterdir() if re.fullmatch(r"\d{8,}", path.name)]
        return sorted((int(path.name), path) for path in paths)

    def _load(self, done: int) -> int:
        """Loads an agent from its last save before the end of the log, if it supports that; returns the number of
        experiences it has learned from.

        Later experiences are learned again. An agent without ``load`` is assumed to have learned everything in the log.
        """
        if done == 0 or not hasattr(self._agent, "load"):
            return done
        for number, path in reversed([saved for saved in self._saved() if saved[0] <= done]):
            self._agent.load(path)
            return number
        return 0


class Rollout:
    """An agent in its environment; the native loop calls it for one experience after another.

    Args:
        agent: The agent.
        env: The environment.
        experience: Finds an experience by its number.
        options: Options of the environment.
        paired_chance: Use the same seed for every evaluation of a world in all blocks.
        watch: Called with each experience and its reward, as soon as it is logged; returning ``False`` ends the run.
        save: Saves the agent after a number of experiences.
    """

    #: Whether the first evaluations of a block are repeated, rather than a random sample drawn from seeds.
    repeats_first = False

    def __init__(
        self,
        agent: Any,
        env: Any,
        experience: Callable[[int], Experience],
        options: Mapping[str, Any],
        paired_chance: bool,
        watch: Callable[[Experience, float], Any] | None,
        save: Callable[[int], None],
    ) -> None:
        self._agent, self._env, self._experience, self._options = agent, env, experience, options
        self._paired_chance, self._watch, self.end_learning = paired_chance, watch, save
        self._frozen: bool | None = None
        self._frozenness = Frozenness()

    def close(self) -> None:
        """Closes the environment."""
        self._env.close()

    def _beginning(self, now: Experience) -> tuple[str | None, int]:
        """The arguments of ``begin`` for an experience: the name of its variant if the agent may know it, and a
        seed.
        """
        chance = now.chance
        if not (now.learning or self._paired_chance):
            # Differs between blocks, in which worlds recur; the same when the experience is repeated within its block.
            print = hashlib.sha256(f"{now.block} {chance}".encode()).digest()
            chance = int.from_bytes(print[:8], "big")
        return None if now.label is None else now.label["name"], chance

    def _seconds(self, steps: int, time: tuple[float, int, float]) -> float:
        """Duration of ``steps`` steps, from the time values passed to :meth:`experience`."""
        time_step, skip, max_seconds = time
        seconds_per_step = time_step * (self._options.get("frame_skip") or skip)
        # A time limit cuts the last step short; an option `max_steps` replaces it.
        limited = max_seconds > 0 and self._options.get("max_steps") is None
        return min(steps * seconds_per_step, max_seconds if limited else math.inf)

    def begin_block(self, learning: bool, repeated: Sequence[int]) -> None:
        """Called before the first experience of a block; ``repeated`` are run twice. An agent without labels must not
        see the border between two learning blocks.
        """
        self._frozenness.begin_block(repeated)
        if self._frozen is not (not learning):
            self._frozen = not learning
            self._agent.freeze(self._frozen)

    def experience(
        self, number: int, world: _native.Stream, time: tuple[float, int, float]
    ) -> tuple[float, bool, int, float, bool, str | None]:
        """Runs one experience in its world; returns its reward, success, steps, seconds, whether a limit truncated it,
        and what ended it.

        ``time`` is the world's time step in seconds, the number of time steps per action, and its time limit in seconds, 0
        for none.
        """
        now = self._experience(number)
        begin = getattr(self._agent, "begin", None)
        if begin is not None:
            begin(*self._beginning(now))
        observation, info = self._env.reset(options={"world": world, "label": now.label, "origin": origin(now)})
        earned, steps, terminated, truncated = 0.0, 0, False, False
        trace = self._frozenness.trace(now.number)
        while not (terminated or truncated):
            if trace is not None:
                trace.see(observation)
            action = self._agent.act(observation, info)
            if trace is not None:
                trace.do(action)
            following, reward, terminated, truncated, info = self._env.step(action)
            earned += float(reward)
            steps += 1
            if now.learning:
                self._agent.learn(
                    Transition(observation, action, float(reward), terminated, truncated, following, info)
                )
            observation = following
        self._frozenness.expect_same(now, trace)
        cut_off = truncated and not terminated
        ended_by = info.get("ended_by") or ("steps" if cut_off else None)
        return earned, bool(info["is_success"]), steps, self._seconds(steps, time), cut_off, ended_by

    def record(self) -> None:
        """Records each experience from now on."""
        self._env.unwrapped.record()

    def recording(self, number: int) -> _native.RecordingHandle:
        """The recording of the last experience."""
        handle: _native.RecordingHandle = self._env.unwrapped.recording()._handle
        return handle

    def logged(self, number: int, reward: float) -> bool:
        """Called after an experience is logged, with NaN for a skipped one; returns whether to continue."""
        return self._watch is None or self._watch(self._experience(number), reward) is not False


def environment(plan: _native.Plan, options: Mapping[str, Any]) -> gymnasium.Env[Any, Any]:
    """The environment for running a plan, starting in its first world."""
    refuse_options(options)
    refuse_covering(plan, options)
    world, options = first_world(plan, options)
    env = DriftworldEnv(world=world, **options)
    return Permitted(env, plan.experience_spec(0)["label"], options.get("info") == "full")


def refuse_options(options: Mapping[str, Any]) -> None:
    """Refuses environment options that the curriculum controls."""
    refused = [name for name in ("task", "world", "variant", "drift", "task_label") if name in options]
    if refused:
        raise TypeError(f"{refused[0]}: found it among the options, expected none: the curriculum sets it")
    if options.get("info") == "none":
        raise ValueError('info: found "none", expected "agent" or "full": a log records values from infos')


def refuse_covering(plan: _native.Plan, options: Mapping[str, Any]) -> None:
    """Refuses options that hide differences between a plan's variants: the lifetime would compare identical variants.

    Raises:
        CurriculumError: Names the options, the worlds' keys, and the variants.
    """
    read = Options.read(cast(EnvOptions, dict(options)))
    messages = coverings(plan.covered(read.overrides, read.images))
    if messages:
        raise CurriculumError("\n".join(messages.values()), code="curriculum/covered")


def first_world(plan: _native.Plan, options: Mapping[str, Any]) -> tuple[_native.Stream, dict[str, Any]]:
    """A world of a plan whose spaces fit all its other worlds, and options to go with it.

    Without the option ``modalities``, observations have all modalities that any world of the plan asks for; those that
    a world does not ask for are 0.
    """
    worlds = _some_worlds(plan)
    read = Options.read(cast(EnvOptions, dict(options)))
    layouts = [read.layouts(world)[0] for world in worlds]
    widest = widest_action(layouts)
    world = next(world for world, layout in zip(worlds, layouts, strict=True) if layout["action"] == widest)
    if read.modalities is not None:
        return world, dict(options)
    return world, {**options, "modalities": read.shown(layouts).modalities, "blank": True}


def _some_worlds(plan: _native.Plan) -> list[_native.Stream]:
    """Worlds of all regimes of a plan, from both ends of drifts, without those that cannot be drawn. If none can be
    drawn, the first world of the plan that can be.
    """
    found, refused = [], None
    for number in plan.ends_of_regimes():
        try:
            found.append(plan.world(number))
        except CurriculumError as error:
            if error.code != "curriculum/world":
                raise
            refused = error
    for number in range(0 if found else len(plan)):
        with contextlib.suppress(CurriculumError):
            return [plan.world(number)]
    if not found:
        raise refused or ValueError("curriculum: found no experience, expected at least one")
    return found


def origin(experience: Experience) -> dict[str, Any]:
    """The names of an experience's variant and world, for full infos."""
    return {
        "task_id": experience.task,
        "variant_id": experience.variant,
        "seed": experience.seed,
        "index": experience.index,
    }


#: Info entries that an agent in a curriculum always gets, whatever the scenario's task labels.
PERMITTED = ("is_success", "ended_by")


class Permitted(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment whose infos only contain what the scenario permits: no name of a variant or a world, and no
    events.

    If the scenario has labels, the number of the variant is ``info["task_label"]``, or one-hot ``"task"`` in dictionary
    observations.

    Args:
        env: The environment.
        label: The label of the first experience, or ``None`` without labels.
        full: Keep all entries of infos, and add the origin of the experience.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], label: Mapping[str, Any] | None, full: bool) -> None:
        super().__init__(env)
        self._label, self._full = label, full
        self._observed = is_observed(label, env.observation_space)
        if label is not None and isinstance(env.observation_space, gymnasium.spaces.Dict) and self._observed:
            box = gymnasium.spaces.Box(0.0, 1.0, (label["of"],), np.float32)
            self.observation_space = gymnasium.spaces.Dict({**env.observation_space.spaces, "task": box})

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode; ``options["label"]`` is its label, ``options["origin"]`` its names in full infos."""
        options = dict(options or {})
        self._label = options.pop("label", self._label)
        names = options.pop("origin", {})
        observation, info = self.env.reset(seed=seed, options=options)
        return self._permitted(observation, {**info, **names})

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Executes one action of the agent."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        observation, info = self._permitted(observation, info)
        return observation, reward, terminated, truncated, info

    def _permitted(self, observation: Any, info: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        if not self._full:
            info = {name: info[name] for name in PERMITTED if name in info}
        if self._label is None:
            return observation, info
        if self._observed:
            return {**observation, "task": one_hot(self._label)}, info
        return observation, {**info, "task_label": self._label["number"]}


def is_observed(label: Mapping[str, Any] | None, space: gymnasium.Space[Any]) -> bool:
    """Whether a label is part of observations; if they are a single image, it is in the infos."""
    return label is not None and bool(label["observed"]) and isinstance(space, gymnasium.spaces.Dict)


def one_hot(label: Mapping[str, Any]) -> NDArray[np.float32]:
    """A label in the form used in observations."""
    numbers = np.zeros(label["of"], dtype=np.float32)
    numbers[label["number"]] = 1.0
    return numbers


def _beside(log: Path) -> Path:
    """The folder beside a log where its agent is saved."""
    path = Path(os.path.abspath(log))
    if not path.name:
        raise ValueError(f"log: found {str(log)!r}, expected the path of a separate folder for the log")
    return path.with_name(f"{path.name}.agent")


def noted(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options in a canonical form for the log, without those set to ``None``."""
    values: dict[str, Any] = json.loads(json.dumps(options, default=_to_json, sort_keys=True))
    return {name: value for name, value in values.items() if value is not None}


def _to_json(value: Any) -> Any:
    try:
        return plain(value)
    except TypeError:
        # Not `repr`, which may contain an address that differs between processes.
        return list(value) if isinstance(value, Iterable) else type(value).__qualname__


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
