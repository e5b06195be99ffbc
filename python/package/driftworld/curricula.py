"""Curricula: learning and evaluation blocks of variants, designed, read, iterated and lived.

A curriculum is a scenario, the document that ``driftworld curriculum`` writes and ``driftworld run`` lives. Living one is in
``lifetimes.py``, scoring what was lived in ``scores.py``.
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
        variant: What it is called: ``task#variant``, in a drift with both ends.
        seed: The seed of its world; ``None`` for a world from a file.
        index: The number of its world under the seed.
        progress: How far on its way a drift is, in 0..=1; 0 where nothing drifts.
        chance: The seed that the agent's own random numbers should be drawn from.
        steps: Decisions after which no more experiences of its regime begin, if it has such a budget.
        label: Where the scenario tells the task: ``number``, ``of``, ``name``, and ``observed``, whether in observations.
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
        return self.variant.rpartition("#")[0]

    def world(self) -> dict[str, Any]:
        """Its world, as it is run: with the scenario's limit of steps laid over it."""
        world: dict[str, Any] = _native.parsed(self._plan.world(self.number).text())
        return world


@dataclass(frozen=True)
class Block:
    """Experiences in which the agent learns, or does not. Iterating it gives them; ``len(block)``, ``block[0]``, ``block[-2:]``.

    Attributes:
        number: Its number in the curriculum, from 0.
        kind: ``"learning"`` or ``"evaluation"``.
        phase: ``"deployment"`` or ``"pre_deployment"``.
        first: The number of its first experience.
        num_experiences: How many it has.
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
        text: The scenario, as JSON text; ours, or one of L2Explorer's.
        path: What messages call it; tasks and worlds that it names by paths are looked for from its folder first.
        stand_in: Let the world file with the nearest name stand in for one that is nowhere; if not given, in L2Explorer's
            scenarios only, as ``driftworld run`` does.

    Raises:
        SpecError: If the scenario is wrong, with pointer, line and column.
        CurriculumError: If something that it names cannot be had.
    """

    def __init__(self, text: str, path: PathLike = "scenario", *, stand_in: bool | None = None) -> None:
        # A world that cannot be drawn matters to who lives it, not to who looks through the others.
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
            SpecError, CurriculumError: As the class.
        """
        return cls(read_text(path), path, stand_in=stand_in)

    @classmethod
    def from_dict(cls, scenario: Mapping[str, Any], *, folder: PathLike = ".") -> Curriculum:
        """Takes a scenario from a dictionary; what it names by paths is looked for in ``folder``.

        Raises:
            SpecError, CurriculumError: As the class.
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
            name: The scenario's name.
            learn: Experiences of each learning block; 2,500 if not given.
            eval_episodes: Experiences of each variant in each evaluation block; 50 if not given.
            evaluate: When the agent is evaluated, frozen, in all variants: ``"every"`` block (default) or at the ``"ends"``.
            evaluate_after: After so many learning blocks each instead; 0 is before the first.
            pre_deployment: Experiences of the first variant in a block before deployment.
            form: ``"condensed"``, ``"dispersed"``, ``"permuted"``, ``"alternating"``, ``"joint"`` or ``"custom"``.
            blocks: How many learning blocks; as many as the form has of itself if not given.
            method: The method of the order, as for :func:`driftworld.order`.
            start: The variant that comes first; if not given, the one that is named first.
            end: The variant that comes last.
            target_step: The step that the method ``target-step`` wants.
            order: From ``start`` on: ``"gradual"``, ``"outward"``, ``"abrupt"``, ``"path"``, ``"farthest"``, or as they are ``"named"``.
            by: What the variants are compared by, as for :func:`driftworld.distance`; not with ``probe`` or ``step_distance``.
            probe: Take variants that differ from the start in this element alone: ``"state"``, ``"action"``, ``"transition"``,
                ``"reward"`` or ``"observation"``.
            modalities: Which images the learner has that the probe is for; those that the task's worlds ask for if not given.
            variants: How many the probe takes.
            step_distance: Make a sequence of variants, each so far from the one before.
            tolerance: How far off each step may be.
            steps: How many steps.
            drift: Learning blocks drift from each variant to the next: ``"linear"``, ``"cosine"``, ``"step:N"`` or ``"sawtooth:N"``.
            mix: Values with nothing in between switch at random; with ``"task"`` each experience is of one of the two
                variants, which may be of two tasks.
            task_label: Whether the learner gets a task label: ``"none"`` (default), ``"info"`` or ``"observation"``.
            seed: What all worlds follow from.
            split: Which worlds it is evaluated in: ``"validation"`` to choose hyperparameters, ``"test"`` (default) for what
                is reported. The two share no world.
            paired_learning: The variants of a task are learned in the same layouts, one by one. If not, no two share one.
            hold_out: Variants, or tasks, that are evaluated and never learned.
            worlds: Draw so many worlds of each regime first, and refuse a design that could not run; 5 if not given, 0 for
                none.
            assets: An asset library whose classes the tasks use.
            controls: A folder to write the controls into: the same variants in reversed, random and contrasting order.
            plot: A PNG file to draw the blocks into.

        Raises:
            SpecError, TaskError: If a task is wrong or nowhere.
            CurriculumError: If the design cannot be.
            TypeError: For a number that is none.
        """
        options = dict(locals())
        del options["cls"]
        return cls(_designed(options)[0], "scenario")

    @classmethod
    def experts(cls, *tasks: str, **options: Any) -> list[Curriculum]:
        """Single-task experts to compare with: a curriculum for every variant that the lifetime learns, in which it alone is
        learned, as long as in the lifetime, in the same worlds and after the same experiences before deployment.

        Args:
            tasks: As for :meth:`design`.
            options: Those of the lifetime, as for :meth:`design`, which also says what is raised; and ``lifetime``, its number
                among :meth:`lifetimes`, from 0.

        Raises:
            TypeError: For an option that there is not.
        """
        return cls._several("experts", options, {"tasks": tasks, "experts": True}, ("lifetime", "fixed_evaluation"))

    @classmethod
    def lifetimes(cls, count: int, *tasks: str, **options: Any) -> list[Curriculum]:
        """So many lifetimes, each in worlds of its own and, in the permuted form, which is the default, in an order of its own.

        The orders are the rows of a balanced Latin square: each variant comes equally often in each place and after each other.
        With an order, blocks or a drift, all have that one.

        Args:
            count: How many, 1 to 10,000.
            tasks: As for :meth:`design`.
            options: As for :meth:`design`, which also says what is raised; and ``fixed_evaluation``: all are evaluated in the
                same worlds.

        Raises:
            TypeError: For an option that there is not.
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
        """How many experiences the whole lifetime has."""
        return len(self._plan)

    def experience(self, number: int) -> Experience:
        """An experience by its number over the whole lifetime.

        Raises:
            CurriculumError: If there is none.
        """
        return _experience(self._plan, number)

    def to_dict(self) -> dict[str, Any]:
        """The scenario as a dictionary of its own."""
        return self._plan.scenario()

    def save(self, path: PathLike) -> None:
        """Writes the scenario file. What it names by paths is not moved with it."""
        write_whole(Path(path), self._plan.text().encode())

    def try_worlds(self, count: int = 5) -> list[dict[str, Any]]:
        """Draws so many worlds of each regime, along its drift where it has one, and says how often that fails, and why.

        Every variant on the way of a drift is looked at, too. Regimes with the same worlds are tried once.

        Args:
            count: How many worlds of each regime, evenly over its experiences.

        Returns:
            One dictionary for each regime: ``block``, ``variant``, ``seed`` and ``worlds``; how many failed for want of a
            ``placement``, by a ``requirement``, or for an ``other`` reason; and ``failed``, the first 100 of them: ``experience``,
            ``index``, ``progress``, ``code`` and ``reason``.
        """
        return self._plan.try_worlds(count)

    def environment(self, **options: Any) -> gymnasium.Env[Any, Any]:
        """The environment that :meth:`run` uses, for agents that are made for its spaces.

        Args:
            options: As for :class:`driftworld.DriftworldEnv`, without what the curriculum says itself.
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

        Interrupted in whatever way, it goes on with the same call at the first experience that is not in the log. An agent that
        has ``save`` and ``load`` is saved after each learning block, into a folder beside the log, ``LOG.agent``, and loaded when the
        log is taken up; what it learned since then it runs through again, unlogged. Without them, hand over one that has learned
        what is in the log.

        Args:
            agent: See :class:`driftworld.Agent`.
            log: The folder of the log; without one nothing is kept.
            resume: Go on with the log in the folder, if there is one; else the folder must hold nothing.
            skip_undrawable: Leave out experiences whose worlds cannot be drawn: each has a row without numbers in the log, and is
                counted in the summary. If not, the run stops there; the same call with this goes on.
            check_frozen: Run 4 drawn evaluations of each block once more at its end, unlogged, and refuse an agent that does not
                do the same in them: evaluations change it, or its random numbers are not drawn from the seed of the experience.
            seed: What the agent begins experiences with follows from it, too: another seed is a repeat in the same worlds. 0 is the
                run that the curriculum has of itself.
            paired_chance: Give ``begin`` the same number in every evaluation of a world, so that an agent that has not changed
                earns the same in it. An agent can know a world by that number; by default it is another one in every block.
            record: Keep what is done in each experience, in an ``actions.jsonl`` beside its rows, so that :func:`driftworld.replay` and
                ``driftworld replay`` draw it once more. A log that was begun so goes on so.
            watch: Called with each experience and its reward as soon as it is logged, NaN for one that is left out; ``False`` from it ends
                the run there.
            options: Options of the environment, as for :class:`driftworld.DriftworldEnv`: ``modalities``, ``size``, ``actions`` and
                so on. A log is taken up only with the same ones. Infos name neither variant nor world, and have no ``events``,
                unless ``info="full"`` asks for them.

        Raises:
            CurriculumError: If evaluations change the agent, an option stands over what variants differ in, the log is of another
                curriculum, agent or environment, or a world cannot be drawn.
            MetricsError: If the log cannot be read or written, or the folder holds something else.
            EnvError: If an action is none.
            TypeError: If the agent lacks a method.
            ValueError: If an option is wrong; then no log is begun.
        """
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
        """Runs through the curriculum as :meth:`run` does, many experiences of a block at the same time.

        Each environment takes the block's next experience when its last one has ended; a block begins when all of the one before are
        over. The log has the same columns, in the order of the curriculum, and is of the same worlds. An agent that does in each
        environment what another one does in :meth:`run` earns the same in evaluations; with one environment, everywhere.

        Args:
            agent: See :class:`driftworld.VectorAgent`.
            log: The folder of the log; without one nothing is kept.
            num_envs: How many environments, 1 to 65,536. A log is taken up only with as many.
            num_threads: Threads that step; 0 is one for each processor.
            resume: As for :meth:`run`. What was under way when a learning block was interrupted has been learned from and is not
                in the log: only an agent with ``save`` and ``load`` goes on as if nothing had happened.
            skip_undrawable: As for :meth:`run`, like all that follows.
            check_frozen: As there, of the first 4 evaluations of each block: these share the same batches again.
            seed: As there.
            paired_chance: As there.
            watch: As there.
            options: As there.

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
        """A plan of one run: what that depends on is noted in it. Of the same tasks, whatever became of their files since."""
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
            """Those of its regimes: of the first experience of each."""
            names: dict[str, None] = {}
            place = 0
            for regime in self.scenario["blocks"][block.number]["regimes"]:
                if place < len(block):
                    names[block[place].variant] = None
                place += regime["count"]
            return ", ".join(names) if len(names) <= 3 else f"{len(names)} variants"

        rows = [(str(block.number), block.kind, variants(block), f"{len(block):,}") for block in self._blocks[:_SHOWN]]
        more = f"; the first {_SHOWN} are shown" if len(self) > _SHOWN else ""
        told = f"{self.name}: {len(self)} blocks, {self.num_experiences:,} experiences{more}"
        return table(("block", "kind", "variants", "experiences"), rows, told)

    def __eq__(self, other: object) -> bool:
        """Whether the same is lived: scenario, tasks and world files say the same."""
        if not isinstance(other, Curriculum):
            return NotImplemented
        return self._plan is other._plan or self._plan.values()[:3] == other._plan.values()[:3]

    def __hash__(self) -> int:
        return hash(self._plan.text())

    def __getstate__(self) -> dict[str, Any]:
        # With its tasks, and not only their names: files may not be where it is unpickled, or be others.
        return {name: value for name, value in self.__dict__.items() if name not in ("scenario", "_blocks")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._begin(state["_plan"])


#: Blocks that a notebook shows.
_SHOWN = 60

#: Options of a design that are whole numbers.
_WHOLE = ("learn", "eval_episodes", "pre_deployment", "blocks", "variants", "steps", "seed", "worlds", "lifetimes", "lifetime")


def _is_whole(value: Any) -> bool:
    return isinstance(value, numbers.Integral) and not isinstance(value, bool)


def _designed(options: dict[str, Any]) -> list[str]:
    """The texts of the scenarios that were designed. Controls are written into their folder."""
    tasks = options.pop("tasks")
    if not tasks:
        raise ValueError('tasks: found none, expected at least one, such as "find_objects#red"')
    if not all(isinstance(task, str) for task in tasks):
        raise TypeError('tasks: expected names such as "find_objects#red": a scenario calls tasks by their names')
    # First, so that what is wrong with a task is raised with its place.
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
    designed, controls = _native.design_curriculum(list(tasks), options)
    for name, text in controls:
        write_whole(Path(options["controls"]) / f"{name}.json", text.encode())
    return [text for _, text in designed]
