"""PPO in one file, on the native vector environment, with no library between learner and loop.

In the style of CleanRL: the whole algorithm is in this file, from the network to the update, and uses only PyTorch.
It also shows how to handle autoreset NEXT_STEP correctly:

- The observation returned at the end of an episode *is* its last one. A truncated episode is therefore bootstrapped
  from it; a terminated episode is not bootstrapped.
- The step after the end of an episode ignores its action and has reward 0. It is not experience, and is excluded from
  the loss.

Afterwards `Curriculum.run_vector` evaluates the policy in worlds that it never learned from.

    python examples/python/cleanrl_ppo.py              # a few minutes on two cores
    python examples/python/cleanrl_ppo.py --results    # also writes the result to results/
    python examples/python/cleanrl_ppo.py --quick      # only checks that it runs

Needs PyTorch (`pip install torch`).
"""

from __future__ import annotations

import argparse
from typing import Any

import driftworld  # noqa: F401  (registers the environments)
import gymnasium as gym
import numpy as np
import torch
from record import EVALUATION_SEED, Record, Watch, evaluate_policy, held_out_curriculum, result_folder
from torch import nn

# Speed in m/s, turn rate in degrees per second, interact: straight ahead, two curves, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", default="blue", help="variant of find_objects (default: blue)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the network, the actions and the worlds (default: 1)")
    parser.add_argument("--steps", type=int, default=250_000, help="steps of learning, over all environments")
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument("--rollout", type=int, default=64, help="steps of each environment between updates")
    parser.add_argument("--episodes", type=int, default=200, help="number of evaluation episodes")
    parser.add_argument(
        "--policy", choices=["sampled", "greedy"], default="sampled", help="how the policy acts in the evaluation"
    )
    parser.add_argument("--threads", type=int, default=2, help="number of PyTorch threads")
    parser.add_argument(
        "--results", nargs="?", const=result_folder(__file__), metavar="FOLDER", help="record the result"
    )
    parser.add_argument("--quick", action="store_true", help="run a few updates, to check that it works")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.steps, arguments.num_envs, arguments.rollout, arguments.threads = 1024, 8, 32, 1
        arguments.episodes = 8
    return arguments


# --- network ------------------------------------------------------------------------------------------------------


def layer(module: nn.Module, gain: float = 2**0.5) -> nn.Module:
    """Initialises a layer orthogonally, as is usual for PPO."""
    nn.init.orthogonal_(module.weight, gain)  # type: ignore[arg-type]
    nn.init.zeros_(module.bias)  # type: ignore[arg-type]
    return module


class Agent(nn.Module):
    """A small convolutional network with two heads: policy and value."""

    def __init__(self, num_actions: int) -> None:
        super().__init__()
        self.trunk = nn.Sequential(
            layer(nn.Conv2d(3, 16, 8, stride=4)), nn.ReLU(),
            layer(nn.Conv2d(16, 32, 4, stride=2)), nn.ReLU(),
            nn.Flatten(),
            layer(nn.Linear(32 * 6 * 6, 128)), nn.ReLU(),
        )  # fmt: skip
        self.policy = layer(nn.Linear(128, num_actions), 0.01)
        self.value = layer(nn.Linear(128, 1), 1.0)

    def forward(self, images: torch.Tensor) -> tuple[torch.distributions.Categorical, torch.Tensor]:
        """Policy and value of images, `(n, 64, 64, 3)` bytes as the environment returns them."""
        features = self.trunk(images.permute(0, 3, 1, 2).float() / 255.0)
        return torch.distributions.Categorical(logits=self.policy(features)), self.value(features).squeeze(-1)


# --- experience -------------------------------------------------------------------------------------------------------


class Rollout:
    """`length` steps of a batch of environments: `(length, num_envs, …)`."""

    def __init__(self, length: int, num_envs: int) -> None:
        self.images = torch.zeros((length, num_envs, 64, 64, 3), dtype=torch.uint8)
        self.actions = torch.zeros((length, num_envs), dtype=torch.long)
        self.log_probs = torch.zeros((length, num_envs))
        self.rewards = torch.zeros((length, num_envs))
        self.values = torch.zeros((length + 1, num_envs))
        self.terminated = torch.zeros((length, num_envs), dtype=torch.bool)
        self.ended = torch.zeros((length, num_envs), dtype=torch.bool)
        self.counts = torch.zeros((length, num_envs), dtype=torch.bool)

    def advantages(self, discount: float, trace: float) -> torch.Tensor:
        """Generalised advantages (Schulman et al. 2016), `(length, num_envs)`.

        `values[t + 1]` is the value of the observation after step t. Under NEXT_STEP, if an episode ended there, this is
        its last observation and not the first of the next episode, so truncation needs no special case.
        """
        advantages = torch.zeros_like(self.rewards)
        following = torch.zeros_like(self.rewards[0])
        for t in reversed(range(len(self.rewards))):
            bootstrap = self.values[t + 1] * ~self.terminated[t]
            td_error = self.rewards[t] + discount * bootstrap - self.values[t]
            following = td_error + discount * trace * following * ~self.ended[t]
            advantages[t] = following
        return advantages


class Learner:
    """Collects experience in the environments and learns from it."""

    def __init__(self, envs: gym.vector.VectorEnv, arguments: argparse.Namespace) -> None:
        self.envs, self.arguments = envs, arguments
        self.agent = Agent(int(envs.single_action_space.n))  # type: ignore[attr-defined]
        self.optimizer = torch.optim.Adam(self.agent.parameters(), lr=5e-4, eps=1e-5)
        self.rollout = Rollout(arguments.rollout, envs.num_envs)
        observation, _ = envs.reset(seed=arguments.seed)
        # A copy: with `copy=False` the environment would return views that its next step overwrites.
        self.image = torch.tensor(observation)
        self.just_ended = torch.zeros(envs.num_envs, dtype=torch.bool)
        self.returns = np.zeros(envs.num_envs)

    @torch.no_grad()
    def collect(self) -> list[float]:
        """Fills the rollout; returns the returns of the episodes that ended in it."""
        rollout, finished = self.rollout, []
        for t in range(len(rollout.rewards)):
            policy, value = self.agent(self.image)
            action = policy.sample()
            rollout.images[t], rollout.actions[t], rollout.values[t] = self.image, action, value
            rollout.log_probs[t] = policy.log_prob(action)
            rollout.counts[t] = ~self.just_ended
            observation, reward, terminated, truncated, _ = self.envs.step(action.numpy())
            self.image = torch.tensor(observation)
            rollout.rewards[t] = torch.tensor(reward / 100.0)  # a cube pays 100
            rollout.terminated[t] = torch.tensor(terminated)
            rollout.ended[t] = self.just_ended = torch.tensor(terminated | truncated)
            self.returns += reward
            for env in np.flatnonzero(terminated | truncated):
                finished.append(float(self.returns[env]))
                self.returns[env] = 0.0
        rollout.values[-1] = self.agent(self.image)[1]
        return finished

    def learn(self, progress: float, epochs: int = 3, minibatch: int = 512, clip: float = 0.2) -> None:
        """One update of PPO from the rollout; the learning rate falls with `progress` (0 to 1)."""
        for group in self.optimizer.param_groups:
            group["lr"] = 5e-4 * (1.0 - progress)
        rollout = self.rollout
        advantages = rollout.advantages(discount=0.98, trace=0.95)
        targets = (advantages + rollout.values[:-1]).flatten()
        advantages = advantages.flatten()
        counts = rollout.counts.flatten().nonzero().squeeze(-1)
        images, actions = rollout.images.flatten(0, 1), rollout.actions.flatten()
        log_probs = rollout.log_probs.flatten()
        for _ in range(epochs):
            # Minibatches of about equal size: a single leftover step would have no standard deviation.
            for part in counts[torch.randperm(len(counts))].tensor_split(max(1, round(len(counts) / minibatch))):
                policy, value = self.agent(images[part])
                advantage = advantages[part]
                advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
                ratio = (policy.log_prob(actions[part]) - log_probs[part]).exp()
                gain = torch.min(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean()
                error = 0.5 * (value - targets[part]).square().mean()
                loss = error - gain - 0.01 * policy.entropy().mean()
                self.optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(self.agent.parameters(), 0.5)
                self.optimizer.step()


# --- program ------------------------------------------------------------------------------------------------------


def main() -> None:
    """Learns, and prints its progress."""
    arguments = parse_arguments()
    watch = Watch()
    torch.manual_seed(arguments.seed)
    torch.set_num_threads(arguments.threads)
    options: dict[str, Any] = {
        "modalities": "rgb", "size": 64, "actions": ACTIONS, "interact": False,
        "frame_skip": 5, "max_steps": 60,
    }  # fmt: skip
    envs = gym.make_vec(
        "driftworld/FindObjects-v0", arguments.num_envs, vectorization_mode="vector_entry_point", variant=arguments.variant, **options
    )
    learner = Learner(envs, arguments)
    steps_per_update = arguments.num_envs * arguments.rollout
    updates = max(1, arguments.steps // steps_per_update)
    curve: list[dict[str, float]] = []
    recent: list[float] = []
    for update in range(updates):
        recent = (recent + learner.collect())[-200:]
        learner.learn(update / updates)
        steps, seconds = (update + 1) * steps_per_update, watch.seconds
        if recent and (update % 10 == 9 or update == updates - 1):
            curve.append({"steps": steps, "seconds": round(seconds, 1), "reward": round(float(np.mean(recent)), 2)})
            print(
                f"{steps:>9,} steps  reward {np.mean(recent):7.1f} in the last {len(recent)} episodes  {steps / seconds:6.0f} steps/s",
                flush=True,
            )
    envs.close()

    @torch.no_grad()
    def probabilities(observations: Any) -> Any:
        return learner.agent(torch.from_numpy(observations))[0].probs.numpy()

    worlds = held_out_curriculum(f"find_objects#{arguments.variant}", arguments.episodes)
    scored = evaluate_policy(worlds, probabilities, arguments.policy, arguments.seed, arguments.num_envs, options)
    print(f"{arguments.policy}, in worlds never learned from: {scored}")
    if arguments.results:
        Record(
            title="PPO in one file",
            text="The learner of `cleanrl_ppo.py` on `driftworld/FindObjects-v0` from 64 × 64 colour pictures, in the native vector "
            "environment with autoreset NEXT_STEP. The curve is of episodes of learning, the table of worlds that it never learned from. "
            "One seed (n = 1): it shows that the program learns, not how well it does with another seed.",
            settings={**vars(arguments), **options, "evaluation_seed": EVALUATION_SEED},
            variants=[f"find_objects#{arguments.variant}"], seeds=[arguments.seed], curve=curve, seconds=watch.seconds, load_before=watch.load, table=[{"seed": arguments.seed, "steps": curve[-1]["steps"], "policy": arguments.policy, **scored}],
            labels=("steps of learning, each held for five time steps", "reward of an episode, mean of the last 200"),
        ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
