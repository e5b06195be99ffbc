"""Long native calls work in processes forked after earlier calls."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys

import pytest

PROGRAM = """
import multiprocessing

import driftworld

red = driftworld.variant("find_objects#red")


def work():
    red.sample_many(20)
    red.sample_many(20, threads=2)
    driftworld.distance_matrix("find_objects").embed()
    driftworld.order("find_objects", "two-opt")
    assert driftworld.Curriculum.design("find_objects#red", "find_objects#blue", learn=1).num_experiences > 0


work()
child = multiprocessing.get_context("fork").Process(target=work)
child.start()
child.join(60)
print("hangs" if child.is_alive() else child.exitcode)
child.kill()
"""


@pytest.mark.parametrize("method", [method for method in multiprocessing.get_all_start_methods() if method == "fork"])
def test_forked_process_works_like_its_parent(method: str) -> None:
    program = PROGRAM.replace("fork", method)
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=180, check=False)
    assert process.stdout == "0\n", process.stderr
