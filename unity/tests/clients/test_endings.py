"""Ends of sessions: the client closes, quits, is killed or paused, loses its connection, or sends invalid data."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from mlagents_envs.communicator_objects.command_pb2 import QUIT
from mlagents_envs.communicator_objects.unity_message_pb2 import UnityMessageProto
from mlagents_envs.exception import (
    UnityCommunicatorStoppedException,
    UnityEnvironmentException,
)
from mlagents_envs.rpc_communicator import RpcCommunicator

from channels import Channels
from clients import GENERATION, TIMEOUT_SECS, Client, Launcher, announced_version, code_and_errors, free_port
from worlds import AHEAD, thing, world


@pytest.mark.parametrize("steps", [None, 0, 3], ids=["before a reset", "after a reset", "after steps"])
def test_a_client_that_closes_ends_the_executable_with_0(launcher: Launcher, steps: int | None) -> None:
    client = launcher.start()
    if steps is not None:
        client.reset()
        for _ in range(steps):
            client.step(AHEAD)
    assert client.close() == 0


def test_closing_twice_is_refused_by_the_client(launcher: Launcher) -> None:
    client = launcher.start()
    client.reset()
    assert client.close() == 0
    with pytest.raises(UnityEnvironmentException, match="No Unity environment is loaded"):
        client.env.close()
    assert client.process.returncode == 0


def test_a_client_in_editor_mode_closes_like_any_other(launcher: Launcher) -> None:
    client = launcher.start_in_editor_mode()
    client.reset()
    client.step(AHEAD)
    client.env.close()
    code, errors = code_and_errors(client.process)
    assert code == 0 and "a client at 127.0.0.1:" in errors


def test_the_executable_waits_for_a_client_that_comes_later(launcher: Launcher) -> None:
    port = free_port()
    process = launcher.run("--mlagents-port", str(port))
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(0.3)
    client = Client(launcher.await_executable(port), process)
    assert client.reset().now.rgb.shape == (84, 84, 3)
    assert client.close() == 0


def test_the_command_quit_ends_the_executable_with_0(launcher: Launcher) -> None:
    client = launcher.start_in_editor_mode()
    client.reset()
    message = UnityMessageProto()
    message.header.status = 200
    message.unity_input.rl_input.command = QUIT
    client.communicator().unity_to_external.parent_conn.send(message)
    assert code_and_errors(client.process)[0] == 0


@pytest.mark.parametrize("number", [float("nan"), float("inf"), float("-inf")])
def test_an_action_that_is_not_finite_ends_both_at_once_and_is_explained(launcher: Launcher, number: float) -> None:
    client = launcher.start_in_editor_mode()
    client.reset()
    with pytest.raises(UnityCommunicatorStoppedException):
        client.step((number, 0.0, 0.0))
    code, errors = code_and_errors(client.process)
    assert code == 1 and "action" in errors, errors


@pytest.mark.parametrize("version", ["0.15.0", "2.0.0"])
def test_a_client_of_a_different_major_version_is_refused_on_both_sides(
    launcher: Launcher, monkeypatch: pytest.MonkeyPatch, version: str
) -> None:
    port = free_port()
    process = launcher.run("--mlagents-port", str(port))
    with (
        announced_version(version, monkeypatch),
        pytest.raises(UnityEnvironmentException, match="version is not compatible"),
    ):
        launcher.await_executable(port)
    code, errors = code_and_errors(process)
    assert code == 1 and f'found version "{version}" of the protocol, expected 1.x' in errors


#: Code of a client in a separate process: starts the named executable, prints its process id, and takes a step for each
#: line that it reads.
CLIENT = """
import sys
sys.path.insert(0, {folder!r})
from clients import ARGS, Client, UnityEnvironment
name, port = sys.argv[1:]
env = UnityEnvironment(name or None, base_port=int(port), timeout_wait=30)
client = Client(env, None)
client.reset()
print(client.process.pid if name else 0, flush=True)
for line in sys.stdin:
    print(client.step((1.0, 0.0, 0.0)).now.vector[2], flush=True)
env.close()
"""


class SeparateClient:
    """A client in a separate process."""

    def __init__(self, name: str, port: int) -> None:
        code = CLIENT.format(folder=str(Path(__file__).parent))
        self.process = subprocess.Popen(
            [sys.executable, "-W", "ignore", "-c", code, name, str(port)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def request_step(self) -> None:
        assert self.process.stdin is not None
        print("step", file=self.process.stdin, flush=True)

    def read_line(self) -> float:
        assert self.process.stdout is not None
        return float(self.process.stdout.readline())

    def end(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate(timeout=TIMEOUT_SECS)


@pytest.fixture
def other(launcher: Launcher) -> Iterator[tuple[SeparateClient, subprocess.Popen[str]]]:
    """A client in a separate process, in editor mode, after one step; and the executable."""
    port = free_port()
    process = launcher.run("--mlagents-port", str(port))
    client = SeparateClient("", port)
    client.read_line()
    client.request_step()
    assert client.read_line() > 0
    yield client, process
    client.end()


@pytest.mark.parametrize("sign", [signal.SIGKILL, signal.SIGTERM])
def test_a_client_that_is_killed_ends_the_executable_with_0(
    other: tuple[SeparateClient, subprocess.Popen[str]], sign: signal.Signals
) -> None:
    client, process = other
    client.process.send_signal(sign)
    code, errors = code_and_errors(process)
    assert code == 0 and "the client is gone" in errors


def test_a_client_that_is_killed_leaves_no_process_behind(launcher: Launcher) -> None:
    client = SeparateClient(str(launcher.file_name), free_port())
    handle = os.pidfd_open(int(client.read_line()))
    try:
        client.process.kill()
        ended, _, _ = select.select([handle], [], [], TIMEOUT_SECS)
        assert ended == [handle], "the executable that the client started must end too"
    finally:
        os.close(handle)
        client.end()


def test_the_executable_waits_for_a_client_that_is_stopped(other: tuple[SeparateClient, subprocess.Popen[str]]) -> None:
    client, process = other
    client.process.send_signal(signal.SIGSTOP)
    client.request_step()
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(1.5)
    client.process.send_signal(signal.SIGCONT)
    assert client.read_line() > 0
    assert client.process.stdin is not None
    client.process.stdin.close()
    client.process.stdin = None
    assert client.process.wait(TIMEOUT_SECS) == 0
    assert code_and_errors(process)[0] == 0


def test_an_executable_that_is_killed_does_not_hang_the_next_one(launcher: Launcher) -> None:
    client = launcher.start()
    client.reset()
    client.process.kill()
    client.env.close()
    assert launcher.start().reset().now.agent_id == 1


class Cable:
    """A connection between an executable and a client that can be cut."""

    def __init__(self, to_port: int) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._server.getsockname()[1])
        self._to_port = to_port
        self._ends: list[socket.socket] = []
        self._threads = [threading.Thread(target=self._connect, daemon=True)]
        self._threads[0].start()

    def _connect(self) -> None:
        near, _ = self._server.accept()
        far = socket.create_connection(("127.0.0.1", self._to_port))
        self._ends = [near, far]
        for source, target in ((near, far), (far, near)):
            self._threads.append(threading.Thread(target=self._carry, args=(source, target), daemon=True))
            self._threads[-1].start()

    @staticmethod
    def _carry(source: socket.socket, target: socket.socket) -> None:
        try:
            while data := source.recv(1 << 16):
                target.sendall(data)
        except OSError:
            pass

    def cut(self) -> None:
        for end in self._ends:
            end.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join(TIMEOUT_SECS)
        for end in [*self._ends, self._server]:
            end.close()


def test_a_connection_that_is_lost_ends_the_executable_with_0(
    launcher: Launcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    port = free_port()
    cable = Cable(port)
    processes: list[subprocess.Popen[str]] = []
    initialize = RpcCommunicator.initialize

    def start_the_executable_first(*args: Any) -> Any:
        # The client is already listening, but not yet waiting for the executable.
        processes.append(launcher.run("--mlagents-port", str(cable.port)))
        return initialize(*args)

    monkeypatch.setattr(RpcCommunicator, "initialize", start_the_executable_first)
    env = launcher.await_executable(port)
    client = Client(env, processes[0])
    client.reset()
    client.step(AHEAD)
    cable.cut()
    code, errors = code_and_errors(client.process)
    assert code == 0 and "the client is gone" in errors
    env.close()


def test_log_file_has_all_messages_and_unity_options_are_ignored(launcher: Launcher, channels: Channels) -> None:
    Path("remarks.log").write_text("before\n", encoding="utf-8")
    client = launcher.start(
        "-logFile",
        "remarks.log",
        "-screen-width",
        "640",
        "-force-opengl",
        "-popupwindow",
        "--mlagents-replay",
        "x.bin",
        channels=channels.all,
        no_graphics=True,
        seed=7,
    )
    channels.reset.say("reset_environment", world(thing(500, 0)))
    client.reset()
    assert client.close() == 0
    lines = Path("remarks.log").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "before" and all(line.startswith("driftworld-unity: ") for line in lines[1:])
    log = "\n".join(lines)
    for expected in [
        '"-popupwindow" is not known',
        '"--mlagents-replay" is not known',
        "a client at ",
        "seed 7: not used",
    ]:
        assert log.count(expected) == 1, (expected, log)
    for unexpected in ["nographics", "batchmode", "screen-width", "640", "x.bin", "force-opengl"]:
        assert unexpected not in log


@pytest.mark.skipif(GENERATION < (0, 28), reason="older clients have no log_folder")
def test_newer_clients_have_the_log_file_in_their_own_folder(launcher: Launcher, tmp_path: Path) -> None:
    client = launcher.start(log_folder=str(tmp_path))
    client.reset()
    assert client.close() == 0
    assert "a client at" in (tmp_path / "Player-0.log").read_text(encoding="utf-8")


def test_a_log_file_that_cannot_be_written_is_an_error(launcher: Launcher) -> None:
    code, errors = code_and_errors(launcher.run("-logFile", "missing/folder/a.log"))
    assert code == 1 and errors.startswith("driftworld-unity: -logFile missing/folder/a.log: cannot be written: "), (
        errors
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (None, "--world own.json: cannot be read: No such file"),
        ("{", "own.json:1:"),
        ("[]", "own.json:1:1"),
        ('{"version": 1, "objcts": []}', 'did you mean "objects"?'),
        ('{"version": 1, "objects": [{"class": 3}]}', "/objects/0/class"),
    ],
)
def test_an_invalid_world_file_is_an_error_before_a_client_connects(
    launcher: Launcher, text: str | None, expected: str
) -> None:
    if text is not None:
        Path("own.json").write_text(text, encoding="utf-8")
    code, errors = code_and_errors(launcher.run("--world", "own.json"))
    assert code == 1 and expected in errors


def test_unknown_keys_of_a_reset_file_of_the_original_are_logged(launcher: Launcher) -> None:
    Path("own.json").write_text(json.dumps({**world(), "objcts": []}), encoding="utf-8")
    client = launcher.start("--world", "own.json", "-logFile", "remarks.log")
    client.reset()
    assert client.close() == 0
    assert "/objcts" in Path("remarks.log").read_text(encoding="utf-8")
