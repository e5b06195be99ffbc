"""A contract that every environment of ours has to keep, and a command that holds any task of a user's against it.

``python -m driftworld.check find_objects#red my_task.json my_world.json`` prints a table of what passed and what failed, with what to
do; :func:`check` is the same from a program. What is compared to the last bit is compared by ``_equality``; nothing is trained.

Exit status of the command: 0 when all passed, 1 when something failed, 2 for arguments that it does not understand.
"""

from __future__ import annotations

import argparse
import copy
import json
import pickle
import platform
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import driftworld
from driftworld._equality import first_difference

__all__ = ["Finding", "Report", "check", "main"]

#: Episodes are cut so short here that many ends and restarts fall into a check.
_SHORT_EPISODE = 9


class _Broken(Exception):
    """A rule is broken; the text says how."""


class _NotHere(Exception):
    """A rule cannot be looked at on this machine; the text says why."""


@dataclass(frozen=True)
class Finding:
    """What became of one rule.

    Attributes:
        rule: The rule in a few words.
        outcome: ``"passed"``, ``"failed"`` or ``"skipped"``.
        detail: What was found where it failed, or why it was skipped; empty where it passed.
        advice: What to do about a failure; empty otherwise.
    """

    rule: str
    outcome: str
    detail: str = ""
    advice: str = ""


@dataclass(frozen=True)
class Report:
    """What became of all rules for one task.

    Attributes:
        task: What was checked.
        findings: One for each rule, in the order in which they were looked at.
        versions: Of Python, Driftworld, Gymnasium and numpy.
    """

    task: str
    findings: tuple[Finding, ...]
    versions: dict[str, str] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether nothing failed."""
        return all(finding.outcome != "failed" for finding in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """The report as plain values, as ``--json`` prints it."""
        findings = [vars(finding) for finding in self.findings]
        return {"task": self.task, "ok": self.ok, "versions": self.versions, "findings": findings}

    def __str__(self) -> str:
        width = max(len(finding.rule) for finding in self.findings)
        lines = [self.task]
        for finding in self.findings:
            lines.append(f"  {finding.outcome:<7}  {finding.rule:<{width}}  {finding.detail}".rstrip())
            if finding.advice:
                lines.append(f"           → {finding.advice}")
        count = sum(finding.outcome == "failed" for finding in self.findings)
        lines.append(f"  {'all rules are kept' if count == 0 else f'{count} of {len(self.findings)} rules are broken'}")
        return "\n".join(lines)


@dataclass(frozen=True)
class _Case:
    """A task with the options and the measure of a check."""

    env_id: str
    options: dict[str, Any]
    num_envs: int
    steps: int
    seed: int

    def single(self, **more: Any) -> gymnasium.Env[Any, Any]:
        return gymnasium.make(self.env_id, disable_env_checker=True, **{**self.options, **more})

    def bare(self, **more: Any) -> gymnasium.Env[Any, Any]:
        """Without Gymnasium's wrappers."""
        return self.single(**more).unwrapped

    def native(self, **more: Any) -> Any:
        options = {"max_episode_steps": _SHORT_EPISODE, **self.options, **more}
        return gymnasium.make_vec(
            self.env_id, num_envs=self.num_envs, vectorization_mode="vector_entry_point", **options
        )

    def gymnasiums(self, mode: str, **vector_kwargs: Any) -> Any:
        """The same environments in Gymnasium's own loop: ``"sync"``, or ``"async"`` with a process for each."""
        options = {"max_episode_steps": _SHORT_EPISODE, **self.options}
        return gymnasium.make_vec(
            self.env_id, num_envs=self.num_envs, vectorization_mode=mode, vector_kwargs=vector_kwargs, **options
        )

    def actions(self, space: gymnasium.Space[Any]) -> list[Any]:
        """The same random actions whoever asks."""
        space.seed(self.seed)
        return [space.sample() for _ in range(self.steps)]


def check(
    task: str,
    *,
    num_envs: int = 3,
    steps: int = 60,
    seed: int = 0,
    processes: bool = True,
    **options: Any,
) -> Report:
    """Holds a task against the contract.

    Args:
        task: A built-in task or a path, with ``#variant`` or without; the path of a world; or the id of an environment.
        num_envs: How many environments the vector ones have, from 1.
        steps: How many steps of random actions each comparison takes, from 1; episodes are cut to 9 steps, so that 60 hold many
            ends.
        seed: Of worlds and actions.
        processes: Whether to compare with ``AsyncVectorEnv`` as well, which starts a process for each environment.
        **options: Options of the environment, such as ``modalities="rgb"``.

    Returns:
        A :class:`Report`; a rule that is broken is a finding in it, never an exception.

    Raises:
        driftworld.DriftworldError: The task does not exist, or its spec is wrong: there is nothing to check then.
        ValueError: ``num_envs`` or ``steps`` is below 1.
    """
    if num_envs < 1 or steps < 1:
        raise ValueError(f"num_envs, steps: found {num_envs} and {steps}, expected at least 1 of each")
    env_id, more = _environment_of(task)
    case = _Case(env_id, {**more, **options}, num_envs, steps, seed)
    # Whatever cannot be made at all says so here, in its own words.
    case.single().close()
    rules = [rule for rule in _RULES if processes or rule.check is not _equal_in_processes]
    findings = tuple(rule.look(case) for rule in rules)
    return Report(task, findings, _versions())


def _environment_of(task: str) -> tuple[str, dict[str, Any]]:
    """The id and the options by which Gymnasium makes the environment of a task, a world, or an id."""
    if task.startswith("driftworld/"):
        return task, {}
    path = Path(task)
    if path.suffix == ".json" and path.is_file():
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            document = {}
        # A task spec declares parameters around a template; whatever is wrong with it, its own reader says.
        if isinstance(document, dict) and not {"template", "parameters", "variants"} & document.keys():
            return "driftworld/World-v0", {"world": task}
    return "driftworld/Task-v0", {"task": task}


def _versions() -> dict[str, str]:
    return {
        "python": platform.python_version(),
        "driftworld": driftworld.__version__,
        "gymnasium": gymnasium.__version__,
        "numpy": np.__version__,
    }


@dataclass(frozen=True)
class _Rule:
    text: str
    check: Callable[[_Case], None]
    advice: str

    def look(self, case: _Case) -> Finding:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                # Of libraries below us, about themselves.
                warnings.simplefilter("ignore", DeprecationWarning)
                warnings.simplefilter("ignore", ResourceWarning)
                self.check(case)
        except _NotHere as reason:
            return Finding(self.text, "skipped", str(reason))
        except Exception as error:  # noqa: BLE001 - a broken rule may show itself as any error at all
            kind = "" if isinstance(error, (_Broken, AssertionError)) else f"{type(error).__name__}: "
            return Finding(self.text, "failed", f"{kind}{error}", self.advice)
        return Finding(self.text, "passed")


def _expect_same(left: Any, right: Any, place: str) -> None:
    difference = first_difference(left, right, place)
    if difference is not None:
        raise _Broken(difference)


def _passes_gymnasiums_check(case: _Case) -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(case.bare(render_mode="rgb_array"))


def _passes_sb3s_check(case: _Case) -> None:
    try:
        from stable_baselines3.common.env_checker import check_env
    except ImportError:
        raise _NotHere('Stable-Baselines3 is not installed: pip install "driftworld[sb3]"') from None
    with closing(case.bare(render_mode="rgb_array")) as env:
        check_env(env)


def _same_seed_same_worlds(case: _Case) -> None:
    with closing(case.single()) as env, closing(case.single()) as again:
        for episode, seed in enumerate([case.seed, None, None, case.seed]):
            first, info = env.reset(seed=seed)
            second, info_again = again.reset(seed=seed)
            _expect_same(first, second, f"observation of reset {episode}")
            _expect_same(info, info_again, f"info of reset {episode}")
            expected = (case.seed, episode % 3)
            found = (info.get("seed"), info.get("index"))
            if found != expected:
                raise _Broken(f"reset {episode}: (seed, index) {found}, expected {expected}")


def _goes_on_from_its_state(case: _Case) -> None:
    with closing(case.bare()) as env, closing(case.bare()) as other:
        actions = case.actions(env.action_space)
        env.reset(seed=case.seed)
        for action in actions[: _SHORT_EPISODE // 2]:
            if any(env.step(action)[2:4]):
                return
        state = json.loads(json.dumps(env.state()))  # type: ignore[attr-defined]
        other.reset(options={"world": state})
        for number, action in enumerate(actions[_SHORT_EPISODE // 2 :]):
            left, right = env.step(action), other.step(action)
            _expect_same(left[:4], right[:4], f"step {number} after the state was taken")
            if left[2] or left[3]:
                return


def _can_be_sent(case: _Case) -> None:
    with closing(case.bare()) as env:
        env.reset(seed=case.seed)
        for name, copied in (("copy.deepcopy", copy.deepcopy(env)), ("pickle", pickle.loads(pickle.dumps(env)))):
            with closing(copied):
                _expect_same(env.observation_space, copied.observation_space, f"{name}: observation_space")
                _expect_same(env.action_space, copied.action_space, f"{name}: action_space")
                _expect_same(_walk(env, case), _walk(copied, case), name)


def _walk(env: gymnasium.Env[Any, Any], case: _Case) -> list[Any]:
    """An episode of random actions, all that came back."""
    told: list[Any] = [env.reset(seed=case.seed)]
    for action in case.actions(env.action_space)[:_SHORT_EPISODE]:
        told.append(copy.deepcopy(env.step(action)))
        if told[-1][2] or told[-1][3]:
            break
    return told


def _draws_pictures(case: _Case) -> None:
    with closing(case.bare(render_mode="rgb_array")) as env:
        env.reset(seed=case.seed)
        picture = env.render()
        if (
            not isinstance(picture, np.ndarray)
            or picture.dtype != np.uint8
            or picture.ndim != 3
            or picture.shape[2] != 3
        ):
            raise _Broken(f"render() returned {type(picture).__name__} {getattr(picture, 'shape', '')}")


def _closes_twice(case: _Case) -> None:
    env = case.single()
    env.reset(seed=case.seed)
    env.close()
    env.close()
    native = case.native()
    native.close()
    native.close()


def _alone_as_in_the_batch(case: _Case) -> None:
    with closing(case.native()) as batch:
        observations, _ = batch.reset(seed=case.seed)
        actions = case.actions(batch.action_space)
        first = [_row(observations, index) for index in range(case.num_envs)]
        rows = [_told(batch, action) for action in actions]
    for index in range(case.num_envs):
        with closing(case.single(max_episode_steps=case.options.get("max_episode_steps", _SHORT_EPISODE))) as env:
            _expect_same(env.reset(seed=case.seed + index)[0], first[index], f"environment {index}, reset")
            has_ended = False
            for number, (action, row) in enumerate(zip(actions, rows, strict=True)):
                alone = (env.reset()[0], 0.0, False, False) if has_ended else env.step(action[index])[:4]
                has_ended = alone[2] or alone[3]
                together = (_row(row[0], index), float(row[1][index]), bool(row[2][index]), bool(row[3][index]))
                _expect_same((alone[0], float(alone[1]), *alone[2:]), together, f"environment {index}, step {number}")


def _told(batch: Any, action: Any) -> Any:
    return copy.deepcopy(batch.step(action)[:4])


def _row(observations: Any, index: int) -> Any:
    if isinstance(observations, dict):
        return {name: np.array(array[index]) for name, array in observations.items()}
    return np.array(observations[index])


def _equal_in_a_loop(case: _Case) -> None:
    with closing(case.native()) as ours, closing(case.gymnasiums("sync")) as theirs:
        _expect_same_lives(case, ours, theirs)


def _equal_in_processes(case: _Case) -> None:
    # Spawned processes import everything anew, as on other platforms; ours have threads, which do not survive a fork.
    with closing(case.native()) as ours, closing(case.gymnasiums("async", context="spawn")) as theirs:
        _expect_same_lives(case, ours, theirs)


def _autoreset(mode: str) -> Callable[[_Case], None]:
    def rule(case: _Case) -> None:
        try:
            from gymnasium.vector import AutoresetMode
        except ImportError:
            raise _NotHere(f"Gymnasium {gymnasium.__version__} has one way of autoreset only") from None
        wanted = {"next_step": AutoresetMode.NEXT_STEP, "same_step": AutoresetMode.SAME_STEP}
        theirs_mode = wanted.get(mode, AutoresetMode.DISABLED)
        with (
            closing(case.native(autoreset_mode=mode)) as ours,
            closing(case.gymnasiums("sync", autoreset_mode=theirs_mode)) as theirs,
        ):
            if ours.metadata.get("autoreset_mode") is not theirs_mode:
                raise _Broken(
                    f"metadata['autoreset_mode'] is {ours.metadata.get('autoreset_mode')!r}, not {theirs_mode!r}"
                )
            _expect_same_lives(case, ours, theirs, resets_by_mask=mode == "disabled")

    return rule


def _expect_same_lives(case: _Case, ours: Any, theirs: Any, *, resets_by_mask: bool = False) -> None:
    """The same seeds and actions for both; everything that comes back must be equal."""
    _expect_same(ours.single_observation_space, theirs.single_observation_space, "single_observation_space")
    _expect_same(ours.single_action_space, theirs.single_action_space, "single_action_space")
    _expect_same(ours.reset(seed=case.seed), theirs.reset(seed=case.seed), "reset")
    num_ends = 0
    for number, action in enumerate(case.actions(theirs.action_space)):
        left, right = ours.step(action), theirs.step(action)
        for name, one, other in zip(_PARTS, left, right, strict=True):
            _expect_same(one, other, f"step {number}, {name}")
        ended = np.logical_or(left[2], left[3])
        num_ends += int(ended.sum())
        if resets_by_mask and ended.any():
            # Gymnasium's loop takes the mask out of the dictionary that it is given.
            one, other = (env.reset(options={"reset_mask": ended.copy()}) for env in (ours, theirs))
            _expect_same(one, other, f"reset by mask after step {number}")
    if num_ends == 0 and case.steps > 2 * _SHORT_EPISODE and "max_episode_steps" not in case.options:
        raise _Broken(f"no episode ended in {case.steps} steps, though each may have {_SHORT_EPISODE} at most")


_PARTS = ("observations", "rewards", "terminated", "truncated", "infos")

_RULES = (
    _Rule(
        "Gymnasium's check_env, without a warning",
        _passes_gymnasiums_check,
        "the message is Gymnasium's; an option of the environment is the likeliest cause",
    ),
    _Rule(
        "Stable-Baselines3's check_env, without a warning",
        _passes_sb3s_check,
        'it takes images of 36 x 36 or more and of uint8 only: modalities="rgb", or depth="uint8" and no class, no instance',
    ),
    _Rule(
        "same seed, same worlds, one after the other",
        _same_seed_same_worlds,
        "please report it with the task and the seed: worlds are a function of task, seed and index",
    ),
    _Rule(
        "goes on from state() to the last bit", _goes_on_from_its_state, "please report it with the task and the seed"
    ),
    _Rule("copies and pickles live the same life", _can_be_sent, "please report it with the options"),
    _Rule('render() draws with render_mode="rgb_array"', _draws_pictures, "please report it with the options"),
    _Rule("closes, and closes again", _closes_twice, "please report it with the options"),
    _Rule("alone as in the batch, bit for bit", _alone_as_in_the_batch, "please report it with the task and the seed"),
    _Rule("as SyncVectorEnv, bit for bit", _equal_in_a_loop, "please report it with the task and the seed"),
    _Rule("as AsyncVectorEnv, bit for bit", _equal_in_processes, "please report it with the task and the seed"),
    _Rule("autoreset in the next step, as Gymnasium's", _autoreset("next_step"), "please report it with the task"),
    _Rule(
        "autoreset in the same step, with the final observation",
        _autoreset("same_step"),
        "please report it with the task",
    ),
    _Rule("no autoreset, resets by mask", _autoreset("disabled"), "please report it with the task"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command; returns its exit status."""
    parser = argparse.ArgumentParser(prog="python -m driftworld.check", description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "tasks", nargs="+", metavar="TASK", help="a task, its path, with #variant or not; a world; an id"
    )
    parser.add_argument(
        "--num-envs", type=int, default=3, help="environments of the vector ones (default: %(default)s)"
    )
    parser.add_argument("--steps", type=int, default=60, help="steps of each comparison (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of worlds and actions (default: %(default)s)")
    parser.add_argument(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        type=_option,
        help="an option of the environment, its value as JSON or as a word; may be given several times",
    )
    parser.add_argument("--no-processes", action="store_true", help="leave the comparison with AsyncVectorEnv out")
    parser.add_argument("--json", action="store_true", help="print the reports as JSON")
    asked = parser.parse_args(arguments)
    if asked.num_envs < 1 or asked.steps < 1:
        parser.error("--num-envs and --steps: expected at least 1")
    reports: list[Report] = []
    for task in asked.tasks:
        reports.append(_checked(task, asked))
        if not asked.json:
            print(reports[-1], end="\n\n", flush=True)
    if asked.json:
        print(json.dumps([report.to_dict() for report in reports], indent=2))
    return 0 if all(report.ok for report in reports) else 1


def _option(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise argparse.ArgumentTypeError(f'found {text!r}, expected NAME=VALUE, such as size=64 or actions="discrete"')
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value


def _checked(task: str, asked: argparse.Namespace) -> Report:
    """The report on a task, also where there is nothing to check because it cannot be made."""
    try:
        return check(
            task,
            num_envs=asked.num_envs,
            steps=asked.steps,
            seed=asked.seed,
            processes=not asked.no_processes,
            **dict(asked.option),
        )
    except Exception as error:  # noqa: BLE001 - Gymnasium and numpy refuse things with classes of their own
        kind = "" if isinstance(error, driftworld.DriftworldError) else f"{type(error).__name__}: "
        advice = "python -m driftworld.check --help says what may be checked"
        return Report(task, (Finding("can be made", "failed", f"{kind}{error}", advice),), _versions())


if __name__ == "__main__":
    sys.exit(main())
