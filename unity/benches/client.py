"""Measures steps per second through mlagents-envs, and where the time goes. `session.rs` measures a step without a client.

    python unity/benches/client.py target/release/driftworld-unity [--steps 2000] [--size 84] [--raw] [--world FILE] [--profile]

Client and executable share one core. Any version of mlagents-envs since 0.16 works (docs/l2explorer.md explains how to install one).
"""

from __future__ import annotations

import argparse
import cProfile
import importlib.metadata
import json
import os
import pathlib
import pstats
import socket
import tempfile
import time
import uuid
from typing import Any

import numpy as np
from mlagents_envs.environment import UnityEnvironment
from mlagents_envs.side_channel.side_channel import OutgoingMessage, SideChannel

RESET_CHANNEL = uuid.UUID("621f0a70-4f87-11ea-a6bf-784f4387d1f7")

# Twenty objects in a ring; the agent drives in a circle.
OBJECTS = 20
RADIUS_M = 12.0


class ResetChannel(SideChannel):
    """Sends worlds and ignores answers."""

    def __init__(self) -> None:
        super().__init__(RESET_CHANNEL)

    def on_message_received(self, msg: Any) -> None:
        """Ignores the answer, which is JSON."""

    def send(self, world: dict[str, Any]) -> None:
        """Queues a reset to a world."""
        message = OutgoingMessage()
        message.write_string(json.dumps({"action": "reset_environment", "payload": world}))
        super().queue_message_to_send(message)


def ring(size: int) -> dict[str, Any]:
    """A world of twenty objects, in the format of L2Explorer's reset files."""
    kinds = ["tree", "barrel", "chair", "rock", "geometric"]
    angles = [2.0 * np.pi * number / OBJECTS for number in range(OBJECTS)]
    return {
        "max_steps": 0,
        "agent_params": {"observation_size": size},
        "objects": [
            {"class": kinds[number % len(kinds)], "coordinates": [RADIUS_M * np.cos(angle), RADIUS_M * np.sin(angle)]}
            for number, angle in enumerate(angles)
        ],
    }


def cpu_seconds(pid: int) -> float:
    """CPU time that a process has used so far."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def actor(env: Any, name: str) -> Any:
    """Returns a function that sets an action of three numbers in this version of the client."""
    numbers = np.array([[5.0, 15.0, 0.0]], dtype=np.float32)
    try:
        from mlagents_envs.base_env import ActionTuple
    except ImportError:
        return lambda: env.set_actions(name, numbers)
    return lambda: env.set_actions(name, ActionTuple(continuous=numbers))


def main() -> None:
    """Runs the measurement and prints the result."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--size", type=int, default=84)
    parser.add_argument("--raw", action="store_true", help="pictures as floats")
    parser.add_argument("--world", type=pathlib.Path, help="a reset file of L2Explorer in place of the ring")
    parser.add_argument("--profile", action="store_true", help="where the client spends its time")
    options = parser.parse_args()
    # The executable inherits this affinity.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        link = pathlib.Path(folder) / "l2explorer.x86_64"
        link.symlink_to(options.executable.resolve())
        channel = ResetChannel()
        arguments = ["--raw-observations"] if options.raw else []
        try:
            env = UnityEnvironment(str(link), base_port=port, side_channels=[channel], args=arguments)
        except TypeError:
            env = UnityEnvironment(str(link), base_port=port, side_channels=[channel], additional_args=arguments)
        channel.send(json.loads(options.world.read_text()) if options.world else ring(options.size))
        env.reset()
        name = next(iter(env.get_behavior_names() if hasattr(env, "get_behavior_names") else env.behavior_specs))
        act = actor(env, name)
        process = getattr(env, "proc1", None) or env._process
        for _ in range(100):
            act()
            env.step()
        profile = cProfile.Profile() if options.profile else None
        ours, client, start = cpu_seconds(process.pid), cpu_seconds(os.getpid()), time.perf_counter()
        if profile:
            profile.enable()
        for _ in range(options.steps):
            act()
            env.step()
            env.get_steps(name)
        if profile:
            profile.disable()
        wall = time.perf_counter() - start
        ours, client = cpu_seconds(process.pid) - ours, cpu_seconds(os.getpid()) - client
        env.close()
    version = importlib.metadata.version("mlagents-envs")
    form = "floats" if options.raw else "PNG"
    print(
        f"mlagents-envs {version}, three pictures of {options.size} x {options.size} as {form}, {options.steps} steps"
    )
    print(f"{options.steps / wall:.0f} steps/s on one core: {1e6 * wall / options.steps:.0f} us a step, of which")
    print(f"  {1e6 * ours / options.steps:6.0f} us driftworld-unity")
    print(f"  {1e6 * client / options.steps:6.0f} us the client in Python")
    if profile:
        pstats.Stats(profile).sort_stats("tottime").print_stats(14)


if __name__ == "__main__":
    main()
