"""The workbench in a notebook: the page of ``driftworld studio`` in a frame."""

from __future__ import annotations

import atexit
import html
import subprocess
import sys
from os import PathLike, fspath

from driftworld.errors import DriftworldError


class Studio:
    """A workbench that is being served to this machine. A notebook shows it in a frame.

    Attributes:
        address: The page's address, for any browser on this machine.
        height: The frame's height in pixels.
    """

    def __init__(self, task: str | PathLike[str] | None, height: int) -> None:
        self.height = height
        words = [sys.executable, "-m", "driftworld", "studio", "--no-open", *([] if task is None else ["--", fspath(task)])]
        # In a session of its own, so that interrupting a cell does not end it.
        self._process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True
        )
        atexit.register(self._process.terminate)
        assert self._process.stdout is not None
        self.address = self._process.stdout.readline().strip()
        if not self.address:
            raise DriftworldError(self._process.communicate()[1].strip().removeprefix("error: "))

    def _repr_html_(self) -> str:
        address = html.escape(self.address)
        return f'<iframe src="{address}" title="The workbench" width="100%" height="{self.height}" style="border: 0"></iframe>'

    def close(self) -> None:
        """Stops serving the page. It also ends with Python."""
        self._process.terminate()
        self._process.communicate()


def studio(task: str | PathLike[str] | None = None, *, height: int = 720) -> Studio:
    """Opens the workbench: play, author, compare, order and replay worlds in a page, also in a notebook.

    Args:
        task: The initial task, as for ``driftworld studio``: a built-in one such as ``"maze"`` or
            ``"find_objects#red"``, or the path of a task spec; ``None`` for the gallery.
        height: The height in pixels of the frame in a notebook.

    Raises:
        DriftworldError: If there is no such task or variant, or the package was built without the page.
    """
    return Studio(task, height)
