# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # See forgetting
#
# A network learns to turn left in a maze, then to turn right. Can it still turn left? In a minute or two you see it forget, try a
# method that is meant to prevent this, and get the numbers that a paper would report.
#
# Needs `pip install "./python[learners]" matplotlib`, or a wheel of Driftworld beside `pip install torch matplotlib`.

# %%
import tempfile
from pathlib import Path

import driftworld
import gymnasium as gym
import torch
from driftworld.learners import CLEAR, FineTuning, Settings
from matplotlib import pyplot as plt

torch.set_num_threads(1)
LOGS = Path(tempfile.mkdtemp())

# %% [markdown]
# ## Two tasks
#
# The agent starts in the hallway of a T. In the variant `left` a red cue hangs there, and the left arm pays; in `right` the cue is
# blue, and the right arm pays. The cue tells the tasks apart. The agent sees 32 × 32 pixels.

# %%
TASKS = ["t_maze#left", "t_maze#right"]
figure, axes = plt.subplots(1, 2, figsize=(7, 3.4), layout="constrained")
for axis, task in zip(axes, TASKS, strict=True):
    env = gym.make("driftworld/Task-v0", task=task, modalities="rgb", size=192)
    axis.imshow(env.reset(seed=1)[0])
    axis.set_title(task)
    axis.axis("off")
    env.close()
plt.show()

# %% [markdown]
# How far apart are they, and in which elements of the decision process? `R` is the reward, `O` the observations.

# %%
print(driftworld.distance(*TASKS).explain())

# %% [markdown]
# ## One lifetime
#
# The agent learns from 33,000 decisions of one task, then from as many of the other. Before, between and after, it is tested in 40
# worlds of both, which it never learns from. During tests it is *frozen*, so that they change nothing.


# %%
def learning(task, seed):
    return {"type": "learning", "regimes": [{"task": task.split("#")[0], "variant": task.split("#")[1], "count": 33_000, "steps": 33_000, "seed": seed}]}


def evaluation():
    regimes = [{"task": task.split("#")[0], "variant": task.split("#")[1], "count": 40, "seed": 9} for task in TASKS]
    return {"type": "evaluation", "regimes": regimes}


blocks = [evaluation(), learning(TASKS[0], 1), evaluation(), learning(TASKS[1], 2), evaluation()]
curriculum = driftworld.Curriculum.from_dict({"version": 1, "name": "see_forgetting", "blocks": blocks})

# %% [markdown]
# ## Two learners
#
# Both have the same network, the same PPO and the same worlds. `FineTuning` just continues to learn. `CLEAR` keeps old
# steps and replays them (Rolnick et al. 2019).

# %%
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]  # m/s, degrees per second, interact
RUN = {"num_envs": 64, "modalities": "rgb", "size": 32, "actions": ACTIONS, "interact": False, "frame_skip": 5}
settings = Settings(entropy=0.05, reward_scale=0.02)
learners = {
    "FineTuning": FineTuning(len(ACTIONS), 64, seed=1, settings=settings),
    "CLEAR": CLEAR(len(ACTIONS), 64, seed=1, settings=settings),
}
for name, learner in learners.items():
    curriculum.run_vector(learner, LOGS / name, check_frozen=False, **RUN)
    print(f"{name}: {learner.seconds:.0f} processor seconds")

# %% [markdown]
# ## What is left
#
# Each point is the share of 40 test worlds in which the agent reached the box that pays.


# %%
def successes(name):
    log = driftworld.read_log(LOGS / name)
    found = {}
    for task in TASKS:
        rows = [kind == "test" and each.endswith(task.split("#")[1]) for kind, each in zip(log["block_type"], log["task_name"], strict=True)]
        blocks = log["block_num"][rows]
        found[task] = [float(log["success"][rows][blocks == block].astype(float).mean()) for block in sorted(set(blocks))]
    return found


figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), sharey=True, layout="constrained")
for axis, name in zip(axes, learners, strict=True):
    for task, shares in successes(name).items():
        axis.plot(shares, marker="o", label=task)
    axis.set_title(name)
    axis.set_xticks(range(3), ["before", "after left", "after right"])
    axis.set_ylim(-0.05, 1.05)
axes[0].set_ylabel("successes")
axes[0].legend()
plt.show()
for name in learners:
    print(name, {task: [round(share, 2) for share in shares] for task, shares in successes(name).items()})

# %% [markdown]
# The blue line of `FineTuning` shows forgetting: it rises when *left* is learned and falls when *right* is learned.
# With these settings `CLEAR` forgets as well. A method that helps in one sequence need not help in the next, so it has
# to be tested.
#
# ## The numbers of a paper
#
# *Performance maintenance* below 0 means forgetting; *forward transfer* above 1 means that one task helps the next.
# These numbers come from one lifetime with one seed, which is enough to see an effect but not to claim one.
# `docs/metrics.md` explains them, and how to rule out chance.

# %%
for name in learners:
    print(name, driftworld.metrics(LOGS / name), sep="\n")

# %% [markdown]
# ## Your turn
#
# - Why does rehearsal not help? Learn both tasks in one block, to see whether this network can solve them together at all.
# - Swap `TASKS`, or use two variants of another family (`driftworld tasks` lists them).
# - Write a method of your own: subclass `driftworld.learners.PPO` and override `extra_loss`; `driftworld benchmark new
#   NAME` writes a file to start from.
# - Write a report: `driftworld.report(LOGS / "FineTuning", "report.html")`.
