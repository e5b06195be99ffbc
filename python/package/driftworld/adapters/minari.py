"""Collects episodes into a Minari data set, each with the variant, seed, index and hash of its world.

import gymnasium, minari
from driftworld.adapters.minari import collect

env = gymnasium.make("driftworld/FindObjects-v0", modalities=["rgb", "state"], size=64)
collect(env, "driftworld/find-objects/random-v0", episodes=10, seed=0, queue=["red", "blue"])
minari.load_dataset("driftworld/find-objects/random-v0")
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import gymnasium
import numpy as np

import driftworld

try:
    import minari
    from minari.data_collector import EpisodeBuffer
except ImportError as error:
    raise ImportError(
        'driftworld.adapters.minari: found no minari, expected version 0.5 or later; pip install "minari[hdf5]>=0.5"'
    ) from error

__all__ = ["collect"]


def collect(
    env: gymnasium.Env[Any, Any],
    dataset_id: str,
    *,
    episodes: int,
    seed: int,
    policy: Callable[[Any, dict[str, Any]], Any] | None = None,
    queue: Sequence[str] | None = None,
    algorithm_name: str | None = None,
    author: str | None = None,
    author_email: str | None = None,
    code_permalink: str | None = None,
    description: str | None = None,
) -> Any:
    """Runs episodes and stores each as soon as it ends, so that memory holds one at a time.

    Images are stored unchanged (Minari's default, JPEG, is lossy).

    Args:
        env: From ``gymnasium.make``, so that the data set can recreate it (``recover_environment``).
        dataset_id: Such as ``"driftworld/find-objects/random-v0"``; it must not exist yet.
        episodes: Number of episodes, from 1.
        seed: Uses worlds 0, 1, 2, … under this seed; also seeds random actions.
        policy: Maps an observation and its info to an action; ``None`` acts at random.
        queue: Variants, one for each episode in turn, cycling; ``None`` keeps the environment's own.
        algorithm_name: Name of the policy; ``"random"`` by default if there is no policy.
        author: As in Minari's ``create_dataset_from_buffers``, like those below.
        author_email: The author's email address.
        code_permalink: A link to the code.
        description: What the data set is for.

    Returns:
        The ``minari.MinariDataset``; ``dataset.storage.get_episode_metadata([0])`` has ``variant_id``, ``task_id``,
        ``world_index``, ``world_seed``, ``world_hash``, ``episode_return`` and, if the infos have it, ``is_success``.

    Raises:
        ValueError: ``episodes`` is below 1.
    """
    if episodes < 1:
        raise ValueError(f"episodes: found {episodes}, expected at least 1")
    if policy is None:
        env.action_space.seed(seed)
        algorithm_name = algorithm_name or "random"
    options: dict[str, Any] = {} if queue is None else {"queue": list(queue)}
    dataset: Any = None
    for number in range(episodes):
        buffer, metadata = _run_episode(
            env, policy, seed=seed if number == 0 else None, options=options if number == 0 else {}
        )
        if dataset is None:
            with warnings.catch_warnings():
                # Minari warns about each of these that is missing; giving them is the caller's choice.
                warnings.simplefilter("ignore", UserWarning)
                dataset = minari.create_dataset_from_buffers(
                    dataset_id,
                    [buffer],
                    env=env,
                    algorithm_name=algorithm_name,
                    author=author,
                    author_email=author_email,
                    code_permalink=code_permalink,
                    description=description,
                    requirements=[f"driftworld=={driftworld.__version__}"],
                    jpeg_encoding=False,
                )
        else:
            dataset.update_dataset_from_buffer([buffer])
        dataset.storage.update_episode_metadata([metadata], [number])
    return dataset


def _run_episode(
    env: gymnasium.Env[Any, Any],
    policy: Callable[[Any, dict[str, Any]], Any] | None,
    *,
    seed: int | None,
    options: dict[str, Any],
) -> tuple[Any, dict[str, Any]]:
    """Runs one episode; returns Minari's buffer and the metadata."""
    observation, info = env.reset(seed=seed, options=options)
    # From the environment itself: the info names the variant only if the agent may know it.
    origin = env.unwrapped.origin()  # type: ignore[attr-defined]
    observations, actions, rewards, terminations, truncations = [observation], [], [], [], []
    has_ended = False
    while not has_ended:
        action = env.action_space.sample() if policy is None else policy(observation, info)
        observation, reward, terminated, truncated, info = env.step(action)
        observations.append(observation)
        actions.append(action)
        rewards.append(float(reward))
        terminations.append(terminated)
        truncations.append(truncated)
        has_ended = terminated or truncated
    buffer = EpisodeBuffer(
        seed=None,
        options=None,
        observations=_columns(observations),
        actions=_columns(actions),
        rewards=rewards,
        terminations=terminations,
        truncations=truncations,
        infos=None,
    )
    # Minari reserves `seed` for itself.
    metadata = {
        "task_id": origin["task_id"],
        "variant_id": origin["variant_id"],
        "world_seed": int(origin["seed"]),
        "world_index": int(origin["index"]),
        "world_hash": origin["world_hash"],
        "episode_return": float(np.sum(rewards)),
        **({"is_success": bool(info["is_success"])} if "is_success" in info else {}),
    }
    return buffer, metadata


def _columns(rows: list[Any]) -> Any:
    """Converts a list of dictionaries to a dictionary of lists; returns anything else unchanged."""
    if rows and isinstance(rows[0], dict):
        return {name: [row[name] for row in rows] for name in rows[0]}
    return rows
