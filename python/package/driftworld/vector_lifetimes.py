"""Runs an agent through a curriculum in many environments at the same time, like ``lifetimes.py`` in one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld.envs import DriftworldVectorEnv
from driftworld.errors import CurriculumError
from driftworld.frozen import Trace
from driftworld.lifetimes import (
    Rollout,
    first_world,
    is_observed,
    one_hot,
    origin,
    refuse_covering,
    refuse_options,
)

if TYPE_CHECKING:
    from driftworld.curricula import Experience


@dataclass(frozen=True, slots=True)
class VectorTransition:
    """One step of all environments, as given to ``learn``.

    The agent may keep the arrays; their first axis is the environment.

    Attributes:
        observations: The observations before the step.
        actions: The actions.
        rewards: Their rewards, float64 ``(num_envs,)``.
        terminated: Whether an event ended the episode, bool ``(num_envs,)``.
        truncated: Whether a step limit ended it, bool ``(num_envs,)``.
        next_observations: The observations after the step; for an ended episode its last observation, never the first
            of the next.
        active: Which environments run an experience, bool ``(num_envs,)``; near the end of a block some have none.
            Ignore the values of the others.
        infos: The infos of the step.
    """

    observations: Any
    actions: Any
    rewards: NDArray[np.float64]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]
    next_observations: Any
    active: NDArray[np.bool_]
    infos: dict[str, Any]


@runtime_checkable
class VectorAgent(Protocol):
    """An agent that can run through a curriculum in many environments at once.

    See :meth:`driftworld.Curriculum.run_vector`.

    It may have ``name``, ``policy``, ``made_with``, ``save`` and ``load`` like :class:`driftworld.Agent`, and ``begin(env, label,
    seed)``, called before each experience with the number of its environment and the arguments of ``Agent.begin``.
    """

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        """Returns actions for all environments, ``(num_envs,)`` rows or ``(num_envs, numbers)``.

        ``infos`` has ``active`` and ``is_success``, bool ``(num_envs,)``, and the entries that the scenario permits, as
        in ``Agent.act``.
        """

    def learn(self, transition: VectorTransition) -> None:
        """Learns from a step of all environments; only called in learning blocks."""

    def freeze(self, frozen: bool) -> None:
        """Like :meth:`driftworld.Agent.freeze`. When evaluations are repeated, the same experiences share the same
        batches.
        """


class VectorRollout(Rollout):
    """An agent in its environments. The native loop asks for one experience after another, some of which have already
    run by then.

    Args:
        plan: The source of the worlds.
        agent: The agent.
        num_envs: Number of environments.
        num_threads: Threads that step them.
        experience: Finds an experience by its number.
        options: Options of the environments.
        paired_chance: Use the same seed for every evaluation of a world in all blocks.
        watch: Called with each experience and its reward, as soon as it is logged; returning ``False`` ends the run.
        save: Saves the agent after a number of experiences.
    """

    #: The first ones, so that repetitions run in the same batches: the last bits of outputs may depend on the batch.
    repeats_first = True

    def __init__(
        self,
        plan: _native.Plan,
        agent: VectorAgent,
        num_envs: int,
        num_threads: int,
        experience: Callable[[int], Experience],
        options: Mapping[str, Any],
        paired_chance: bool,
        watch: Callable[[Experience, float], Any] | None,
        save: Callable[[int], None],
    ) -> None:
        refuse_options(options)
        refuse_covering(plan, options)
        # Views: the agent's copy is made once, after all ended environments have been reset.
        world, options = first_world(plan, options)
        envs = DriftworldVectorEnv(
            world=world, num_envs=num_envs, num_threads=num_threads, copy=False, **options
        )
        super().__init__(agent, envs, experience, options, paired_chance, watch, save)
        rows, expected = getattr(envs.single_action_space, "n", None), getattr(agent, "num_actions", None)
        if isinstance(expected, int) and expected != rows:
            found = "no table" if rows is None else f"{rows} rows"
            raise ValueError(f"actions: found {found}, expected {expected} rows as in the agent's num_actions; pass actions=[[…], …]")
        self._plan, self._num_envs, self._full = plan, num_envs, options.get("info") == "full"
        label = plan.experience_spec(0)["label"]
        self._labelled, self._observed = label is not None, is_observed(label, envs.single_observation_space)
        self._labels: list[Mapping[str, Any] | None] = [label] * num_envs
        self._num_regimes = max(len(block["regimes"]) for block in plan.scenario()["blocks"])
        self._names: list[dict[str, Any]] = [{}] * num_envs
        self._has_begun = self._learning = self._records = False
        self._abandon()

    def record(self) -> None:
        """Records each experience from now on."""
        self._env.record()
        self._records = True

    def recording(self, number: int) -> _native.RecordingHandle:
        """The recording of a finished experience; available once."""
        return self._recordings.pop(number)

    def _abandon(self) -> None:
        """Discards the experiences under way."""
        self._next, self._block = 0, -1
        self._running: list[int | None] = [None] * self._num_envs
        self._regimes = np.zeros(self._num_envs, dtype=np.int64)
        self._decisions = np.zeros(self._num_regimes, dtype=np.int64)
        self._finished: dict[int, tuple[float, bool, int, bool, str | None]] = {}
        self._traces: dict[int, Trace | None] = {}
        self._recordings: dict[int, _native.RecordingHandle] = {}
        self._earned = np.zeros(self._num_envs)
        self._steps = np.zeros(self._num_envs, dtype=np.int64)
        self._observations: Any = None
        self._success = np.zeros(self._num_envs, dtype=np.bool_)
        self._events = np.empty(self._num_envs, dtype=object)
        self._events.fill(())

    def begin_block(self, learning: bool, repeated: Sequence[int]) -> None:
        """Called before the first experience of a block; ``repeated`` are run twice."""
        self._abandon()
        super().begin_block(learning, repeated)

    def experience(
        self, number: int, world: _native.Stream, time: tuple[float, int, float]
    ) -> tuple[float, bool, int, float, bool, str | None]:
        """Returns one experience, which may have run while earlier ones were requested; like
        :meth:`driftworld.lifetimes.Rollout.experience`.
        """
        now = self._experience(number)
        # An earlier experience that is neither under way nor finished is run again, with all later ones, so that
        # batches are the same as before.
        if now.block != self._block or (number < self._next and not (number in self._finished or number in self._running)):
            self._abandon()
            self._next, self._block, self._learning = number, now.block, now.learning
        while number not in self._finished:
            self._step()
        reward, success, steps, truncated, ended_by = self._finished.pop(number)
        self._frozenness.expect_same(now, self._traces.pop(number, None))
        return reward, success, steps, self._seconds(steps, time), truncated, ended_by

    def _step(self) -> None:
        """Steps all environments, after assigning the next experiences of the block to idle ones."""
        started = [self._begin(env) for env in range(self._num_envs) if self._running[env] is None]
        if any(started):
            self._observations = self._copied()
        active = np.array([number is not None for number in self._running])
        observations = self._observations
        traces = [(env, self._traces.get(number)) for env, number in enumerate(self._running) if number is not None]
        checked = [(env, trace) for env, trace in traces if trace is not None]
        for env, trace in checked:
            trace.see(row_of(observations, env))
        actions = self._agent.act(observations, self._permitted(active))
        for env, trace in checked:
            trace.do(np.asarray(actions)[env])
        self._seen, rewards, terminated, truncated, infos = self._env.step(actions)
        rewards, terminated, truncated = rewards * active, terminated & active, truncated & active
        self._success, self._events = infos["is_success"] & active, infos["events"]
        self._earned += rewards
        self._steps += active
        self._decisions += np.bincount(self._regimes[active], minlength=self._num_regimes)
        self._observations = self._copied()
        if self._learning:
            following = self._observations
            self._agent.learn(
                VectorTransition(
                    observations, actions, rewards, terminated, truncated, following, active, self._permitted(active)
                )
            )
        for env in np.flatnonzero(terminated | truncated).tolist():
            number = self._running[env]
            assert number is not None, "an environment that is active runs an experience"
            cut_off = bool(truncated[env] and not terminated[env])
            earned, success, steps = float(self._earned[env]), bool(self._success[env]), int(self._steps[env])
            ended_by = infos["ended_by"][env] or ("steps" if cut_off else None)
            self._finished[number] = (earned, success, steps, cut_off, ended_by)
            if self._records:
                self._recordings[number] = self._env.recording(env)._handle
            self._running[env] = None

    def _begin(self, env: int) -> bool:
        """Starts the block's next experience in an environment; returns whether there is one."""
        while self._next < len(self._plan):
            now = self._experience(self._next)
            if now.block != self._block:
                return False
            if now.steps is not None and self._decisions[now.regime] >= now.steps:
                # Skips experiences beyond the regime's budget, like the native loop.
                self._next = self._plan.after(self._next)
                continue
            self._next += 1
            try:
                world = self._plan.world(now.number)
            except CurriculumError as error:
                if error.code != "curriculum/world":
                    raise
                # The native loop skips or refuses it when its turn comes.
                continue
            begin = getattr(self._agent, "begin", None)
            if begin is not None:
                begin(env, *self._beginning(now))
            # Before the first step every environment needs a world.
            chosen = {"reset_mask": np.arange(self._num_envs) == env} if self._has_begun else {}
            self._seen, infos = self._env.reset(options={"world": world, **chosen})
            self._has_begun, self._success[env], self._events[env] = True, False, ()
            if self._full:
                self._names[env] = {**origin(now), "world_hash": infos["world_hash"][env]}
            self._labels[env] = now.label
            self._running[env], self._earned[env], self._steps[env] = now.number, 0.0, 0
            self._regimes[env] = now.regime
            self._traces[now.number] = self._frozenness.trace(now.number)
            return True
        return False

    def _copied(self) -> Any:
        """A copy of the current observations, with labels if observations contain them."""
        seen = self._seen
        if not isinstance(seen, Mapping):
            return seen.copy()
        copied = {kind: view.copy() for kind, view in seen.items()}
        if self._observed:
            copied["task"] = np.stack([one_hot(label) for label in self._labels if label is not None])
        return copied

    def _permitted(self, active: NDArray[np.bool_]) -> dict[str, Any]:
        """The infos given to the agent."""
        infos = {"active": active, "is_success": self._success.copy()}
        if self._labelled and not self._observed:
            infos["task_label"] = np.array([-1 if label is None else label["number"] for label in self._labels])
        if self._full:
            infos["events"] = self._events.copy()
            infos |= {
                name: np.array([names.get(name) for names in self._names], dtype=object)
                for name in ("task_id", "variant_id", "seed", "index", "world_hash")
            }
        return infos


def row_of(observations: Any, env: int) -> Any:
    """The observation of one environment."""
    if isinstance(observations, Mapping):
        return {kind: array[env] for kind, array in observations.items()}
    return observations[env]
