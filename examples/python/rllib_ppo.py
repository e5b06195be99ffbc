"""RLlib's PPO on Find Objects, with env runners that step native vector environments; on a cluster it only needs an address.

    python examples/python/rllib_ppo.py                    # a cluster of this machine's own
    python examples/python/rllib_ppo.py --address auto     # the Ray cluster that this machine is in
    python examples/python/rllib_ppo.py --quick            # only checks that it runs

Unlike sampling and measuring (`ray_sample_and_measure.py`), learning depends on the number of runners: the experience
comes from different worlds, in a different order. Needs `pip install "./python[ray]" torch`.
"""

from __future__ import annotations

import argparse
import logging
from typing import Any

import gymnasium as gym
import numpy as np
import ray
from driftworld.envs import DriftworldVectorEnv
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
from ray.tune.registry import register_env

# Speed in m/s, turn rate in degrees per second, interact: straight ahead, two curves, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
OPTIONS: dict[str, Any] = {
    "task": "find_objects#blue", "modalities": "rgb", "size": 64, "actions": ACTIONS, "interact": False,
    "frame_skip": 5, "max_steps": 60,
}  # fmt: skip


class ForRllib(gym.vector.VectorWrapper):
    """Native environments in the form that RLlib's networks expect.

    Images are scaled to 0 to 1, and rewards to about 1. RLlib gives runner *w* the seed *s* + *w*; seeds for its
    environments are spread from it, so that no two runners share worlds.
    """

    def __init__(self, env: gym.vector.VectorEnv) -> None:
        super().__init__(env)
        self.single_observation_space = gym.spaces.Box(0.0, 1.0, (64, 64, 3), np.float32)
        self.observation_space = gym.vector.utils.batch_space(self.single_observation_space, self.num_envs)

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observation, info = self.env.reset(seed=seed, options=options)
        return observation.astype(np.float32) / 255.0, info

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        observation, reward, terminated, truncated, info = self.env.step(actions)
        return observation.astype(np.float32) / 255.0, reward / 100.0, terminated, truncated, info


def make_environments(config: dict[str, Any]) -> gym.vector.VectorEnv:
    """Makes the environments of an env runner, on whichever machine it runs."""
    return ForRllib(DriftworldVectorEnv(**config))


def configuration(arguments: argparse.Namespace) -> PPOConfig:
    """PPO with the settings of the other examples."""
    register_env("find_objects", make_environments)
    each = arguments.num_envs // arguments.runners
    return (
        PPOConfig()
        .environment("find_objects", env_config=OPTIONS)
        .env_runners(
            num_env_runners=arguments.runners,
            num_envs_per_env_runner=each,
            gym_env_vectorize_mode=gym.VectorizeMode.VECTOR_ENTRY_POINT,
            rollout_fragment_length=arguments.rollout,
        )
        .learners(num_learners=0)
        .training(
            lr=5e-4, gamma=0.98, lambda_=0.95, entropy_coeff=0.01, num_epochs=3, minibatch_size=512, vf_clip_param=10.0,
            train_batch_size_per_learner=arguments.runners * each * arguments.rollout, use_kl_loss=False, grad_clip=0.5,
        )
        .rl_module(
            model_config=DefaultModelConfig(
                conv_filters=[[16, 8, 4], [32, 4, 2]], conv_activation="relu",
                head_fcnet_hiddens=[128], head_fcnet_activation="relu", vf_share_layers=True,
            )
        )
        .debugging(seed=arguments.seed, log_level="ERROR")
    )  # fmt: skip


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--address", help="address of a running Ray cluster, such as auto or ray://HOST:10001")
    parser.add_argument("--runners", type=int, default=2, help="number of env runners, one processor each (default: 2)")
    parser.add_argument("--num-envs", type=int, default=32, help="environments over all runners")
    parser.add_argument("--rollout", type=int, default=64, help="steps of each environment between updates")
    parser.add_argument("--iterations", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="run two small updates, to check that it works")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.num_envs, arguments.iterations = 16, 2
    return arguments


def main() -> None:
    """Learns, and prints its progress."""
    arguments = parse_arguments()
    if arguments.address is not None:
        ray.init(address=arguments.address, log_to_driver=False, logging_level=logging.ERROR)
    else:
        # Runners and learner take turns, so one processor for each runner is enough; Ray asks for one more.
        ray.init(
            "local",
            num_cpus=arguments.runners + 1,
            include_dashboard=False,
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
    algorithm = configuration(arguments).build_algo()
    for iteration in range(arguments.iterations):
        runners = algorithm.train()["env_runners"]
        if "episode_return_mean" in runners and (iteration % 10 == 0 or iteration == arguments.iterations - 1):
            print(
                f"{int(runners['num_env_steps_sampled_lifetime']):>9,} steps  reward {100 * runners['episode_return_mean']:7.1f}",
                flush=True,
            )
    algorithm.stop()
    ray.shutdown()


if __name__ == "__main__":
    main()
