"""Recorded episodes replay: from curricula in one or many environments, from custom loops, and after an interruption."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from driftworld import Curriculum, DriftworldEnv, DriftworldVectorEnv, LogWriter, Recording, read_log, replay
from small_lifetime import SMALL, Circler, Pupil, small


def recorded_lines(log: Path) -> dict[str, str]:
    return {str(path.relative_to(log)): path.read_text() for path in sorted(log.rglob("actions.jsonl"))}


class Wanderer:
    """Acts at random in each environment, seeded by the experience."""

    name = "wanderer"

    def __init__(self, num_envs: int) -> None:
        self.rngs = [np.random.default_rng(0)] * num_envs

    def begin(self, env: int, label: str | None, seed: int) -> None:
        self.rngs[env] = np.random.default_rng(seed)

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        return np.stack([rng.uniform([0, -90, 0], [10, 90, 1]).astype(np.float32) for rng in self.rngs])

    def learn(self, transition: Any) -> None: ...

    def freeze(self, frozen: bool) -> None: ...


def check(log: Path) -> None:
    """Replays every episode of a log: compares it with its row, and renders it."""
    rows = read_log(log)
    for number, reward, steps in zip(rows["exp_num"], rows["reward"], rows["episode_step_count"], strict=True):
        recording = Recording.read(log, int(number))
        assert (recording.reward, recording.steps) == (reward, steps)
        frames = recording.frames(size=8, every=1000)
        assert frames.shape == (2, 8, 8, 3)
        assert frames.dtype == np.uint8


def test_recorded_lifetime_replays(tmp_path: Path) -> None:
    small().run(Pupil(), tmp_path / "plain", **SMALL)
    small().run(Pupil(), tmp_path / "log", record=True, **SMALL)
    plain, log = read_log(tmp_path / "plain"), read_log(tmp_path / "log")
    assert list(plain["reward"]) == list(log["reward"])
    assert not recorded_lines(tmp_path / "plain")
    check(tmp_path / "log")


@pytest.mark.parametrize("num_envs", [1, 3])
def test_recorded_lifetime_in_many_environments_replays(tmp_path: Path, num_envs: int) -> None:
    small().run_vector(Wanderer(num_envs), tmp_path / "log", num_envs=num_envs, record=True, frame_skip=2, **SMALL)
    check(tmp_path / "log")
    # The recorded world includes the environment's options.
    assert Recording.read(tmp_path / "log", 0).world()["agent_params"]["frame_skip"] == 2


def test_interrupted_recorded_lifetime_keeps_recording(tmp_path: Path) -> None:
    small().run(Pupil(), tmp_path / "whole", record=True, **SMALL)
    for stop in (1, 7, 12):
        log = tmp_path / f"stopped-{stop}"
        small().run(Pupil(), log, record=True, watch=lambda experience, _, stop=stop: experience.number < stop, **SMALL)
        # Simulates a process killed while writing, in the middle of a block.
        last = max(log.rglob("actions.jsonl"), key=lambda path: path.stat().st_mtime_ns)
        if last.read_text() != (tmp_path / "whole" / last.relative_to(log)).read_text():
            with last.open("a") as file:
                file.write('{"experience":')
        small().run(Pupil(), log, **SMALL)
        assert recorded_lines(log) == recorded_lines(tmp_path / "whole")


@pytest.mark.parametrize("actions", ["normalized", "discrete"])
def test_custom_loop_records_its_episodes(tmp_path: Path, actions: str) -> None:
    env = DriftworldEnv("find_objects#red", size=8, actions=actions, max_steps=20)
    env.record()
    env.action_space.seed(3)
    seen: list[list[Any]] = []
    with LogWriter(tmp_path / "log", ["reward", "episode_step_count"]) as log:
        for number in range(3):
            env.reset(seed=number)
            done, earned, steps = False, 0.0, 0
            positions = [env.state()["agent_params"]["coordinates"]]
            while not done:
                _, reward, terminated, truncated, _ = env.step(env.action_space.sample())
                done, earned, steps = terminated or truncated, earned + float(reward), steps + 1
                positions.append(env.state()["agent_params"]["coordinates"])
            seen.append(positions)
            recording = env.recording()
            assert (recording.steps, recording.reward) == (steps, earned)
            log.write(
                block_num=0,
                exp_num=number,
                block_type="train",
                task_name="findobjects_red",
                recording=recording,
                reward=earned,
                episode_step_count=steps,
            )
    check(tmp_path / "log")
    for number, positions in enumerate(seen):
        recording = Recording.read(tmp_path / "log", number)
        again = DriftworldEnv(world=recording.world(), actions="discrete" if actions == "discrete" else "normalized")
        again.reset()
        for action, position in zip(recording.actions, positions[1:], strict=True):
            again.step(action)
            assert again.state()["agent_params"]["coordinates"] == position


@pytest.mark.parametrize("autoreset", ["next_step", "same_step", "disabled"])
def test_each_vector_environment_is_recorded(autoreset: str) -> None:
    envs = DriftworldVectorEnv("find_objects#red", num_envs=2, size=8, max_steps=5, autoreset_mode=autoreset)
    with pytest.raises(RuntimeError, match="record"):
        envs.recording(0)
    envs.record()
    envs.action_space.seed(1)
    envs.reset(seed=4)
    for _ in range(5):
        envs.step(envs.action_space.sample())
    for env in range(2):
        recording = envs.recording(env)
        assert recording.steps == 5
        assert recording.frames(size=4).shape == (6, 4, 4, 3)


def test_recording_started_after_an_episode_has_no_end() -> None:
    env = DriftworldEnv("find_objects", size=8, max_steps=1)
    env.reset(seed=0)
    assert env.step(env.action_space.sample())[3]
    env.record()
    recording = env.recording()
    assert (recording.steps, recording.ended_by) == (0, None)


def test_episode_is_rendered_in_any_size_and_view(tmp_path: Path) -> None:
    env = DriftworldEnv("find_objects#red", size=8, max_steps=10)
    env.record()
    env.reset(seed=0)
    for _ in range(10):
        env.step(env.action_space.sample())
    recording = env.recording()
    assert recording.frames(size=24, view="both").shape == (11, 24, 48, 3)
    assert recording.frames(size=24, view="above", every=3).shape == (5, 24, 24, 3)
    depth = recording.frames(size=24, modality="depth")
    assert (depth[..., 0] == depth[..., 1]).all()
    for name, signature in (("e.gif", b"GIF89a"), ("e.apng", b"\x89PNG"), ("e.png", b"\x89PNG")):
        recording.save(tmp_path / name, size=24)
        assert (tmp_path / name).read_bytes().startswith(signature)
    sheets = {}
    for view, modality in (("agent", "rgb"), ("agent", "depth"), ("above", "rgb"), ("both", "rgb"), ("both", "depth")):
        recording.save(tmp_path / "e.png", size=24, view=view, modality=modality)
        sheets[view, modality] = (tmp_path / "e.png").read_bytes()
    assert len(set(sheets.values())) == len(sheets)
    with pytest.raises(ValueError, match="modality: found depth for the view from above"):
        recording.save(tmp_path / "e.png", view="above", modality="depth")
    assert recording._repr_png_().startswith(b"\x89PNG")
    assert repr(recording) == f"<Recording of episode 0: 10 steps, reward {recording.reward:g}, ended by steps>"
    assert pickle.loads(pickle.dumps(recording)) == recording
    with pytest.raises(ValueError, match="expected one of agent, above, both"):
        recording.frames(view="behind")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="ffmpeg"):
        recording.save(tmp_path / "e.mp4")


def test_missing_or_damaged_recording_is_reported(tmp_path: Path) -> None:
    log = tmp_path / "log"
    small().run(Circler(), log, record=True, **SMALL)
    assert replay(log, 1, tmp_path / "e.gif", size=8) is None
    frames = replay(log, 1, size=8)
    assert frames is not None and len(frames) == Recording.read(log, 1).steps + 1
    with pytest.raises(driftworld.DriftworldError, match="found no episode 999"):
        replay(log, 999)
    first = next(iter(sorted(log.rglob("actions.jsonl"))))
    lines = first.read_text().splitlines(keepends=True)
    episode = json.loads(lines[2])
    episode["reward"] += 1.0
    first.write_text("".join([*lines[:2], json.dumps(episode) + "\n", *lines[3:]]))
    with pytest.raises(driftworld.CurriculumError, match=r"actions\.jsonl: line 3: found"):
        replay(log, episode["experience"])
    Curriculum.design("find_objects#red", learn=1, eval_episodes=1).run(Circler(), tmp_path / "none", max_steps=3, **SMALL)
    with pytest.raises(driftworld.DriftworldError, match="found no recording of episode 0"):
        replay(tmp_path / "none", 0)
