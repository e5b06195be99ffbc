"""Ports without a client or with another server; invalid arguments, help and version."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import grpc
import pytest

from clients import Launcher, code_and_errors, free_port


def test_missing_client_ends_with_3_and_advice_about_the_port(launcher: Launcher) -> None:
    port = free_port()
    code, errors = code_and_errors(launcher.run("--mlagents-port", str(port), "--wait", "0.5"))
    assert code == 3
    assert f"127.0.0.1:{port}: no client within 0.5 s; start it first" in errors and "--mlagents-port" in errors


def test_the_default_port_is_the_editor_modes_port(launcher: Launcher) -> None:
    code, errors = code_and_errors(launcher.run("--wait", "0.1"))
    # Another program may be listening there; the error then names the same port.
    assert code in (1, 3) and "127.0.0.1:5004" in errors


@contextmanager
def silent() -> Iterator[int]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield int(server.getsockname()[1])


@contextmanager
def talking(answer: bytes) -> Iterator[int]:
    """A server that sends the same bytes on every connection, reads once, and hangs up."""

    def serve() -> None:
        while True:
            try:
                connection, _ = server.accept()
            except OSError:
                return
            with connection:
                connection.sendall(answer)
                connection.recv(1 << 16)

    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield int(server.getsockname()[1])
        finally:
            server.shutdown(socket.SHUT_RDWR)
            thread.join()


class Web(BaseHTTPRequestHandler):
    """A web server that speaks HTTP/1.0."""

    def log_message(self, *_: object) -> None:
        pass


@contextmanager
def web() -> Iterator[int]:
    with ThreadingHTTPServer(("127.0.0.1", 0), Web) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server.server_port
        finally:
            server.shutdown()
            thread.join()


@contextmanager
def other_grpc() -> Iterator[int]:
    server = grpc.server(ThreadPoolExecutor(1))
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    try:
        yield port
    finally:
        server.stop(None).wait()


@pytest.mark.parametrize(
    ("stranger", "expected"),
    [
        (silent, "silence for 1 s"),
        (web, ""),
        (other_grpc, "Unimplemented"),
        (lambda: talking(b"SSH-2.0-OpenSSH_9.6\r\n"), ""),
        (lambda: talking(b"\0" * 1000), ""),
    ],
    ids=["silent", "web server", "another gRPC server", "secure shell", "zeros"],
)
def test_a_server_that_is_not_a_client_is_reported(launcher: Launcher, stranger: object, expected: str) -> None:
    with stranger() as port:  # type: ignore[operator]
        code, errors = code_and_errors(launcher.run("--mlagents-port", str(port), "--wait", "1"))
    assert code == 1, errors
    assert f"127.0.0.1:{port}: the server there does not answer like an ML-Agents client: " in errors
    assert expected in errors and errors.count("\n") == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ["--mlagents-port"],
        ["--mlagents-port", "http"],
        ["--mlagents-port", "0"],
        ["--wait", "-1"],
        ["--world", "--wait"],
    ],
)
def test_invalid_arguments_end_with_2_and_name_the_help(launcher: Launcher, arguments: list[str]) -> None:
    code, errors = code_and_errors(launcher.run(*arguments))
    assert code == 2 and errors.startswith(f"driftworld-unity: {arguments[0]}: found ")
    assert errors.endswith("\n`driftworld-unity --help` lists the options\n") and errors.count("\n") == 2


def test_help_and_version_are_printed_and_end_with_0(launcher: Launcher) -> None:
    for option, expected in [("--help", "Usage: driftworld-unity"), ("--version", "stand-in for the L2Explorer")]:
        process = launcher.run(option)
        out, errors = process.communicate(timeout=10)
        assert (process.returncode, errors) == (0, "") and expected in out
