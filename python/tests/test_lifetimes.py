"""Curricula that Python runs write the same log as the command."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from driftworld import Agent, Curriculum, CurriculumError, TaskSpec, Transition, read_log, validate_log
from small_lifetime import SMALL, Circler, Pupil, rows, small

#: The columns that do not depend on the agent.
PLAN_COLUMNS = [
    "block_num",
    "exp_num",
    "worker_id",
    "block_type",
    "block_subtype",
    "task_name",
    "task_params",
    "exp_status",
    "progress",
    "world_index",
    "distance",
    "distance_state",
    "distance_action",
    "distance_transition",
    "distance_reward",
    "distance_observation",
]


def test_log_matches_the_command(tmp_path: Path) -> None:
    curriculum, script = small(), tmp_path / "circle.txt"
    script.write_text("step 1 5 45 0\nrepeat\n", encoding="utf-8")
    curriculum.save(tmp_path / "s.json")
    argv = ["run", str(tmp_path / "s.json"), "--agent", f"scripted:{script}", "--output", str(tmp_path / "theirs")]
    subprocess.run([sys.executable, "-m", "driftworld", *argv], check=True, capture_output=True)
    agent = Circler()
    summary = curriculum.run(agent, tmp_path / "mine", **SMALL)
    assert rows(tmp_path / "mine") == rows(tmp_path / "theirs")
    assert validate_log(tmp_path / "mine")["valid"]
    infos = [
        json.loads((tmp_path / log / "logger_info.json").read_text(encoding="utf-8")) for log in ("mine", "theirs")
    ]
    assert infos[0] == infos[1]
    assert summary.finished and summary.experiences == 19 and summary.log == tmp_path / "mine"
    assert summary.steps == sum(read_log(tmp_path / "mine")["episode_step_count"])
    assert driftworld.metrics(tmp_path / "mine").lifetime == driftworld.metrics(tmp_path / "theirs").lifetime


def test_random_agents_log_has_the_commands_form(tmp_path: Path) -> None:
    curriculum = small(max_steps=10)
    curriculum.save(tmp_path / "s.json")
    argv = ["run", str(tmp_path / "s.json"), "--agent", "random", "--output", str(tmp_path / "theirs")]
    subprocess.run([sys.executable, "-m", "driftworld", *argv], check=True, capture_output=True)
    space = curriculum.environment(**SMALL).action_space

    class Random(Circler):
        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            return space.sample()

    # The action space is not seeded, so the agent behaves differently in repeated evaluations.
    curriculum.run(Random(), tmp_path / "mine", check_frozen=False, **SMALL)
    assert rows(tmp_path / "mine", PLAN_COLUMNS) == rows(tmp_path / "theirs", PLAN_COLUMNS)


def test_agent_learns_in_learning_blocks_only(tmp_path: Path) -> None:
    agent = Circler()
    assert isinstance(agent, Agent)
    small(max_steps=7).run(agent, check_frozen=False, **SMALL)
    assert agent.frozen == [False, True, False, True, False, True]
    assert len(agent.learned) == 7 * (2 + 5 + 3) and len(agent.begun) == 19
    assert {label for label, _ in agent.begun} == {None}
    # Within a block, all variants share the agent's seed for the same world number; no seed recurs in another block.
    seeds = [seed for _, seed in agent.begun]
    assert seeds[2] == seeds[4] and seeds[5:7] == seeds[7:9]
    assert len(set(seeds)) == 2 + 2 + 3 + 2 + 3 + 2
    # With `paired_chance`, every evaluation of a world has the same seed, and learning a different one.
    paired = Circler()
    small(max_steps=7).run(paired, check_frozen=False, paired_chance=True, **SMALL)
    seeds = [seed for _, seed in paired.begun]
    assert seeds[2:5] == seeds[10:13] == seeds[16:19]
    assert len(set(seeds)) == 2 + 2 + 3 + 3


class Memoriser(Circler):
    """Its actions depend on the number of experiences so far, so evaluations change it."""

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        return np.array([len(self.begun), 20 * (len(self.begun) % 3), 0], dtype=np.float32)


def test_agent_changed_by_evaluations_is_refused(tmp_path: Path) -> None:
    regimes = [{"task": "get_to_goal", "variant": "soft", "count": 6, "seed": 1, "max_steps": 30}]
    curriculum = Curriculum.from_dict({"name": "frozen", "blocks": [{"type": "evaluation", "regimes": regimes}]})
    with pytest.raises(CurriculumError, match="block 0: found a different action in step 1 of experience 0 .get_to_goal#soft."):
        curriculum.run(Memoriser(), tmp_path / "log", **SMALL)
    assert curriculum.run(Memoriser(), check_frozen=False, **SMALL).finished
    # For an agent that acts the same in repeated evaluations, the check does not change the log.
    for name, check in [("checked", True), ("unchecked", False)]:
        curriculum.run(Pupil(), tmp_path / name, check_frozen=check, **SMALL)
    assert rows(tmp_path / "checked", ["reward"]) == rows(tmp_path / "unchecked", ["reward"])


def test_freeze_is_called_only_on_a_change(tmp_path: Path) -> None:
    regime = {"task": "find_objects", "variant": "blue", "count": 1, "max_steps": 3}
    kinds = ["learning", "learning", "evaluation", "evaluation", "learning"]
    blocks = [{"type": kind, "regimes": [regime]} for kind in kinds]
    agent = Circler()
    Curriculum.from_dict({"name": "borders", "blocks": blocks}).run(agent, **SMALL)
    assert agent.frozen == [False, True, False]


def test_transition_matches_the_step() -> None:
    transitions: list[Transition] = []

    class Watcher(Circler):
        def learn(self, transition: Transition) -> None:
            transitions.append(transition)

    watcher = Watcher()
    small(max_steps=5).run(watcher, info="full", **SMALL)
    first = transitions[:5]
    assert [transition.truncated for transition in first] == [False] * 4 + [True]
    for before, after in pairwise(first):
        assert before.next_observation is after.observation
    assert first[0].observation is watcher.seen[0][0] and first[0].action.tolist() == [5, 45, 0]
    assert set(first[0].info) >= {"events", "is_success"}


@pytest.mark.parametrize("finished", [1, 4, 6, 9, 12, 16])
def test_stopped_run_resumes_as_if_uninterrupted(tmp_path: Path, finished: int) -> None:
    curriculum, undisturbed = small(), Pupil()
    curriculum.run(undisturbed, tmp_path / "whole", **SMALL)
    first, second = Pupil(), Pupil()
    stopped = curriculum.run(
        first, tmp_path / "log", watch=lambda experience, reward: experience.number + 1 < finished, **SMALL
    )
    assert (stopped.experiences, stopped.finished) == (finished, False)
    whole = curriculum.run(second, tmp_path / "log", **SMALL)
    assert whole.finished and whole.regimes == curriculum.run(Pupil(), tmp_path / "whole", **SMALL).regimes
    assert rows(tmp_path / "log") == rows(tmp_path / "whole")
    assert second.knowledge == undisturbed.knowledge != 0
    assert sorted(path.name for path in (tmp_path / "log.agent").iterdir()) == ["00000016", "lifetime.json"]


def test_interrupt_leaves_a_resumable_log(tmp_path: Path) -> None:
    class Interrupting(Circler):
        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            if len(self.begun) == 6:
                raise KeyboardInterrupt
            return super().act(observation, info)

    curriculum = small()
    with pytest.raises(KeyboardInterrupt):
        curriculum.run(Interrupting(), tmp_path / "log", **SMALL)
    assert len(read_log(tmp_path / "log")) == 5
    assert curriculum.run(Circler(), tmp_path / "log", **SMALL).finished
    assert len(read_log(tmp_path / "log")) == 19


@pytest.mark.skipif(os.name != "posix", reason="directories are held open on POSIX systems")
@pytest.mark.parametrize("what", ["folder-lost", "file-lost"])
def test_deleted_log_raises_an_error(tmp_path: Path, what: str) -> None:
    log = tmp_path / "log"

    class Careless(Circler):
        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            if len(self.begun) == 6 and log.exists():
                lost = [log] if what == "folder-lost" else list(log.glob("*/*/data-log.tsv"))
                for path in lost:
                    path.rename(tmp_path / "away")
            return super().act(observation, info)

    with pytest.raises(driftworld.MetricsError, match="found no (directory|file), expected") as refused:
        small().run(Careless(), log, **SMALL)
    assert refused.value.code == f"metrics/{what}"
    assert log.exists() == (what == "file-lost")


def test_stopped_clock_still_stamps_every_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DRIFTWORLD_CLOCK", "2026-01-31T12:00:00Z")
    for name in ["a", "b"]:
        small().run(Circler(), tmp_path / name, **SMALL)
    tables = [sorted((tmp_path / name).glob("*/*/data-log.tsv")) for name in ["a", "b"]]
    texts = [[table.read_text() for table in found] for found in tables]
    assert texts[0] == texts[1] and "\t20260131T120000.000000\t" in texts[0][0]
    monkeypatch.setenv("DRIFTWORLD_CLOCK", "noon")
    with pytest.raises(ValueError, match="DRIFTWORLD_CLOCK: found \"noon\""):
        small().run(Circler(), tmp_path / "c", **SMALL)


def test_log_resumes_only_with_the_same_settings(tmp_path: Path) -> None:
    log = tmp_path / "log"
    small(max_steps=3).run(Circler(), log, **SMALL)
    with pytest.raises(CurriculumError, match="/made_from/environment/size"):
        small(max_steps=3).run(Circler(), log, **{**SMALL, "size": 16})
    with pytest.raises(CurriculumError, match="max_steps"):
        small(max_steps=4).run(Circler(), log, **SMALL)
    with pytest.raises(CurriculumError, match="/agent"):
        small(max_steps=3).run(Pupil(), log, **SMALL)
    with pytest.raises(CurriculumError, match="/made_from/environment/info"):
        small(max_steps=3).run(Circler(), log, info="full", **SMALL)
    with pytest.raises(CurriculumError, match="/made_from/paired_chance"):
        small(max_steps=3).run(Circler(), log, paired_chance=True, **SMALL)
    greedy = Circler()
    greedy.policy = "greedy"  # type: ignore[attr-defined]
    with pytest.raises(CurriculumError, match="/made_from/policy"):
        small(max_steps=3).run(greedy, log, **SMALL)
    tuned = Circler()
    tuned.made_with = {"rate": 0.5}  # type: ignore[attr-defined]
    with pytest.raises(CurriculumError, match=r"/made_from/agent: found nothing, expected .*rate"):
        small(max_steps=3).run(tuned, log, **SMALL)
    with pytest.raises(driftworld.MetricsError) as refused:
        small(max_steps=3).run(Circler(), log, resume=False, **SMALL)
    assert refused.value.code == "metrics/log-exists"


@pytest.mark.parametrize("place", ["info", "observation"])
def test_label_is_given_if_the_scenario_has_it(place: str) -> None:
    curriculum = Curriculum.design("find_objects#blue", "find_objects#red", learn=1, eval_episodes=1, task_label=place)
    agent = Circler()
    options = {**SMALL, "modalities": ["rgb"], "max_steps": 2}
    env = curriculum.environment(**options)
    curriculum.run(agent, **options)
    assert {label for label, _ in agent.begun} == {"find_objects#blue", "find_objects#red"}
    numbers = {"find_objects#blue": 0, "find_objects#red": 1}
    expected = [numbers[label or ""] for label, _ in agent.begun for _ in range(2)]
    if place == "info":
        assert [info["task_label"] for _, info in agent.seen] == expected
        assert "task" not in env.observation_space.spaces
    else:
        assert [int(observation["task"].argmax()) for observation, _ in agent.seen] == expected
        assert env.observation_space["task"].shape == (2,)
        assert all(env.observation_space.contains(observation) for observation, _ in agent.seen)
        # A single image has no room for the label: its number is in the infos.
        agent.seen.clear()
        curriculum.run(agent, **{**options, "modalities": "rgb"})
        assert [info["task_label"] for _, info in agent.seen] == expected


def test_l2explorer_scenario_runs_like_the_command(tmp_path: Path) -> None:
    theirs, maps = tmp_path / "theirs.json", tmp_path / "maps"
    maps.mkdir()
    regimes = []
    for name, count in [("near", 2), ("far", 1)]:
        tree = {"class": "tree", "coordinates": [3, 4] if name == "near" else [30, 40]}
        (maps / f"{name}.json").write_text(json.dumps({"game_mode": "learn", "objects": [tree]}), encoding="utf-8")
        regimes.append({"task": "trees", "count": count, "params": {"map": f"maps/{name}.json", "maxsteps": 5}})
    blocks = [{"type": "train", "regimes": regimes}, {"type": "test", "regimes": regimes}]
    theirs.write_text(json.dumps({"logging_base_dir": "logs", "scenario": blocks}), encoding="utf-8")
    # Another map stands in for a missing one, because L2Explorer's own scenario lacks a map.
    min(maps.iterdir()).unlink()
    with pytest.warns(UserWarning, match="stood in for it"):
        curriculum = Curriculum.load(theirs)
    summary = curriculum.run(Circler(), tmp_path / "log", **SMALL)
    assert summary.finished and summary.experiences == curriculum.num_experiences == 6
    with pytest.raises(CurriculumError, match="expected a world file"):
        Curriculum.load(theirs, stand_in=False)


@pytest.mark.parametrize("log_is", ["deleted", "replaced"])
def test_agent_saved_in_another_lifetime_is_not_loaded(tmp_path: Path, log_is: str) -> None:
    log, regime = tmp_path / "log", {"task": "find_objects", "variant": "red", "count": 5, "seed": 9, "max_steps": 10}
    other = Curriculum.from_dict({"name": "other", "blocks": [{"type": "learning", "regimes": [regime]}]})
    small().run(Pupil(), log, watch=lambda experience, reward: experience.number < 1, **SMALL)
    assert (tmp_path / "log.agent" / "00000002").is_dir()
    shutil.rmtree(log)
    replacement = log if log_is == "deleted" else tmp_path / "elsewhere"
    other.run(Pupil(), replacement, watch=lambda experience, reward: experience.number < 2, **SMALL)
    replacement.rename(log)
    pupil, undisturbed = Pupil(), Pupil()
    other.run(pupil, log, **SMALL)
    other.run(undisturbed, **SMALL)
    assert pupil.knowledge == undisturbed.knowledge != 0


def test_time_counts_every_held_step(tmp_path: Path) -> None:
    task = json.loads((Path(__file__).parents[2] / "examples/tasks/get_to_goal.json").read_text(encoding="utf-8"))
    task["world"].setdefault("agent_params", {})["frame_skip"] = 4
    (tmp_path / "mine.json").write_text(json.dumps(task), encoding="utf-8")
    name = TaskSpec.from_dict(task).variant_names()[0]
    regime = {"task": "mine.json", "variant": name, "count": 1, "max_steps": 20}
    document = {"name": "s", "blocks": [{"type": "evaluation", "regimes": [regime]}]}
    (tmp_path / "s.json").write_text(json.dumps(document), encoding="utf-8")
    script = tmp_path / "circle.txt"
    script.write_text("step 1 5 45 0\nrepeat\n", encoding="utf-8")
    argv = ["run", str(tmp_path / "s.json"), "--agent", f"scripted:{script}", "--output", str(tmp_path / "theirs")]
    subprocess.run([sys.executable, "-m", "driftworld", *argv], check=True, capture_output=True)
    curriculum = Curriculum.load(tmp_path / "s.json")
    curriculum.run(Circler(), tmp_path / "mine", **SMALL)
    curriculum.run(Circler(), tmp_path / "twice", frame_skip=2, **SMALL)
    for log, seconds in (("theirs", 0.4), ("mine", 0.4), ("twice", 0.2)):
        read = read_log(tmp_path / log)
        assert read["time_to_completion"].tolist() == pytest.approx(list(seconds * read["episode_step_count"])), log
        assert read["episode_step_count"].tolist() == [20]


def test_wrong_option_starts_no_log(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="size: found"):
        small().run(Circler(), tmp_path / "log", size=-1)
    assert not (tmp_path / "log").exists()
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "letter.txt").touch()
    with pytest.raises(driftworld.MetricsError):
        small().run(Circler(), tmp_path / "taken", **SMALL)
    with pytest.raises(ValueError, match="log: found '/', expected"):
        small().run(Circler(), "/", **SMALL)


def test_log_may_be_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert small(max_steps=2).run(Pupil(), ".", **SMALL).finished
    assert (tmp_path / "here.agent" / "00000016").is_dir() and len(read_log(tmp_path / "here")) == 19


def test_equivalent_options_are_noted_equally(tmp_path: Path) -> None:
    curriculum, rows_of_actions = small(max_steps=2), [[3.0, 4.0, 0.0], [-3.0, 4.0, 0.0]]

    class First(Circler):
        def act(self, observation: Any, info: dict[str, Any]) -> Any:
            return 0

    curriculum.run(First(), tmp_path / "log", size=8, modalities=["rgb"], actions=rows_of_actions)
    again = {"modalities": ("rgb",), "size": np.int64(8), "actions": np.array(rows_of_actions), "supersampling": None}
    assert curriculum.run(First(), tmp_path / "log", **again).finished
    with pytest.raises(CurriculumError, match="/made_from/environment/modalities"):
        curriculum.run(First(), tmp_path / "log", **{**again, "modalities": "rgb"})


#: A task with rocks that cannot be placed in some worlds, and with a parameter that must not have values near 5.
QUARRY = {
    "version": 2,
    "name": "quarry",
    "require": ["x <= 4 or x >= 6"],
    "parameters": {
        "x": {"role": "variant", "type": "number", "affects": ["T"], "range": [0, 10], "default": 0},
        "rocks": {"role": "variant", "type": "integer", "affects": ["S"], "range": [0, 4], "default": 0},
    },
    "world": {"max_steps": 3, "environment_params": {"map_size": [40, 40]}},
    "groups": [
        {
            "name": "rocks",
            "count": {"param": "rocks"},
            "object": {"class": "rock"},
            "separation": 5,
            "keep_out": {"walls": 0, "agent": 0},
            "placement": {"box": {"low": [10, 10], "high": [18, 18]}},
        }
    ],
    "variants": {"low": {}, "high": {"x": 10}, "full": {"rocks": 4}},
}


def test_undrawable_worlds_are_found_and_skipped(tmp_path: Path) -> None:
    task = tmp_path / "quarry.json"
    task.write_text(json.dumps(QUARRY), encoding="utf-8")
    trial = TaskSpec.load(task).variant("full").try_worlds(30)
    assert trial["worlds"] == 30 and 0 < trial["placement"] == len(trial["failed"])
    with pytest.raises(CurriculumError, match="worlds cannot be drawn"):
        Curriculum.design(f"{task}#low", f"{task}#high", drift="linear", learn=21)
    curriculum = Curriculum.design(f"{task}#low", f"{task}#high", drift="linear", learn=21, eval_episodes=1, worlds=0)
    drift = next(trial for trial in curriculum.try_worlds(2) if trial["variant"].endswith("low..high"))
    assert drift["requirement"] == 3 and drift["failed"][0]["progress"] == 0.45
    log = tmp_path / "log"
    with pytest.raises(CurriculumError, match=r"quarry#low\.\.high at progress 0\.45"):
        curriculum.run(Circler(), log, modalities="rgb", size=8)
    seen_rewards: list[float] = []
    summary = curriculum.run(
        Circler(), log, skip_undrawable=True, modalities="rgb", size=8, watch=lambda now, reward: seen_rewards.append(reward)
    )
    assert summary.finished and summary.skipped == 3 and summary.experiences == 22
    assert [one["experience"] for one in summary.left_out] == [11, 12, 13]
    assert [np.isnan(reward) for reward in seen_rewards[:4]] == [True, True, True, False]
    assert validate_log(log)["valid"]
    rewards = read_log(log).columns["reward"]
    assert len(rewards) == 25 and np.isnan(rewards).sum() == 3
    again = curriculum.run(Circler(), log, skip_undrawable=True, modalities="rgb", size=8)
    assert again == summary and (summary.resumed, again.resumed) == (11, 25)
    assert str(summary).endswith(f"\nresumed {log} after 11 experiences")
    assert str(again).endswith(f"\nnothing was run: {log} is already finished; for another lifetime, pass another folder")
