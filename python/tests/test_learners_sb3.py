"""In curricula, Stable-Baselines3 models learn as with their own ``learn``, and evaluations do not change them."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from driftworld import Curriculum, CurriculumError

pytestmark = pytest.mark.learners

OPTIONS: dict[str, Any] = {"modalities": "rgb", "size": 36, "actions": "discrete", "max_steps": 7}
NUMBERS: dict[str, Any] = {**OPTIONS, "actions": "normalized", "interact": False}
PPO = {"n_steps": 8, "batch_size": 8, "n_epochs": 2, "learning_rate": lambda left: 1e-3 * left}
DQN = {"buffer_size": 60, "batch_size": 4, "learning_starts": 16, "train_freq": 4, "target_update_interval": 8, "exploration_fraction": 0.5}
SAC = {"buffer_size": 60, "batch_size": 4, "learning_starts": 8, "train_freq": 2, "gradient_steps": -1}
#: Name of the model, its settings, and the environment options.
MODELS = {
    "PPO": (PPO, OPTIONS),
    "PPO dict": (PPO, {**OPTIONS, "modalities": ["rgb", "state"]}),
    "PPO numbers": (PPO, NUMBERS),
    "A2C": ({"n_steps": 5}, OPTIONS),
    "DQN": (DQN, OPTIONS),
    "DQN dict": (DQN, {**OPTIONS, "modalities": ["rgb", "state"]}),
    "SAC": (SAC, NUMBERS),
    "TD3": (SAC, NUMBERS),
}
TOTAL = 96


def curriculum(learn: int, *, evaluate: int = 0, seed: int = 4, task_label: str = "none") -> Curriculum:
    """One task; or, with evaluations, two tasks that are evaluated before, between and after learning."""

    def block(kind: str, *variants: str) -> dict[str, Any]:
        count = learn if kind == "learning" else evaluate
        regimes = [{"task": "find_objects", "variant": name, "count": count, "seed": seed} for name in variants]
        return {"type": kind, "regimes": regimes}

    blocks = [block("learning", "red")]
    if evaluate:
        evaluation = block("evaluation", "red", "blue")
        blocks = [evaluation, *blocks, evaluation, block("learning", "blue"), evaluation]
    return Curriculum.from_dict({"version": 1, "name": "small", "task_label": task_label, "blocks": blocks})


def make_model(kind: str, env: Any, **settings: Any) -> Any:
    sb3 = pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    pytest.importorskip("torch").set_num_threads(1)
    name, _, _ = kind.partition(" ")
    dictionary = isinstance(env.observation_space, gym.spaces.Dict)
    policy = "MultiInputPolicy" if dictionary else "CnnPolicy"
    small = {"features_extractor_kwargs": {"cnn_output_dim" if dictionary else "features_dim": 16}, "net_arch": [8]}
    return getattr(sb3, name)(policy, env, device="cpu", policy_kwargs=small, **{"seed": 3, **MODELS[kind][0], **settings})


def make_envs(plan: Curriculum, num_envs: int, **options: Any) -> Any:
    """Environments that define a model's spaces."""
    from stable_baselines3.common.vec_env import DummyVecEnv

    return DummyVecEnv([lambda: plan.environment(**options)] * num_envs)


def make_agent(kind: str, plan: Curriculum, num_envs: int = 1, total: int = TOTAL, policy: str | None = None, **settings: Any) -> Any:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import Agent

    return Agent(make_model(kind, make_envs(plan, num_envs, **MODELS[kind][1]), **settings), total_timesteps=total, policy=policy)


def digest(model: Any) -> str:
    """A hash of a model's weights."""
    return hashlib.sha256(b"".join(value.numpy().tobytes() for value in model.policy.state_dict().values())).hexdigest()


def record_updates(model: Any) -> list[tuple[int, str]]:
    """Records each update: the number of decisions so far, and the weights."""
    updates: list[tuple[int, str]] = []
    train = model.train

    def train_and_record(*arguments: Any, **options: Any) -> None:
        train(*arguments, **options)
        updates.append((model.num_timesteps, digest(model)))

    model.train = train_and_record
    return updates


class PlannedEnv(gym.Wrapper[Any, Any, Any, Any]):
    """Starts the next experience of a plan at each reset; several environments share the plan."""

    def __init__(self, env: Any, plan: Curriculum, started: list[int]) -> None:
        super().__init__(env)
        self._plan, self._started = plan._plan, started

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        self._started.append(len(self._started))
        return self.env.reset(options={"world": self._plan.world(self._started[-1])})


@pytest.mark.parametrize(("kind", "num_envs"), [*((kind, 1) for kind in MODELS), ("PPO", 4), ("PPO numbers", 4), ("A2C", 4), ("DQN", 4), ("TD3", 4)])
def test_model_learns_the_same_weights_as_with_its_own_learn(kind: str, num_envs: int) -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from stable_baselines3.common.vec_env import DummyVecEnv

    plan, options = curriculum(18), MODELS[kind][1]
    started: list[int] = []
    own = make_model(kind, DummyVecEnv([lambda: PlannedEnv(plan.environment(**options), plan, started)] * num_envs))
    expected = record_updates(own)
    own.learn(TOTAL)
    agent = make_agent(kind, plan, num_envs)
    found = record_updates(agent.model)
    if num_envs == 1:
        plan.run(agent, **options)
    else:
        plan.run_vector(agent, num_envs=num_envs, **options)
    # The last update may have a learning rate of 0.
    assert len({digest for _, digest in expected}) >= max(2, len(expected) - 1)
    assert found[: len(expected)] == expected


@pytest.mark.parametrize(("kind", "num_envs"), [("PPO", 1), ("PPO", 4), ("DQN", 1), ("DQN", 4), ("PPO numbers", 2)])
def test_evaluations_change_no_weights(kind: str, num_envs: int) -> None:
    found = []
    for evaluate in (1, 5):
        plan = curriculum(8, evaluate=evaluate)
        agent = make_agent(kind, plan, num_envs, policy="sampled")
        updates = record_updates(agent.model)
        run = plan.run_vector if num_envs > 1 else plan.run
        run(agent, **MODELS[kind][1], **({"num_envs": num_envs} if num_envs > 1 else {}))
        found.append(updates)
    assert len(found[0]) >= 2
    assert found[0] == found[1]


@pytest.mark.parametrize(("kind", "num_envs"), [("PPO", 1), ("PPO dict", 4), ("DQN", 4)])
def test_killed_run_resumes_to_the_same_weights(kind: str, num_envs: int, tmp_path: Path) -> None:
    plan = curriculum(10, evaluate=2)

    def run_log(log: str, seed: int = 3, **options: Any) -> Any:
        agent = make_agent(kind, plan, num_envs, seed=seed)
        if num_envs == 1:
            summary = plan.run(agent, tmp_path / log, **MODELS[kind][1], **options)
        else:
            summary = plan.run_vector(agent, tmp_path / log, num_envs=num_envs, **MODELS[kind][1], **options)
        return summary, agent.model

    whole, model = run_log("whole")
    assert not run_log("killed", watch=lambda experience, _: experience.number < 22)[0].finished
    summary, again = run_log("killed")
    assert summary.finished and summary.regimes == whole.regimes
    assert (again.num_timesteps, digest(again)) == (model.num_timesteps, digest(model))
    saved = tmp_path / "killed.agent"
    own = type(model).load(next(saved.glob("0*")) / "model.zip", device="cpu")
    assert own.num_timesteps == model.num_timesteps
    with pytest.raises(CurriculumError, match="/made_from/agent/seed: found 3, expected 4 as in this run"):
        run_log("killed", seed=4)


@pytest.mark.parametrize("kind", ["PPO", "PPO dict", "A2C"])
def test_on_policy_update_skips_environments_without_an_experience(kind: str) -> None:
    # Four experiences of 7 steps, then the fifth alone.
    plan = curriculum(5)
    agent = make_agent(kind, plan, 4, n_steps=14)
    model, sizes, batch = agent.model, [], MODELS[kind][0].get("batch_size")
    train = model.train
    model.train = lambda: (sizes.extend(len(part.returns) for part in model.rollout_buffer.get(batch)), train())
    plan.run_vector(agent, num_envs=4, **MODELS[kind][1])
    assert (sum(sizes), model.num_timesteps) == (35, 35)
    assert np.isfinite(model.policy.predict_values(model.policy.obs_to_tensor(model.observation_space.sample())[0]).item())


def test_off_policy_rows_contain_only_steps_of_experiences() -> None:
    plan = curriculum(5)
    agent = make_agent("DQN", plan, 4)
    plan.run_vector(agent, num_envs=4, **OPTIONS)
    buffer = agent.model.replay_buffer
    assert (buffer.pos, agent.model.num_timesteps) == (8, 32)
    # The fifth experience's last steps wait for a row of their own; all finished experiences were truncated.
    assert buffer.dones.sum() == buffer.timeouts.sum() == 4


def test_model_that_remembers_evaluations_is_refused() -> None:
    plan = curriculum(2, evaluate=2)
    agent = make_agent("PPO", plan, policy="sampled")
    agent._evaluation_randomness = lambda _: __import__("contextlib").nullcontext()
    with pytest.raises(CurriculumError, match="once more"):
        plan.run(agent, **OPTIONS)


def test_no_temporary_files_remain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    plan = curriculum(2)
    plan.run_vector(make_agent("PPO", plan, 2), num_envs=2, **OPTIONS)
    assert list(tmp_path.iterdir()) == []


def test_label_in_the_observation_reaches_the_model() -> None:
    options = {**OPTIONS, "modalities": ["rgb"]}
    plan = curriculum(4, evaluate=1, task_label="observation")
    env = plan.environment(**options)
    assert set(env.observation_space.spaces) == {"rgb", "task"}
    from driftworld.adapters.sb3 import Agent

    model = make_model("PPO dict", env)
    assert plan.run(Agent(model, total_timesteps=TOTAL), **options).finished


def test_models_that_would_learn_differently_are_refused() -> None:
    sb3 = pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3")
    from driftworld.adapters.sb3 import Agent
    from stable_baselines3.common.vec_env import VecFrameStack, VecNormalize

    plan = curriculum(2)

    def expect(error: type[Exception], match: str, model: Any, **options: Any) -> None:
        with pytest.raises(error, match=match):
            Agent(model, **options)

    envs = make_envs(plan, 2, **OPTIONS)
    expect(TypeError, "found list", [])
    expect(ValueError, "total_timesteps: found none for the model's exploration_schedule", make_model("DQN", envs))
    expect(ValueError, "total_timesteps: found none for the model's lr_schedule", make_model("PPO", envs))
    expect(ValueError, "policy: found 'best'", make_model("A2C", envs), policy="best")
    expect(ValueError, "found optimize_memory_usage=True with 2", make_model("DQN", envs, optimize_memory_usage=True, replay_buffer_kwargs={"handle_timeout_termination": False}), total_timesteps=9)  # fmt: skip
    expect(ValueError, "in VecNormalize", make_model("A2C", VecNormalize(envs, norm_obs=False)))
    expect(ValueError, "in VecFrameStack", make_model("A2C", VecFrameStack(envs, 2)))
    expect(ValueError, "use_sde", sb3.PPO("CnnPolicy", make_envs(plan, 1, **NUMBERS), use_sde=True, device="cpu"))

    class OwnRollouts(sb3.PPO):  # type: ignore[misc, name-defined, unused-ignore]
        def collect_rollouts(self, *_: Any, **__: Any) -> bool:
            return True

    expect(TypeError, "OwnRollouts, which collects rollouts its own way", OwnRollouts("CnnPolicy", envs, device="cpu"))
    agent = Agent(make_model("A2C", envs))
    with pytest.raises(ValueError, match="expected .*; make the model with"):
        plan.run_vector(agent, num_envs=2, **{**OPTIONS, "size": 40})
    with pytest.raises(ValueError, match="num_envs=2"):
        plan.run_vector(agent, num_envs=3, **OPTIONS)
    with pytest.raises(ValueError, match="num_envs=2"):
        plan.run(agent, **OPTIONS)
