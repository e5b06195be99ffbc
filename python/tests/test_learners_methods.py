"""Compares each continual method with values computed by hand."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest
from small_learners import Steps, package, small

pytestmark = pytest.mark.learners
torch: Any = pytest.importorskip("torch", reason="needs PyTorch")


def module(name: str) -> Any:
    package()
    return importlib.import_module(f"driftworld.learners.{name}")


def weights(learner: Any) -> dict[str, Any]:
    return {name: weight.detach().clone() for name, weight in learner.network.named_parameters()}


def flat(learner: Any) -> Any:
    return torch.cat([weight.flatten() for weight in weights(learner).values()])


# --- EWC ---


class SoftmaxLinear(torch.nn.Module):  # type: ignore[misc]
    """log π = log softmax(W x), and a value that does not belong to the policy."""

    def __init__(self, policy: Any) -> None:
        super().__init__()
        self.policy, self.value = torch.nn.Linear(2, 3, bias=False), torch.nn.Linear(2, 1)
        with torch.no_grad():
            self.policy.weight.copy_(policy)

    def forward(self, states: Any) -> Any:
        return torch.log_softmax(self.policy(states), dim=-1), self.value(states).squeeze(-1)


STATES = torch.tensor([[1.0, 0.0], [0.5, -2.0], [3.0, 1.0]])
POLICY = torch.tensor([[0.3, -0.2], [0.1, 0.4], [-0.5, 0.2]])


def test_fisher_of_a_softmax_linear_policy_matches_the_formula() -> None:
    network = SoftmaxLinear(POLICY)
    found = module("ewc").fisher(network, STATES, chunk=2)
    # ∂ log π(a|s) / ∂W[k, j] = (1[a = k] − π(k|s)) xⱼ; so Σₐ π(a|s) (…)² = π(k|s) (1 − π(k|s)) xⱼ².
    expected = np.zeros((3, 2))
    for state in STATES.numpy():
        exponents = np.exp(POLICY.numpy() @ state)
        policy = exponents / exponents.sum()
        expected += np.outer(policy * (1 - policy), state**2) / len(STATES)
    assert found["policy.weight"].numpy() == pytest.approx(expected, abs=1e-6)
    assert not found["value.weight"].any() and not found["value.bias"].any()


def test_fisher_is_not_the_square_of_the_mean_gradient() -> None:
    # Two states with opposite gradients: their mean is 0, their squares are not.
    states = torch.tensor([[1.0, 0.0], [-1.0, 0.0]])
    network = SoftmaxLinear(torch.zeros(3, 2))
    found = module("ewc").fisher(network, states)["policy.weight"]
    assert found[:, 0].tolist() == pytest.approx([2 / 9] * 3)
    assert found[:, 1].tolist() == [0.0] * 3


def test_importances_have_mean_1_over_the_policys_tensors() -> None:
    ewc = module("ewc")
    importance = ewc.normalized(ewc.fisher(SoftmaxLinear(POLICY * 7), STATES))
    assert importance["policy.weight"].mean().item() == pytest.approx(1.0)
    assert not importance["value.weight"].any()
    nothing = ewc.normalized({"a": torch.zeros(3)})
    assert nothing["a"].tolist() == [0.0] * 3


@pytest.mark.parametrize("kind", ["EWC", "OnlineEWC", "L2"])
def test_springs_pull_towards_the_weights_at_the_border(kind: str) -> None:
    learner = small(kind, strength=3.0)
    Steps(learner, label="a").take(20)
    assert learner.extra_loss() == 0
    learner.begin(0, "b", 0)
    anchor = weights(learner)
    assert learner.extra_loss().item() == 0.0
    with torch.no_grad():
        for weight in learner.network.parameters():
            weight.add_(0.1)
    learner.optimizer.zero_grad()
    loss = learner.extra_loss()
    loss.backward()
    numbers = {name: weight.numel() for name, weight in anchor.items()}
    if kind == "L2":
        assert loss.item() == pytest.approx(0.5 * 3.0 * 0.01 * sum(numbers.values()), rel=1e-4)
    else:
        # Importances have mean 1 over all tensors but the value head.
        policy = sum(number for name, number in numbers.items() if not name.startswith("value."))
        assert loss.item() == pytest.approx(0.5 * 3.0 * 0.01 * policy, rel=1e-3)
        (importance, anchors), = learner.springs  # fmt: skip
        assert all(torch.equal(anchors[name], weight) for name, weight in anchor.items())
        gradient = learner.network.policy.weight.grad
        assert torch.allclose(gradient, 3.0 * 0.1 * importance["policy.weight"], atol=1e-6)


def test_ewc_has_springs_for_each_task_and_online_ewc_one_set() -> None:
    many, one = small("EWC"), small("OnlineEWC", decay=0.5)
    for learner in (many, one):
        for label in ("a", "b", "c"):
            Steps(learner, label=label).take(20)
    assert len(many.springs) == 2 and len(one.springs) == 1
    assert many.report()["method_bytes"] == 2 * one.report()["method_bytes"]
    # Importances have mean 1: the second task contributes 1, and the first a half.
    used = [rows for name, rows in one.springs[0][0].items() if not name.startswith("value.")]
    assert sum(rows.sum() for rows in used).item() / sum(rows.numel() for rows in used) == pytest.approx(1.5, rel=1e-3)


def test_fisher_uses_the_last_observations_of_the_ending_task() -> None:
    learner = small("EWC", samples=1000)
    steps = Steps(learner, label="a")
    steps.take(16)
    seen = learner.rollout.images[:-1][learner.rollout.active].clone()
    learner.begin(0, "b", 0)
    expected = module("ewc").normalized(module("ewc").fisher(learner.network, seen))
    for name, values in learner.springs[0][0].items():
        assert torch.allclose(values, expected[name], rtol=1e-3, atol=1e-4)
    assert not learner.rollout.active.any(), "its observations are not used for the next task"


# --- PackNet ---


def test_frozen_weights_stay_bit_identical_under_adam() -> None:
    learner = small("PackNet", max_tasks=3, task_decisions=100, retraining=0.5)
    Steps(learner, label="a").take(40)
    assert learner.is_pruned and learner.optimizer.state, "Adam has moments"
    learner.begin(0, "b", 0)
    before, owned = weights(learner), {name: rows == 1 for name, rows in learner.owners.items()}
    Steps(learner, seed=1, label="b").take(160)
    assert learner.updates > 90 and learner.is_pruned
    after = weights(learner)
    for name, mask in owned.items():
        assert mask.any()
        assert torch.equal(before[name][mask], after[name][mask]), name
    moved = {name: not torch.equal(before[name], after[name]) for name in owned if after[name].dim() > 1}
    assert all(moved.values()), "free weights learn in every layer"
    # Retraining changes only the task's own weights; pruned weights stay 0.
    for name, rows in learner.owners.items():
        assert not after[name][rows == 0].any()


def test_packnet_shares_are_equal_and_the_largest_weights_are_kept() -> None:
    learner = small("PackNet", max_tasks=3)
    for number, label in enumerate(("a", "b", "c"), start=1):
        Steps(learner, label=label).take(3)
        free = {name: rows == 0 for name, rows in learner.owners.items()}
        magnitudes = {name: weight.abs() for name, weight in weights(learner).items()}
        learner.prune()
        for name, rows in learner.owners.items():
            kept = rows == number
            if rows.dim() == 1:
                assert (rows == 1).all(), "biases belong to the first task"
                continue
            assert abs(int(kept.sum()) - rows.numel() / 3) <= 1
            lost = free[name] & ~kept
            if lost.any():
                assert magnitudes[name][kept].min() >= magnitudes[name][lost].max()
    assert all((rows > 0).all() for rows in learner.owners.values())
    with pytest.raises(ValueError, match="found task number 4, expected at most max_tasks=3"):
        learner.begin(0, "d", 0)


def test_packnet_acts_in_a_finished_task_as_it_did_at_its_end() -> None:
    learner = small("PackNet", max_tasks=2, policy="greedy")
    steps = Steps(learner, label="a")
    steps.take(40)
    learner.freeze(True)
    images = steps.images()
    for env in range(4):
        learner.begin(env, "a", env)
    before = learner.look(torch.from_numpy(images))[0]
    learner.freeze(False)
    Steps(learner, seed=1, label="b").take(60)
    learner.freeze(True)
    for env, label in enumerate(("a", "b", "a", "unknown")):
        learner.begin(env, label, env)
    with torch.no_grad():
        after, now = learner.look(torch.from_numpy(images))[0], learner.network(torch.from_numpy(images))[0]
    assert torch.allclose(after[[0, 2]], before[[0, 2]], atol=1e-6)
    assert torch.allclose(after[[1, 3]], now[[1, 3]], atol=1e-6)
    assert not torch.allclose(after[1], before[1], atol=1e-4)


# --- CLEAR ---


def numbered(number: int) -> Any:
    """A rollout of one step of one environment, identified by its reward."""
    rollout = package().Rollout(1, 1, 8, 5)
    rollout.rewards[:], rollout.active[:] = float(number), True
    return rollout


def test_reservoir_is_uniform_by_chi_square() -> None:
    clear, offered, capacity, repeats = module("clear"), 40, 10, 400
    counts = np.zeros(offered)
    rollouts = [numbered(number) for number in range(offered)]
    for seed in range(repeats):
        reservoir = clear.Reservoir(capacity, seed)
        for rollout in rollouts:
            reservoir.offer(rollout)
        for stretch in reservoir.stretches:
            counts[int(stretch["rewards"])] += 1
    assert counts.sum() == capacity * repeats
    expected = capacity * repeats / offered
    # Without replacement, each count's variance is 1 − capacity / offered times that of independent draws.
    statistic = ((counts - expected) ** 2).sum() / expected / (1 - capacity / offered)
    # Quantiles of chi-square with 39 degrees of freedom at 0.001 and 0.999.
    assert 16.27 < statistic < 72.05


def test_reservoir_follows_its_seed_and_skips_idle_environments() -> None:
    clear = module("clear")

    def kept(seed: int) -> list[float]:
        reservoir = clear.Reservoir(5, seed)
        for number in range(50):
            rollout = package().Rollout(1, 2, 8, 5)
            rollout.rewards[:] = torch.tensor([[float(number), -1.0]])
            rollout.active[:] = torch.tensor([[True, False]])
            reservoir.offer(rollout)
        assert reservoir.offered == 50
        return [float(stretch["rewards"]) for stretch in reservoir.stretches] + reservoir.draw(
            8
        ).rewards.flatten().tolist()

    assert kept(1) == kept(1) != kept(2)
    assert -1.0 not in kept(1)


def test_v_trace_on_a_chain_of_two_states_gives_the_known_values() -> None:
    """In state A the action `go` leads to B and pays 1; in B it ends the episode and pays 2. `stay` pays 0 and does nothing.

    The target policy always goes: V(A) = 1 + γ 2, V(B) = 2. The behaviour policy goes half of the time.
    """
    clear, discount, rollouts = module("clear"), 0.9, 400
    rng = torch.Generator().manual_seed(1)
    length = 6
    rollout = package().Rollout(length, rollouts, 8, 2)
    state, states = torch.zeros(rollouts, dtype=torch.long), []
    for t in range(length):
        goes = torch.rand(rollouts, generator=rng) < 0.5
        states.append(state)
        rollout.actions[t], rollout.rewards[t] = goes.long(), goes * (1.0 + state)
        rollout.terminated[t] = rollout.ended[t] = goes & (state == 1)
        state = torch.where(goes, 1 - state, state)
    states.append(state)
    # The target policy never stays, so those ratios are 0. The ratio of going is 2, truncated at 1.
    log_ratio = torch.where(rollout.actions == 1, torch.tensor(2.0).log(), torch.tensor(-torch.inf))
    known = torch.tensor([1.0 + discount * 2.0, 2.0])
    seen = torch.stack(states)
    targets, advantages = clear.v_trace(rollout, known[seen], log_ratio, discount)
    # The known values are V-trace's fixed point, whatever the actions.
    assert torch.allclose(targets, known[seen[:-1]], atol=1e-5)
    assert torch.allclose(advantages, torch.zeros_like(advantages), atol=1e-5)
    # Starting from wrong values, iterating the mean targets of each state converges to the known values.
    values = torch.zeros(2)
    for _ in range(60):
        targets, _ = clear.v_trace(rollout, values[seen], log_ratio, discount)
        values = torch.stack([targets[seen[:-1] == number].mean() for number in (0, 1)])
    assert values.tolist() == pytest.approx(known.tolist(), abs=1e-3)


def test_v_trace_bootstraps_truncation_from_its_own_last_image() -> None:
    rollout = package().Rollout(4, 1, 8, 5)
    rollout.rewards[:, 0] = torch.tensor([1.0, 2.0, 4.0, 8.0])
    rollout.ended[:, 0] = torch.tensor([False, True, True, False])
    rollout.terminated[:, 0] = torch.tensor([False, False, True, False])
    rollout.last_values[:, 0] = torch.tensor([0.0, 30.0, 70.0, 0.0])
    values = torch.tensor([[3.0], [5.0], [7.0], [9.0], [11.0]])
    targets, advantages = module("clear").v_trace(rollout, values, torch.zeros(4, 1), 0.5)
    # On-policy targets are discounted returns: 30 follows the second step, nothing the third.
    returns = [1.0 + 0.5 * (2.0 + 0.5 * 30.0), 2.0 + 0.5 * 30.0, 4.0, 8.0 + 0.5 * 11.0]
    assert targets.flatten().tolist() == pytest.approx(returns)
    assert (targets - values[:-1]).flatten().tolist() == pytest.approx(advantages.flatten().tolist())


def test_cloning_loss_is_0_at_the_old_policy_and_values_and_pulls_back() -> None:
    learner = small("CLEAR", policy_cloning=1.0, value_cloning=1.0)
    Steps(learner).take(7)
    with torch.no_grad():
        learner.rollout.values[7] = learner.values_of(learner.rollout.images[7], torch.arange(4))
    old = learner.rollout.first(7)
    with torch.no_grad():
        at_old_policy = learner.replay_loss(old).item()
        learner.policy_cloning = learner.value_cloning = 0.0
        assert learner.replay_loss(old).item() == pytest.approx(at_old_policy, abs=1e-6)
        for weight in learner.network.parameters():
            weight.add_(0.05)
        without = learner.replay_loss(old).item()
        learner.policy_cloning = learner.value_cloning = 1.0
        assert learner.replay_loss(old).item() > without + 1e-3


# --- others ---


def test_shrink_and_perturb_mixes_with_fresh_weights_and_clears_adam() -> None:
    learner = small("ShrinkAndPerturb", shrink=0.5, perturb=0.25)
    Steps(learner, label="a").take(24)
    before = weights(learner)
    learner.begin(0, "b", 0)
    fresh = dict(learner.fresh_network(1).named_parameters())
    for name, weight in weights(learner).items():
        assert torch.allclose(weight, 0.5 * before[name] + 0.25 * fresh[name], atol=1e-7)
    assert not learner.optimizer.state


def test_from_scratch_starts_each_task_with_new_weights_and_the_first_like_ppo() -> None:
    learner, ppo = small("FromScratch"), small("PPO")
    Steps(learner, label="a").take(1)
    assert torch.equal(flat(learner), flat(ppo))
    Steps(learner, label="a").take(23)
    learner.begin(0, "b", 0)
    assert not torch.equal(flat(learner), flat(ppo))
    assert flat(learner).norm().item() == pytest.approx(flat(ppo).norm().item(), rel=0.05)
    assert not learner.optimizer.state


def test_resetting_the_optimiser_clears_moments_and_keeps_weights() -> None:
    learner = small("ResetOptimizer")
    Steps(learner, label="a").take(24)
    before = flat(learner)
    assert learner.optimizer.state
    learner.begin(0, "b", 0)
    assert torch.equal(flat(learner), before) and not learner.optimizer.state


# --- recurrent ---


def test_replayed_sequences_match_the_outputs_when_acting() -> None:
    learner = small("RecurrentPPO")
    found = []

    def look_again(rollout: Any, advantages: Any, part: Any) -> Any:
        log_policy, values = learner.look_again(rollout, part)
        found.append((log_policy - rollout.log_policy.flatten(0, 1)[part]).abs().max().item())
        found.append((values - rollout.values[:-1].flatten()[part]).abs().max().item())
        return (values * 0).sum()

    learner.loss = look_again
    Steps(learner).take(24)
    assert len(found) >= 12
    assert max(found) < 1e-5


def test_memory_is_reset_only_at_episode_starts() -> None:
    learner = small("RecurrentPPO")
    images = torch.from_numpy(Steps(learner).images())
    learner.freeze(True)
    first = learner.look(images)[0].clone()
    second = learner.look(images)[0].clone()
    learner.begin(2, None, 0)
    third = learner.look(images)[0].clone()
    assert torch.allclose(third[2], first[2], atol=1e-6)
    assert not torch.allclose(second[2], first[2], atol=1e-5)
    assert not torch.allclose(third[1], first[1], atol=1e-5)
