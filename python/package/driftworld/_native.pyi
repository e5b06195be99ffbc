"""Type stub of the native module, with a section for each file of ``python/src/``. Private, except for what
``driftworld`` re-exports.

``python/tests/test_native_stub.py`` compares it with the module itself.
"""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__version__: str

# -- batch.rs ----------------------------------------------------------------------------------------------------------

_Stepped: TypeAlias = tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_], list[int]]

@final
class Batch:
    """Environments that step together; a single environment is a batch of one."""

    def __new__(
        cls,
        streams: Sequence[Stream],
        overrides: str,
        autoreset: str,
        num_threads: int,
        renderer: str,
        depth: str,
        libraries: Sequence[bytes],
        modalities: str,
        max_episode_steps: int | None = None,
    ) -> Batch: ...
    @property
    def renderer(self) -> str: ...
    def seed(self, env: int, seed: int, index: int) -> None: ...
    def episode_steps(self, env: int) -> int: ...
    def set_episode_steps(self, env: int, steps: int) -> None: ...
    def index(self, env: int, index: int) -> None: ...
    def stream(self, env: int, stream: Stream) -> None: ...
    def give(self, env: int, stream: Stream) -> None: ...
    def place(self, env: int) -> tuple[int, int, int]: ...
    def set_place(self, env: int, place: tuple[int, int, int]) -> None: ...
    def reset(self, mask: NDArray[np.bool_] | None = None) -> None: ...
    def step_numbers(self, actions: NDArray[np.float64]) -> _Stepped: ...
    def step_rows(self, actions: NDArray[np.int64]) -> _Stepped: ...
    def step_one_by_numbers(self, numbers: Sequence[float]) -> tuple[float, bool, bool, bool, bool]: ...
    def step_one_by_row(self, row: int) -> tuple[float, bool, bool, bool, bool]: ...
    def ended_by(self, env: int) -> str | None: ...
    def repeat(self, steps: int) -> None: ...
    def buffers(self) -> dict[str, NDArray[Any]]: ...
    def final_buffers(self) -> dict[str, NDArray[Any]] | None: ...
    def origin(self, env: int) -> tuple[str, str, int, int, str]: ...
    def events(self, env: int) -> tuple[dict[str, Any], ...]: ...
    def record(self, records: bool, env: int | None = None) -> None: ...
    def recording(self, env: int) -> RecordingHandle | None: ...
    def state(self, env: int) -> str: ...
    def warnings(self, env: int) -> list[str]: ...
    def picture(self, env: int, height: int, width: int, from_above: bool) -> NDArray[np.uint8]: ...

# -- command.rs --------------------------------------------------------------------------------------------------------

def main(argv: Sequence[str]) -> int: ...

# -- covered.rs --------------------------------------------------------------------------------------------------------

def covered(variants: Sequence[Variant], overrides: str, shown: str | None) -> str: ...

# -- curriculum.rs -----------------------------------------------------------------------------------------------------

_PlanValues: TypeAlias = tuple[str, list[tuple[str, str, str]], list[tuple[str, str, str | None]], list[str]]

@final
class Plan:
    """A scenario with all the tasks and worlds that it names."""

    def __new__(
        cls, path: str | PathLike[str], text: str, stand_in: bool | None, skip_undrawable: bool
    ) -> Plan: ...
    @staticmethod
    def from_values(values: _PlanValues, skip_undrawable: bool) -> Plan: ...
    def values(self) -> _PlanValues: ...
    @property
    def warnings(self) -> list[str]: ...
    def scenario(self) -> dict[str, Any]: ...
    def text(self) -> str: ...
    def __len__(self) -> int: ...
    def experience_spec(self, number: int) -> dict[str, Any]: ...
    def after(self, number: int) -> int: ...
    def ends_of_regimes(self) -> list[int]: ...
    def covered(self, overrides: str, shown: str | None) -> str: ...
    def world(self, number: int) -> Stream: ...
    def try_worlds(self, worlds: int) -> list[dict[str, Any]]: ...
    def set_lanes(self, lanes: int) -> None: ...
    def set_run_seed(self, seed: int) -> None: ...
    def add_fingerprint(self, what: str, print: Any) -> None: ...

@final
class Journal:
    """The log of a lifetime, open for writing."""

    def __new__(cls, folder: str | PathLike[str], plan: Plan, agent: str, resume: bool, record: bool) -> Journal: ...
    @property
    def records(self) -> bool: ...
    def run(self, plan: Plan, rollout: Any, learned: int, check_frozen: bool) -> dict[str, Any]: ...
    def withdraw_block(self) -> None: ...
    def __len__(self) -> int: ...
    def close(self) -> None: ...

# -- design.rs ---------------------------------------------------------------------------------------------------------

def design_curriculum(
    options: dict[str, Any], plot: str | PathLike[str] | None
) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]: ...

# -- elements.rs -------------------------------------------------------------------------------------------------------

def elements(task: TaskSpec, options: dict[str, Any]) -> dict[str, Any]: ...

# -- distances.rs ------------------------------------------------------------------------------------------------------

def distance(
    a: Variant | tuple[str, str],
    b: Variant | tuple[str, str],
    weights: dict[str, float] | None,
    worlds: int | None,
    seed: int,
    index: int,
    by: str | None,
    scale: str,
    libraries: Sequence[bytes],
) -> dict[str, Any]: ...
def compared_by() -> list[str]: ...
def order_methods() -> list[str]: ...
def removed_format(ending: str) -> str | None: ...

@final
class Matrix:
    """All pairwise distances among some items."""

    @staticmethod
    def measure(
        labels: Sequence[str],
        variants: Sequence[Variant],
        weights: dict[str, float] | None,
        by: str | None,
        worlds: int | None,
        scale: str,
        libraries: Sequence[bytes],
    ) -> Matrix: ...
    @staticmethod
    def from_values(labels: Sequence[str], values: NDArray[np.float64]) -> Matrix: ...
    @staticmethod
    def from_csv(text: str) -> Matrix: ...
    @staticmethod
    def from_json(text: str) -> Matrix: ...
    def to_csv(self) -> str: ...
    def to_json(self) -> str: ...
    @property
    def labels(self) -> list[str]: ...
    def values(self) -> NDArray[np.float64]: ...
    @property
    def is_metric(self) -> bool: ...
    def map(self) -> tuple[NDArray[np.float64], float]: ...
    def order(
        self, method: str | None, start: int | None, end: int | None, seed: int, target_step: float | None
    ) -> dict[str, Any]: ...
    def __len__(self) -> int: ...

# -- document.rs -------------------------------------------------------------------------------------------------------

def parsed(text: str) -> dict[str, Any]: ...
def check(
    name: str, text: str, kind: str | None, libraries: list[bytes]
) -> tuple[str, list[dict[str, Any]], list[str], BaseException | None]: ...

# -- drift.rs ----------------------------------------------------------------------------------------------------------

@final
class Drift:
    """The path from one variant of a task to another: ``Drift(blue, dusk, schedule="cosine").at(0.25)``.

    Args:
        from_: The first variant.
        to: The last variant, of the same task unless whole variants switch.
        schedule: ``"linear"``, ``"cosine"``, ``{"steps": n}`` or ``{"sawtooth": n}``, with n at least 1.
        switch: When values that cannot be interpolated change: ``"at_point"``, or with ``"mixture"`` at random, more
            likely as the drift goes on. With ``"task"`` the whole variant is one of the two at random; they may belong
            to two tasks.
        seed: The seed of random switches.

    Raises:
        GeneratorError: If the variants belong to different tasks.
        ValueError: For an unknown schedule or switch.
    """

    def __new__(
        cls,
        from_: Variant,
        to: Variant,
        *,
        schedule: str | Mapping[str, int] | None = None,
        switch: Literal["at_point", "mixture", "task"] = "at_point",
        seed: int = 0,
    ) -> Drift: ...
    def at(self, progress: float, index: int = 0) -> Variant:
        """The variant at ``progress``, in 0..=1; ``index`` is the number of the world, which only mixtures use."""

# -- files.rs ----------------------------------------------------------------------------------------------------------

def read_file(path: str | PathLike[str], kind: str) -> bytes: ...
def write_file(path: str | PathLike[str], content: bytes) -> None: ...

# -- logs.rs -----------------------------------------------------------------------------------------------------------

@final
class LogFile:
    """An open log."""

    @staticmethod
    def create(folder: str | PathLike[str], columns: Sequence[str], info: Mapping[str, Any]) -> LogFile: ...
    @staticmethod
    def resume(folder: str | PathLike[str]) -> LogFile: ...
    def write(
        self,
        block_num: int,
        exp_num: int,
        block_type: str,
        block_subtype: str,
        task_name: str,
        task_params: Mapping[str, Any],
        exp_status: str,
        worker_id: str,
        metrics: dict[str, float],
        recording: RecordingHandle | None = None,
    ) -> None: ...
    def close(self) -> None: ...

def read_log(
    folder: str | PathLike[str], texts: bool
) -> tuple[str, dict[str, Any], dict[str, Any], dict[str, Any], list[str]]: ...
def validate_log(folder: str | PathLike[str]) -> dict[str, Any]: ...

# -- options.rs --------------------------------------------------------------------------------------------------------

def requests() -> dict[str, list[tuple[str, str | None]]]: ...

# -- recordings.rs -----------------------------------------------------------------------------------------------------

@final
class RecordingHandle:
    """A recorded episode."""

    @staticmethod
    def from_text(text: str) -> RecordingHandle: ...
    def about(self) -> dict[str, Any]: ...
    def world(self) -> str: ...
    def actions(self) -> NDArray[Any]: ...
    def frames(self, shown: dict[str, Any]) -> NDArray[np.uint8]: ...
    def write(
        self, path: str | PathLike[str], shown: dict[str, Any], fps: float | None
    ) -> tuple[int, int, int, float]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def png(picture: NDArray[np.uint8]) -> bytes: ...
def read_recording(path: str | PathLike[str], episode: int, worker: str | None) -> RecordingHandle: ...

# -- scores.rs ---------------------------------------------------------------------------------------------------------

@final
class Scores:
    """The scores of lifetimes."""

    @staticmethod
    def of(logs: Sequence[str], options: dict[str, Any]) -> tuple[Scores, list[str]]: ...
    def values(self) -> dict[str, Any]: ...
    def regimes(self) -> list[dict[str, Any]]: ...
    def save(self, folder: str | PathLike[str], name: str | None) -> None: ...

def report(logs: Sequence[str], options: dict[str, Any]) -> tuple[str, list[str]]: ...

# -- supply.rs ---------------------------------------------------------------------------------------------------------

@final
class Stream:
    """An endless stream of worlds: number *i* under a seed."""

    @staticmethod
    def variants(variants: Sequence[Variant]) -> Stream: ...
    @staticmethod
    def dealt(variants: Sequence[Variant], order: NDArray[np.uint32], num_envs: int) -> list[Stream]: ...
    @staticmethod
    def drift(from_: Variant, to: Variant, schedule: str, switch: str, episodes: int) -> Stream: ...
    @staticmethod
    def world(name: str, text: str) -> Stream: ...
    def text(self) -> str: ...
    def layouts(self, overrides: str) -> list[str]: ...

# -- task.rs -----------------------------------------------------------------------------------------------------------

@final
class TaskSpec:
    """A task: what its worlds have in common, and exactly what varies between them.

    Made by :meth:`load`, :meth:`from_json` or :meth:`from_dict`. Immutable and picklable; equal if the documents have
    the same content.
    """

    @staticmethod
    def load(name_or_path: str | PathLike[str]) -> TaskSpec:
        """The task with a built-in name, such as ``"find_objects"``, or at a path; a variant after ``#`` is ignored.

        Raises:
            TaskError: If it does not exist or cannot be read.
            SpecError: If the document is wrong, with every problem and its position.
        """

    @staticmethod
    def from_json(name: str, text: str) -> TaskSpec:
        """The task in a JSON text; ``name`` is used in messages."""

    @staticmethod
    def from_dict(document: dict[str, Any], name: str = "task spec") -> TaskSpec:
        """The task in a dictionary; ``name`` is used in messages."""

    def to_json(self) -> str:
        """The document as one line of JSON; :meth:`from_json` reads the same task from it."""

    def to_dict(self) -> dict[str, Any]:
        """The document as a dictionary."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def description(self) -> str:
        """Its author's description."""

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Its parameters by name, each as the document declares it."""

    @property
    def families(self) -> dict[str, list[str]]:
        """The families of variants declared by grids and sweeps, each with the names of its members."""

    def _repr_html_(self) -> str: ...
    def variant_names(self) -> list[str]:
        """The names of the declared variants, with families expanded; ``["default"]`` if none is declared."""

    @property
    def variants(self) -> list[Variant]:
        """All declared variants, in the order of the document."""

    def variant(self, name: str | None = None) -> Variant:
        """One variant; without a name, the one with the default of every parameter.

        Raises:
            TaskError: If there is no variant of this name.
        """

    def sample(self, variant: str | None = None, seed: int = 0, index: int = 0) -> dict[str, Any]:
        """World number ``index`` of a variant under a seed."""

    def __hash__(self) -> int: ...

@final
class Variant:
    """One variant of a task: every parameter that is not drawn for each world has its value.

    Immutable and picklable; equal if worlds and distances are the same.
    """

    @property
    def id(self) -> str:
        """``task#variant``."""

    @property
    def name(self) -> str:
        """Its name within the task."""

    @property
    def task(self) -> TaskSpec:
        """The task that it belongs to."""

    @property
    def description(self) -> str | None:
        """Its author's description, if any."""

    def _repr_html_(self) -> str: ...
    @property
    def values(self) -> dict[str, Any]:
        """The values of all parameters that are the same in every world, by name."""

    @property
    def hash(self) -> str:
        """A hash of everything that determines its worlds and distances: 64 hexadecimal digits."""

    def with_values(self, name: str, /, **changes: Any) -> Variant:
        """A copy of this variant under another name, with some parameters changed: ``with_values("dim", light=0.5)``.

        Raises:
            SpecError: With every parameter whose value is not allowed.
            ValueError: For a name that is empty or has a ``#``, or a number that is not finite.
        """

    def at_distance(
        self, distance: float, subject: str | Sequence[str], *, tolerance: float = 1e-3, name: str = "found"
    ) -> tuple[Variant, float]:
        """A variant at a given distance from this one that changes as few parameters as possible, and its distance.

        Args:
            distance: The requested distance: 0 or more, where 1 is one parameter moved over its whole range.
            subject: What may change: an element of the decision process (``"reward"`` or ``"R"``; the distance in that
                element counts), or a list of parameters (the total distance counts).
            tolerance: Accepted deviation from the distance.
            name: Name of the variant.

        Raises:
            GeneratorError: If nothing can change, or no variant is that far away; names the nearest one.
            ValueError: For a name that is empty or has a ``#``.
        """

    def sample(self, seed: int = 0, index: int = 0) -> dict[str, Any]:
        """World number ``index`` under a seed: the same on every machine, and independent of earlier draws.

        Raises:
            GeneratorError: If the world cannot be drawn.
        """

    def sample_json(self, seed: int = 0, index: int = 0) -> str:
        """The same as one line of JSON."""

    def sample_many(self, count: int, *, seed: int = 0, start: int = 0, threads: int = 0) -> list[dict[str, Any]]:
        """``count`` worlds, starting at number ``start``, drawn by ``threads`` threads, at most 1024; 0 means one for
        each processor.
        """

    def sample_many_json(self, count: int, *, seed: int = 0, start: int = 0, threads: int = 0) -> list[str]:
        """The same, each world as one line of JSON."""

    def try_worlds(self, count: int, *, seed: int = 0) -> dict[str, Any]:
        """Draws the first ``count`` worlds under a seed, and counts failures by reason.

        Returns:
            ``variant``, ``seed`` and ``worlds``; how many failed because of a ``placement``, a ``requirement``, or for
            an ``other`` reason; and ``failed``, the first 100 of them: ``index``, ``progress``, ``code`` and
            ``reason``.
        """

    def __hash__(self) -> int: ...

def built_in_names() -> list[str]: ...
def task_groups() -> list[tuple[str, list[str]]]: ...
def class_numbers(libraries: Sequence[bytes]) -> list[tuple[str, int]]: ...
def load_variant(name: str) -> Variant: ...
def load_variants(name: str) -> list[Variant]: ...
