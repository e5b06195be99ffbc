"""PPO: advantages match a direct sum, steps of idle environments are not learned from, evaluations do not change
learning, and resumed runs are identical bit for bit.
"""

from __future__ import annotations

import builtins
import importlib
import pickle
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from conftest import ROOT
from small_learners import OPTIONS, Steps, curriculum, package, run_lifetime, small

needs_torch = pytest.mark.learners


@pytest.fixture
def learners() -> Any:
    """The package."""
    return package()


KINDS = [
    "PPO", "FineTuning", "ResetOptimizer", "FromScratch", "L2", "EWC", "OnlineEWC", "PackNet", "CLEAR", "ShrinkAndPerturb", "RecurrentPPO"
]  # fmt: skip


def test_import_without_torch_names_the_package_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def refuse(name: str, *rest: Any) -> Any:
        if name.partition(".")[0] == "torch":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    for name in [name for name in sys.modules if name.startswith("driftworld.learners")]:
        monkeypatch.delitem(sys.modules, name)
    with pytest.raises(ImportError, match=r'found no torch.*pip install "torch>=2\.1"'):
        importlib.import_module("driftworld.learners")


@needs_torch
def test_advantages_equal_the_direct_sum_within_episodes(learners: Any) -> None:
    torch = sys.modules["torch"]
    rng = torch.Generator().manual_seed(1)
    length, envs, discount, trace = 12, 5, 0.9, 0.8
    rollout = learners.Rollout(length, envs, 8, 5)
    for name in ("rewards", "values", "last_values"):
        getattr(rollout, name).normal_(generator=rng)
    rollout.terminated = torch.rand(length, envs, generator=rng) < 0.2
    rollout.ended = rollout.terminated | (torch.rand(length, envs, generator=rng) < 0.2)
    found = importlib.import_module("driftworld.learners.rollout").gae(rollout, discount, trace)

    def td_error(t: int, env: int) -> float:
        following = rollout.last_values[t, env] if rollout.ended[t, env] else rollout.values[t + 1, env]
        following = 0.0 if rollout.terminated[t, env] else following
        return float(rollout.rewards[t, env] + discount * following - rollout.values[t, env])

    for env in range(envs):
        for t in range(length):
            end = next((k for k in range(t, length) if rollout.ended[k, env]), length - 1)
            expected = sum((discount * trace) ** (k - t) * td_error(k, env) for k in range(t, end + 1))
            assert found[t, env].item() == pytest.approx(expected, abs=1e-5)


@needs_torch
@pytest.mark.parametrize("kind", ["PPO", "RecurrentPPO"])
def test_truncation_is_valued_by_the_episodes_own_last_image(learners: Any, kind: str) -> None:
    torch = sys.modules["torch"]
    learner = small(kind)
    steps = Steps(learner, terminates=0.0, truncates=0.0, idles=0.0)
    for env in range(4):
        learner.begin(env, None, env)
    steps.take(2)
    last = steps.images()
    learner.act(steps.seen, {})
    with torch.no_grad():
        # Before the next episode's first image is processed, with this episode's memory.
        expected = learner.values_of(torch.from_numpy(last), torch.arange(4))
    yes, no = np.array([True, False, False, False]), np.zeros(4, dtype=bool)
    learner.learn(driftworld.VectorTransition(steps.seen, None, np.zeros(4), no, yes, last, ~no, {}))
    learner.begin(0, None, 9)
    learner.act(steps.images(), {})
    assert learner.rollout.last_values[2, 0].item() == pytest.approx(expected[0].item(), abs=1e-6)
    assert learner.rollout.following(learner.rollout.values)[2, 0] == learner.rollout.last_values[2, 0]
    assert not learner.rollout.last_values[2, 1:].any()


@needs_torch
@pytest.mark.parametrize("kind", ["PPO", "CLEAR", "RecurrentPPO"])
def test_idle_environments_are_not_learned_from(learners: Any, kind: str) -> None:
    torch = sys.modules["torch"]
    digests = []
    for noise in (0, 1):
        learner, rng = small(kind), np.random.default_rng(5)
        other = np.random.default_rng(noise)
        for env in range(4):
            learner.begin(env, None, env)
        idle = np.array([False, False, True, True])
        for _ in range(8):
            images = rng.integers(0, 256, (4, 8, 8, 3), dtype=np.uint8)
            following = rng.integers(0, 256, (4, 8, 8, 3), dtype=np.uint8)
            images[idle] = other.integers(0, 256, (2, 8, 8, 3), dtype=np.uint8)
            rewards = np.where(idle, other.random(4), rng.random(4))
            actions = learner.act(images, {})
            no = np.zeros(4, dtype=bool)
            learner.learn(driftworld.VectorTransition(images, actions, rewards, no, no, following, ~idle, {}))
        assert learner.decisions == 16 and learner.updates > 0
        digests.append(torch.cat([weight.flatten() for weight in learner.network.parameters()]))
    assert torch.equal(*digests)


@needs_torch
@pytest.mark.parametrize("kind", KINDS)
def test_saved_learner_continues_to_the_same_digest(learners: Any, kind: str, tmp_path: Path) -> None:
    whole, half = small(kind), small(kind)
    for learner in (whole, half):
        run_lifetime(learner, None, "left")
    assert whole.updates > 0 and whole.digest() == half.digest()
    half.save(tmp_path / "saved")
    again = small(kind, seed=3)
    again.load(tmp_path / "saved")
    assert again.digest() == half.digest()
    for learner in (whole, again):
        run_lifetime(learner, None, "right")
    assert again.digest() == whole.digest() != half.digest()
    report = again.report()
    assert report["decisions"] == whole.decisions and report["tasks"] == (2 if whole.borders == "labels" else 1)
    assert report["memory_bytes"] > report["method_bytes"] >= 0 and report["seconds"] > 0


@needs_torch
@pytest.mark.parametrize(
    "kind, borders", [("PackNet", "labels"), ("OnlineEWC", "blocks"), ("CLEAR", "none"), ("RecurrentPPO", "none")]
)
def test_killed_lifetime_resumes_to_the_same_digest(learners: Any, kind: str, borders: str, tmp_path: Path) -> None:
    whole = run_lifetime(small(kind, borders=borders), tmp_path / "whole", "left", "right")
    seen = 0

    def kill(experience: Any, reward: float) -> bool:
        nonlocal seen
        seen += 1
        # This is in the second learning block; the last save was before the evaluation.
        return seen < 45

    plan = curriculum("left", "right", learn=24)
    options = {**OPTIONS, "size": 8, "max_steps": 6, "num_envs": 4, "num_threads": 1}
    assert not plan.run_vector(small(kind, borders=borders), tmp_path / "log", watch=kill, **options).finished
    resumed = small(kind, borders=borders)
    assert plan.run_vector(resumed, tmp_path / "log", **options).finished
    assert resumed.digest() == whole.digest()


@needs_torch
@pytest.mark.parametrize("kind", ["EWC", "PackNet", "CLEAR", "RecurrentPPO"])
def test_evaluations_do_not_change_learning(learners: Any, kind: str) -> None:
    # run_vector refuses a learner that acts differently in a repeated evaluation.
    digests = set()
    for policy, evaluate in (("sampled", 4), ("sampled", 9), ("greedy", 4)):
        digests.add(run_lifetime(small(kind, policy=policy), None, "left", "right", evaluate=evaluate).digest())
    assert len(digests) == 1


@needs_torch
def test_global_random_numbers_are_neither_used_nor_changed(learners: Any) -> None:
    torch = sys.modules["torch"]
    digests = set()
    for seed in (1, 2):
        torch.manual_seed(seed)
        np.random.seed(seed)
        before = torch.get_rng_state(), np.random.get_state()[1].copy()
        for kind in ("EWC", "CLEAR", "ShrinkAndPerturb"):
            digests.add(run_lifetime(small(kind), None, "left", "right").digest())
        assert torch.equal(before[0], torch.get_rng_state())
        assert (before[1] == np.random.get_state()[1]).all()
    assert len(digests) == 3


@needs_torch
def test_task_borders_follow_the_option(learners: Any) -> None:
    class Noting(learners.PPO):  # type: ignore[misc, name-defined]
        def __init__(self, *arguments: Any, **options: Any) -> None:
            super().__init__(*arguments, **options)
            self.noted: list[tuple[str, str | None, int]] = []

        def begin_task(self, label: str | None) -> None:
            self.noted.append(("begin", label, self.time))

        def end_task(self, label: str | None) -> None:
            self.noted.append(("end", label, self.time))

    found = {}
    for borders in ("none", "labels", "blocks"):
        learner = Noting(5, 4, size=8, borders=borders, settings=learners.Settings(rollout=8, minibatch=16))
        found[borders] = [row[:2] for row in run_lifetime(learner, None, "left", "left", "right").noted]
        assert all(time == 0 for *_, time in learner.noted), "at a border, every step so far has been learned from"
    first, left, right = found["none"][0], found["labels"][0][1], found["labels"][-1][1]
    assert "left" in str(left) and "right" in str(right)
    assert found["none"] == [first] == [("begin", left)]
    assert found["labels"] == [("begin", left), ("end", left), ("begin", right)]
    assert found["blocks"] == [("begin", left), ("end", left), ("begin", left), ("end", left), ("begin", right)]
    with pytest.raises(ValueError, match=r'without a label.*task_label="info".*borders="blocks"'):
        run_lifetime(small("EWC"), None, "left", task_label="none")
    run_lifetime(small("EWC", borders="blocks"), None, "left", "right", task_label="none")


@needs_torch
def test_finished_log_refuses_a_learner_with_other_arguments(learners: Any, tmp_path: Path) -> None:
    log = tmp_path / "log"
    digest = run_lifetime(small("L2", strength=0.5), log, "left").digest()
    assert run_lifetime(small("L2", strength=0.5), log, "left").digest() == digest
    for options, place in [
        ({"seed": 4}, "seed: found 3, expected 4"),
        ({"strength": 0.25}, "strength: found 0.5, expected 0.25"),
        ({"borders": "blocks"}, 'borders: found nothing, expected "blocks"'),
        ({"settings": learners.Settings(rollout=8, minibatch=16, clip=0.1)}, "settings/clip: found 0.2, expected 0.1"),
    ]:
        with pytest.raises(driftworld.CurriculumError, match=f"/made_from/agent/{place} as in this run"):
            run_lifetime(small("L2", **{"strength": 0.5, **options}), log, "left")


@needs_torch
def test_arguments_are_noted_with_defaults_however_they_are_passed(learners: Any) -> None:
    class Own(learners.PPO):  # type: ignore[misc, name-defined]
        def __init__(self, *arguments: Any, own: int = 2, **options: Any) -> None:
            super().__init__(*arguments, **options)

    noted = Own(5, 4).made_with
    assert noted == Own(num_actions=5, num_envs=4, seed=0, settings=learners.Settings()).made_with
    assert (noted["num_envs"], noted["own"], noted["settings"]["clip"]) == (4, 2, 0.2)
    assert pickle.loads(pickle.dumps(small("EWC"))).made_with == small("EWC").made_with


@needs_torch
@pytest.mark.parametrize("value", [None, float("nan"), "inf"])
def test_loss_that_is_not_finite_ends_the_run(learners: Any, value: Any) -> None:
    class Own(learners.PPO):  # type: ignore[misc, name-defined]
        name = "own"

        def extra_loss(self) -> Any:
            return sys.modules["torch"].tensor([float(value)]) if value == "inf" else value

    with pytest.raises(ValueError, match=f"own: extra_loss: found {value} in update 1, expected a finite number"):
        run_lifetime(small(Own), None, "left")


@needs_torch
def test_step_takes_a_tensor_of_one_number(learners: Any) -> None:
    with pytest.raises(TypeError, match=r"ppo: loss: found the number 0\.5, expected a tensor with gradients"):
        small().step(0.5)
    with pytest.raises(ValueError, match=r"ppo: loss: found shape \(3,\) in update 1"):
        small().step(sys.modules["torch"].ones(3))


@needs_torch
def test_learner_of_several_environments_is_refused_by_run(learners: Any) -> None:
    with pytest.raises(TypeError, match=r"agent: found a learner for several environments.*use run_vector"):
        curriculum("left", learn=1).run(small(), **OPTIONS)


@needs_torch
def test_border_hooks_without_borders_are_refused(learners: Any) -> None:
    class Own(learners.PPO):  # type: ignore[misc, name-defined]
        name = "own"

        def end_task(self, label: str | None) -> None:
            pass

    with pytest.raises(ValueError, match=r'own: found end_task without borders.*own_borders = "labels"'):
        small(Own)
    assert small(Own, borders="none").borders == "none"


@needs_torch
def test_misspelt_options_and_hooks_are_named(learners: Any) -> None:
    with pytest.raises(TypeError, match=r"EWC: found an option strenght, expected some of .*did you mean strength\?"):
        small("EWC", strenght=1.0)
    with pytest.warns(UserWarning, match=r"Own: found a method end_tasks, .*did you mean end_task\?"):
        type("Own", (learners.PPO,), {"end_tasks": lambda self, label: None, "distil": lambda self: None})


@needs_torch
def test_method_that_keeps_something_unsaved_warns(learners: Any, tmp_path: Path) -> None:
    class Keeping(learners.EWC):  # type: ignore[misc, name-defined]
        def __init__(self, *arguments: Any, weights: list[float], **options: Any) -> None:
            super().__init__(*arguments, **options)
            self.weights, self.old = weights, [weights]

    small("EWC").save(tmp_path / "silent")
    with pytest.warns(UserWarning, match="keeping: found old, but no method_state"):
        small(Keeping, weights=[1.0]).save(tmp_path / "warns")
    type("Saving", (Keeping,), {"method_state": lambda self: {"old": self.old}})(5, 4, size=8, weights=[1.0]).save(tmp_path / "saves")


@needs_torch
def test_method_is_named_and_noted_after_its_class(learners: Any, tmp_path: Path) -> None:
    class OwnMethod(learners.PPO):  # type: ignore[misc, name-defined]
        pull = 1.0

    log = tmp_path / "log"
    assert run_lifetime(small(OwnMethod), log, "left").report()["learner"] == "own_method"
    with pytest.raises(driftworld.CurriculumError, match=r'/agent: found "own_method", expected "ppo"'):
        run_lifetime(small(), log, "left")
    OwnMethod.pull = 2.0
    with pytest.raises(driftworld.CurriculumError, match=r"/made_from/agent/pull: found 1\.0, expected 2\.0"):
        run_lifetime(small(OwnMethod), log, "left")


@needs_torch
def test_arguments_of_any_kind_are_noted(learners: Any) -> None:
    class Odd(learners.PPO):  # type: ignore[misc, name-defined]
        def __init__(self, *arguments: Any, weights: Any = None, ratio: float = float("nan"), **options: Any) -> None:
            super().__init__(*arguments, **options)

    noted = Odd(5, 4, weights=sys.modules["torch"].ones(3)).made_with
    assert (noted["weights"], noted["ratio"]) == ("Tensor", "nan")
    noted = Odd(5, 4, weights=np.arange(2), ratio=np.float32(0.5)).made_with
    assert (noted["weights"], noted["ratio"]) == ([0, 1], 0.5)


@needs_torch
def test_seeds_of_learners_differ_between_lifetimes(learners: Any, tmp_path: Path) -> None:
    logs = [tmp_path / str(seed) for seed in (1, 2)]
    for seed, log in enumerate(logs):
        run_lifetime(small(seed=seed), log, "left", "right")
    assert driftworld.metrics(logs).varied["run_seed"] is True


@needs_torch
def test_action_table_of_another_length_is_refused(learners: Any, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="actions: found 4 rows, expected 5 rows as in the agent's num_actions"):
        run_lifetime(small(), tmp_path / "log", "left", actions=OPTIONS["actions"][:4])
    with pytest.raises(ValueError, match=r"actions: found no table, expected 5 rows.*pass actions="):
        run_lifetime(small(), tmp_path / "log", "left", actions="normalized")
    assert not (tmp_path / "log").exists()


@needs_torch
@pytest.mark.parametrize(
    "options, message",
    [
        ({"policy": "best"}, "policy: found 'best', expected one of sampled, greedy"),
        ({"borders": "some"}, "borders: found 'some', expected one of none, labels, blocks"),
        ({"size": 36}, "size: found 36, expected a multiple of 8, such as 32"),
    ],
)
def test_wrong_options_are_refused(learners: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        small(**options)


@needs_torch
@pytest.mark.parametrize(
    "name, value, bound",
    [
        ("rollout", 0, "at least 1"),
        ("minibatch", 1, "at least 2"),
        ("discount", 1.5, "at most 1"),
        ("clip", 0, "more than 0"),
    ],
)
def test_numbers_out_of_range_are_refused(learners: Any, name: str, value: float, bound: str) -> None:
    with pytest.raises(ValueError, match=f"^{name}: found {value}, expected {bound}$"):
        learners.Settings(**{name: value})


@needs_torch
def test_more_environments_than_declared_are_refused(learners: Any) -> None:
    plan = curriculum("left", learn=8, evaluate=8)
    with pytest.raises(ValueError, match="found environment number 4, expected at most 3; pass run_vector num_envs=4"):
        plan.run_vector(small(), num_envs=6, **{**OPTIONS, "size": 8, "max_steps": 6})


@needs_torch
def test_images_of_the_wrong_size_are_refused_with_the_matching_options(learners: Any) -> None:
    with pytest.raises(ValueError, match=r'found observations \(4, 16, 16, 3\).*modalities="rgb", size=8'):
        run_lifetime(small(), None, "left", size=16)


@needs_torch
@pytest.mark.parametrize("steps", [1, 2, 31, 512, 513, 1025, 1535, 4095])
def test_no_minibatch_has_a_single_step(learners: Any, steps: int) -> None:
    torch = sys.modules["torch"]
    learner, rollout = learners.PPO(5, 8, size=8), learners.Rollout(512, 8, 8, 5)
    rollout.active.view(-1)[torch.randperm(4096)[:steps]] = True
    parts = list(learner.parts(rollout))
    # A standard deviation needs two steps; a rollout of one step is not learned from.
    assert sum(len(part) for part in parts) == (steps if steps > 1 else 0)
    assert all(2 <= len(part) <= 768 for part in parts)
    assert sorted(torch.cat(parts).tolist() if parts else []) == (
        rollout.active.flatten().nonzero().flatten().tolist() if steps > 1 else []
    )


@needs_torch
def test_learning_rate_falls_to_a_tenth_within_a_task(learners: Any) -> None:
    learner = small(settings=learners.Settings(rollout=8, minibatch=16, annealing=64))
    steps, rates = Steps(learner, idles=0.0), []
    for _ in range(4):
        steps.take(8)
        rates.append(learner.optimizer.param_groups[0]["lr"])
    assert rates == pytest.approx([5e-4, 1e-4, 1e-4, 1e-4])


@needs_torch
def test_ppo_learns_a_t_maze_in_20_000_decisions(learners: Any) -> None:
    learner, start = learners.PPO(5, 32, seed=1), time.process_time()
    options = {**OPTIONS, "size": 32, "num_envs": 32, "num_threads": 1}
    summary = curriculum("left", learn=1500, evaluate=64).run_vector(learner, **options)
    before, _, after = summary.regimes
    assert before["success_rate"] < 0.7 and after["success_rate"] > 0.95
    assert learner.decisions < 25_000
    assert time.process_time() - start < 30


@needs_torch
def test_cost_of_a_decision_is_measured(learners: Any) -> None:
    program = ROOT / "scripts" / "learners.py"
    done = subprocess.run([sys.executable, program, "--quick"], capture_output=True, text=True, check=True)
    assert re.fullmatch(r"\| ppo \| \d+ \| \d+ \| \d+ \|", done.stdout.splitlines()[-1]), done.stdout
