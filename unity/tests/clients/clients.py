"""A common interface to clients of all generations, and a launcher for clients and executables."""

from __future__ import annotations

import re
import socket
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mlagents_envs
import numpy as np
import numpy.typing as npt
from mlagents_envs.environment import UnityEnvironment
from mlagents_envs.side_channel.side_channel import SideChannel

#: The generation of the client: (0, 16), (0, 28), (1, 1).
GENERATION = tuple(int(number) for number in re.findall(r"\d+", mlagents_envs.__version__)[:2])

#: The behaviour's name.
BEHAVIOR = "L2Explorer?team=0"

#: Timeout for events that normally happen at once.
TIMEOUT_SECS = 30

#: An action that does nothing.
REST = (0.0, 0.0, 0.0)

Floats = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Seen:
    """What a client receives about the agent at one moment."""

    agent_id: int
    reward: float
    #: The observations, as the client returns them.
    arrays: list[Floats]
    #: Whether the step limit ended the episode.
    truncated: bool = False

    @property
    def pictures(self) -> list[Floats]:
        """Depth, colour and segmentation as (height, width, channels), for any client's order of axes."""
        axes = (1, 2, 0) if GENERATION >= (1, 0) else (0, 1, 2)
        return [array.transpose(axes) for array in self.arrays if array.ndim == 3]

    @property
    def depth(self) -> Floats:
        return self.pictures[0]

    @property
    def rgb(self) -> Floats:
        return self.pictures[1]

    @property
    def segmentation(self) -> Floats:
        return self.pictures[2]

    @property
    def vector(self) -> Floats:
        """The number of the collected object, x, y, heading, velocity x, velocity y."""
        return self.arrays[3]

    def equals(self, other: Seen) -> bool:
        """Whether both have equal observations, bit for bit."""
        return len(self.arrays) == len(other.arrays) and all(
            mine.shape == theirs.shape and bool((mine == theirs).all())
            for mine, theirs in zip(self.arrays, other.arrays)
        )


@dataclass(frozen=True)
class Moment:
    """The result of a reset or a step."""

    #: The agent before its next action.
    now: Seen
    #: The agent at the end of its episode, if the step was the last.
    end: Seen | None


class Client:
    """A client of the installed generation, and its executable."""

    def __init__(self, env: UnityEnvironment, process: subprocess.Popen[Any] | None) -> None:
        self.env = env
        #: The process of the executable, which the client or the launcher started.
        self.process: subprocess.Popen[Any] = process or (env.proc1 if GENERATION < (0, 17) else env._process)

    def reset(self) -> Moment:
        self.env.reset()
        return self.moment()

    def step(self, action: Sequence[float] | npt.NDArray[Any] = REST) -> Moment:
        self.act(np.array([action], dtype=np.float32))
        self.env.step()
        return self.moment()

    def choose(self, row: int) -> Moment:
        """Takes a step with a row of the world's action table."""
        if GENERATION < (0, 17):
            self.env.set_actions(BEHAVIOR, np.array([[row]], dtype=np.int32))
        else:
            from mlagents_envs.base_env import ActionTuple

            self.env.set_actions(BEHAVIOR, ActionTuple(discrete=np.array([[row]], dtype=np.int32)))
        self.env.step()
        return self.moment()

    def branches(self) -> tuple[int, ...]:
        """The number of choices for each discrete number of an action."""
        spec = self.spec()
        if GENERATION < (0, 17):
            return tuple(spec.discrete_action_branches or ())
        return tuple(spec.action_spec.discrete_branches)

    def act(self, actions: Floats) -> None:
        """Sets the actions of all agents."""
        if GENERATION < (0, 17):
            self.env.set_actions(BEHAVIOR, actions)
        else:
            from mlagents_envs.base_env import ActionTuple

            self.env.set_actions(BEHAVIOR, ActionTuple(continuous=actions))

    def moment(self) -> Moment:
        decisions, terminals = self.env.get_steps(BEHAVIOR)
        ends = self._seen(terminals)
        (now,) = self._seen(decisions)
        assert len(ends) <= 1, "there is one agent"
        return Moment(now, ends[0] if ends else None)

    @staticmethod
    def _seen(steps: Any) -> list[Seen]:
        truncated = getattr(steps, "interrupted", getattr(steps, "max_step", [False] * len(steps)))
        return [
            Seen(
                int(steps.agent_id[index]),
                float(steps.reward[index]),
                [array[index].copy() for array in steps.obs],
                bool(truncated[index]),
            )
            for index in range(len(steps))
        ]

    def behaviors(self) -> list[str]:
        return list(self.env.get_behavior_names() if GENERATION < (0, 17) else self.env.behavior_specs)

    def spec(self) -> Any:
        return self.env.get_behavior_spec(BEHAVIOR) if GENERATION < (0, 17) else self.env.behavior_specs[BEHAVIOR]

    def shapes(self) -> list[tuple[int, ...]]:
        """The observation shapes that the client received, pictures as (height, width, channels)."""
        spec = self.spec()
        if GENERATION < (0, 17):
            return list(spec.observation_shapes)
        shapes = [tuple(each.shape) for each in spec.observation_specs]
        return [(*shape[1:], shape[0]) if GENERATION >= (1, 0) and len(shape) == 3 else shape for shape in shapes]

    def communicator(self) -> Any:
        """The client's communicator, to send messages that the client itself never sends."""
        return self.env.communicator if GENERATION < (0, 17) else self.env._communicator

    def close(self) -> int:
        """Ends the session; returns the executable's exit code."""
        self.env.close()
        return self.process.wait(TIMEOUT_SECS)


class Launcher:
    """Starts clients and executables, and stops all of them at the end."""

    def __init__(self, executable: Path, folder: Path) -> None:
        #: The executable under its own name.
        self.executable = executable
        # Clients look for this extension.
        self.file_name = folder / "l2explorer.x86_64"
        self.file_name.symlink_to(executable)
        self._clients: list[Client] = []
        self._processes: list[subprocess.Popen[str]] = []

    def start(
        self,
        *args: str,
        channels: Sequence[SideChannel] = (),
        port: int | None = None,
        worker: int = 0,
        **options: Any,
    ) -> Client:
        """Starts a client, which starts the executable itself."""
        options[ARGS] = list(args)
        env = UnityEnvironment(
            str(self.file_name),
            worker_id=worker,
            base_port=port or free_port(),
            timeout_wait=TIMEOUT_SECS,
            side_channels=list(channels),
            **options,
        )
        self._clients.append(Client(env, None))
        return self._clients[-1]

    def run(self, *args: str) -> subprocess.Popen[str]:
        """Starts the executable alone, with its output piped."""
        process = subprocess.Popen(
            [str(self.executable), *args], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self._processes.append(process)
        return process

    def start_in_editor_mode(self, *args: str, channels: Sequence[SideChannel] = ()) -> Client:
        """Starts a client in Unity's editor mode, in which it starts no executable, and an executable for it."""
        port = free_port()
        process = self.run("--mlagents-port", str(port), *args)
        self._clients.append(Client(self.await_executable(port, channels), process))
        return self._clients[-1]

    @staticmethod
    def await_executable(port: int, channels: Sequence[SideChannel] = ()) -> UnityEnvironment:
        """Starts a client in editor mode, which waits for an executable."""
        return UnityEnvironment(None, base_port=port, timeout_wait=TIMEOUT_SECS, side_channels=list(channels))

    def end(self) -> None:
        for client in self._clients:
            if client.env._loaded:
                client.env.close()
        for process in [*self._processes, *(client.process for client in self._clients)]:
            if process.poll() is None:
                process.kill()
            process.wait(TIMEOUT_SECS)
            for pipe in (process.stdout, process.stderr):
                if pipe is not None:
                    pipe.close()


#: The clients' name for additional arguments of the executable.
ARGS = "args" if GENERATION < (0, 20) else "additional_args"


def free_port(count: int = 1) -> int:
    """The first of ``count`` consecutive free ports."""
    while True:
        with closing(socket.create_server(("127.0.0.1", 0))) as first:
            port = int(first.getsockname()[1])
            try:
                for offset in range(1, count):
                    socket.create_server(("127.0.0.1", port + offset)).close()
            except (OSError, OverflowError):
                continue
        return port


def code_and_errors(process: subprocess.Popen[str]) -> tuple[int, str]:
    """The exit code and the error output of an executable that ends by itself."""
    _, errors = process.communicate(timeout=TIMEOUT_SECS)
    return process.returncode, errors


@contextmanager
def announced_version(version: str, monkeypatch: Any) -> Iterator[None]:
    """Makes clients announce this version of the protocol within a block."""
    with monkeypatch.context() as patch:
        patch.setattr(UnityEnvironment, "API_VERSION", version)
        yield
