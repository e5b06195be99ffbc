"""Ctrl-C ends long native calls before they finish."""

from __future__ import annotations

import subprocess
import sys

import pytest

#: Each call would run far longer than the test's time limit.
CALLS = {
    "sample_many": "driftworld.variant('scavenger_hunt').sample_many_json(10**6)",
    "many_quick_samples": "driftworld.TaskSpec.from_dict({'name': 'tiny'}).variant().sample_many_json(10**7)",
    "distance_matrix": "driftworld.distance_matrix(variants, by='worlds')",
    "distance": "driftworld.distance('find_objects#blue', 'find_objects#red', worlds=100000)",
}

PROGRAM = """
import os, signal, threading
import driftworld

red = driftworld.variant("find_objects#red")
variants = ["get_to_goal#plain", *(red.with_values(f"v{{n}}", light=0.3 + n / 20000) for n in range(4000))]
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    {call}
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_ends_a_long_call(call: str) -> None:
    program = PROGRAM.format(call=CALLS[call])
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert (process.stdout, process.returncode) == ("interrupted\n", 0), process.stderr


SIGNAL_HANDLERS = """
import os, pathlib, signal
import driftworld

def caught():
    status = pathlib.Path("/proc/self/status").read_text()
    return [line for line in status.splitlines() if line.startswith(("SigCgt:", "SigIgn:"))]

before = caught()
driftworld.Curriculum.design("find_objects#blue", learn=1, eval_episodes=1)
assert caught() == before, (before, caught())
for _ in range(2):
    try:
        os.kill(os.getpid(), signal.SIGINT)
    except KeyboardInterrupt:
        print("interrupted")
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals are seen in /proc")
def test_python_keeps_its_signal_handlers() -> None:
    process = subprocess.run([sys.executable, "-c", SIGNAL_HANDLERS], capture_output=True, text=True, timeout=120, check=False)
    assert (process.stdout, process.returncode) == ("interrupted\ninterrupted\n", 0), process.stderr
