"""The Python examples run, have the properties that they claim, and have reproducible results. Learning success is not
tested.
"""

from __future__ import annotations

import argparse
import ast
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import driftworld
import gymnasium
import pytest
from driftworld import _native

FOLDER = Path(__file__).parents[2] / "examples" / "python"
EXAMPLES = sorted(path for path in FOLDER.glob("*.py") if path.stem != "record")
NOTEBOOKS = sorted((FOLDER / "notebooks").glob("*.py"))
RESULTS = sorted((FOLDER / "results").glob("*/config.json"))

learners = pytest.mark.learners


def run(program: Path, *arguments: str, cwd: Path) -> str:
    """A program's output; it must succeed, without a display."""
    environment = {**os.environ, "MPLBACKEND": "Agg", "SDL_VIDEODRIVER": "dummy"}
    done = subprocess.run(
        [sys.executable, str(program), *arguments],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        timeout=400,
        check=False,
    )
    assert done.returncode == 0, f"{program.name} {' '.join(arguments)}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def load(name: str) -> ModuleType:
    """An example as a module, without running it."""
    if str(FOLDER) not in sys.path:
        sys.path.insert(0, str(FOLDER))
    specification = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


def first_line(path: Path) -> str:
    """The first line of an example's docstring."""
    if path.parent.name == "notebooks":
        return next(line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("# # "))[4:]
    return (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").splitlines()[0]


def test_index_matches_the_first_line_of_each_example() -> None:
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    index = readme.split("<!-- index -->\n")[1].split("<!-- end of index -->")[0]
    paths = [path.relative_to(FOLDER).as_posix() for path in [*EXAMPLES, *NOTEBOOKS]]
    lines = [f"- [{path}]({path}): {first_line(FOLDER / path)}" for path in paths]
    assert index == "\n".join(lines) + "\n", "the index is\n" + "\n".join(lines)


@pytest.mark.parametrize("config", RESULTS, ids=[path.parent.name for path in RESULTS])
def test_result_names_worlds_that_are_still_drawn(config: Path) -> None:
    recorded = json.loads(config.read_text(encoding="utf-8"))
    assert recorded["command"].startswith("python examples/python/")
    assert recorded["worlds"]
    other = []
    for name, hashes in recorded["worlds"].items():
        path = name if name.partition("#")[0] in _native.built_in_names() else str(FOLDER.parents[1] / name)
        env = gymnasium.make("driftworld/Task-v0", task=path)
        if _native.load_variant(path).hash != hashes["variant"]:
            other.append(name)
        for seed, world_hash in hashes["first_worlds"].items():
            if env.reset(seed=int(seed))[1]["world_hash"] != world_hash:
                other.append(f"{name} under seed {seed}")
        env.close()
    if "outdated" in recorded:
        # Results from older worlds are marked as such, also on their page, until measured again.
        assert other
        assert "Measured before" in (config.parent / "README.md").read_text(encoding="utf-8")
    else:
        assert not other


@pytest.mark.parametrize("config", RESULTS, ids=[path.parent.name for path in RESULTS])
def test_result_has_page_curve_and_figure(config: Path) -> None:
    page = (config.parent / "README.md").read_text(encoding="utf-8")
    recorded = json.loads(config.read_text(encoding="utf-8"))
    assert recorded["command"] in page
    assert (config.parent / "curve.csv").read_text(encoding="utf-8").count("\n") > 3
    assert (config.parent / "curve.png").read_bytes().startswith(b"\x89PNG")


@learners
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_notebook_runs_as_a_program(notebook: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="notebooks draw")
    pytest.importorskip("pandas", reason="scores are shown as data frames")
    run(notebook, cwd=tmp_path)


@learners
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_notebook_is_valid_jupytext(notebook: Path) -> None:
    jupytext = pytest.importorskip("jupytext", reason="converts scripts to notebooks")
    kinds = [cell.cell_type for cell in jupytext.read(notebook).cells]
    assert kinds.count("code") >= 5
    assert kinds.count("markdown") >= 5


@learners
@pytest.mark.parametrize("name", ["cleanrl_ppo", "ppo_find_objects", "experts_and_sequential_ppo"])
def test_learner_runs_and_writes_its_result(name: str, tmp_path: Path) -> None:
    pytest.importorskip("torch", reason="the learners are networks")
    pytest.importorskip("matplotlib", reason="results have a figure")
    if name == "ppo_find_objects":
        pytest.importorskip("stable_baselines3", reason="the example uses its PPO")
    run(FOLDER / f"{name}.py", "--quick", "--results", str(tmp_path / "result"), cwd=tmp_path)
    recorded = json.loads((tmp_path / "result" / "config.json").read_text(encoding="utf-8"))
    assert {"command", "settings", "versions", "machine", "seconds", "worlds"} <= recorded.keys()
    assert str(tmp_path) not in json.dumps(recorded), "a result is the same wherever it is written to"
    assert (tmp_path / "result" / "curve.png").read_bytes().startswith(b"\x89PNG")


@learners
def test_replay_is_compared_without_running_anything_twice(tmp_path: Path) -> None:
    pytest.importorskip("torch", reason="the learners are networks")
    first = run(FOLDER / "replay_ppo.py", "--quick", cwd=tmp_path)
    assert "not run again" not in first
    assert "perf_maintenance_mrlep" in first
    assert (tmp_path / "logs" / "two_skies" / "replay_ppo.html").exists()
    second = run(FOLDER / "replay_ppo.py", "--quick", cwd=tmp_path)
    # Two experts of each of the two learners, and the two lifetimes.
    assert second.count("not run again") == 6
    assert second.splitlines()[-10:] == first.splitlines()[-10:]


@learners
def test_rllib_learns_on_several_runners(tmp_path: Path) -> None:
    pytest.importorskip("ray.rllib", reason="the example needs it")
    assert "steps  reward" in run(FOLDER / "rllib_ppo.py", "--quick", cwd=tmp_path)


@learners
def test_ray_results_do_not_depend_on_the_number_of_workers(tmp_path: Path) -> None:
    pytest.importorskip("ray.data", reason="the example needs it")
    answers = []
    for workers in ("1", "2"):
        output = run(FOLDER / "ray_sample_and_measure.py", "--quick", "--workers", workers, cwd=tmp_path)
        answers.append(json.loads(output[: output.rindex("}") + 1]))
    assert answers[0] == answers[1]
    assert answers[0]["variants"] == 60
    assert sum(answers[0]["distance"]["histogram"]) == 60


def one_environment(**columns: list[Any]) -> dict[str, Any]:
    """Columns of a rollout of one environment, as tensors of shape (length, 1)."""
    import torch

    return {name: torch.tensor(values).unsqueeze(1) for name, values in columns.items()}


def arguments_of_a_lifetime(**changes: Any) -> argparse.Namespace:
    """Arguments for a few experiences of the examples' curriculum."""
    return argparse.Namespace(**{"learn": 12, "evaluate": 4, "num_envs": 4, "again": True, "policy": "sampled", **changes})


def run_example(folder: Path, learner: Any, order: tuple[str, ...], **changes: Any) -> tuple[Any, dict[str, list[Any]]]:
    """Runs a learner through the examples' curriculum; returns the learner, and rewards and kinds from its log."""
    module = load("experts_and_sequential_ppo")
    arguments = arguments_of_a_lifetime(**changes)
    evaluated = changes.get("evaluated", module.VARIANTS)
    module.lifetime(learner, module.scenario(order, 1, arguments, evaluated), folder, arguments)
    log = driftworld.read_log(folder)
    return learner, {name: log[name].tolist() for name in ("block_type", "task_name", "reward", "episode_step_count")}


@learners
@pytest.mark.parametrize("name", ["Learner", "ReplayLearner"])
def test_number_of_evaluations_does_not_change_learning(name: str, tmp_path: Path) -> None:
    torch = pytest.importorskip("torch", reason="the learners are networks")
    torch.set_num_threads(1)
    make = getattr(load("experts_and_sequential_ppo"), name, None) or getattr(load("replay_ppo"), name)
    settings: dict[str, dict[str, Any]] = {
        "often": {}, "more": {"evaluate": 9}, "never": {"evaluated": ()}, "greedy": {"policy": "greedy"},
    }  # fmt: skip
    learned, networks = [], []
    for kind, changes in settings.items():
        learner = make(3, 4, changes.get("policy", "sampled"), length=32)
        learner, log = run_example(tmp_path / kind, learner, ("day", "evening"), **changes)
        learned.append([row for kind, row in zip(log["block_type"], log["reward"], strict=True) if kind == "train"])
        networks.append(torch.cat([parameter.flatten() for parameter in learner.network.parameters()]))
        assert learner.updates > 0
    assert len(learned[0]) == 24 and len(set(learned[0])) > 2
    assert all(rewards == learned[0] for rewards in learned)
    assert all(torch.equal(network, networks[0]) for network in networks)


@learners
def test_lifetime_starts_like_its_expert_and_replay_takes_as_many_steps(tmp_path: Path) -> None:
    torch = pytest.importorskip("torch", reason="the learners are networks")
    torch.set_num_threads(1)
    sequential, replay = load("experts_and_sequential_ppo").Learner, load("replay_ppo").ReplayLearner
    expert, first = run_example(tmp_path / "expert", sequential(3, 4, length=32), ("day",), evaluated=("day",))
    lifetime, whole = run_example(tmp_path / "lifetime", sequential(3, 4, length=32), ("day", "evening"))
    rehearsing, _ = run_example(tmp_path / "replay", replay(3, 4, length=32), ("day", "evening"))

    def block(log: dict[str, list[Any]]) -> list[Any]:
        rows = zip(log["block_type"], log["task_name"], log["reward"], log["episode_step_count"], strict=True)
        return [row for row in rows if row[0] == "train" and row[1].endswith("day")]

    assert block(first) == block(whole) and len(block(first)) == 12
    assert lifetime.updates == rehearsing.updates > expert.updates > 0
    # The log contains the policy: a different policy is a different run.
    info = json.loads((tmp_path / "lifetime" / "scenario_info.json").read_text(encoding="utf-8"))
    assert info["made_from"]["policy"] == "sampled"


@learners
def test_saved_learner_continues_unchanged(tmp_path: Path) -> None:
    torch = pytest.importorskip("torch", reason="the learners are networks")
    torch.set_num_threads(1)
    load("experts_and_sequential_ppo")
    make = load("replay_ppo").ReplayLearner
    learner, _ = run_example(tmp_path / "log", make(3, 4, length=32), ("day",))
    learner.save(tmp_path / "kept")
    again = make(4, 4, length=32)
    again.load(tmp_path / "kept")
    assert again.time == learner.time and again.updates == learner.updates
    for one, other in zip(learner.network.parameters(), again.network.parameters(), strict=True):
        assert torch.equal(one, other)
    assert again.digest() == learner.digest()
    assert again.reservoir.draw(2).rewards.tolist() == learner.reservoir.draw(2).rewards.tolist()


@learners
@pytest.mark.parametrize("name", ["cleanrl_ppo"])
def test_advantages_bootstrap_truncated_but_not_terminated_episodes(name: str) -> None:
    torch = pytest.importorskip("torch", reason="the learners are networks")
    module = load(name)
    rollout = module.Rollout(4, 1)
    # An episode of two steps, the step that only resets, and the first step of the next episode.
    columns = one_environment(
        rewards=[1.0, 2.0, 0.0, 4.0],
        values=[10.0, 20.0, 30.0, 40.0, 50.0],
        ended=[False, True, False, False],
        terminated=[False, False, False, False],
        counts=[True, True, False, True],
    )
    for column, values in columns.items():
        setattr(rollout, column, values)
    settings = {"discount": 0.5, "trace": 0.5}
    discount = settings["discount"]
    last = 2.0 + discount * 30.0 - 20.0  # the observation after the end is the episode's last, with value 30
    first = 1.0 + discount * 20.0 - 10.0 + discount * 0.5 * last
    assert rollout.advantages(**settings)[:2].flatten().tolist() == pytest.approx([first, last])
    rollout.terminated = torch.tensor([[False], [True], [False], [False]])
    assert rollout.advantages(**settings)[1].item() == pytest.approx(2.0 - 20.0)
