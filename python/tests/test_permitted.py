"""The infos of an agent name neither variant nor world, unless requested."""

from __future__ import annotations

from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import pytest
from driftworld import Curriculum
from small_lifetime import SMALL, Circler

LABELS = ["none", "info", "observation"]
#: Keys that name a variant, a world, or its contents.
NAMES = ["task_id", "variant_id", "seed", "index", "world_hash", "events"]


class Listener(Circler):
    """Stores all infos that it gets, and whether it was frozen at the time."""

    def __init__(self) -> None:
        super().__init__()
        self.infos: list[dict[str, Any]] = []

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        self.infos.append(info | {"frozen": self.frozen[-1]})
        return super().act(observation, info)

    def learn(self, transition: driftworld.Transition) -> None:
        super().learn(transition)
        self.infos.append(transition.info | {"frozen": False})


def curriculum(variants: list[str], seed: int, label: str) -> Curriculum:
    """Learning and evaluation in each variant, three steps an episode."""
    regimes = [{"task": "find_objects", "variant": name, "count": 2, "seed": seed, "max_steps": 3} for name in variants]
    kinds = ["learning", "evaluation", "learning", "learning"]
    blocks = [{"type": kind, "regimes": regimes} for kind in kinds]
    return Curriculum.from_dict({"name": "permitted", "task_label": label, "blocks": blocks})


def run_listener(variants: list[str], seed: int, label: str, **options: Any) -> Listener:
    """Runs a listener through this curriculum."""
    listener = Listener()
    size = {**SMALL, "modalities": ["rgb"]} if label == "observation" else SMALL
    curriculum(variants, seed, label).run(listener, **size, **options)
    return listener


@pytest.mark.parametrize("label", LABELS)
def test_infos_reveal_neither_variant_nor_world(label: str) -> None:
    rng = np.random.default_rng(LABELS.index(label))
    names = np.array(["blue", "red", "green", "dusk", "wide", "penalty", "slow"])
    listeners = [run_listener(rng.choice(names, 2, replace=False).tolist(), int(rng.integers(2**31)), label) for _ in range(4)]
    # The same keys and values, whatever the variants and worlds, in learning and evaluation.
    assert all(one.infos == listeners[0].infos for one in listeners)
    wanted = {"is_success", "ended_by", "frozen", *(["task_label"] if label == "info" else [])}
    assert {key for info in listeners[0].infos for key in info} == wanted
    assert {info["frozen"] for info in listeners[0].infos} == {False, True}
    # Borders between learning blocks are not revealed either.
    assert listeners[0].frozen == [False, True, False]
    if label == "none":
        assert all(begun is None for one in listeners for begun, _ in one.begun)


@pytest.mark.parametrize("label", LABELS)
def test_full_infos_name_variant_and_world(label: str) -> None:
    listener = run_listener(["blue", "red"], 5, label, info="full")
    resets = [info for info in listener.infos if "variant_id" in info]
    assert all(key in info for info in resets for key in NAMES)
    plan = curriculum(["blue", "red"], 5, label)
    planned = [(one.task, one.variant, one.seed, one.index) for block in plan for one in block]
    reported = [tuple(info[key] for key in ("task_id", "variant_id", "seed", "index")) for info in resets]
    assert reported[: len(planned) // 2] == planned[: len(planned) // 2]


def test_no_seed_identifies_a_world() -> None:
    listener = run_listener(["blue", "red"], 5, "none")
    plan = curriculum(["blue", "red"], 5, "none")
    positions = [(one.block, one.index) for block in plan for one in block]
    positions[8:8] = positions[4:8]  # the evaluations are repeated
    numbers: dict[int, set[tuple[int, int | None]]] = {}
    for position, (_, number) in zip(positions, listener.begun, strict=True):
        numbers.setdefault(number, set()).add(position)
    assert all(len(found) == 1 for found in numbers.values())


@pytest.mark.parametrize("where", ["none", "info", "observation"])
@pytest.mark.parametrize("wanted", ["agent", "full"])
def test_single_environment_names_its_variant_only_if_permitted(where: str, wanted: str) -> None:
    options: dict[str, Any] = {"modalities": ["rgb"], "size": 8, "task_label": where, "info": wanted, "max_steps": 2}
    names = {"task_id", "variant_id"} if where != "none" or wanted == "full" else set()
    env = gym.make("driftworld/FindObjects-v0", variant="red", **options)
    info = env.reset(seed=3)[1]
    assert info.keys() & {"task_id", "variant_id"} == names
    assert env.unwrapped.origin()["variant_id"] == "find_objects#red"  # type: ignore[attr-defined]
    assert env.unwrapped.origin()["world_hash"] == info["world_hash"]  # type: ignore[attr-defined]
    for mode in ("next_step", "same_step"):
        envs = gym.make_vec(
            "driftworld/FindObjects-v0", 2, vectorization_mode="vector_entry_point", autoreset_mode=mode, **options
        )
        keys = set(envs.reset(seed=3)[1])
        for _ in range(4):
            keys |= set(envs.step(envs.action_space.sample())[4])
        assert keys & {"task_id", "variant_id"} == names


def test_unknown_info_option_is_refused() -> None:
    with pytest.raises(ValueError, match="info: found 'all', expected one of agent, full"):
        gym.make("driftworld/FindObjects-v0", info="all")
