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
# # Author a task
#
# You write a task as one document, look at its worlds, make a mistake on purpose, check what your variants change, and train a small
# network to solve it. This takes two minutes and no graphics card.
#
# Needs `pip install "./python[learners]" matplotlib`, or a wheel of Driftworld beside `pip install torch matplotlib`.

# %%
import json
import tempfile
from pathlib import Path

import driftworld
import gymnasium as gym
import torch
from driftworld.learners import PPO, Settings
from matplotlib import pyplot as plt

torch.set_num_threads(1)
WORK = Path(tempfile.mkdtemp())

# %% [markdown]
# ## The document
#
# An orchard: red spheres are ripe and pay, green ones are unripe and cost. The world is a walled square of 16 m.
# Everything that may differ between variants is a *parameter*, which declares the elements of the decision process that
# it affects: `R` is the reward, `O` the observations, `S` the states.

# %%
orchard = {
    "version": 2,
    "name": "orchard",
    "description": "Pick what is ripe, leave what is not.",
    "parameters": {
        "light": {"role": "variant", "type": "number", "affects": ["O"], "range": [0.3, 4], "default": 2.3},
        "ripe": {"role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "gold", "blue"], "default": "red"},
        "unripe_reward": {"role": "variant", "type": "number", "affects": ["R"], "range": [-20, 20], "default": -5},
    },
    "world": {
        "max_seconds": 20,
        "environment_params": {"map_size": [16, 16], "light_intensity": {"param": "light"}},
        "agent_params": {"coordinates": [0, -6], "heading": 0, "max_linear_speed": 6, "max_angular_speed": 120},
    },
    "groups": [
        {
            "name": "ripe", "count": 6,
            "object": {"class": "geometric", "model": "2", "solid": False, "color": {"param": "ripe"}, "reward": 10},
            "placement": {"box": {"low": [-7, -3], "high": [7, 7]}},
        },
        {
            "name": "unripe", "count": 8,
            "object": {"class": "geometric", "model": "2", "solid": False, "color": "green", "reward": {"param": "unripe_reward"}},
            "placement": {"box": {"low": [-7, -3], "high": [7, 7]}},
        },
    ],
    "variants": {"day": {}, "dusk": {"light": 0.6}, "golden": {"ripe": "gold"}, "swapped": {"unripe_reward": 10}},
}  # fmt: skip
path = WORK / "orchard.json"
path.write_text(json.dumps(orchard, indent=1), encoding="utf-8")
task = driftworld.TaskSpec.load(path)
print(task.name, task.variant_names())

# %% [markdown]
# ## A mistake
#
# A document is checked as a whole before anything runs. Each message states the position, what was found, what was expected, and what
# to do.

# %%
wrong = json.loads(path.read_text(encoding="utf-8"))
wrong["world"]["agent_params"]["max_linear_sped"] = 6
wrong["parameters"]["light"]["default"] = 40
try:
    driftworld.TaskSpec.from_dict(wrong, "wrong.json")
except driftworld.SpecError as error:
    print(error)

# %% [markdown]
# ## Its worlds
#
# World number *i* under a seed is always the same, on every machine, and variants share their random
# numbers: with one seed the spheres are at the same positions in all four.

# %%
figure, axes = plt.subplots(2, 4, figsize=(12, 5.6), layout="constrained")
for column, name in enumerate(task.variant_names()):
    env = gym.make("driftworld/Task-v0", task=task, variant=name, modalities="rgb", size=160)
    above = gym.make("driftworld/Task-v0", task=task, variant=name, render_mode="rgb_array", camera="above", render_size=(200, 200))
    above.reset(seed=3)
    axes[0, column].imshow(env.reset(seed=3)[0])
    axes[1, column].imshow(above.render())
    axes[0, column].set_title(name)
    env.close()
    above.close()
for axis in axes.flat:
    axis.axis("off")
plt.show()

# %% [markdown]
# ## How far apart are the variants?
#
# When measured by parameters, a distance of 1 is one parameter moved over its whole range, so 0.4 is two fifths of that.

# %%
matrix = driftworld.distance_matrix(task.variants)
print(matrix.labels, matrix.values.round(2), sep="\n")
print(driftworld.distance(task.variant("day"), task.variant("swapped")).explain())

# %% [markdown]
# ## Does each variant change what it declares?
#
# The document declares that `dusk` changes what is observed and nothing else. An experiment checks it: both worlds of a pair are run
# side by side with the same actions. `phi` is the part of `O` that says how things look; *sound* means that the
# measurement agrees with the declaration.


# %%
def experiment(spec):
    for found in driftworld.elements(spec, worlds=16)["variants"]:
        measured = [each["element"] for each in found["measured"]]
        print(f"{found['variant']:8} declares {found['declared']}, measured {measured}: {found['verdict']}")


experiment(task)

# %% [markdown]
# *Idle* means that `swapped` makes no difference in any world, so the document has a mistake that no check of its keys can find:
# the spheres have a reward, but nothing says *when* it is paid. The next cell pays it once, when the agent touches a sphere,
# which then vanishes.

# %%
for group in orchard["groups"]:
    group["object"] |= {"reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"]}
path.write_text(json.dumps(orchard, indent=1), encoding="utf-8")
task = driftworld.TaskSpec.load(path)
experiment(task)

# %% [markdown]
# ## Can it be learned?
#
# PPO learns from a hundred thousand decisions on 32 × 32 pixels, and is tested before and after in 50 worlds that it never
# learns from.

# %%
ACTIONS = [[6, 0, 0], [6, 45, 0], [6, -45, 0], [2, 120, 0], [2, -120, 0]]  # m/s, degrees per second, interact
RUN = {"num_envs": 64, "modalities": "rgb", "size": 32, "actions": ACTIONS, "interact": False, "frame_skip": 5}
test = {"type": "evaluation", "regimes": [{"task": str(path), "variant": "day", "count": 50, "seed": 2}]}
learn = {"type": "learning", "regimes": [{"task": str(path), "variant": "day", "count": 100_000, "steps": 100_000, "seed": 1}]}
curriculum = driftworld.Curriculum.from_dict({"version": 1, "name": "orchard_alone", "blocks": [test, learn, test]})
learner = PPO(len(ACTIONS), 64, seed=1, settings=Settings(reward_scale=0.1, annealing=100_000))
print(curriculum.run_vector(learner, WORK / "log", check_frozen=False, **RUN))

# %%
log = driftworld.read_log(WORK / "log")
for block, when in ((0, "before"), (2, "after")):
    print(f"{when} learning: {log['reward'][log['block_num'] == block].astype(float).mean():.1f} of 60 in a world")
training = log["reward"][log["block_type"] == "train"].astype(float)
plt.figure(figsize=(7, 3), layout="constrained")
plt.plot([training[max(0, i - 100) : i + 1].mean() for i in range(len(training))])
plt.xlabel("episode of learning")
plt.ylabel("reward, mean of the last 100")
plt.show()

# %% [markdown]
# ## Your turn
#
# - `swapped` makes the green spheres pay too. Learn `day` first and then `swapped`, as in the notebook `forgetting.py`.
# - Draw a new number in every world: `"role": "randomized"` with a `distribution` (`docs/task-specs.md`).
# - Add walls, doors, keys, things to carry: `docs/worlds.md` shows each in a few lines.
