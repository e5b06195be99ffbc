"""Options of an environment that hide differences between variants are refused in curricula, and cause warnings in
single and vector environments.
"""

from __future__ import annotations

import ast
import itertools
import json
import re
import warnings
from pathlib import Path
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from conftest import ROOT
from driftworld import Curriculum, CurriculumError, DriftworldEnv, DriftworldVectorEnv
from small_lifetime import SMALL, Circler

CURRICULA = sorted((ROOT / "examples" / "curricula").glob("*.json"))
LEARNERS = sorted((ROOT / "examples" / "python").glob("*ppo*.py"))


def options_of(program: Path) -> dict[str, Any]:
    """The options that an example passes to environments, without the task."""
    text = program.read_text(encoding="utf-8")
    table = re.search(r"^ACTIONS = (\[.*\])$", text, re.MULTILINE)
    found = re.search(r"^ *(?:OPTIONS|options): dict\[str, Any\] = (\{.*?\n *\})", text, re.MULTILINE | re.DOTALL)
    if found is None:
        return {}
    rows = ast.literal_eval(table[1]) if table else [[10, 0, 0], [3, 90, 0]]
    given = ast.literal_eval(found[1].replace("ACTIONS", repr(rows)))
    return {name: value for name, value in given.items() if name != "task"}


#: Each distinct set of options in the examples, by the first example that uses it.
EXAMPLES: dict[str, dict[str, Any]] = {}
for program in LEARNERS:
    if (options := options_of(program)) and options not in EXAMPLES.values():
        EXAMPLES[program.name] = options
OPTION_SETS: list[dict[str, Any]] = [
    {"frame_skip": 5},
    {"modalities": "rgb"},
    {"modalities": ["rgb"], "blank": True},
    {"modalities": ["rgb", "depth", "class"]},
    {"modalities": ["rgb", "depth", "class"], "blank": True},
    {"interact": True},
    {"interact": False},
    {"actions": "discrete"},
    {"actions": None},
    {"size": 8},
    {"max_steps": 7},
    {"supersampling": 2},
    {},
]


def evaluation_of(*variants: str) -> Curriculum:
    listed = [{"task": name.partition("#")[0], "variant": name.partition("#")[2], "count": 1} for name in variants]
    blocks = [{"type": "evaluation", "regimes": [{**regime, "seed": 1} for regime in listed]}]
    return Curriculum.from_dict({"name": "pair", "blocks": blocks})


def world(variant: str, options: dict[str, Any]) -> dict[str, Any]:
    """A variant's first world with these options, with only the modalities that observations have."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env = DriftworldEnv(variant, **{"size": 8, **options})
    env.reset(seed=0)
    state = env.state()
    shown = options.get("modalities")
    if shown is not None:
        agent = state["agent_params"]
        agent["modalities"] = [kind for kind in agent.get("modalities", ["rgb", "depth"]) if kind in shown]
    return state


def expect_distinguishable(variants: list[str], options: dict[str, Any]) -> None:
    """Expects variants whose first worlds differ to differ with the options too."""
    plain = {name: world(name, {"actions": None}) for name in variants}
    under: dict[str, Any] = {}
    for one, other in itertools.combinations(variants, 2):
        if plain[one] == plain[other] or one.partition("#")[0] != other.partition("#")[0]:
            continue
        for name in (one, other):
            if name not in under:
                under[name] = world(name, options)
        assert under[one] != under[other], f"{one} and {other} are the same with {options}"


@pytest.mark.parametrize("example", EXAMPLES)
@pytest.mark.parametrize("path", CURRICULA, ids=lambda path: path.stem)
def test_example_options_hide_no_variant_differences(path: Path, example: str) -> None:
    curriculum, options = Curriculum.load(path), EXAMPLES[example]
    variants = sorted({experience.variant for block in curriculum for experience in (block[0], *block[:: max(1, len(block) // 12)])})
    variants = [name for name in variants if ".." not in name]
    try:
        curriculum.environment(**options)
    except CurriculumError as error:
        assert error.code == "curriculum/covered"
        return
    expect_distinguishable(variants, options)


def test_shipped_examples_run_with_agreeing_variants() -> None:
    refused = set()
    for path in CURRICULA:
        for options in EXAMPLES.values():
            try:
                Curriculum.load(path).environment(**options)
            except CurriculumError:
                refused.add(path.stem)
    assert refused == {"transition", "interaction", "modality", "families_interaction", "families_modality"}


def test_drawn_variants_stay_distinct() -> None:
    rng = np.random.default_rng(38)
    names = [f"{task}#{name}" for task in ("find_objects", "moving_object") for name in driftworld.TaskSpec.load(task).variant_names()]
    likely = [name for name in names if name.endswith(("held", "no_interact", "rgb_only", "depth_only", "with_class"))]
    refused = 0
    for number in range(24):
        pair = [str(rng.choice(likely if number % 2 else names)), str(rng.choice(names))]
        options = OPTION_SETS[rng.integers(len(OPTION_SETS))]
        if pair[0] == pair[1]:
            continue
        try:
            evaluation_of(*pair).environment(**options)
        except CurriculumError as error:
            assert error.code == "curriculum/covered"
            refused += 1
        except ValueError:
            continue
        else:
            expect_distinguishable(pair, options)
    assert refused >= 3


@pytest.mark.parametrize(
    "pair, options, message",
    [
        (("blue", "long_held"), {"frame_skip": 5}, r"^frame_skip: .*agent_params\.frame_skip.*#blue \(1\).*#long_held \(5\)"),
        (("held",), {"frame_skip": 1}, r"^frame_skip: .*#held \(\d+\).*#default \(1\)"),
        (("blue", "rgb_only"), {"modalities": "rgb", "blank": False}, r'^modalities: .*\["rgb", "depth"\].*\["rgb"\].*blank=True'),
        (("blue", "rgb_only"), {"modalities": ["rgb"], "blank": True}, r"^modalities: "),
        (("blue", "no_interact"), {"interact": True}, r"^interact: .*\(true\).*\(false\)"),
    ],
    ids=str,
)
def test_option_hiding_a_difference_is_refused_with_key_and_variants(
    pair: tuple[str, ...], options: dict[str, Any], message: str
) -> None:
    names = [f"find_objects#{name}" for name in pair]
    curriculum = evaluation_of(*names)
    given = {**SMALL, "modalities": ["rgb", "depth"], "blank": True, **options}
    runs = [
        lambda: curriculum.run(Circler(), **given),
        lambda: curriculum.run_vector(Circler(), num_envs=2, **given),  # type: ignore[arg-type]
        lambda: curriculum.environment(**given),
    ]
    for run in runs:
        with pytest.raises(CurriculumError, match=message) as refused:
            run()
        assert refused.value.code == "curriculum/covered"
    if given["modalities"] == ["rgb"]:
        with pytest.raises(ValueError, match="found images of depth"):
            DriftworldVectorEnv(names[0], 2, variants=[pair[0], pair[-1]], **given)
        return
    with pytest.warns(UserWarning, match=message):
        DriftworldVectorEnv(names[0], 2, variants=[pair[0], pair[-1]], **given)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        gym.make("driftworld/FindObjects-v0", variant=pair[-1], **given).reset(seed=0, options={"variant": pair[0]})
    assert any(str(one.message).startswith(message[1 : message.index(":") + 1]) for one in warned)


def test_hidden_random_values_cause_a_warning_and_limits_join_tasks() -> None:
    task = driftworld.TaskSpec.load("get_to_goal")
    document = json.loads(task.to_json())
    document["name"] = "drawn"
    document["world"]["agent_params"]["frame_skip"] = {"integer_uniform": {"low": 1, "high": 5}}
    with pytest.warns(UserWarning, match="^frame_skip: .*draws anew in each world"):
        DriftworldEnv(document, size=8, frame_skip=2)
    curriculum = evaluation_of("find_objects#blue", "get_to_goal#plain")
    curriculum.environment(**SMALL, max_steps=20).close()


def test_options_without_differences_cause_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for options in EXAMPLES.values():
            gym.make("driftworld/FindObjects-v0", variant="blue", **options).close()
            DriftworldVectorEnv("find_objects", 3, variants=["blue", "red", "dusk"], **options).close()


def test_variants_that_look_alike_in_all_images_are_refused() -> None:
    message = r"^modalities: found it hiding target_color, in which find_objects#blue and find_objects#red differ and which only rgb"
    curriculum = evaluation_of("find_objects#blue", "find_objects#red")
    for shown in ("depth", ["depth", "class"], "state"):
        with pytest.raises(CurriculumError, match=message) as refused:
            curriculum.environment(size=8, modalities=shown)
        assert refused.value.code == "curriculum/covered"
    with pytest.warns(UserWarning, match=message):
        DriftworldVectorEnv("find_objects#blue", 2, variants=["blue", "red"], size=8, modalities="depth").close()
    curriculum.environment(size=8, modalities=["rgb", "depth"]).close()
    evaluation_of("find_objects#blue", "find_objects#huddle").environment(size=8, modalities="depth").close()


def test_continuous_action_bounds_include_every_drawn_world() -> None:
    env = DriftworldEnv("find_objects#any_speed", actions="continuous", size=8)
    assert env.action_space.high.tolist() == [10, 90, 1]  # type: ignore[attr-defined]
    for seed in range(8):
        env.reset(seed=seed)
        assert env.state()["agent_params"]["max_linear_speed"] <= 10
    env.reset(options={"world": env.state()})
    with pytest.raises(ValueError, match="found actions of numbers"):
        DriftworldEnv("find_objects#blue", actions="continuous", size=8).reset(options={"world": {"agent_params": {"max_linear_speed": 11}}})
    document = driftworld.TaskSpec.load("get_to_goal").to_dict()
    document["name"] = "unbounded"
    document["world"]["agent_params"]["max_linear_speed"] = {"normal": {"mean": 8, "std": 1}}
    assert DriftworldEnv(document, actions="continuous", size=8).action_space.high[0] == 100  # type: ignore[attr-defined]
