"""``Agent``: runs a Stable-Baselines3 model through a curriculum. Import it from ``driftworld.adapters.sb3``.

    options = {"modalities": "rgb", "size": 36, "actions": "discrete"}
    model = DQN("CnnPolicy", curriculum.environment(**options))
    curriculum.run(Agent(model, total_timesteps=100_000), "logs/dqn", **options)

The model's environment only defines the spaces and the number of environments; the curriculum makes its own.
"""

from __future__ import annotations

import copy
import inspect
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
from stable_baselines3.common.on_policy_algorithm import OnPolicyAlgorithm
from stable_baselines3.common.preprocessing import maybe_transpose
from stable_baselines3.common.save_util import load_from_pkl, save_to_pkl
from stable_baselines3.common.utils import obs_as_tensor, should_collect_more_steps
from stable_baselines3.common.vec_env import VecEnvWrapper, VecMonitor, VecTransposeImage

from driftworld._plain import described
from driftworld.lifetimes import Transition
from driftworld.vector_lifetimes import row_of

#: Attributes that a model keeps when another one is loaded into it.
_KEPT_ATTRIBUTES = ("env", "_vec_normalize_env", "_logger", "_custom_logger")
#: Schedules over the remaining share of ``total_timesteps``, for models that have them.
_SCHEDULES = ("lr_schedule", "clip_range", "clip_range_vf", "exploration_schedule")


class Agent:
    """Wraps a model that collects rollouts like Stable-Baselines3's ``OnPolicyAlgorithm`` or ``OffPolicyAlgorithm``:
    PPO, A2C, DQN, SAC, TD3.

    It updates the model when ``model.learn`` would, and the same experience leads to the same weights. Evaluations draw
    random numbers from the seeds of their experiences, and leave the model and the global random generators unchanged.
    In :meth:`driftworld.Curriculum.run_vector` all environments of an evaluation share one random stream, so an action
    also depends on the experiences that run beside it.

    Near the end of a block some environments are idle. Updates of on-policy models skip their steps. Off-policy models
    add a row to the replay buffer as soon as there are ``n_envs`` steps of any environments, and count rows.

    :meth:`save` writes a folder: ``model.zip``, for Stable-Baselines3's own ``load``, and ``rest.pkl`` with the buffer.
    Loading unpickles both, which may run code.

    Args:
        model: Made with ``curriculum.environment(**options)``, or with a ``DummyVecEnv`` of ``num_envs`` such
            environments.
        total_timesteps: The number of decisions after which schedules stay at their final value, as for
            ``model.learn``. It may be omitted if the model has no schedules.
        policy: ``"sampled"`` or ``"greedy"``, for evaluations; ``None`` means sampled for on-policy models, and greedy
            for the others.

    Raises:
        TypeError: If the model collects rollouts in its own way, like recurrent models.
        ValueError: If the model has a schedule but ``total_timesteps`` is missing, if its environment normalises or
            stacks observations, if it has ``use_sde``, or if options of its replay buffer do not support several
            environments.
    """

    def __init__(self, model: Any, *, total_timesteps: int | None = None, policy: str | None = None) -> None:
        kinds: dict[Any, type[_Collector]] = {OnPolicyAlgorithm: _OnPolicy, OffPolicyAlgorithm: _OffPolicy}
        kind = next((kind for kind in kinds if isinstance(model, kind)), None)
        self.name = type(model).__name__
        if kind is None or type(model).collect_rollouts is not kind.collect_rollouts:
            raise TypeError(f"model: found {self.name}, which collects rollouts its own way, expected a model such as PPO or DQN")
        _reject_unsupported(model, total_timesteps)
        self.model = model
        self.policy = policy or ("sampled" if kind is OnPolicyAlgorithm else "greedy")
        if self.policy not in ("sampled", "greedy"):
            raise ValueError(f"policy: found {policy!r}, expected sampled or greedy")
        arguments = {name: described(getattr(model, name, None)) for name in inspect.signature(type(model).__init__).parameters}
        numbers = {name: value for name, value in arguments.items() if isinstance(value, (int, float)) and name != "verbose"}
        #: The model's numeric arguments; a log can only be resumed with equal ones.
        self.made_with = {**numbers, "total_timesteps": total_timesteps}
        if not model.verbose and model.tensorboard_log is None and not model._custom_logger:
            # Stable-Baselines3's own logger creates a temporary folder and never removes it, even if it writes nothing.
            model.set_logger(Logger(folder=None, output_formats=[]))
        model._setup_learn(total_timesteps or 0)
        model.policy.set_training_mode(False)
        self._collector = kinds[kind](model, total_timesteps)
        self._generators = [np.random.default_rng() for _ in range(model.n_envs)]
        self._actions = copy.deepcopy(model.action_space)
        self._frozen = False

    def begin(self, *beginning: Any) -> None:
        """Seeds the experience that begins: ``(label, seed)``, or ``(env, label, seed)``."""
        env, seed = (beginning[0] if len(beginning) == 3 else 0), beginning[-1]
        if env >= len(self._generators):
            raise ValueError(f"Agent: found more environments than the model has, expected {len(self._generators)}; pass num_envs={len(self._generators)}")
        self._generators[env] = np.random.default_rng([seed, self.model.seed or 0])

    def freeze(self, frozen: bool) -> None:
        """Sets whether the agent is being evaluated."""
        self._frozen = frozen

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        """Actions for all environments, or the action of a single one."""
        is_many = "active" in infos
        observed = self._model_observations(observations if is_many else _batch_of_one(observations))
        if self._frozen:
            with self._evaluation_randomness(np.flatnonzero(infos["active"]) if is_many else np.zeros(1, dtype=int)):
                actions = self.model.predict(observed, deterministic=self.policy == "greedy")[0]
        else:
            actions = self._collector.act(observed)
        return actions if is_many else actions[0]

    def learn(self, transition: Any) -> None:
        """Stores a step, and learns when ``model.learn`` would."""
        if isinstance(transition, Transition):
            next_obs = _batch_of_one(transition.next_observation)
            numbers = [transition.reward, transition.terminated, transition.truncated, True]
        else:
            next_obs = transition.next_observations
            numbers = [transition.rewards, transition.terminated, transition.truncated, transition.active]
        rewards, terminated, truncated, active = (np.atleast_1d(number) for number in numbers)
        self._collector.learn(
            self._model_observations(next_obs), rewards.astype(np.float32), terminated | truncated, truncated & ~terminated, active
        )

    def _model_observations(self, observations: Any) -> Any:
        """Converts observations to the layout of the model's environment, in which images have channels first."""
        space, model = self.model.observation_space, self.model
        spaces = getattr(space, "spaces", {"": space})
        arrays = observations if isinstance(observations, Mapping) else {"": observations}
        observed = {kind: maybe_transpose(array, spaces[kind]) for kind, array in arrays.items() if kind in spaces}
        expected = {kind: (model.n_envs, *each.shape) for kind, each in spaces.items()}
        if {kind: array.shape for kind, array in observed.items()} != expected:
            found = {kind: array.shape for kind, array in arrays.items()}
            raise ValueError(
                f"Agent: found observations {found}, expected {expected} (images with the channels first or last) as in the model's "
                f"environment; make the model with curriculum.environment(**options), and run it with these options and num_envs={model.n_envs}"
            )
        return observed if isinstance(observations, Mapping) else observed[""]

    @contextmanager
    def _evaluation_randomness(self, active: NDArray[Any]) -> Iterator[None]:
        """Draws random numbers from the seeds of these environments' experiences, and restores all other generators."""
        model = self.model
        seed = int(np.random.SeedSequence([int(self._generators[env].integers(2**32)) for env in active]).generate_state(1)[0])
        before, space = np.random.get_state(), model.action_space
        devices = [model.device] if model.device.type == "cuda" else []
        with torch.random.fork_rng(devices=devices):
            # `torch.manual_seed` would take milliseconds where torch was built for GPUs but there is none.
            torch.default_generator.manual_seed(seed)
            if devices:
                torch.cuda.manual_seed(seed)
            np.random.seed(seed)
            self._actions.seed(seed)
            model.action_space = self._actions
            try:
                yield
            finally:
                model.action_space = space
                np.random.set_state(before)

    def save(self, path: Path) -> None:
        """Writes the model, its buffer and the states of the random generators into a folder."""
        path.mkdir()
        self.model.save(path / "model.zip")
        random_states = torch.get_rng_state(), np.random.get_state()
        save_to_pkl(path / "rest.pkl", (self._collector.state(), random_states))

    def load(self, path: Path) -> None:
        """Loads a folder that :meth:`save` wrote."""
        loaded = type(self.model).load(path / "model.zip", device=self.model.device)
        vars(self.model).update({name: value for name, value in vars(loaded).items() if name not in _KEPT_ATTRIBUTES})
        state, (torch_state, numpy_state) = load_from_pkl(path / "rest.pkl")
        self._collector.load_state(state)
        self.model.policy.set_training_mode(False)
        torch.set_rng_state(torch_state)
        np.random.set_state(numpy_state)


class _Collector:
    """Collects rollouts: the part that does not depend on the kind of model.

    Args:
        model: The model.
        total: The number of decisions after which schedules stay at their final value.
    """

    #: The names of the collector's attributes that make up its state.
    state_names: tuple[str, ...] = ()
    #: The name of the model's attribute that holds its buffer.
    buffer = ""

    def __init__(self, model: Any, total: int | None) -> None:
        self.model, self.total = model, total

    def state(self) -> dict[str, Any]:
        """The state of the current rollout."""
        return {"buffer": getattr(self.model, self.buffer), **{name: getattr(self, name) for name in self.state_names}}

    def load_state(self, state: dict[str, Any]) -> None:
        """Restores a state that :meth:`state` returned."""
        setattr(self.model, self.buffer, state["buffer"])
        vars(self).update({name: state[name] for name in self.state_names})

    def act(self, observed: Any) -> NDArray[Any]:
        """Actions with exploration; stores what learning needs."""
        raise NotImplementedError

    def learn(
        self, next_obs: Any, rewards: NDArray[np.float32], ended: NDArray[np.bool_], cut_off: NDArray[np.bool_], active: NDArray[np.bool_]
    ) -> None:  # fmt: skip
        """Stores a step of the active environments, and trains the model if an update is due."""
        raise NotImplementedError

    def note_progress(self) -> None:
        """Updates the model's remaining progress."""
        if self.total is not None:
            self.model._update_current_progress_remaining(min(self.model.num_timesteps, self.total), self.total)


class _OnPolicy(_Collector):
    """``OnPolicyAlgorithm.collect_rollouts``, step by step."""

    state_names = ("active", "starts")
    buffer = "rollout_buffer"

    def __init__(self, model: Any, total: int | None) -> None:
        super().__init__(model, total)
        model.rollout_buffer.reset()
        self.active: list[NDArray[np.bool_]] = []
        self.starts = np.ones(model.n_envs, dtype=np.bool_)

    def act(self, observed: Any) -> NDArray[Any]:
        """Actions clipped to the space; stores the unclipped ones with their values and log probabilities."""
        model = self.model
        with torch.no_grad():
            sampled_actions, self.values, self.log_probs = model.policy(obs_as_tensor(observed, model.device))
        self.observed, self.sampled_actions = observed, sampled_actions.cpu().numpy()
        if not hasattr(model.action_space, "low"):
            return np.asarray(self.sampled_actions)
        if model.policy.squash_output:
            return np.asarray(model.policy.unscale_action(self.sampled_actions))
        return np.asarray(np.clip(self.sampled_actions, model.action_space.low, model.action_space.high))

    def learn(
        self, next_obs: Any, rewards: NDArray[np.float32], ended: NDArray[np.bool_], cut_off: NDArray[np.bool_], active: NDArray[np.bool_]
    ) -> None:  # fmt: skip
        """Like :meth:`_Collector.learn`; an update is due when the buffer is full."""
        model, buffer = self.model, self.model.rollout_buffer
        model.num_timesteps += int(active.sum())
        for env in np.flatnonzero(cut_off).tolist():
            last = model.policy.obs_to_tensor(row_of(next_obs, env))[0]
            with torch.no_grad():
                # Computed in float32, like Stable-Baselines3.
                rewards[env] += (model.gamma * model.policy.predict_values(last)[0]).item()
        sampled_actions = self.sampled_actions if hasattr(model.action_space, "low") else self.sampled_actions.reshape(model.n_envs, -1)
        buffer.add(self.observed, sampled_actions, rewards, self.starts, self.values, self.log_probs)
        self.active.append(active)
        self.starts = ended | ~active
        if not buffer.full:
            return
        with torch.no_grad():
            values = model.policy.predict_values(obs_as_tensor(next_obs, model.device))
        buffer.compute_returns_and_advantage(last_values=values, dones=self.starts)
        self.note_progress()
        # Positions in the flattened arrays of the buffer, which go environment by environment.
        positions = np.flatnonzero(np.stack(self.active, axis=1))
        if len(positions) < buffer.buffer_size * model.n_envs:
            buffer.get = partial(_active_samples, buffer, positions)
        model.train()
        vars(buffer).pop("get", None)
        model.policy.set_training_mode(False)
        buffer.reset()
        self.active = []


class _OffPolicy(_Collector):
    """``OffPolicyAlgorithm.collect_rollouts``, step by step. A step is a row of ``n_envs`` decisions."""

    state_names = ("waiting", "steps", "episodes")
    buffer = "replay_buffer"

    def __init__(self, model: Any, total: int | None) -> None:
        super().__init__(model, total)
        self.waiting: list[tuple[Any, ...]] = []
        self.steps = self.episodes = 0

    def act(self, observed: Any) -> NDArray[Any]:
        """Actions with exploration; also stores them in the form that the replay buffer expects."""
        model = self.model
        self.observed = model._last_obs = observed
        actions, self.stored = model._sample_action(model.learning_starts, model.action_noise, model.n_envs)
        return np.asarray(actions)

    def learn(
        self, next_obs: Any, rewards: NDArray[np.float32], ended: NDArray[np.bool_], cut_off: NDArray[np.bool_], active: NDArray[np.bool_]
    ) -> None:  # fmt: skip
        """Like :meth:`_Collector.learn`; stores a row as soon as there are enough decisions for one."""
        model = self.model
        for env in np.flatnonzero(active).tolist():
            info = {"TimeLimit.truncated": bool(cut_off[env])}
            step = row_of(self.observed, env), row_of(next_obs, env), self.stored[env], rewards[env], ended[env], info
            self.waiting.append(step)
            if ended[env] and model.action_noise is not None:
                model.action_noise.reset(**({"indices": [env]} if model.n_envs > 1 else {}))
        if len(self.waiting) < model.n_envs:
            return
        row, self.waiting = self.waiting[: model.n_envs], self.waiting[model.n_envs :]
        observed, row_next_obs, actions, row_rewards, dones, infos = zip(*row, strict=True)
        model.num_timesteps += model.n_envs
        model.replay_buffer.add(_stack(observed), _stack(row_next_obs), np.stack(actions), np.array(row_rewards), np.array(dones), list(infos))
        self.note_progress()
        model._on_step()
        self.steps, self.episodes = self.steps + 1, self.episodes + sum(map(int, dones))
        model._episode_num += sum(map(int, dones))
        if should_collect_more_steps(model.train_freq, self.steps, self.episodes):
            return
        collected, self.steps, self.episodes = self.steps * model.n_envs, 0, 0
        gradient_steps = model.gradient_steps if model.gradient_steps >= 0 else collected
        if model.num_timesteps > model.learning_starts and gradient_steps > 0:
            model.train(batch_size=model.batch_size, gradient_steps=gradient_steps)
            model.policy.set_training_mode(False)


def _reject_unsupported(model: Any, total: int | None) -> None:
    """Rejects models that would not learn as with ``model.learn``."""
    schedules = [name for name in _SCHEDULES if callable(getattr(model, name, None))]
    changing = [name for name in schedules if getattr(model, name)(1.0) != getattr(model, name)(0.0)]
    if changing and total is None:
        raise ValueError(f"total_timesteps: found none for the model's {changing[0]}, expected the number of decisions over which it changes")
    if model.use_sde:
        raise ValueError("model: found use_sde=True, expected False: its noise is drawn for each rollout, not for each experience")
    wrapper = model.env
    while isinstance(wrapper, VecEnvWrapper):
        if not isinstance(wrapper, (VecMonitor, VecTransposeImage)):
            raise ValueError(f"model: found an environment wrapped in {type(wrapper).__name__}, expected one with the curriculum's observations and rewards")
        wrapper = wrapper.venv
    for name, plain in (("optimize_memory_usage", False), ("n_steps", 1)) if isinstance(model, OffPolicyAlgorithm) else ():
        if model.n_envs > 1 and getattr(model, name, plain) != plain:
            raise ValueError(f"model: found {name}={getattr(model, name)} with {model.n_envs} environments, expected one environment, or {name}={plain}")


def _active_samples(buffer: Any, positions: NDArray[np.intp], batch_size: int | None = None) -> Iterator[Any]:
    """Like ``buffer.get``, but yields only these positions of its flattened arrays."""
    # The first `get` flattens the arrays.
    next(type(buffer).get(buffer, 1))
    shuffled = np.random.permutation(positions)
    for start in range(0, len(shuffled), batch_size or len(shuffled)):
        yield buffer._get_samples(shuffled[start : start + (batch_size or len(shuffled))])


def _batch_of_one(observation: Any) -> Any:
    """One observation as a batch of one."""
    return _stack([observation])


def _stack(rows: Any) -> Any:
    """Observations of several environments as a batch."""
    if isinstance(rows[0], Mapping):
        return {kind: np.stack([row[kind] for row in rows]) for kind in rows[0]}
    return np.stack(rows)
