"""Episodes written down as a Minari data set, each with the variant, seed, index and hash of its world. Reading it is Minari's.

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
        'driftworld.adapters.minari: found no minari, expected version 0.5 or later; pip install "./python[minari]"'
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
    """Runs episodes and writes each down as soon as it is over, so that memory holds one at a time.

    Images are kept as they are (Minari's own default, JPEG, loses a little).

    Args:
        env: From ``gymnasium.make``, so that the data set can make it again (``recover_environment``).
        dataset_id: Such as ``"driftworld/find-objects/random-v0"``; it must not exist yet.
        episodes: How many, from 1.
        seed: Worlds 0, 1, 2, … under this seed; random actions are drawn under it as well.
        policy: An action for an observation and the info that came with it; ``None`` acts at random.
        queue: Variants, one in each episode in turn, over and over; ``None`` stays with the environment's.
        algorithm_name: What acted; ``"random"`` without a policy.
        author: As Minari's ``create_dataset_from_buffers``, like those below.
        author_email: Of the author.
        code_permalink: Where the code is.
        description: What it is for.

    Returns:
        The ``minari.MinariDataset``; ``dataset.storage.get_episode_metadata([0])`` has ``variant_id``, ``task_id``, ``world_index``,
        ``world_seed``, ``world_hash``, ``episode_return`` and, where infos say it, ``is_success``.

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
        buffer, metadata = _lived(
            env, policy, seed=seed if number == 0 else None, options=options if number == 0 else {}
        )
        if dataset is None:
            with warnings.catch_warnings():
                # Minari warns of each of these that is left out; whether to say who one is, is the caller's to know.
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


def _lived(
    env: gymnasium.Env[Any, Any],
    policy: Callable[[Any, dict[str, Any]], Any] | None,
    *,
    seed: int | None,
    options: dict[str, Any],
) -> tuple[Any, dict[str, Any]]:
    """One episode as Minari's buffer, and what is to be known of it."""
    observation, info = env.reset(seed=seed, options=options)
    # Of the environment itself: the info names the variant only where the agent may know it.
    told = env.unwrapped.origin()  # type: ignore[attr-defined]
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
    # Minari keeps `seed` for itself.
    metadata = {
        "task_id": told["task_id"],
        "variant_id": told["variant_id"],
        "world_seed": int(told["seed"]),
        "world_index": int(told["index"]),
        "world_hash": told["world_hash"],
        "episode_return": float(np.sum(rewards)),
        **({"is_success": bool(info["is_success"])} if "is_success" in info else {}),
    }
    return buffer, metadata


def _columns(rows: list[Any]) -> Any:
    """A list of dictionaries as a dictionary of lists; anything else as it is."""
    if rows and isinstance(rows[0], dict):
        return {name: [row[name] for row in rows] for name in rows[0]}
    return rows
