"""Simultaneous sessions, and long ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from channels import Channels
from clients import Client, Launcher, Seen, free_port
from worlds import thing, world

WORLDS = [world(thing(0, 4), thing(3, 5)), world(thing(2, 6, 1.0), agent={"heading": 20, "observation_size": 24})]


def test_two_workers_at_once_give_the_same_results_as_alone(launcher: Launcher) -> None:
    def start(number: int, port: int) -> tuple[Channels, list[Seen]]:
        channels = Channels()
        client = launcher.start(channels=channels.all, port=port, worker=number)
        clients.append(client)
        channels.reset.say("reset_environment", WORLDS[number])
        return channels, [client.reset().now]

    def action(number: int, step: int) -> tuple[float, float, float]:
        return (4.0, 30.0, 0.0) if (step + number) % 3 else (8.0, -45.0, 0.0)

    clients: list[Client] = []
    port = free_port(2)
    histories = [start(number, port)[1] for number in range(2)]
    for step in range(60):
        for number, client in enumerate(clients[:2]):
            histories[number].append(client.step(action(number, step)).now)
    for number in range(2):
        _, alone = start(number, free_port(2))
        alone += [clients[-1].step(action(number, step)).now for step in range(60)]
        assert all(one.equals(other) for one, other in zip(histories[number], alone))
        assert {seen.agent_id for seen in histories[number]} == {1}, "each worker counts its own episodes"
    assert not histories[0][0].equals(histories[1][0])


def resident_kib(pid: int) -> int:
    """The resident memory of a process."""
    lines = Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS:"))


def test_a_thousand_resets_use_no_more_memory_than_a_hundred(launcher: Launcher, channels: Channels) -> None:
    client = launcher.start(channels=channels.all)
    rng = np.random.default_rng(1)

    def resets(count: int) -> int:
        for number in range(count):
            if number % 2:
                positions = rng.uniform(-15, 15, (20, 2))
                channels.reset.say("reset_environment", world(*(thing(x, y, 1.0) for x, y in positions.tolist())))
            start = client.reset().now
            assert client.step((5.0, 0.0, 0.0)).now.agent_id == start.agent_id
        channels.reset.take()
        return resident_kib(client.process.pid)

    before = resets(100)
    after = resets(1000)
    # The allocator's memory varies by a few hundred KiB from run to run.
    assert after - before < 2048, (before, after)
