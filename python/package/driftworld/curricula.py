"""Curricula: learning and evaluation blocks of variants, to design, read, iterate and run.

A curriculum is a scenario, the document that ``driftworld curriculum`` writes and ``driftworld run`` runs.
"""

from __future__ import annotations

import inspect
import json
import numbers
import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import gymnasium

from driftworld import _native
from driftworld._files import read_text, write_whole
from driftworld._html import table
from driftworld._literals import (
    BlockKind,
    ComparedBy,
    DesignOrder,
    Evaluate,
    Form,
    ImageKind,
    OrderMethod,
    Phase,
    Probe,
    TaskLabel,
    WorldSplit,
)
from driftworld.lifetimes import Agent, Lifetime, Rollout, Summary, environment, noted
from driftworld.specs import variants
from driftworld.vector_lifetimes import VectorAgent, VectorRollout

if TYPE_CHECKING:
    from typing_extensions import Self

PathLike = str | os.PathLike[str]


@dataclass(frozen=True)
class Experience:
    """One episode of a lifetime.

    Attributes:
        number: Its number over the whole lifetime, from 0.
        block: Its block, from 0.
        regime: Its regime in the block, from 0.
        learning: Whether the agent may learn from it.
        variant: The variant's name: ``task#variant``; in a drift, the names of both ends.
        seed: The seed of its world; ``None`` for a world from a file.
        index: The number of its world under the seed.
        progress: Progress of the drift, in 0..=1; 0 without a drift.
        chance: The seed for the agent's own random numbers.
        steps: Decisions after which no more experiences of its regime begin, if it has such a budget.
        label: The task label if the scenario gives one: ``number``, ``of``, ``name``, and ``observed``, whether it is
            part of observations.
    """

    number: int
    block: int
    regime: int
    learning: bool
    variant: str
    seed: int | None
    index: int | None
    progress: float
    chance: int = field(repr=False)
    steps: int | None
    label: dict[str, Any] | None = field(repr=False)
    _plan: _native.Plan = field(repr=False, compare=False)

    @property
    def task(self) -> str:
        """The name of its task."""
        return self.variant.partition("#")[0]

    def world(self) -> dict[str, Any]:
        """Its world as it is run, with the scenario's step limit applied."""
        return _native.parsed(self._plan.world(self.number).text())


@dataclass(frozen=True)
class Block:
    """A learning or evaluation block: a sequence of experiences, with ``len(block)``, ``block[0]``, ``block[-2:]``.

    Attributes:
        number: Its number in the curriculum, from 0.
        kind: ``"learning"`` or ``"evaluation"``.
        phase: ``"deployment"`` or ``"pre_deployment"``.
        first: The number of its first experience.
        num_experiences: The number of its experiences.
    """

    number: int
    kind: BlockKind
    phase: Phase
    first: int
    num_experiences: int
    _plan: _native.Plan = field(repr=False, compare=False)

    def __len__(self) -> int:
        return self.num_experiences

    def __getitem__(self, place: Any) -> Any:
        if isinstance(place, slice):
            return [self[index] for index in range(*place.indices(len(self)))]
        if not -len(self) <= place < len(self):
            raise IndexError(f"block {self.number}: found experience {place}, expected one of {len(self)}")
        return _experience(self._plan, self.first + place % len(self))

    def __iter__(self) -> Iterator[Experience]:
        return (self[place] for place in range(len(self)))


def _experience(plan: _native.Plan, number: int) -> Experience:
    return Experience(**plan.experience_spec(number), _plan=plan)


class Curriculum(Sequence[Block]):
    """Learning and evaluation blocks of variants. A sequence of blocks.

    Made by :meth:`load`, :meth:`from_dict`, :meth:`design`, :meth:`experts` or :meth:`lifetimes`::

        curriculum = Curriculum.design("find_objects#blue", "find_objects#red", learn=20)
        for block in curriculum:
            for experience in block:
                print(block.kind, experience.variant, experience.seed, experience.index)
        curriculum.run(agent, log="logs/mine")

    Args:
        text: The scenario, as JSON text; Driftworld's or L2Explorer's.
        path: Its name in messages; tasks and worlds given by paths are searched for in its folder first.
        stand_in: Replace a missing world file by the one with the nearest name; by default in L2Explorer's scenarios
            only, like ``driftworld run``.

    Raises:
        SpecError: If the scenario is wrong, with pointer, line and column.
        CurriculumError: If something that it names cannot be loaded.
    """

    def __init__(self, text: str, path: PathLike = "scenario", *, stand_in: bool | None = None) -> None:
        # A world that cannot be drawn matters only when the scenario is run.
        plan = _native.Plan(Path(path), text, stand_in, True)
        for warning in plan.warnings:
            warnings.warn(warning, stacklevel=2)
        self._begin(plan)

    def _begin(self, plan: _native.Plan) -> None:
        self._plan = plan
        self.scenario: dict[str, Any] = self._plan.scenario()
        """The scenario as a dictionary."""
        self._blocks: list[Block] = []
        first = 0
        for number, block in enumerate(self.scenario["blocks"]):
            count = sum(regime["count"] for regime in block["regimes"])
            phase = block.get("phase", "deployment")
            self._blocks.append(Block(number, block["type"], phase, first, count, self._plan))
            first += count

    @classmethod
    def _of(cls, plan: _native.Plan) -> Self:
        curriculum = cls.__new__(cls)
        curriculum._begin(plan)
        return curriculum

    @classmethod
    def load(cls, path: PathLike, *, stand_in: bool | None = None) -> Curriculum:
        """Reads a scenario file.

        Raises:
            FileNotFoundError: If there is no such file.
            SpecError, CurriculumError: Like the class.
        """
        return cls(read_text(path), path, stand_in=stand_in)

    @classmethod
    def from_dict(cls, scenario: Mapping[str, Any], *, folder: PathLike = ".") -> Curriculum:
        """Takes a scenario from a dictionary; relative paths in it are searched for in ``folder``.

        Raises:
            SpecError, CurriculumError: Like the class.
        """
        return cls(json.dumps(scenario), Path(folder) / "scenario")

    @classmethod
    def design(
        cls,
        *tasks: str,
        name: str | None = None,
        learn: int | None = None,
        eval_episodes: int | None = None,
        evaluate: Evaluate | None = None,
        evaluate_after: Sequence[int] | None = None,
        pre_deployment: int | None = None,
        form: Form | None = None,
        blocks: int | None = None,
        method: OrderMethod | None = None,
        start: str | None = None,
        end: str | None = None,
        target_step: float | None = None,
        order: DesignOrder | None = None,
        by: ComparedBy | None = None,
        probe: Probe | None = None,
        modalities: Sequence[ImageKind] | None = None,
        variants: int | None = None,
        step_distance: float | None = None,
        tolerance: float | None = None,
        steps: int | None = None,
        drift: str | None = None,
        mix: bool | Literal["task"] = False,
        task_label: TaskLabel | None = None,
        seed: int | None = None,
        split: WorldSplit | None = None,
        paired_learning: bool = False,
        hold_out: Sequence[str] | None = None,
        worlds: int | None = None,
        assets: PathLike | None = None,
        controls: PathLike | None = None,
        plot: PathLike | None = None,
    ) -> Curriculum:
        """Designs blocks from variants and their distances, as ``driftworld curriculum`` does.

        Args:
            tasks: Variants, or tasks, which stand for all their variants.
            name: The scenario's name; ``"curriculum"`` by default.
            learn: Experiences of each learning block; 2,500 by default.
            eval_episodes: Experiences of each variant in each evaluation block; 50 by default.
            evaluate: When the agent is evaluated, frozen, in all variants: ``"every"`` block (default) or at the
                ``"ends"``.
            evaluate_after: Evaluate after these numbers of learning blocks instead; 0 is before the first.
            pre_deployment: Experiences of the first variant in a block before deployment.
            form: ``"condensed"``, ``"dispersed"``, ``"permuted"``, ``"alternating"``, ``"joint"`` or ``"custom"``.
            blocks: Number of learning blocks; by default the form's own.
            method: The method of the order, as for :func:`driftworld.order`.
            start: The variant that comes first; by default the one that is named first.
            end: The variant that comes last.
            target_step: The step of the method ``target-step``.
            order: The order from ``start`` on: ``"gradual"``, ``"outward"``, ``"abrupt"``, ``"path"``, ``"farthest"``,
                or ``"named"``, as given.
            by: The basis of comparison, as for :func:`driftworld.distance`; not with ``probe`` or ``step_distance``.
            probe: Take variants that differ from the start in this element alone: ``"state"``, ``"action"``,
                ``"transition"``, ``"reward"`` or ``"observation"``.
            modalities: The images that the probed learner sees; by default those that the task's worlds ask for.
            variants: Number of variants in the probe.
            step_distance: Make a sequence of variants, each at this distance from the one before.
            tolerance: Accepted deviation of each step.
            steps: Number of steps.
            drift: Learning blocks drift from each variant to the next: ``"linear"``, ``"cosine"``, ``"step:N"`` or
                ``"sawtooth:N"``.
            mix: Values that cannot be interpolated switch at random; with ``"task"`` each experience uses one of the
                two variants, which may belong to different tasks.
            task_label: Whether the learner gets a task label: ``"none"`` (default), ``"info"`` or ``"observation"``.
            seed: The seed of all worlds.
            split: The evaluation worlds: ``"validation"`` to choose hyperparameters, ``"test"`` (default) for reported
                results. The two share no world.
            paired_learning: Learn the variants of a task in the same layouts, experience by experience. Otherwise no
                two share a layout.
            hold_out: Variants, or tasks, that are evaluated but never learned.
            worlds: Number of worlds of each regime to draw first, refusing a design that could not run; 5 by default, 0
                for none.
            assets: An asset library with classes that the tasks use.
            controls: A folder to write the controls into: the same variants in reversed, random and contrasting order.
            plot: A PNG file to draw the blocks into.

        Raises:
            SpecError, TaskError: If a task is wrong or missing.
            CurriculumError: If the design is impossible.
            TypeError: For a value that is not a number.
        """
        options = dict(locals())
        del options["cls"]
        return cls(_designed(options)[0], "scenario")

    @classmethod
    def experts(cls, *tasks: str, **options: Any) -> list[Curriculum]:
        """Single-task experts to compare with: one curriculum for every learned variant of the lifetime. Each learns
        its variant alone, for as long as the lifetime does, in the same worlds and after the same experiences before
        deployment.

        Args:
            tasks: As for :meth:`design`.
            options: Those of the lifetime, as for :meth:`design`, which also lists the errors; and ``lifetime``, its
                number among :meth:`lifetimes`, from 0.

        Raises:
            TypeError: For an unknown option.
        """
        return cls._several("experts", options, {"tasks": tasks, "experts": True}, ("lifetime", "fixed_evaluation"))

    @classmethod
    def lifetimes(cls, count: int, *tasks: str, **options: Any) -> list[Curriculum]:
        """Designs ``count`` lifetimes, each with its own worlds and, in the permuted form, the default, with its own
        order.

        The orders are the rows of a balanced Latin square: each variant comes equally often in each position and after
        every other variant. If an order, blocks or a drift is given, all share one order.

        Args:
            count: Number of lifetimes, 1 to 10,000.
            tasks: As for :meth:`design`.
            options: As for :meth:`design`, which also lists the errors; and ``fixed_evaluation``: all are evaluated in
                the same worlds.

        Raises:
            TypeError: For an unknown option.
        """
        return cls._several("lifetimes", options, {"tasks": tasks, "lifetimes": count}, ("fixed_evaluation",))

    @classmethod
    def _several(
        cls, maker: str, options: dict[str, Any], fixed: dict[str, Any], own: tuple[str, ...]
    ) -> list[Curriculum]:
        known = [name for name in inspect.signature(cls.design).parameters if name != "tasks"]
        known.extend(own)
        for name in options:
            if name not in known:
                raise TypeError(f"{maker}: found option {name!r}, expected one of {', '.join(known)}")
        return [cls(text, "scenario") for text in _designed({**options, **fixed})]

    @property
    def name(self) -> str:
        """The scenario's name."""
        name: str = self.scenario["name"]
        return name

    @property
    def blocks(self) -> list[Block]:
        """The blocks, in the order in which they are run."""
        return list(self._blocks)

    @property
    def num_experiences(self) -> int:
        """The number of experiences in the whole lifetime."""
        return len(self._plan)

    def experience(self, number: int) -> Experience:
        """An experience by its number over the whole lifetime.

        Raises:
            CurriculumError: If there is no such experience.
        """
        return _experience(self._plan, number)

    def to_dict(self) -> dict[str, Any]:
        """The scenario as a new dictionary."""
        return self._plan.scenario()

    def save(self, path: PathLike) -> None:
        """Writes the scenario file. Files that it names by paths are not copied."""
        write_whole(Path(path), self._plan.text().encode())

    def try_worlds(self, count: int = 5) -> list[dict[str, Any]]:
        """Draws ``count`` worlds of each regime, along its drift if it has one, and counts failures by reason.

        Every variant along a drift is checked, too. Regimes with the same worlds are tried once.

        Args:
            count: Number of worlds of each regime, spread evenly over its experiences.

        Returns:
            One dictionary for each regime: ``block``, ``variant``, ``seed`` and ``worlds``; how many failed because of
            a ``placement``, a ``requirement``, or for an ``other`` reason; and ``failed``, the first 100 of them:
            ``experience``, ``index``, ``progress``, ``code`` and ``reason``.
        """
        return self._plan.try_worlds(count)

    def environment(self, **options: Any) -> gymnasium.Env[Any, Any]:
        """The environment that :meth:`run` uses, for agents that need its spaces.

        Args:
            options: As for :class:`driftworld.DriftworldEnv`, without those that the curriculum sets itself.
        """
        return environment(self._plan, options)

    def run(
        self,
        agent: Agent,
        log: PathLike | None = None,
        *,
        resume: bool = True,
        skip_undrawable: bool = False,
        check_frozen: bool = True,
        seed: int = 0,
        paired_chance: bool = False,
        record: bool = False,
        watch: Callable[[Experience, float], Any] | None = None,
        **options: Any,
    ) -> Summary:
        """Runs an agent through the curriculum, and logs every experience as ``driftworld run`` does.

        After any interruption, the same call resumes at the first experience that is not in the log. An agent with
        ``save`` and ``load`` is saved after each learning block, into the folder ``LOG.agent`` beside the log, and
        loaded on resuming; experiences learned since then are run again, unlogged. Without these methods, pass an agent
        that has learned everything in the log.

        Args:
            agent: See :class:`driftworld.Agent`.
            log: The folder of the log; by default no log is written.
            resume: Resume the log in the folder, if there is one; otherwise the folder must be empty.
            skip_undrawable: Skip experiences whose worlds cannot be drawn: each gets a row without numbers in the log,
                and is counted in the summary. Otherwise the run stops there; the same call with this option resumes it.
            check_frozen: Repeat 4 randomly chosen evaluations of each block at its end, unlogged, and refuse an agent
                that behaves differently: evaluations change it, or it does not draw its random numbers from the seed of
                the experience.
            seed: Varies the agent's random numbers in each experience: a run with a different seed is a repeat in the
                same worlds. 0 is the curriculum's own run.
            paired_chance: Give ``begin`` the same seed in every evaluation of a world, so that an unchanged agent earns
                the same reward in it. An agent can recognise a world by that seed; by default every block uses a
                different one.
            record: Record the actions of each experience in an ``actions.jsonl`` beside its rows, for
                :func:`driftworld.replay` and ``driftworld replay``. A log started with this keeps recording when
                resumed.
            watch: Called with each experience and its reward as soon as it is logged, NaN for a skipped one; returning
                ``False`` ends the run there.
            options: Options of the environment, as for :class:`driftworld.DriftworldEnv`: ``modalities``, ``size``,
                ``actions`` and so on. A log can only be resumed with the same ones. Infos name neither variant nor
                world, and have no ``events``, unless ``info="full"`` asks for them.

        Raises:
            CurriculumError: If evaluations change the agent, an option overrides a difference between variants, the log
                belongs to another curriculum, agent or environment, or a world cannot be drawn.
            MetricsError: If the log cannot be read or written, or the folder contains something else.
            EnvError: If an action is invalid.
            TypeError: If the agent lacks a method.
            ValueError: If an option is wrong; no log is started.
        """
        if isinstance(getattr(agent, "num_envs", None), int):
            raise TypeError("agent: found a learner for several environments, expected one for a single environment; use run_vector(…, num_envs=…)")
        plan = self._own_plan(skip_undrawable, seed)

        def rollout(save: Callable[[int], None]) -> Rollout:
            env = environment(plan, options)
            return Rollout(agent, env, lambda number: _experience(plan, number), options, paired_chance, watch, save)

        made_with = {"environment": noted(options), **({"paired_chance": True} if paired_chance else {})}
        return Lifetime(plan, agent, log, resume, check_frozen, record).live(made_with, rollout)

    def run_vector(
        self,
        agent: VectorAgent,
        log: PathLike | None = None,
        *,
        num_envs: int,
        num_threads: int = 0,
        resume: bool = True,
        skip_undrawable: bool = False,
        check_frozen: bool = True,
        seed: int = 0,
        paired_chance: bool = False,
        record: bool = False,
        watch: Callable[[Experience, float], Any] | None = None,
        **options: Any,
    ) -> Summary:
        """Like :meth:`run`, with many experiences of a block at the same time.

        Each environment takes the block's next experience when its last one has ended; a block starts when the one
        before has finished. The log has the same columns and worlds, in the order of the curriculum. An agent that
        behaves in each environment as a single agent does in :meth:`run` earns the same rewards in evaluations; with
        one environment, in all experiences.

        Args:
            agent: See :class:`driftworld.VectorAgent`.
            log: The folder of the log; by default no log is written.
            num_envs: Number of environments, 1 to 65,536. A log can only be resumed with the same number.
            num_threads: Threads that step; 0 is one for each processor.
            resume: As for :meth:`run`. Experiences under way when a learning block was interrupted have been learned
                from and are not in the log: only an agent with ``save`` and ``load`` continues as if nothing had
                happened.
            skip_undrawable: As for :meth:`run`.
            check_frozen: As for :meth:`run`, but for the first 4 evaluations of each block, repeated in the same
                batches.
            seed: As for :meth:`run`.
            paired_chance: As for :meth:`run`.
            watch: As for :meth:`run`.
            options: As for :meth:`run`.

        Raises:
            CurriculumError, MetricsError, EnvError, TypeError, ValueError: As :meth:`run`.
        """
        plan = self._own_plan(skip_undrawable, seed)
        plan.set_lanes(int(num_envs))

        def rollout(save: Callable[[int], None]) -> Rollout:
            return VectorRollout(
                plan, agent, num_envs, num_threads, lambda number: _experience(plan, number), options, paired_chance, watch, save
            )

        made_with = {"environment": noted(options), "num_envs": int(num_envs)}
        made_with |= {"paired_chance": True} if paired_chance else {}
        return Lifetime(plan, agent, log, resume, check_frozen, record).live(made_with, rollout)

    def _own_plan(self, skip_undrawable: bool, seed: int) -> _native.Plan:
        """The plan of one run, with the run's settings. It uses the loaded tasks, even if their files have changed
        since.
        """
        plan = _native.Plan.from_values(self._plan.values(), skip_undrawable)
        plan.set_run_seed(seed)
        return plan

    def __len__(self) -> int:
        return len(self._blocks)

    def __getitem__(self, place: Any) -> Any:
        return self._blocks[place]

    def __iter__(self) -> Iterator[Block]:
        return iter(self._blocks)

    def __repr__(self) -> str:
        return f"<Curriculum {self.name!r} of {len(self)} blocks, {self.num_experiences} experiences>"

    def _repr_html_(self) -> str:
        def variants(block: Block) -> str:
            """The variants of its regimes, each from the regime's first experience."""
            names: dict[str, None] = {}
            place = 0
            for regime in self.scenario["blocks"][block.number]["regimes"]:
                if place < len(block):
                    names[block[place].variant] = None
                place += regime["count"]
            return ", ".join(names) if len(names) <= 3 else f"{len(names)} variants"

        rows = [(str(block.number), block.kind, variants(block), f"{len(block):,}") for block in self._blocks[:_SHOWN]]
        more = f"; the first {_SHOWN} are shown" if len(self) > _SHOWN else ""
        caption = f"{self.name}: {len(self)} blocks, {self.num_experiences:,} experiences{more}"
        return table(("block", "kind", "variants", "experiences"), rows, caption)

    def __eq__(self, other: object) -> bool:
        """Whether both would run the same: scenario, tasks and world files are equal."""
        if not isinstance(other, Curriculum):
            return NotImplemented
        return self._plan is other._plan or self._plan.values()[:3] == other._plan.values()[:3]

    def __hash__(self) -> int:
        return hash(self._plan.text())

    def __getstate__(self) -> dict[str, Any]:
        # Includes the tasks themselves: their files may be missing or different where it is unpickled.
        return {name: value for name, value in self.__dict__.items() if name not in ("scenario", "_blocks")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._begin(state["_plan"])


#: Maximum number of blocks that a notebook shows.
_SHOWN = 60

#: Options of a design that are whole numbers.
_WHOLE = ("learn", "eval_episodes", "pre_deployment", "blocks", "variants", "steps", "seed", "worlds", "lifetimes", "lifetime")


def _is_whole(value: Any) -> bool:
    return isinstance(value, numbers.Integral) and not isinstance(value, bool)


def _designed(options: dict[str, Any]) -> list[str]:
    """The texts of the designed scenarios. Controls are written into their folder."""
    tasks, plot = options["tasks"], options.pop("plot", None)
    if not tasks:
        raise ValueError('tasks: found none, expected at least one, such as "find_objects#red"')
    if not all(isinstance(task, str) for task in tasks):
        raise TypeError('tasks: found objects, expected names such as "find_objects#red": a scenario refers to tasks by name')
    # Checks the tasks first, so that their errors are raised with their position.
    variants(*tasks)
    for name in _WHOLE:
        if options.get(name) is not None and not _is_whole(options[name]):
            raise TypeError(f"{name}: found {options[name]!r}, expected a whole number")
    after = options.get("evaluate_after")
    if after is not None:
        if isinstance(after, str) or not isinstance(after, Iterable):
            raise TypeError(f"evaluate_after: found {after!r}, expected a list of whole numbers, such as [0, 2]")
        options["evaluate_after"] = list(after)
        wrong = [place for place in options["evaluate_after"] if not _is_whole(place)]
        if wrong:
            raise TypeError(f"evaluate_after: found {wrong[0]!r} in it, expected whole numbers")
    designed, controls = _native.design_curriculum({**options, "controls": options.get("controls") is not None}, plot)
    for name, text in controls:
        write_whole(Path(options["controls"]) / f"{name}.json", text.encode())
    return [text for _, text in designed]
