"""Living a curriculum: an agent in a single environment, experience after experience, each logged.

Which experiences there are is said by ``curricula.py``, what a log holds by the native journal: the columns of ``driftworld run``.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import gymnasium
import numpy as np

from driftworld import _native
from driftworld._files import write_whole
from driftworld._plain import plain
from driftworld.envs import DriftworldEnv
from driftworld.errors import CurriculumError

if TYPE_CHECKING:
    from driftworld.curricula import Experience


#: The file among an agent's saves that says which lifetime they are of.
WHOSE = "lifetime.json"


@dataclass(frozen=True, slots=True)
class Transition:
    """One step, as an agent learns from it.

    Attributes:
        observation: What it saw before.
        action: What it did.
        reward: What that paid.
        terminated: Whether what happened ended the episode.
        truncated: Whether a limit of steps did.
        next_observation: What it saw then.
        info: What the step said beside it.
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
    """Who lives a curriculum.

    Beside these three methods an agent may have

    - ``name``, what logs call it; its class's name if not;
    - ``begin(label, seed)``, called before each experience with the name of its variant where the scenario tells it, else
      ``None``, and the number that its chance should be drawn from: the same in every evaluation of a world, so that an agent that
      has not changed earns the same in it;
    - ``save(path)`` and ``load(path)``, called with a path that nothing is at, respectively with the last that was saved at: after
      each learning block, and when a log is taken up.
    """

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """An action for an observation; ``info`` is what the last reset or step said beside it."""

    def learn(self, transition: Transition) -> None:
        """Learns from a step; only called in learning blocks."""

    def freeze(self, frozen: bool) -> None:
        """Called before the first block, and before each block where it changes whether the agent may learn.

        A frozen agent earns the same in the same world, drawn by the same seed: the first evaluations of each block are run once more
        at its end, and a lifetime in which they pay something else is refused. Running statistics, memories and random numbers of
        evaluations are kept apart from those of learning; the latter are drawn from the seed that ``begin`` gets.
        """


@dataclass(frozen=True)
class Summary:
    """What a lifetime came to.

    Attributes:
        experiences: How many were lived, those of earlier runs included.
        skipped: How many were left out because their worlds cannot be drawn.
        left_out: The first 100 of those: dictionaries with ``experience``, ``block``, ``variant``, ``progress`` and ``reason``.
        steps: Steps in all that were lived.
        finished: Whether the whole curriculum was lived.
        regimes: One dictionary for each regime that was begun: ``block``, ``kind``, ``variant``, ``experiences``, ``skipped``,
            ``mean_reward`` and ``success_rate``.
        log: The folder of the log, if it was kept.
    """

    experiences: int
    steps: int
    finished: bool
    regimes: list[dict[str, Any]]
    log: Path | None
    skipped: int = 0
    left_out: list[dict[str, Any]] = field(default_factory=list)

    def __str__(self) -> str:
        rows = [("block", "kind", "variant", "experiences", "mean reward", "success")]
        for regime in self.regimes:
            numbers = (str(regime["experiences"]), f"{regime['mean_reward']:.1f}", f"{regime['success_rate']:.0%}")
            rows.append((str(regime["block"]), regime["kind"], regime["variant"], *numbers))
        widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        lines = [
            "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
        ]
        return "\n".join(lines)


class Lifetime:
    """A curriculum under way.

    Args:
        plan: What is lived.
        agent: Who lives it.
        options: Options of the environment.
        log: The folder to log into; without one the log is forgotten.
        resume: Go on with the log in the folder if there is one.
        watch: Told each experience and what it paid, as soon as it is logged; may say ``False`` to end there.
        check_frozen: Run the first evaluations of each block once more, and refuse an agent that earns something else in them.
    """

    def __init__(
        self,
        plan: _native.Plan,
        agent: Agent,
        options: Mapping[str, Any],
        log: str | PathLike[str] | None,
        resume: bool,
        watch: Callable[[Experience, float], Any] | None,
        check_frozen: bool,
    ) -> None:
        missing = [name for name in ("act", "learn", "freeze") if not callable(getattr(agent, name, None))]
        if missing:
            found = f"{type(agent).__name__} without {', '.join(missing)}"
            raise TypeError(f"agent: found {found}, expected act, learn and freeze; see driftworld.Agent")
        self._plan, self._agent, self._options, self._watch = plan, agent, dict(options), watch
        self._log = None if log is None else Path(log)
        self._resume, self._check_frozen = resume, check_frozen
        # What is saved lies beside the log: a log holds rows, nothing else.
        self._saves = None if self._log is None else _beside(self._log)
        self._whose = ""

    def live(self, experience: Callable[[int], Experience]) -> Summary:
        """Lives it from the first experience that is not in the log to the last; ``experience`` finds one by its number."""
        with ExitStack() as stack:
            folder = self._log or Path(stack.enter_context(tempfile.TemporaryDirectory())) / "log"
            # First: where an option is wrong no log is begun.
            env = environment(self._plan, self._options)
            stack.callback(env.close)
            made_with = _told(self._options)
            self._plan.add_fingerprint("environment", made_with)
            name = str(getattr(self._agent, "name", type(self._agent).__name__))
            journal = _native.Journal(folder, self._plan, name, self._resume)
            stack.callback(journal.close)
            done = len(journal)
            self._own_saves(done, {"scenario": self._plan.scenario(), "agent": name, "environment": made_with})
            rollout = Rollout(self._agent, env, experience, self._options, self._watch, self._save)
            said = journal.run(self._plan, rollout, self._load(done), self._check_frozen)
        return Summary(**said, log=self._log)

    def _own_saves(self, done: int, lifetime: dict[str, Any]) -> None:
        """Sees to it that what is saved beside the log is of this lifetime: what another one left there goes."""
        if self._saves is None:
            return
        self._whose = json.dumps(lifetime, sort_keys=True, indent=2)
        file = self._saves / WHOSE
        if done > 0 and file.is_file() and file.read_text(encoding="utf-8") == self._whose:
            return
        for place in [file, self._saves / "unfinished", *(place for _, place in self._saved())]:
            _remove(place)

    def _save(self, done: int) -> None:
        """Lets the agent save itself after so many experiences; then what was saved before goes."""
        if self._saves is None or not hasattr(self._agent, "save"):
            return
        self._saves.mkdir(parents=True, exist_ok=True)
        write_whole(self._saves / WHOSE, self._whose.encode())
        # Renamed when it is whole: what lies under a number was saved to the end.
        unfinished = self._saves / "unfinished"
        _remove(unfinished)
        self._agent.save(unfinished)
        if unfinished.exists():
            place = self._saves / f"{done:08d}"
            _remove(place)
            unfinished.rename(place)
        for number, place in self._saved():
            if number < done:
                _remove(place)

    def _saved(self) -> list[tuple[int, Path]]:
        """Where the agent was saved, and after how many experiences, in order."""
        if self._saves is None or not self._saves.is_dir():
            return []
        places = [place for place in self._saves.iterdir() if re.fullmatch(r"\d{8,}", place.name)]
        return sorted((int(place.name), place) for place in places)

    def _load(self, done: int) -> int:
        """Brings an agent that can be loaded to its last save before the end of the log; from how many experiences it has learned.

        What it learned after that it learns again. One that cannot be loaded has learned what is in the log.
        """
        if done == 0 or not hasattr(self._agent, "load"):
            return done
        for number, place in reversed([saved for saved in self._saved() if saved[0] <= done]):
            self._agent.load(place)
            return number
        return 0


class Rollout:
    """An agent in its environment, which the native loop asks for one experience after the other.

    Args:
        agent: Who acts.
        env: The environment.
        experience: Finds an experience by its number.
        options: Options of the environment.
        watch: Told each experience and what it paid, as soon as it is logged; may say ``False`` to end there.
        save: Saves the agent after so many experiences.
    """

    def __init__(
        self,
        agent: Agent,
        env: gymnasium.Env[Any, Any],
        experience: Callable[[int], Experience],
        options: Mapping[str, Any],
        watch: Callable[[Experience, float], Any] | None,
        save: Callable[[int], None],
    ) -> None:
        self._agent, self._env, self._experience, self._options = agent, env, experience, options
        self._watch, self.end_learning = watch, save
        self._frozen: bool | None = None

    def begin_block(self, learning: bool) -> None:
        """Before the first experience of a block. An agent without labels is not to see the border between two blocks of learning."""
        if self._frozen is not (not learning):
            self._frozen = not learning
            self._agent.freeze(self._frozen)

    def experience(
        self, number: int, world: _native.Stream, time: tuple[float, int, float]
    ) -> tuple[float, bool, int, float, bool]:
        """One experience in its world: reward, success, steps, seconds and whether a limit cut it off.

        ``time`` is the world's time step in seconds, for how many of these each action is held, and its limit of seconds, 0 for none.
        """
        now = self._experience(number)
        begin = getattr(self._agent, "begin", None)
        if begin is not None:
            begin(None if now.label is None else now.label["name"], now.chance)
        time_step, skip, max_seconds = time
        seconds_per_step = time_step * (self._options.get("frame_skip") or skip)
        # A limit of seconds cuts the last step short; one of steps stands in its place.
        limited = max_seconds > 0 and self._options.get("max_steps") is None
        most = max_seconds if limited else math.inf
        observation, info = self._env.reset(options={"world": world, "label": now.label})
        earned, steps, terminated, truncated = 0.0, 0, False, False
        while not (terminated or truncated):
            action = self._agent.act(observation, info)
            following, reward, terminated, truncated, info = self._env.step(action)
            earned += float(reward)
            steps += 1
            if now.learning:
                self._agent.learn(
                    Transition(observation, action, float(reward), terminated, truncated, following, info)
                )
            observation = following
        return earned, bool(info["is_success"]), steps, min(steps * seconds_per_step, most), truncated and not terminated

    def logged(self, number: int, reward: float) -> bool:
        """After an experience was logged, NaN for one that was left out; whether to go on."""
        return self._watch is None or self._watch(self._experience(number), reward) is not False


def environment(plan: _native.Plan, options: Mapping[str, Any]) -> gymnasium.Env[Any, Any]:
    """The environment that a plan is lived in, at its first world."""
    refused = [name for name in ("task", "world", "variant", "drift", "task_label") if name in options]
    if refused:
        raise TypeError(f"{refused[0]}: found it among the options, expected none: the curriculum says what is lived")
    env = DriftworldEnv(world=_first_world(plan), **options)
    return Labelled(env, plan.experience_spec(0)["label"])


def _first_world(plan: _native.Plan) -> _native.Stream:
    """The first world of a plan that can be drawn; the spaces of all others are the same."""
    for number in range(len(plan)):
        try:
            return plan.world(number)
        except CurriculumError as error:
            if error.code != "curriculum/world" or number + 1 == len(plan):
                raise
    raise ValueError("curriculum: found no experience, expected at least one")


class Labelled(gymnasium.Wrapper[Any, Any, Any, Any]):
    """An environment that tells the label of each experience, where the scenario wants it told.

    As the environments do with ``task_label``: the number of the variant as ``info["task_label"]``, or one-hot as ``"task"`` in
    observations.

    Args:
        env: The environment.
        label: The label of the first experience, or ``None`` where none are told.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], label: Mapping[str, Any] | None) -> None:
        super().__init__(env)
        self._label = label
        self._observed = label is not None and bool(label["observed"])
        if label is not None and self._observed:
            space = env.observation_space
            if not isinstance(space, gymnasium.spaces.Dict):
                raise ValueError(
                    "modalities: found a single image, expected a list: the scenario's task_label is a part of observations"
                )
            box = gymnasium.spaces.Box(0.0, 1.0, (label["of"],), np.float32)
            self.observation_space = gymnasium.spaces.Dict({**space.spaces, "task": box})

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode; ``options["label"]`` is its label."""
        options = dict(options or {})
        self._label = options.pop("label", self._label)
        observation, info = self.env.reset(seed=seed, options=options)
        return self._told(observation, info)

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Lets the agent act once."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        observation, info = self._told(observation, info)
        return observation, reward, terminated, truncated, info

    def _told(self, observation: Any, info: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        if self._label is None:
            return observation, info
        if self._observed:
            one_hot = np.zeros(self._label["of"], dtype=np.float32)
            one_hot[self._label["number"]] = 1.0
            return {**observation, "task": one_hot}, info
        return observation, {**info, "task_label": self._label["number"]}


def _beside(log: Path) -> Path:
    """The folder beside a log that its agent is saved into."""
    whole = Path(os.path.abspath(log))
    if not whole.name:
        raise ValueError(f"log: found {str(log)!r}, expected the path of a folder of its own")
    return whole.with_name(f"{whole.name}.agent")


def _told(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of an environment as they are written down: the same however they were written; left out where none is given."""
    told: dict[str, Any] = json.loads(json.dumps(options, default=_said, sort_keys=True))
    return {name: value for name, value in told.items() if value is not None}


def _said(value: Any) -> Any:
    try:
        return plain(value)
    except TypeError:
        # Never its address: it would be another in every process.
        return list(value) if isinstance(value, Iterable) else type(value).__qualname__


def _remove(place: Path) -> None:
    if place.is_dir():
        shutil.rmtree(place)
    else:
        place.unlink(missing_ok=True)
