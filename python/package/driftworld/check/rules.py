"""The rules that environments must keep, each a function that raises if its rule is broken.

Values that must be equal are compared to the last bit, by ``_equality``.
"""

from __future__ import annotations

import copy
import json
import pickle
import warnings
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from driftworld._equality import first_difference
from driftworld.check.case import SHORT_EPISODE, Case
from driftworld.check.report import Finding
from driftworld.envs import spread_seeds


class Broken(Exception):
    """A rule is broken; the message describes how."""


class NotHere(Exception):
    """A rule cannot be checked on this machine; the message gives the reason."""


@dataclass(frozen=True)
class Rule:
    text: str
    check: Callable[[Case], None]
    advice: str

    def look(self, case: Case) -> Finding:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                # These warnings are raised by underlying libraries and concern only them.
                warnings.simplefilter("ignore", DeprecationWarning)
                warnings.simplefilter("ignore", ResourceWarning)
                self.check(case)
        except NotHere as reason:
            return Finding(self.text, "skipped", str(reason))
        except Exception as error:  # noqa: BLE001 - a broken rule may raise any error at all
            kind = "" if isinstance(error, (Broken, AssertionError)) else f"{type(error).__name__}: "
            return Finding(self.text, "failed", f"{kind}{error}", self.advice)
        return Finding(self.text, "passed")


def _expect_same(left: Any, right: Any, place: str) -> None:
    difference = first_difference(left, right, place)
    if difference is not None:
        raise Broken(difference)


def _passes_gymnasiums_check(case: Case) -> None:
    from gymnasium.utils.env_checker import check_env

    env = case.bare(render_mode="rgb_array")
    # `check_env` opens a window if "human" is among the render modes; a separate rule checks that.
    env.metadata = {**env.metadata, "render_modes": ["rgb_array"]}
    check_env(env)


def _opens_a_window(case: Case) -> None:
    try:
        import pygame
    except ImportError:
        raise NotHere('pygame is not installed: pip install "pygame>=2.1.3"') from None
    try:
        pygame.display.init()
    except pygame.error as error:
        raise NotHere(f"there is no display: {error}") from None
    with closing(case.bare(render_mode="human")) as env:
        env.metadata = {**env.metadata, "render_fps": 1000}
        env.reset(seed=case.seed)
        if env.render() is not None:
            raise Broken("render() returned a picture, expected None and a window that shows it")


def _passes_sb3s_check(case: Case) -> None:
    try:
        from stable_baselines3.common.env_checker import check_env
    except ImportError:
        raise NotHere('Stable-Baselines3 is not installed: pip install "stable-baselines3>=2.4"') from None
    with closing(case.bare(render_mode="rgb_array")) as env:
        check_env(env)


def _same_seed_same_worlds(case: Case) -> None:
    with closing(case.single()) as env, closing(case.single()) as other:
        for episode, seed in enumerate([case.seed, None, None, case.seed]):
            first, info = env.reset(seed=seed)
            second, other_info = other.reset(seed=seed)
            _expect_same(first, second, f"observation of reset {episode}")
            _expect_same(info, other_info, f"info of reset {episode}")
            expected = (case.seed, episode % 3)
            found = (info.get("seed"), info.get("index"))
            if found != expected:
                raise Broken(f"reset {episode}: (seed, index) {found}, expected {expected}")


def _continues_from_its_state(case: Case) -> None:
    with closing(case.bare()) as env, closing(case.bare()) as other:
        actions = case.actions(env.action_space)
        # Takes the state earlier if episodes end within a few steps; as a last resort, before the first step.
        for before in (SHORT_EPISODE // 2, 1, 0):
            env.reset(seed=case.seed)
            if not any(any(env.step(action)[2:4]) for action in actions[:before]):
                break
        state = json.loads(json.dumps(env.state()))  # type: ignore[attr-defined]
        other.reset(options={"world": state})
        for number, action in enumerate(actions[SHORT_EPISODE // 2 :]):
            left, right = env.step(action), other.step(action)
            _expect_same(left[:4], right[:4], f"step {number} after the state was taken")
            if left[2] or left[3]:
                return


def _can_be_copied(case: Case) -> None:
    with closing(case.bare()) as env:
        env.reset(seed=case.seed)
        for name, copied in (("copy.deepcopy", copy.deepcopy(env)), ("pickle", pickle.loads(pickle.dumps(env)))):
            with closing(copied):
                _expect_same(env.observation_space, copied.observation_space, f"{name}: observation_space")
                _expect_same(env.action_space, copied.action_space, f"{name}: action_space")
                _expect_same(_walk(env, case), _walk(copied, case), name)


def _walk(env: gymnasium.Env[Any, Any], case: Case) -> list[Any]:
    """Runs an episode of random actions; returns everything that the environment returned."""
    results: list[Any] = [env.reset(seed=case.seed)]
    for action in case.actions(env.action_space)[:SHORT_EPISODE]:
        results.append(copy.deepcopy(env.step(action)))
        if results[-1][2] or results[-1][3]:
            break
    return results


def _draws_pictures(case: Case) -> None:
    with closing(case.bare(render_mode="rgb_array")) as env:
        env.reset(seed=case.seed)
        picture = env.render()
        if (
            not isinstance(picture, np.ndarray)
            or picture.dtype != np.uint8
            or picture.ndim != 3
            or picture.shape[2] != 3
        ):
            raise Broken(f"render() returned {type(picture).__name__} {getattr(picture, 'shape', '')}")


def _closes_twice(case: Case) -> None:
    env = case.single()
    env.reset(seed=case.seed)
    env.close()
    env.close()
    native = case.native()
    native.close()
    native.close()


def _alone_as_in_the_batch(case: Case) -> None:
    with closing(case.native()) as batch:
        observations, _ = batch.reset(seed=case.seed)
        actions = case.actions(batch.action_space)
        first = [_row(observations, index) for index in range(case.num_envs)]
        rows = [_step_results(batch, action) for action in actions]
    for index, seed in enumerate(spread_seeds(case.seed, case.num_envs)):
        with closing(case.single(max_episode_steps=case.options.get("max_episode_steps", SHORT_EPISODE))) as env:
            _expect_same(env.reset(seed=seed)[0], first[index], f"environment {index}, reset")
            has_ended = False
            for number, (action, row) in enumerate(zip(actions, rows, strict=True)):
                alone = (env.reset()[0], 0.0, False, False) if has_ended else env.step(action[index])[:4]
                has_ended = alone[2] or alone[3]
                together = (_row(row[0], index), float(row[1][index]), bool(row[2][index]), bool(row[3][index]))
                _expect_same((alone[0], float(alone[1]), *alone[2:]), together, f"environment {index}, step {number}")


def _step_results(batch: Any, action: Any) -> Any:
    return copy.deepcopy(batch.step(action)[:4])


def _row(observations: Any, index: int) -> Any:
    if isinstance(observations, dict):
        return {name: np.array(array[index]) for name, array in observations.items()}
    return np.array(observations[index])


def _equal_in_a_loop(case: Case) -> None:
    with closing(case.native()) as ours, closing(case.gymnasiums("sync")) as theirs:
        _expect_same_results(case, ours, theirs)


def equal_in_processes(case: Case) -> None:
    # Spawned processes import everything again, as on other platforms; Driftworld's threads do not survive a fork.
    with closing(case.native()) as ours, closing(case.gymnasiums("async", context="spawn")) as theirs:
        _expect_same_results(case, ours, theirs)


def _autoreset(mode: str) -> Callable[[Case], None]:
    def rule(case: Case) -> None:
        try:
            from gymnasium.vector import AutoresetMode
        except ImportError:
            raise NotHere(f"Gymnasium {gymnasium.__version__} has only one autoreset mode") from None
        wanted = {"next_step": AutoresetMode.NEXT_STEP, "same_step": AutoresetMode.SAME_STEP}
        theirs_mode = wanted.get(mode, AutoresetMode.DISABLED)
        with (
            closing(case.native(autoreset_mode=mode)) as ours,
            closing(case.gymnasiums("sync", autoreset_mode=theirs_mode)) as theirs,
        ):
            if ours.metadata.get("autoreset_mode") is not theirs_mode:
                raise Broken(
                    f"metadata['autoreset_mode'] is {ours.metadata.get('autoreset_mode')!r}, not {theirs_mode!r}"
                )
            _expect_same_results(case, ours, theirs, resets_by_mask=mode == "disabled")

    return rule


def _expect_same_results(case: Case, ours: Any, theirs: Any, *, resets_by_mask: bool = False) -> None:
    """Runs both with the same seeds and actions; everything that they return must be equal."""
    _expect_same(ours.single_observation_space, theirs.single_observation_space, "single_observation_space")
    _expect_same(ours.single_action_space, theirs.single_action_space, "single_action_space")
    _expect_same(ours.reset(seed=case.seed), theirs.reset(seed=spread_seeds(case.seed, theirs.num_envs)), "reset")
    num_ends = 0
    for number, action in enumerate(case.actions(theirs.action_space)):
        left, right = ours.step(action), theirs.step(action)
        for name, one, other in zip(_PARTS, left, right, strict=True):
            _expect_same(one, other, f"step {number}, {name}")
        ended = np.logical_or(left[2], left[3])
        num_ends += int(ended.sum())
        if resets_by_mask and ended.any():
            # Gymnasium's loop removes the mask from the dictionary that it is given.
            one, other = (env.reset(options={"reset_mask": ended.copy()}) for env in (ours, theirs))
            _expect_same(one, other, f"reset by mask after step {number}")
    if num_ends == 0 and case.steps > 2 * SHORT_EPISODE and "max_episode_steps" not in case.options:
        raise Broken(f"no episode ended in {case.steps} steps, although each is limited to {SHORT_EPISODE}")


_PARTS = ("observations", "rewards", "terminated", "truncated", "infos")

RULES = (
    Rule(
        "Gymnasium's check_env, without a warning",
        _passes_gymnasiums_check,
        "the message is Gymnasium's; an option of the environment is the likeliest cause",
    ),
    Rule(
        "Stable-Baselines3's check_env, without a warning",
        _passes_sb3s_check,
        'it accepts only uint8 images of at least 36 x 36: modalities="rgb", or depth="uint8" without class and instance',
    ),
    Rule(
        "same seed, same sequence of worlds",
        _same_seed_same_worlds,
        "please report it with the task and the seed: worlds are a function of task, seed and index",
    ),
    Rule(
        "continues from state(), bit for bit", _continues_from_its_state, "please report it with the task and the seed"
    ),
    Rule("copies and pickles behave identically", _can_be_copied, "please report it with the options"),
    Rule('render() draws with render_mode="rgb_array"', _draws_pictures, "please report it with the options"),
    Rule('opens a window with render_mode="human"', _opens_a_window, "please report it with the options"),
    Rule("can be closed twice", _closes_twice, "please report it with the options"),
    Rule("a single environment matches the batch, bit for bit", _alone_as_in_the_batch, "please report it with the task and the seed"),
    Rule("matches SyncVectorEnv, bit for bit", _equal_in_a_loop, "please report it with the task and the seed"),
    Rule("matches AsyncVectorEnv, bit for bit", equal_in_processes, "please report it with the task and the seed"),
    Rule("autoreset in the next step, as in Gymnasium", _autoreset("next_step"), "please report it with the task"),
    Rule(
        "autoreset in the same step, with the final observation",
        _autoreset("same_step"),
        "please report it with the task",
    ),
    Rule("no autoreset, resets by mask", _autoreset("disabled"), "please report it with the task"),
)
