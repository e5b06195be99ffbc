"""Not an example: records results of the examples, so that they can be reproduced.

A result is a folder: `config.json` (command, seeds, options, versions, machine, and the hashes of variants and first
worlds), `curve.csv`, `curve.png`, and a `README.md` generated from them.
"""

from __future__ import annotations

import csv
import datetime
import importlib.metadata
import json
import os
import platform
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

# The seed of the held-out worlds.
EVALUATION_SEED = 1_000_000
# Student's t for 95 % intervals of means of 2, 3, … 10 numbers.
T_95 = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26)
FOLDER = Path(__file__).parent / "results"
# Settings that differ between users, such as the folder of results, and are therefore not recorded.
_UNRECORDED = ("logs", "results", "quick", "again", "threads", "address")
PACKAGES = ("driftworld", "gymnasium", "numpy", "torch", "stable-baselines3", "ray")


def result_folder(program: str) -> str:
    """The name of an example's result folder."""
    return str(FOLDER / Path(program).stem)


class Watch:
    """The start of a run, and the machine's load at that time."""

    def __init__(self) -> None:
        self._start = time.perf_counter()
        self.load = round(os.getloadavg()[0], 2)

    @property
    def seconds(self) -> float:
        """Seconds since the start."""
        return time.perf_counter() - self._start


class FrozenPolicy:
    """A policy under evaluation: a `driftworld.VectorAgent` that does not learn.

    Args:
        probabilities: Maps observations to action probabilities, `(num_envs, actions)`.
        policy: `"sampled"` draws actions from them; `"greedy"` takes the most probable.
        seed: Seeds the actions, together with the seed of each experience.
        num_envs: Number of environments.
    """

    def __init__(self, probabilities: Callable[[Any], Any], policy: str, seed: int, num_envs: int) -> None:
        self.probabilities, self.policy, self.seed = probabilities, policy, seed
        self.generators = [np.random.default_rng(seed) for _ in range(num_envs)]

    def begin(self, env: int, label: str | None, seed: int) -> None:
        """Seeds the actions of an experience, so that they do not depend on generators used for learning."""
        self.generators[env] = np.random.default_rng([seed, self.seed])

    def act(self, observations: Any, infos: dict[str, Any]) -> Any:
        """Actions for all environments, `(num_envs,)`."""
        probabilities = np.asarray(self.probabilities(observations), dtype=np.float64)
        if self.policy == "greedy":
            return probabilities.argmax(axis=1)
        drawn = np.array([generator.random() for generator in self.generators])
        return np.minimum((probabilities.cumsum(axis=1) < drawn[:, None]).sum(axis=1), probabilities.shape[1] - 1)

    def learn(self, transition: Any) -> None:
        """Does nothing: the policy does not learn."""

    def freeze(self, frozen: bool) -> None:
        """Does nothing: the policy is always frozen."""


def held_out_curriculum(variant: str, episodes: int) -> Any:
    """A curriculum with one evaluation, in worlds 0 to `episodes` - 1 of the held-out seed."""
    import driftworld

    task, _, name = variant.partition("#")
    regime = {"task": task, "variant": name, "count": episodes, "seed": EVALUATION_SEED}
    blocks = [{"type": "evaluation", "regimes": [regime]}]
    return driftworld.Curriculum.from_dict({"version": 1, "name": "held_out", "blocks": blocks})


def evaluate_policy(
    curriculum: Any, probabilities: Callable[[Any], Any], policy: str, seed: int, num_envs: int, options: dict[str, Any]
) -> dict[str, float]:
    """Mean reward, its standard deviation over episodes, and the share of solved episodes."""
    rewards: list[float] = []
    summary = curriculum.run_vector(
        FrozenPolicy(probabilities, policy, seed, num_envs),
        num_envs=num_envs,
        watch=lambda experience, reward: rewards.append(reward),
        **options,
    )
    return {
        "reward": round(float(np.mean(rewards)), 1),
        "deviation": round(float(np.std(rewards)), 1),
        "success": round(summary.regimes[0]["success_rate"], 3),
        "episodes": len(rewards),
    }


@dataclass
class Record:
    """The result of one run of an example.

    Attributes:
        title: The heading of its page.
        text: A description of the run, in a few sentences.
        settings: All settings: options of the environment, options of the learner, and seeds.
        variants: The variants that were used, `task#variant`.
        seeds: Seeds; the hash of the first world of each is recorded.
        curve: Rows of numbers; those with the same `seed` (or `run`) form one line of the figure.
        seconds: Duration of the run.
        load_before: The machine's load before the run.
        lines: Levels for comparison, by name, drawn as horizontal lines.
        table: Rows of the page's table.
        files: Additional files, texts or JSON documents, by file name.
        axes: The columns of the curve on the horizontal and the vertical axis.
        labels: The labels of these axes.
    """

    title: str
    text: str
    settings: Mapping[str, Any]
    variants: Sequence[str]
    seeds: Sequence[int]
    curve: Sequence[Mapping[str, Any]]
    seconds: float
    load_before: float
    lines: Mapping[str, float] = field(default_factory=dict)
    table: Sequence[Mapping[str, Any]] = ()
    files: Mapping[str, Any] = field(default_factory=dict)
    axes: tuple[str, str] = ("steps", "reward")
    labels: tuple[str, str] = ("steps of learning", "reward of an episode, mean of the last 100")

    def write(self, folder: str | Path) -> None:
        """Writes the folder, overwriting files with the same names."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        config = self._config()
        (folder / "config.json").write_text(json.dumps(config, indent=2) + "\n", encoding="utf-8")
        for name, document in self.files.items():
            text = document if isinstance(document, str) else json.dumps(document) + "\n"
            (folder / name).write_text(text, encoding="utf-8")
        if self.curve:
            with (folder / "curve.csv").open("w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, list(self.curve[0]), lineterminator="\n")
                writer.writeheader()
                writer.writerows(self.curve)
            self._draw(folder / "curve.png")
        (folder / "README.md").write_text(self._page(config), encoding="utf-8")
        print(f"recorded in {folder}")

    def _config(self) -> dict[str, Any]:
        return {
            "command": " ".join(["python", f"examples/python/{Path(sys.argv[0]).name}", *_portable(sys.argv[1:])]),
            "date": datetime.date.today().isoformat(),
            "seconds": round(self.seconds, 1),
            "machine": {"processor": _processor(), "cores": os.cpu_count(), "load_before": self.load_before},
            "versions": {"python": platform.python_version(), **_versions()},
            "settings": {name: value for name, value in self.settings.items() if name not in _UNRECORDED},
            "worlds": {variant: _hashes(variant, self.seeds) for variant in self.variants},
        }

    def _page(self, config: Mapping[str, Any]) -> str:
        machine, versions = config["machine"], config["versions"]
        package_versions = ", ".join(f"{name} {version}" for name, version in versions.items())
        provenance = (
            f"Made on {config['date']} in {config['seconds'] / 60:.1f} minutes on {machine['cores']} cores "
            f"({machine['processor']}; load average before the run {machine['load_before']}), with {package_versions}."
        )
        parts = [f"# {self.title}", "", self.text, "", "```sh", config["command"], "```", ""]
        if self.curve:
            parts += ["![The curve: " + self.labels[1] + ", by " + self.labels[0] + "](curve.png)", ""]
        parts += [*_table(self.table), ""]
        if self.lines:
            parts += [*_table([{"for comparison": name, "reward": level} for name, level in self.lines.items()]), ""]
        parts += [
            provenance,
            "",
            "All settings, and the hashes of the variants and of the first worlds, are in [config.json](config.json).",
        ]
        kept = [*(["curve.csv"] if self.curve else []), *self.files]
        if kept:
            parts += ["Other files: " + ", ".join(f"[{name}]({name})" for name in kept) + "."]
        parts += [""]
        return "\n".join(parts)

    def _draw(self, path: Path) -> None:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        x_column, y_column = self.axes
        key = next((name for name in ("run", "seed") if name in self.curve[0]), None)
        figure, axes = pyplot.subplots(figsize=(7.2, 4.2), dpi=120, layout="constrained")
        names = dict.fromkeys(row[key] for row in self.curve) if key else {None: None}
        # Runs named "day, replay" and "day, sequential" share a colour; the second is dashed.
        parts = [str(name).partition(", ") for name in names]
        colours = list(dict.fromkeys(first for first, _, _ in parts))
        styles = list(dict.fromkeys(second for _, _, second in parts))
        for name, (first, _, second) in zip(names, parts, strict=True):
            rows = [row for row in self.curve if key is None or row[key] == name]
            axes.plot(
                [row[x_column] for row in rows],
                [row[y_column] for row in rows],
                label=None if key is None else f"{key} {name}" if key == "seed" else str(name),
                color=f"C{colours.index(first)}",
                linestyle=("-", "--")[styles.index(second) % 2],
                marker="o" if len(rows) < 20 else None,
                linewidth=1.6,
            )
        for (name, level), style in zip(self.lines.items(), ("--", ":", "-."), strict=False):
            axes.axhline(level, color="0.35", linestyle=style, linewidth=1.1, label=f"{name} ({level:g})")
        axes.set_xlabel(self.labels[0])
        axes.set_ylabel(self.labels[1])
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(lambda value, _: f"{value:,.0f}" if float(value).is_integer() else f"{value:g}")
        axes.set_xlim(left=0)
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
        if key or self.lines:
            figure.legend(frameon=False, loc="outside upper center", ncols=2)
        figure.savefig(path, metadata={"Software": None})
        pyplot.close(figure)


def _portable(arguments: Iterable[str]) -> list[str]:
    """The command line without the result folder, which differs between users."""
    words = list(arguments)
    if "--results" in words:
        index = words.index("--results")
        has_folder = index + 1 < len(words) and not words[index + 1].startswith("--")
        words[index : index + 2 if has_folder else index + 1] = ["--results"]
    return words


def _table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    if not rows:
        return []
    columns = list(rows[0])
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return [*lines, *("| " + " | ".join(_cell(row[column]) for column in columns) + " |" for row in rows)]


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 10 else f"{value:.1f}"
    return f"{value:,}" if isinstance(value, int) and abs(value) >= 10_000 else str(value)


def _versions() -> dict[str, str]:
    versions = {}
    for package in PACKAGES:
        if package.replace("-", "_") in sys.modules or package == "numpy":
            try:
                versions[package] = importlib.metadata.version(package)
            except importlib.metadata.PackageNotFoundError:  # run from its source
                versions[package] = str(getattr(sys.modules[package], "__version__", "unknown"))
    return versions


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def _hashes(variant: str, seeds: Sequence[int]) -> dict[str, Any]:
    """The hash of a variant, and of its first world under each seed."""
    import driftworld
    import gymnasium

    task, _, name = variant.partition("#")
    env = gymnasium.make("driftworld/Task-v0", task=variant)
    first_worlds = {str(seed): env.reset(seed=seed)[1]["world_hash"] for seed in seeds}
    env.close()
    return {"variant": driftworld.TaskSpec.load(task).variant(name).hash, "first_worlds": first_worlds}
