"""Invalid requests raise the documented exceptions, with Python's names, before any large allocation."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld import Curriculum, DriftworldError, _literals, _native
from driftworld._equality import first_difference
from gymnasium.error import ResetNeeded

FIND = "driftworld/FindObjects-v0"


def native(num_envs: int, **options: Any) -> Any:
    options = {"modalities": "state", "size": 16, **options}
    return gym.make_vec(FIND, num_envs, vectorization_mode="vector_entry_point", **options)


# -- steps without a reset ---------------------------------------------------------------------------------------------


def test_step_without_reset_is_refused_as_in_gymnasium() -> None:
    theirs = gym.make_vec(FIND, 3, vectorization_mode="sync", modalities="state", size=16)
    ours = native(3, max_steps=2)
    action = ours.action_space.sample()
    for envs in (theirs, ours):
        with pytest.raises(ResetNeeded, match="reset"):
            envs.step(action)
    with pytest.raises(ResetNeeded, match="reset"):
        gym.make(FIND, modalities="state", size=16, disable_env_checker=True).unwrapped.step(action[0])
    seeds = ours.reset()[1]["seed"].tolist()
    assert len(set(seeds)) == 3


def test_every_environment_needs_a_reset() -> None:
    envs = native(3)
    action = envs.action_space.sample()
    envs.reset(seed=0, options={"reset_mask": np.array([True, False, True])})
    with pytest.raises(ResetNeeded, match="no reset of environments 1,"):
        envs.step(action)
    envs.reset(seed=0, options={"reset_mask": np.array([False, True, False])})
    envs.step(action)


# -- excessive requests ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("num_envs", "size"), [(65_536, 4096), (400, 4096), (65_536, 300)])
def test_too_large_batch_is_refused(num_envs: int, size: int) -> None:
    with pytest.raises(driftworld.EnvError, match="expected at most 16 GiB.*num_envs") as refused:
        driftworld.DriftworldVectorEnv("find_objects", num_envs=num_envs, size=size, modalities="rgb")
    assert refused.value.code == "env/batch-memory"


@pytest.mark.parametrize("sample", ["sample_many", "sample_many_json"])
def test_too_many_worlds_are_refused(sample: str) -> None:
    draw = getattr(driftworld.variant("scavenger_hunt"), sample)
    for count in (2**60, 2**64 - 1, 10_000_001):
        with pytest.raises(ValueError, match=f"count: found {count}, expected at most 10000000 worlds at once"):
            draw(count)
    with pytest.raises(ValueError, match="GiB as text, expected at most 16 GiB at once; .* portions, with start"):
        draw(10_000_000)
    assert len(draw(3, start=2**60)) == 3


def test_threads_are_limited_by_processors_and_environments() -> None:
    tasks = Path("/proc/self/task")
    if not tasks.is_dir():
        pytest.skip("threads are counted in /proc")
    import os

    before = len(list(tasks.iterdir()))
    envs = native(400, num_threads=2000)
    # Making many environments also starts the shared worker pool, one thread for each processor.
    processors = os.cpu_count() or 1
    assert len(list(tasks.iterdir())) - before <= 6 * processors
    envs.close()


# -- Ctrl-C ------------------------------------------------------------------------------------------------------------

PROGRAM = """
import os, signal, threading
import driftworld

envs = driftworld.DriftworldVectorEnv("get_to_goal", 64, modalities="state", size=8)
envs.reset(seed=0)
world = driftworld.variant("get_to_goal").sample()
world["environment_params"] = {{"map_size": [300, 300]}}
world["objects"] = [
    {{"class": "cube", "coordinates": [3 * (n % 90) - 135, 3 * (n // 90) - 135]}} for n in range(8_000)
]
world["agent_params"]["coordinates"] = [145, 145]
take = envs._members.take

def begin(prepared, env, seed):
    if env == 0:
        soon()
    take(prepared, env, seed)

def soon():
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()

envs._members.take = begin
try:
    {call}
    print("finished")
except KeyboardInterrupt:
    begun = sum(len(envs.state(env)["objects"]) > 1000 for env in range(64))
    print("interrupted", begun < 64, bool(envs._members.has_begun.any()))
"""


def test_ctrl_c_ends_a_reset_between_environments() -> None:
    program = PROGRAM.format(call='envs.reset(options={"world": world})')
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=200, check=False)
    assert (process.stdout, process.returncode) == ("interrupted True False\n", 0), process.stderr


def test_ctrl_c_ends_making_many_environments() -> None:
    call = 'soon(); driftworld.DriftworldVectorEnv(num_envs=4096, world=world, modalities="state", size=8)'
    process = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(call=call)], capture_output=True, text=True, timeout=200, check=False
    )
    assert (process.stdout, process.returncode) == ("interrupted True True\n", 0), process.stderr


# -- actions -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", [-1, 99, 2**62, -(2**62)])
def test_action_of_an_ended_environment_is_ignored(row: int) -> None:
    options = {"actions": "discrete", "max_episode_steps": 3}
    ours, other = native(2, **options), native(2, **options)
    ours.reset(seed=0)
    other.reset(seed=0)
    ended = np.zeros(2, dtype=bool)
    for _ in range(9):
        results = ours.step(np.where(ended, row, 1))
        assert first_difference(results, other.step(np.array([1, 1]))) is None
        ended = results[2] | results[3]
    with pytest.raises((ValueError, DriftworldError), match=f"action: found row {row}, expected 0 to 6"):
        ours.step(np.array([1, row]))


@pytest.mark.parametrize("row", [2**70, -(2**70), 2**63, -1, -(2**63) - 1, 7])
def test_invalid_row_is_refused_with_the_valid_range(row: int) -> None:
    env = driftworld.DriftworldEnv("find_objects", actions="discrete", modalities="state", size=16)
    env.reset(seed=0)
    before = env.state()
    with pytest.raises((ValueError, DriftworldError), match=f"action: found (row )?{row}, expected .*0 to 6"):
        env.step(row)
    assert first_difference(before, env.state()) is None


def test_row_beyond_64_bits_is_refused_in_vectors() -> None:
    envs = native(2, actions="discrete")
    envs.reset(seed=0)
    for rows in (np.array([2**63, 0], dtype=np.uint64), [2**70, 0], [0, 2**64 - 1]):
        with pytest.raises((ValueError, DriftworldError), match="action.*expected.*nothing was changed"):
            envs.step(rows)


# -- a long queue ------------------------------------------------------------------------------------------------------


def test_queue_looks_up_each_distinct_variant_once(monkeypatch: pytest.MonkeyPatch) -> None:
    from driftworld.envs.origin import Home

    looked_up: list[Any] = []
    find = Home.variant
    monkeypatch.setattr(Home, "variant", lambda self, name, option: (looked_up.append(name), find(self, name, option))[1])
    queue = ["red", "blue", "find_objects#dusk", driftworld.variant("find_objects#near")] * 25_000
    envs = native(3)
    envs.reset(seed=0, options={"queue": queue})
    assert looked_up == queue[:4]


@pytest.mark.parametrize("num_envs", [1, 2, 3, 4])
@pytest.mark.parametrize("length", [1, 2, 3, 4, 6])
def test_queue_is_distributed_repeatedly(num_envs: int, length: int) -> None:
    names = ["red", "blue", "red", "dusk", "near", "blue"][:length]
    envs = native(num_envs, autoreset_mode="disabled", info="full")
    ids = [envs.reset(seed=0, options={"queue": np.array(names)})[1]["variant_id"]]
    ids += [envs.reset()[1]["variant_id"] for _ in range(2 * length)]
    distributed = [name for each in ids for name in each]
    assert distributed == [f"find_objects#{names[turn % length]}" for turn in range(len(distributed))]


# -- values ------------------------------------------------------------------------------------------------------------


def write_log(folder: Path) -> Path:
    with driftworld.LogWriter(folder) as log:
        for number in range(30):
            kind: Any = "test" if number // 10 % 2 else "train"
            log.write(block_num=number // 10, exp_num=number, block_type=kind, task_name="a_b", reward=float(number))
    return folder


WRONG: dict[str, tuple[Callable[[Path], Any], str]] = {
    "perf_measure": (lambda log: driftworld.metrics(log, perf_measure="rewrd"), "perf_measure: log log: found no metrics column"),
    "no log": (lambda log: driftworld.metrics([]), "logs: found none"),
    "no log to report": (lambda log: driftworld.report([]), "logs: found none"),
    "no task": (lambda log: Curriculum.design(), "tasks: found none"),
    "form": (lambda log: Curriculum.design("find_objects#red", form="x"), "form: found 'x', expected one of cond"),  # type: ignore[arg-type]
    "learn": (lambda log: Curriculum.design("find_objects#red", learn=-1), "learn: found -1, expected a whole"),
    "learn much": (lambda log: Curriculum.design("find_objects#red", learn=2**70), "expected a smaller number"),
    "seed": (lambda log: Curriculum.design("find_objects#red", seed=-1), "seed: found -1, expected a whole number"),
    "drift": (lambda log: Curriculum.design("find_objects", drift="x"), "drift: found 'x', expected linear, cosine"),
    "steps": (lambda log: Curriculum.design("find_objects#red", steps=3), "steps: found without step_distance"),
    "tolerance": (
        lambda log: Curriculum.design("find_objects#red", step_distance=0.1, steps=2, tolerance="a"),  # type: ignore[arg-type]
        "tolerance: found 'a', expected a number",
    ),
    "lifetimes": (lambda log: Curriculum.lifetimes(0, "find_objects"), "lifetimes: found 0, expected a whole"),
    "variant_mode": (lambda log: driftworld.metrics(log, variant_mode="x"), "expected one of aware, agnostic"),  # type: ignore[arg-type]
    "window_length": (lambda log: driftworld.metrics(log, window_length=-3), "window_length: found -3, expected"),
    "noise": (lambda log: driftworld.metrics(log, noise_seed=3), "options: found no noise, expected it beside"),
    "resampling": (lambda log: driftworld.metrics(log, resampling="x"), "expected one of runs, strata"),  # type: ignore[arg-type]
    "worlds": (lambda log: driftworld.distance("find_objects#red", "find_objects#blue", worlds=2**70), "found 11805"),
    "worlds below 0": (lambda log: driftworld.distance("find_objects", "find_objects", worlds=-1), "found -1"),
    "threads": (lambda log: driftworld.variant("find_objects").sample_many(1, threads=-1), "found -1, expected"),
    "many threads": (lambda log: driftworld.variant("find_objects").sample_many(1, threads=2**70), "found 11805"),
    "experience": (lambda log: Curriculum.design("find_objects#red").experience(2**70), "found 11805"),
}


@pytest.mark.parametrize("name", WRONG)
def test_invalid_values_are_refused_with_pythons_names(name: str, tmp_path: Path) -> None:
    call, message = WRONG[name]
    with pytest.raises((ValueError, DriftworldError), match=re.escape(message)) as refused:
        call(write_log(tmp_path / "log"))
    text = str(refused.value).replace(str(tmp_path), "")
    assert "expected" in text or "choose" in text
    for word in ("::", "--", "<", "invalid ", "borrowed", "digit", "literal", "target type", "possible values"):
        assert word not in text, text


@pytest.mark.parametrize(
    "ask",
    [
        lambda: driftworld.variant("find_objects#rde"),
        lambda: driftworld.variants("find_objects#rde"),
        lambda: driftworld.TaskSpec.load("find_objects").variant("rde"),
        lambda: driftworld.distance("find_objects#rde", "find_objects#red"),
        lambda: driftworld.DriftworldEnv("find_objects#rde"),
        lambda: driftworld.DriftworldEnv("find_objects", variant="rde"),
        lambda: driftworld.DriftworldVectorEnv("find_objects", 2, variants=["red", "rde"]),
        lambda: Curriculum.design("find_objects#rde"),
        lambda: driftworld.variant("find_object"),
    ],
)
def test_unknown_name_raises_the_documented_error(ask: Callable[[], Any]) -> None:
    with pytest.raises(driftworld.TaskError, match="did you mean") as refused:
        ask()
    assert isinstance(refused.value, LookupError) and isinstance(refused.value, ValueError)
    assert refused.value.code in ("task/unknown", "spec/unknown-variant")


# -- signatures --------------------------------------------------------------------------------------------------------


def callables() -> list[tuple[str, Any]]:
    """All callables shown by ``help(driftworld)``."""
    found: list[tuple[str, Any]] = []
    for name in driftworld.__all__:
        value = getattr(driftworld, name)
        if inspect.isclass(value):
            members = [(f"{name}.{member}", getattr(value, member)) for member in vars(value) if not member.startswith("_")]
            found.extend((called, member) for called, member in members if callable(member))
        if callable(value):
            found.append((name, value))
    return found


@pytest.mark.parametrize(("name", "value"), callables(), ids=lambda value: value if isinstance(value, str) else "")
def test_help_shows_every_default(name: str, value: Any) -> None:
    try:
        parameters = inspect.signature(value).parameters.values()
    except ValueError:
        return
    assert [parameter.name for parameter in parameters if parameter.default is ...] == []


def literal_words(value: Any, parameter: str) -> set[Any]:
    """The words in the `Literal` types of a parameter."""
    pending, words = [typing.get_type_hints(value)[parameter]], set()
    while pending:
        kind = pending.pop()
        if get_origin(kind) is Literal:
            words.update(get_args(kind))
        elif get_args(kind):
            pending.extend(get_args(kind))
    return words


def accepted_words(call: Callable[[str], Any]) -> set[str]:
    """The words that the error of a call lists as expected."""
    with pytest.raises((ValueError, DriftworldError)) as refused:
        call("no such word")
    text = str(refused.value).partition("expected ")[2].removeprefix("one of ")
    text = re.split(r"[,;] (?:or a |each |did you|as in)", text)[0]
    return set(re.split(r", | or ", text))


ENVS = (driftworld.DriftworldEnv.__init__, driftworld.DriftworldVectorEnv.__init__)
LITERALS: dict[str, tuple[Any, Callable[[str], Any]]] = {
    **{
        f"{name} of {made.__qualname__}": (
            (made, name),
            lambda word, name=name: native(1, **{name: word}),
        )
        for made in ENVS
        for name in ("modalities", "depth", "actions", "renderer", "task_label", "camera")
    },
    "autoreset_mode": ((ENVS[1], "autoreset_mode"), lambda word: native(1, autoreset_mode=word)),
    "method": ((driftworld.order, "method"), lambda word: driftworld.order("find_objects", word)),  # type: ignore[arg-type]
    "kind": ((driftworld.validate, "kind"), lambda word: driftworld.validate("find_objects", word)),  # type: ignore[arg-type]
    **{
        f"{name} of design": (
            (Curriculum.design, name),
            lambda word, name=name: Curriculum.design("find_objects#red", **{name: word}),
        )
        for name in ("form", "evaluate", "order", "probe", "task_label", "method")
    },
    **{
        f"{name} of metrics": ((driftworld.metrics, name), lambda word, name=name: driftworld.metrics(".", **{name: word}))
        for name in (
            "variant_mode",
            "ste_averaging_method",
            "aggregation_method",
            "maintenance_method",
            "transfer_method",
            "normalization_method",
            "smoothing_method",
            "resampling",
        )
    },
}


@pytest.mark.parametrize("name", LITERALS)
def test_literal_types_list_the_accepted_words(name: str) -> None:
    (value, parameter), call = LITERALS[name]
    # `expert` is for experts only, and a letter may stand for the name of an element.
    letters = {word for word in accepted_words(call) if len(word) == 1 or word.startswith("or the letter")}
    assert literal_words(value, parameter) == accepted_words(call) - {"expert"} - letters


def test_order_methods_match_the_library() -> None:
    assert get_args(_literals.ComparedBy) == tuple(_native.compared_by())
    assert get_args(_literals.OrderMethod) == tuple(_native.order_methods())
