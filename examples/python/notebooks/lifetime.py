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
# # Run and score a lifetime
#
# Two small learners go through the same curriculum: by day blue cubes pay and red ones cost; in the evening it is the
# other way round. One learner remembers a value for each colour, the other a value for each colour and sky. What does
# each retain, and what do the metrics of lifelong learning show? This notebook only shows the mechanics: with one
# lifetime each, 12 experiences per block and 6 evaluations, a difference between the two may be due to chance.
#
# Needs `pip install "./python[pandas]" matplotlib`, and runs in seconds: these learners search for coloured pixels and
# have no network. `../experts_and_sequential_ppo.py` does the same with a network.

# %%
import tempfile
from pathlib import Path

import driftworld
import numpy as np
from matplotlib import pyplot as plt

HERE = Path(__file__).parent if "__file__" in globals() else Path.cwd()
SPEC = str(HERE.parent / "two_skies.json")
LOGS = Path(tempfile.mkdtemp())

# %% [markdown]
# ## Two learners


# %%
class Seeker:
    """Walks towards the colour that it values most and away from colours that cost, and learns values by touching
    objects.
    """

    def __init__(self, name: str, by_sky: bool) -> None:
        self.name, self.by_sky = name, by_sky
        self.worth: dict[tuple[str, str], float] = {}
        self.sought: tuple[str, str] | None = None

    def key(self, picture, colour):
        """The key under which a value is remembered."""
        red, _, blue = picture[0].mean(axis=0)
        sky = ("evening" if red > blue else "day") if self.by_sky else "any"
        return (sky, colour)

    def act(self, picture, info):
        red, green, blue = np.moveaxis(picture.astype(int), -1, 0)
        seen = {"blue": (blue > 60) & (red < 40) & (green < 40), "red": (red > 60) & (green < 40) & (blue < 40)}
        worths = {
            colour: self.worth.get(self.key(picture, colour), 30.0) for colour in seen
        }  # unknown colours are worth a try
        self.sought, turn = None, 0.6
        best = min(0.0, max(worths.values()) - 1.0)  # if all seem to cost, the least bad
        for colour, pixels in seen.items():
            if not pixels.any():
                continue
            column = np.nonzero(pixels)[1].mean() / (picture.shape[1] - 1) - 0.5
            if worths[colour] > best:
                self.sought, best, turn = self.key(picture, colour), worths[colour], float(np.clip(4 * column, -1, 1))
            elif self.sought is None and abs(column) < 0.3 and pixels.mean() > 0.01:
                turn = -0.8 if column > 0 else 0.8
        return np.array([0.3 if self.sought is None else 0.8, turn])

    def learn(self, step):
        if abs(step.reward) > 10 and self.sought is not None:
            before = self.worth.get(self.sought, step.reward)
            self.worth[self.sought] = before + 0.5 * (step.reward - before)

    def freeze(self, frozen):
        pass


# %% [markdown]
# ## A curriculum for both
#
# Two variants alternate, twice each. Everything is logged in the l2logger format, as by `driftworld run`. Each expert
# learns one variant, with as many experiences as in both blocks of the lifetime together.

# %%
VARIANTS = [f"{SPEC}#day", f"{SPEC}#evening"]
PLAN = {"learn": 12, "eval_episodes": 6, "seed": 5}
OPTIONS = {"modalities": "rgb", "size": 48, "interact": False, "frame_skip": 2, "max_steps": 150}
PLAN |= {"form": "alternating", "blocks": 4}
curriculum = driftworld.Curriculum.design(*VARIANTS, name="two_skies", **PLAN)
experts = []
for number, plan in enumerate(driftworld.Curriculum.experts(*VARIANTS, **PLAN | {"learn": 2 * PLAN["learn"]})):
    plan.run(Seeker("expert", by_sky=False), log=LOGS / f"expert_{number}", **OPTIONS)
    experts.append(LOGS / f"expert_{number}")
for name, by_sky in (("one_memory", False), ("memory_by_sky", True)):
    summary = curriculum.run(Seeker(name, by_sky), log=LOGS / name, **OPTIONS)
    print(name, summary, sep="\n", end="\n\n")

# %% [markdown]
# ## What was retained
#
# Performance maintenance below 0 means forgetting; forward and backward transfer above 1 mean that one task helps
# another. `driftworld.metrics(log).null` shows whether a number may be due to chance: it has the range of values that
# the same log would give if the agent had never changed.

# %%
scores = driftworld.metrics([LOGS / "one_memory", LOGS / "memory_by_sky"], ste=experts)
print(scores.to_pandas().T.to_string(float_format="{:.2f}".format))

# %%
figure, axes = plt.subplots(2, 1, figsize=(10, 5), sharex=True, sharey=True, layout="constrained")
for axis, name in zip(axes, ("one_memory", "memory_by_sky"), strict=True):
    log = driftworld.read_log(LOGS / name)
    for variant, colour in (("day", "tab:blue"), ("evening", "tab:orange")):
        for kind, marker in (("train", "."), ("test", "x")):
            chosen = [task.endswith(variant) for task in log["task_name"]] & (log["block_type"] == kind)
            axis.plot(
                log["exp_num"][chosen], log["reward"][chosen], marker, color=colour, alpha=0.8,
                label=f"{variant}, {'learning' if kind == 'train' else 'evaluation'}",
            )  # fmt: skip
    axis.set_title(name.replace("_", " "))
    axis.set_ylabel("reward")
axes[1].set_xlabel("experience")
axes[1].legend(ncols=2, loc="lower right")
plt.show()

# %% [markdown]
# ## Everything on one page

# %%
page = driftworld.report(
    [LOGS / "one_memory", LOGS / "memory_by_sky"],
    LOGS / "report.html",
    ste=experts,
    title="Two memories under two skies",
)
print(f"the report: {LOGS / 'report.html'}, {len(page):,} characters")
