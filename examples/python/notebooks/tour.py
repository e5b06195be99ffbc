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
# # From a task spec to a curriculum
#
# An overview: a spec with its variants, worlds drawn from them, an agent's view, distances between variants, and a
# curriculum ordered by distance. `jupytext --to notebook tour.py` turns this file into a notebook; it also runs as a
# program.
#
# Needs `pip install ./python matplotlib`.

# %%
import driftworld
import gymnasium as gym
import numpy as np
from matplotlib import pyplot as plt

# %% [markdown]
# ## A spec and its variants
#
# Parameters are fixed, drawn for every world, or set by variants. Each variant parameter says which element of the decision
# process it touches: states, actions, transitions, rewards, observations.

# %%
task = driftworld.TaskSpec.load("find_objects")
print(task.name, "-", task.description)
for name, parameter in task.parameters.items():
    print(f"{name:14} {parameter['role']:11} {' '.join(parameter.get('affects', [])):4} {parameter['description']}")

# %%
NAMES = ["blue", "red", "green", "dusk", "spheres", "huddle", "wide", "slow"]
variants = [task.variant(name) for name in NAMES]

# %% [markdown]
# ## Worlds
#
# World number i of a seed is a pure function of the variant, the seed and i. With the same seed, variants share their
# random numbers, so equal parts of their specs give equal parts of their worlds.

# %%
world = task.variant("blue").sample(seed=3, index=0)
again = task.variant("blue").sample(seed=3, index=0)
assert world == again
wide = task.variant("wide").sample(seed=3, index=0)
for name, drawn in (("blue", world), ("wide", wide)):
    cubes = [thing["coordinates"] for thing in drawn["objects"] if thing.get("tag") == "targets"]
    print(f"{name}: cubes at", [[round(number, 1) for number in place] for place in cubes])

# %% [markdown]
# ## What an agent sees
#
# An observation has several modalities: here colour, distance, and the reward category of objects.

# %%
env = gym.make(
    "driftworld/FindObjects-v0", size=120, depth="float32", modalities=["rgb", "depth", "segmentation"]
)
figure, axes = plt.subplots(3, len(NAMES), figsize=(14, 5.4), layout="constrained")
for column, name in enumerate(NAMES):
    observation, info = env.reset(seed=3, options={"variant": name})
    axes[0, column].imshow(observation["rgb"])
    axes[1, column].imshow(observation["depth"][..., 0], cmap="viridis_r", vmax=40)
    axes[2, column].imshow(observation["segmentation"][..., 0], cmap="tab10", vmin=0, vmax=9, interpolation="nearest")
    axes[0, column].set_title(name)
for row, words in enumerate(("colour", "distance to 40 m", "reward category")):
    axes[row, 0].set_ylabel(words)
for axis in axes.flat:
    axis.set_xticks([])
    axis.set_yticks([])
env.close()
plt.show()

# %% [markdown]
# ## Distances between variants
#
# The distance is a sum over parameters, in units of their ranges, and is split by element.

# %%
print(driftworld.distance("find_objects#blue", "find_objects#dusk").explain())

# %%
matrix = driftworld.distance_matrix(variants)
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
picture = left.imshow(matrix.values, cmap="magma_r", vmin=0)
left.set_xticks(range(len(NAMES)), NAMES, rotation=45, ha="right")
left.set_yticks(range(len(NAMES)), NAMES)
left.set_title("distance")
figure.colorbar(picture, ax=left, shrink=0.85)

order = driftworld.order(matrix)
print("a short path through all of them:", " > ".join(label.split("#")[-1] for label in order.labels))

# Classical scaling gives each variant two coordinates that preserve the distances as well as possible.
points = matrix.embed(2)
right.plot(*points[order.indices].T, color="0.6", linewidth=1)
right.scatter(*points.T, zorder=2)
for number, (name, point) in enumerate(zip(NAMES, points, strict=True)):
    right.annotate(name, point, xytext=(6, 6 if number % 2 else -12), textcoords="offset points")
right.set_title("variants on a plane, and the order")
right.set_aspect("equal", adjustable="datalim")
plt.show()

# %% [markdown]
# ## A curriculum
#
# Three variants become blocks of learning, with evaluations of all of them before and after each block.

# %%
curriculum = driftworld.Curriculum.design(
    "find_objects#blue",
    "find_objects#red",
    "find_objects#dusk",
    start="find_objects#blue",
    learn=6,
    eval_episodes=2,
    seed=3,
)
for block in curriculum:
    print(
        f"{block.kind:10} {len(block):2} experiences, first of {block[0].variant}, world {block[0].index} under seed {block[0].seed}"
    )


# %% [markdown]
# Any agent with `act`, `learn` and `freeze` can run through it; the notebook `lifetime.py` scores the log.


# %%
class Wanderer:
    """Walks ahead with random turns, and learns nothing."""

    def begin(self, label, seed):
        # Seeded in each experience, so that a frozen agent acts identically when an evaluation is repeated.
        self.rng = np.random.default_rng(seed)

    def act(self, observation, info):
        return np.array([1.0, self.rng.uniform(-0.4, 0.4)])

    def learn(self, transition):
        pass

    def freeze(self, frozen):
        pass


summary = curriculum.run(Wanderer(), interact=False, size=48, modalities="rgb")
print(summary)
