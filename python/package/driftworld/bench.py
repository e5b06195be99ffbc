"""Measures the speed of environments through Python, compared with the same batch in Rust and with installed peers.

``python -m driftworld.bench`` measures on this machine and prints a table; ``--quick`` measures only briefly, to check
that it works.

Peers: ViZDoom (``pip install vizdoom``) and MiniWorld (``pip install miniworld``; it needs a display, ``xvfb-run``
makes one). Each is measured with one environment, next to a single-threaded Driftworld environment at the peer's usual
image size.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import gymnasium
import numpy as np

import driftworld

__all__ = ["main", "measure"]

FIND = "driftworld/FindObjects-v0"
_THREE = ("rgb", "depth", "segmentation")
#: A rate is the median of this many measurements.
_STRETCHES = 15


def measure(*, seconds: float = 2.0, peers: bool = True) -> dict[str, Any]:
    """Runs all measurements.

    Args:
        seconds: Time spent on each rate, which is the median of 15 measurements.
        peers: Whether to measure ViZDoom and MiniWorld if they are installed.

    Returns:
        Rates per second, overheads in µs and ratios by name; for a peer that could not be measured, the reason.
    """
    figures: dict[str, Any] = {
        "machine": {
            "processors": os.cpu_count(),
            "python": platform.python_version(),
            "driftworld": driftworld.__version__,
            "gymnasium": gymnasium.__version__,
        },
    }
    modes: tuple[tuple[str, dict[str, Any]], ...] = (
        ("_copies", {"copy": True}),
        ("", {"copy": False}),
        ("_metres", {"copy": False, "depth": "float32"}),
    )
    for name, options in modes:
        figures.update(_vector(name, seconds, {"modalities": _THREE, **options}))
    figures.update(_single(seconds))
    figures.update(_resets(seconds))
    if peers:
        figures.update(_beside("vizdoom_160x120", _vizdoom, (120, 160), seconds))
        figures.update(_beside("miniworld_84x84", _miniworld, (84, 84), seconds))
    return figures


def _rate(work: Callable[[], int], seconds: float) -> float:
    """The rate per second; ``work`` returns the amount of work that it did."""
    return _rates([work], seconds)[0]


def _rates(works: Sequence[Callable[[], int]], seconds: float) -> list[float]:
    """The rates of several workloads, measured in turn, so that a busy moment of the machine affects all of them."""
    for work in works:
        work()
    rates: list[list[float]] = [[] for _ in works]
    for _ in range(_STRETCHES):
        for work, own in zip(works, rates, strict=True):
            done, start = 0, time.perf_counter()
            while (passed := time.perf_counter() - start) < seconds / _STRETCHES:
                done += work()
            own.append(done / passed)
    return [statistics.median(own) for own in rates]


def _batch(env: Any) -> Any:
    """The native batch behind an environment."""
    return env.unwrapped._members.batch


def _vector(name: str, seconds: float, options: dict[str, Any]) -> dict[str, Any]:
    """64 environments: steps through Python, and the same steps without returning to it."""
    envs = gymnasium.make_vec(FIND, num_envs=64, vectorization_mode="vector_entry_point", **options)
    envs.reset(seed=0)
    envs.action_space.seed(0)
    actions = envs.action_space.sample()
    batch = _batch(envs)

    def through_python() -> int:
        for _ in range(8):
            envs.step(actions)
        return 8 * 64

    def in_rust() -> int:
        batch.repeat(8)
        return 8 * 64

    python, rust = _rates([through_python, in_rust], seconds)
    envs.close()
    return {f"vector{name}": python, f"vector{name}_rust": rust, f"vector{name}_ratio": python / rust}


def _single(seconds: float) -> dict[str, Any]:
    """One environment: the overhead of a step over the same step in Rust."""
    env = gymnasium.make(FIND, modalities=_THREE, disable_env_checker=True).unwrapped
    env.reset(seed=0)
    action = np.array([0.5, 0.2, 0.0], dtype=np.float32)
    env.step(action)
    left = [0]

    def through_python() -> int:
        for _ in range(16):
            if left[0] == 0:
                env.reset(seed=0)
                left[0] = 256
            env.step(action)
            left[0] -= 1
        return 16

    # The batch of a single environment does not reset itself, so Rust's share is measured on one that does.
    alone = gymnasium.make_vec(
        FIND,
        num_envs=1,
        num_threads=1,
        modalities=_THREE,
        max_episode_steps=256,
        vectorization_mode="vector_entry_point",
    )
    alone.reset(seed=0)
    alone.step(action[np.newaxis])

    def in_rust() -> int:
        _batch(alone).repeat(16)
        return 16

    python, rust = _rates([through_python, in_rust], seconds)
    env.close()
    alone.close()
    return {"single": python, "single_rust": rust, "single_overhead_us": 1e6 * (1 / python - 1 / rust)}


def _resets(seconds: float) -> dict[str, Any]:
    env = gymnasium.make(FIND, modalities=_THREE, disable_env_checker=True).unwrapped
    env.reset(seed=0)

    def reset() -> int:
        env.reset()
        return 1

    return {"resets": _rate(reset, seconds)}


def _ours(size: tuple[int, int], seconds: float) -> float:
    """One Driftworld environment with one thread, drawing everything that the peer draws and more."""
    env = gymnasium.make(FIND, modalities=_THREE, size=size, disable_env_checker=True).unwrapped
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]
    return _rate(_steps(env, actions), seconds)


def _steps(env: Any, actions: list[Any]) -> Callable[[], int]:
    """64 random steps, including the time of resets when episodes end."""
    env.reset(seed=0)

    def work() -> int:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(actions)

    return work


def _beside(name: str, peer: Callable[[float], float], size: tuple[int, int], seconds: float) -> dict[str, Any]:
    try:
        theirs = peer(seconds)
    except Exception as error:  # noqa: BLE001 - peers fail in ways of their own: no display, no driver, another version
        return {f"{name}_missing": f"{type(error).__name__}: {error}".splitlines()[0]}
    ours = _ours(size, seconds)
    return {name: theirs, f"{name}_ours": ours, f"{name}_ratio": ours / theirs}


def _vizdoom(seconds: float) -> float:
    """ViZDoom's basic scenario with depth and labels, stepped as in its own examples."""
    import vizdoom

    game = vizdoom.DoomGame()
    game.load_config(os.path.join(vizdoom.scenarios_path, "basic.cfg"))
    game.set_screen_resolution(vizdoom.ScreenResolution.RES_160X120)
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    game.set_depth_buffer_enabled(True)
    game.set_labels_buffer_enabled(True)
    game.set_window_visible(False)
    game.set_mode(vizdoom.Mode.PLAYER)
    game.init()
    chance = np.random.default_rng(0)
    actions = chance.integers(0, 2, (64, game.get_available_buttons_size())).astype(bool).tolist()

    def work() -> int:
        for action in actions:
            if game.is_episode_finished():
                game.new_episode()
            _ = game.get_state().screen_buffer
            game.make_action(action)
        return len(actions)

    try:
        game.new_episode()
        return _rate(work, seconds)
    finally:
        game.close()


def _miniworld(seconds: float) -> float:
    """MiniWorld's smallest room, colour images only."""
    import miniworld  # noqa: F401 - registers its environments

    env = gymnasium.make("MiniWorld-OneRoom-v0", obs_width=84, obs_height=84)
    try:
        return _rate(_steps(env, [env.action_space.sample() for _ in range(64)]), seconds)
    finally:
        env.close()


_LINES = (
    (
        "64 environments, three modalities, copies",
        "vector_copies",
        "vector_copies_rust",
        "vector_copies_ratio",
        "Rust alone",
    ),
    ("the same, read-only views (copy=False)", "vector", "vector_rust", "vector_ratio", "Rust alone"),
    (
        "the same views, depth in metres",
        "vector_metres",
        "vector_metres_rust",
        "vector_metres_ratio",
        "Rust alone",
    ),
    ("one environment, 160 x 120", "vizdoom_160x120_ours", "vizdoom_160x120", "vizdoom_160x120_ratio", "ViZDoom"),
    (
        "one environment, 84 x 84",
        "miniworld_84x84_ours",
        "miniworld_84x84",
        "miniworld_84x84_ratio",
        "MiniWorld, colour",
    ),
)


def _table(figures: dict[str, Any]) -> str:
    machine = figures["machine"]
    versions = f"Driftworld {machine['driftworld']}, Python {machine['python']}, Gymnasium {machine['gymnasium']}"
    lines = [
        f"{versions}, {machine['processors']} processors",
        f"{'steps per second':<52}{'ours':>10}  {'other':>10}  {'ratio':>6}",
    ]
    for text, ours, theirs, ratio, who in _LINES:
        if ours in figures:
            lines.append(f"{text:<52}{figures[ours]:>10,.0f}  {figures[theirs]:>10,.0f}  {figures[ratio]:>6.2f}  {who}")
        elif f"{theirs}_missing" in figures:
            lines.append(f"{text:<52}{'':>10}  {'':>10}  {'':>6}  {who}: {figures[f'{theirs}_missing']}")
    lines.append(
        f"one environment alone: {figures['single']:,.0f} steps/s, {figures['single_overhead_us']:.1f} µs a step on top of the "
        f"step in Rust ({figures['single_rust']:,.0f} steps/s)"
    )
    lines.append(f"resets: {figures['resets']:,.0f} per second, each to a new world")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit status."""
    parser = argparse.ArgumentParser(prog="python -m driftworld.bench", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=2.0, help="time spent on each rate (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="measure each rate only briefly, and no peers")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    asked = parser.parse_args(arguments)
    if not asked.seconds > 0:
        parser.error("--seconds: expected more than 0")
    figures = measure(seconds=0.05 if asked.quick else asked.seconds, peers=not asked.quick)
    print(json.dumps(figures, indent=2) if asked.json else _table(figures))
    return 0


if __name__ == "__main__":
    sys.exit(main())
