"""Stable-Baselines3's PPO learns to find objects from 64 × 64 colour pictures, in minutes on two cores.

The learner only gets the agent's view. It is compared with two agents in the same environment: a random one, and the
planner, which knows the map and walks from cube to cube.

    python examples/python/ppo_find_objects.py                               # one seed
    python examples/python/ppo_find_objects.py --seeds 1 2 3 4 5 --results   # also writes the result to results/
    python examples/python/ppo_find_objects.py --quick                       # only checks that it runs

Seeds are independent: their environments share no world. All agents are evaluated in the same worlds, by
`Curriculum.run_vector`, once with actions sampled from the policy and once greedily.

Needs `pip install "./python[sb3]"`.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import driftworld
import gymnasium as gym
import numpy as np
import torch
from driftworld.adapters.sb3 import make_vec_env
from record import EVALUATION_SEED, T_95, Record, Watch, evaluate_policy, held_out_curriculum, result_folder
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from stable_baselines3.common.vec_env import VecNormalize
from torch import nn

ID = "driftworld/FindObjects-v0"
# Speed in m/s, turn rate in degrees per second, interact: straight ahead, two curves, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
# Each action is held for half a second of simulated time, so that 60 of them make the task's 300 time steps.
OPTIONS: dict[str, Any] = {
    "modalities": "rgb", "size": 64, "actions": ACTIONS, "interact": False, "frame_skip": 5, "max_steps": 60,
}  # fmt: skip


class SmallCnn(BaseFeaturesExtractor):
    """Two convolutions and a layer of 128: enough for coloured cubes, and fast without a graphics card."""

    def __init__(self, observation_space: gym.spaces.Box) -> None:
        super().__init__(observation_space, features_dim=128)
        self.layers = nn.Sequential(
            nn.Conv2d(3, 16, 8, stride=4), nn.ReLU(),
            nn.Conv2d(16, 32, 4, stride=2), nn.ReLU(),
            nn.Flatten(),
            nn.Linear(32 * 6 * 6, 128), nn.ReLU(),
        )  # fmt: skip

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        """Features of images in 0 to 1, `(n, 3, 64, 64)`."""
        return self.layers(images)  # type: ignore[no-any-return]


class Curve(BaseCallback):
    """Records the mean reward of the last 100 episodes after each rollout."""

    def __init__(self, seed: int) -> None:
        super().__init__()
        self.seed, self.rows, self.start = seed, [], time.perf_counter()  # type: ignore[var-annotated]

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        episodes = self.model.ep_info_buffer
        if not episodes or not self.model.ep_success_buffer:
            return
        seconds = time.perf_counter() - self.start
        row = {
            "seed": self.seed,
            "steps": self.num_timesteps,
            "seconds": round(seconds, 1),
            "reward": round(float(np.mean([episode["r"] for episode in episodes])), 2),
            "success": round(float(np.mean(self.model.ep_success_buffer)), 3),
        }
        self.rows.append(row)
        if len(self.rows) % 10 == 1:
            print(
                f"seed {self.seed} {row['steps']:>9,} steps {seconds:6.0f} s  reward {row['reward']:6.1f}  "
                f"found all {row['success']:4.0%}",
                flush=True,
            )


def learn(seed: int, arguments: argparse.Namespace) -> tuple[PPO, list[dict[str, Any]]]:
    """Trains from scratch; returns the model and its learning curve."""
    envs = make_vec_env(ID, arguments.num_envs, seed=seed, variant=arguments.variant, **OPTIONS)
    # The curve shows the task's rewards; the learner gets them scaled to about 1.
    envs = VecNormalize(envs, norm_obs=False, gamma=0.98)
    model = PPO(
        "CnnPolicy", envs, seed=seed, device="cpu",
        n_steps=arguments.rollout, batch_size=512, n_epochs=3, gamma=0.98, gae_lambda=0.95, ent_coef=0.01,
        learning_rate=lambda left: 5e-4 * left,
        policy_kwargs={"features_extractor_class": SmallCnn, "net_arch": []},
    )  # fmt: skip
    curve = Curve(seed)
    model.learn(arguments.steps, callback=curve)
    envs.close()
    return model, curve.rows


def evaluate(arguments: argparse.Namespace, model: PPO | None, policy: str, seed: int = 0) -> dict[str, float]:
    """Reward and success in held-out worlds; without a model, those of a random agent."""

    @torch.no_grad()
    def probabilities(observations: Any) -> Any:
        if model is None:
            return np.full((len(observations), len(ACTIONS)), 1.0 / len(ACTIONS))
        images, _ = model.policy.obs_to_tensor(observations)
        return model.policy.get_distribution(images).distribution.probs.numpy()  # type: ignore[union-attr, attr-defined]

    worlds = held_out_curriculum(f"find_objects#{arguments.variant}", arguments.episodes)
    return evaluate_policy(worlds, probabilities, policy, seed, arguments.num_envs, OPTIONS)


def expert(arguments: argparse.Namespace, **changes: Any) -> dict[str, float]:
    """Reward and success of the planner, which knows the map. It holds actions as long as the learner does, unless
    `changes` set another duration.
    """
    env = gym.make(ID, variant=arguments.variant, **(OPTIONS | changes))
    variant = driftworld.TaskSpec.load("find_objects").variant(arguments.variant)
    rewards, successes = [], []
    for index in range(arguments.episodes):
        world = variant.sample(EVALUATION_SEED, index)
        world["agent_params"]["action_model"] = "onrails"
        env.reset(options={"world": world})
        reward, over = 0.0, False
        while not over:
            _, pay, terminated, truncated, info = env.step(0)  # it ignores the action
            reward, over = reward + float(pay), terminated or truncated
        rewards.append(reward)
        successes.append(info["is_success"])
    env.close()
    return {"reward": round(float(np.mean(rewards)), 1), "success": round(float(np.mean(successes)), 3)}


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", default="blue", help="variant of find_objects (default: blue)")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="seeds, one run each (default: 1)")
    parser.add_argument("--steps", type=int, default=300_000, help="steps of learning, over all environments")
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument("--rollout", type=int, default=64, help="steps of each environment between updates")
    parser.add_argument("--episodes", type=int, default=200, help="number of episodes in each evaluation")
    parser.add_argument("--threads", type=int, default=2, help="number of PyTorch threads")
    parser.add_argument(
        "--results", nargs="?", const=result_folder(__file__), metavar="FOLDER", help="record the result"
    )
    parser.add_argument("--quick", action="store_true", help="run a few updates, to check that it works")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.steps, arguments.num_envs, arguments.rollout, arguments.episodes = 1024, 8, 64, 8
        arguments.threads = 1
    return arguments


def main() -> None:
    """Learns with every seed, compares, and writes the result if requested."""
    arguments = parse_arguments()
    torch.set_num_threads(arguments.threads)
    watch = Watch()
    lines = {
        "planner": expert(arguments)["reward"],
        "planner that acts in every time step": expert(arguments, frame_skip=1, max_steps=300)["reward"],
        "random": evaluate(arguments, None, "sampled")["reward"],
    }
    for name, level in lines.items():
        print(f"{name}: reward {level}")
    curve: list[dict[str, Any]] = []
    table = []
    for seed in arguments.seeds:
        model, rows = learn(seed, arguments)
        curve += rows
        for policy in ("sampled", "greedy"):
            scored = evaluate(arguments, model, policy, seed)
            print(
                f"seed {seed}, {policy}: on worlds never learned from, reward {scored['reward']}, found all {scored['success']:.0%}",
                flush=True,
            )
            table.append({
                "seed": seed,
                "policy": policy,
                "steps": rows[-1]["steps"],
                "minutes": round(rows[-1]["seconds"] / 60, 1),
                f"reward in {scored['episodes']} worlds never learned from": scored["reward"],
                "standard deviation of episodes": scored["deviation"],
                "share with all cubes found": scored["success"],
            })  # fmt: skip
        if arguments.results:
            # Write the results so far, so that an interrupted run keeps its finished seeds.
            write_result(arguments, curve, table, lines, watch)


def with_means(table: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The table, followed by the means over 2 to 10 seeds with 95 % intervals."""
    rows = list(table)
    for policy in ("sampled", "greedy"):
        own = [row for row in table if row["policy"] == policy]
        if not 2 <= len(own) <= len(T_95) + 1:
            continue
        mean = {"seed": f"mean of {len(own)}, 95 %", "policy": policy, "steps": own[0]["steps"], "minutes": ""}
        for name in list(own[0])[len(mean) :]:
            numbers = np.array([row[name] for row in own])
            half_width = T_95[len(own) - 2] * numbers.std(ddof=1) / len(own) ** 0.5
            digits = 3 if name.startswith("of them") else 1
            mean[name] = f"{numbers.mean():.{digits}f} ± {half_width:.{digits}f}"
        rows.append(mean)
    return rows


def write_result(
    arguments: argparse.Namespace,
    curve: list[dict[str, Any]],
    table: list[dict[str, Any]],
    lines: dict[str, float],
    watch: Watch,
) -> None:
    """Writes the result of the finished seeds."""
    done = list(dict.fromkeys(row["seed"] for row in table))
    Record(
        title="PPO finds objects",
        text="Stable-Baselines3's PPO on `driftworld/FindObjects-v0` from 64 × 64 colour pictures. Five cubes pay 100 each, each second costs 1, "
        "each action is held for five time steps (half a second); an episode is 60 actions. The planner knows the map; one holds its "
        f"actions as long, the other acts in each of 300 time steps. n = {len(done)} seeds of learning, which share no world. All agents are "
        "evaluated in the same worlds; 95 % intervals are over seeds, and do not cover the choice of these worlds.",
        settings={"id": ID, **vars(arguments), "seeds": done, **OPTIONS, "evaluation_seed": EVALUATION_SEED},
        variants=[f"find_objects#{arguments.variant}"],
        seeds=[*done, EVALUATION_SEED],
        curve=curve, lines=lines, table=with_means(table), seconds=watch.seconds, load_before=watch.load,
        labels=("steps of learning, each held for five time steps", "reward of an episode, mean of the last 100"),
    ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
