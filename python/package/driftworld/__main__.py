"""The ``driftworld`` command, as installed by the wheel and run by ``python -m driftworld``. All subcommands except
``benchmark`` are native.
"""

from __future__ import annotations

import signal
import sys

from driftworld import _native


def main() -> int:
    """Runs the command with the arguments of the process; returns its exit code: 0, 1 for wrong input, 2 for wrong arguments."""
    if sys.argv[1:2] == ["benchmark"]:
        from driftworld.benchmark import command

        return command.main(sys.argv[2:])
    # As in the native binary: an interrupt ends the process, unless a subcommand handles it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = _native.main(["driftworld", *sys.argv[1:]])
    if sys.argv[1:] in (["-h"], ["--help"], ["help"]):
        print("\nIn Python also:\n  benchmark        Compare continual learners in frozen sequences of tasks")
    return code


if __name__ == "__main__":
    sys.exit(main())
