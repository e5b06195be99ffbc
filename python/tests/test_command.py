"""The command installed by the wheel: arguments, exit codes, pipes and signals."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import driftworld
import pytest


def command(*argv: str) -> list[str]:
    return [sys.executable, "-m", "driftworld", *argv]


def run(*argv: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(*argv), capture_output=True, text=True, check=False)


def test_version_is_printed() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout) == (0, f"driftworld {driftworld.__version__}\n")


def test_output_is_printed() -> None:
    done = run("sample", "find_objects#red", "--seed", "7")
    assert done.returncode == 0 and json.loads(done.stdout) == driftworld.variant("find_objects#red").sample(7)


def test_wrong_input_exits_with_1() -> None:
    done = run("sample", "find_object#red")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.startswith("error: found task") and 'did you mean "find_objects"?' in " ".join(done.stderr.split())


@pytest.mark.parametrize("argv", [["sampel"], ["sample", "find_objects", "--sed", "3"], ["order"]])
def test_wrong_arguments_exit_with_2(argv: list[str]) -> None:
    done = run(*argv)
    assert done.returncode == 2 and "driftworld" in done.stderr and "__main__" not in done.stderr


def test_help_exits_with_0() -> None:
    done = run("sample", "--help")
    assert done.returncode == 0 and "Usage: driftworld sample" in done.stdout and done.stderr == ""


def test_python_errors_match_the_command() -> None:
    with pytest.raises(driftworld.TaskError) as refused:
        driftworld.variant("find_object#red")
    # The command wraps lines to fit the terminal.
    stderr = run("sample", "find_object#red").stderr
    assert stderr.split() == f"error: {refused.value}".split()


def test_closed_pipe_ends_the_command_quietly() -> None:
    child = subprocess.Popen(
        command("sample", "find_objects", "--count", "100000", "--jsonl"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert child.stdout is not None and child.stderr is not None
    child.stdout.readline()
    child.stdout.close()
    assert child.stderr.read() == b"" and child.wait(60) == 0
    child.stderr.close()


def test_interrupt_ends_the_command_with_a_message() -> None:
    child = subprocess.Popen(
        command("sample", "find_objects", "--count", "100000000", "--jsonl"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert child.stdout is not None
    child.stdout.readline()
    child.send_signal(signal.SIGINT)
    # Reads everything: the writer would otherwise block and never end.
    _, stderr = child.communicate(timeout=60)
    # `sample` handles interrupts, to remove unfinished files.
    assert child.returncode == 130 and stderr.startswith(b"error: interrupted after ")


def test_interrupted_run_leaves_a_resumable_log(tmp_path: Path) -> None:
    scenario, log = tmp_path / "scenario.json", tmp_path / "log"
    driftworld.Curriculum.design("find_objects#blue", learn=3000, eval_episodes=1).save(scenario)
    argv = command("run", str(scenario), "--agent", "random", "--output", str(log))
    child = subprocess.Popen(argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not list(log.glob("*/1-train")) and child.poll() is None:
        pass
    child.send_signal(signal.SIGINT)
    _, stderr = child.communicate(timeout=60)
    assert child.returncode == 130 and "interrupted" in stderr and "--resume" in stderr
    num_rows = len(driftworld.read_log(log))
    assert 0 < num_rows < 3002
    subprocess.run([*argv, "--resume"], check=True, capture_output=True)
    assert len(driftworld.read_log(log)) == 3002
