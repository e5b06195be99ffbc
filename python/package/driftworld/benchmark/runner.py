"""Runs the cells of a table, each once, in any free process; resumes killed cells.

A cell's folder is ``FOLDER/SEQUENCE/LEARNER/SEED``. While it runs, its logs and its learner are in ``work/``; in the
end, only ``report.json`` and ``logs.tar.xz`` remain. Several processes and several machines may share the folder: the
process that creates the folder ``claim/`` runs the cell, and keeps touching that folder. A claim that is no longer
touched is renamed, then removed.
"""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import importlib.util
import inspect
import io
import json
import os
import platform
import resource
import shutil
import tarfile
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from driftworld._files import write_whole
from driftworld.benchmark.sequence import Sequence
from driftworld.curricula import Curriculum
from driftworld.logs import read_log

#: Seconds after which an untouched claim is stale; can be set by ``DRIFTWORLD_STALE_SECONDS`` in the environment, to
#: the same value in all processes that share the folder.
STALE = float(os.environ.get("DRIFTWORLD_STALE_SECONDS", "60"))
#: Seconds between touches.
TOUCH = STALE / 12


@dataclass(frozen=True)
class Cell:
    """One learner with one seed in one sequence.

    Attributes:
        sequence: Name or file of the sequence.
        learner: Name of a learner of ``driftworld.learners``, or ``FILE.py:CLASS``.
        seed: The seed of the worlds and of the learner.
        split: ``"test"``, or ``"validation"`` to tune.
        arguments: Arguments of the learner, overriding the sequence's arguments for it.
    """

    sequence: str
    learner: str
    seed: int
    split: str = "test"
    arguments: tuple[tuple[str, Any], ...] = ()

    @property
    def label(self) -> str:
        """The learner's name in tables and folders."""
        own = self.learner.rpartition(":")[2].lower() if ":" in self.learner else self.learner
        return "-".join([own, *(f"{name}={value}" for name, value in self.arguments)])

    def folder(self, results: Path) -> Path:
        """The folder of its results."""
        name = Sequence.load(self.sequence).name + ("" if self.split == "test" else f"-{self.split}")
        return results / name / self.label / str(self.seed)

    def run(self, results: Path) -> dict[str, Any] | None:
        """Runs or resumes the cell; returns its report, or ``None`` if another process is running it."""
        folder = self.folder(results)
        report = folder / "report.json"
        if report.is_file():
            return self._finished(report)
        folder.mkdir(parents=True, exist_ok=True)
        with _claim(folder / "claim") as is_ours:
            if not is_ours:
                return None
            if not report.is_file():
                _run_cell(self, folder)
        return _read(report)

    def source(self) -> dict[str, str] | None:
        """Name and SHA-256 of the learner's file, if it does not come with Driftworld."""
        if ":" not in self.learner:
            return None
        path = Path(self.learner.rpartition(":")[0])
        return {"file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}

    def _finished(self, report: Path) -> dict[str, Any]:
        """The existing report; raises ``ValueError`` if it was made with another version of the learner's file."""
        found, own = _read(report), self.source()
        if own is not None and found.get("source", own) != own:
            raise ValueError(
                f"{report.parent}: found a cell finished with another version of {found['source']['file']} (SHA-256 {found['source']['sha256'][:12]}), "
                f"expected the current version of {self.learner} ({own['sha256'][:12]}); pass another folder with -o, or delete this one"
            )
        return found


def _read(file: Path) -> dict[str, Any]:
    read: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return read


@contextlib.contextmanager
def _claim(claim: Path) -> Iterator[bool]:
    """Yields whether this process created the folder."""
    with contextlib.suppress(FileNotFoundError):
        if time.time() - claim.stat().st_mtime > STALE:
            # Only one process can rename a folder; another may already have renamed the stale one and created its own.
            gone = claim.with_name(f"claim-{uuid.uuid4().hex}")
            with contextlib.suppress(FileNotFoundError):
                claim.rename(gone)
                if time.time() - gone.stat().st_mtime > STALE:
                    gone.rmdir()
                else:
                    gone.rename(claim)
    try:
        claim.mkdir()
    except FileExistsError:
        yield False
        return
    finished = threading.Event()

    def touch() -> None:
        while not finished.wait(TOUCH):
            with contextlib.suppress(OSError):
                os.utime(claim)

    toucher = threading.Thread(target=touch, daemon=True)
    toucher.start()
    try:
        yield True
    finally:
        finished.set()
        toucher.join()
        with contextlib.suppress(OSError):
            claim.rmdir()


def learner_class(name: str) -> Any:
    """The class of a learner, by its name in ``driftworld.learners`` or as ``FILE.py:CLASS``.

    Raises:
        ValueError: If there is no such class.
    """
    if ":" in name:
        file, _, own = name.rpartition(":")
        if not Path(file).is_file():
            raise ValueError(f"learner: found {name!r}, expected FILE.py:CLASS; there is no file {file!r}")
        spec = importlib.util.spec_from_file_location(Path(file).stem, file)
        assert spec is not None and spec.loader is not None, "a Python file has a loader"
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found = getattr(module, own, None)
        if not inspect.isclass(found):
            raise ValueError(f"learner: found {name!r}, expected a class {own} in {file}")
        return found
    known = learners_by_name()
    if name not in known:
        raise ValueError(f"learner: found {name!r}, expected FILE.py:CLASS or one of {', '.join(sorted(known))}")
    return known[name]


def learners_by_name() -> dict[str, Any]:
    """The learners of ``driftworld.learners``."""
    from driftworld import learners

    classes = [getattr(learners, name) for name in learners.__all__]
    return {each.name: each for each in classes if inspect.isclass(each) and issubclass(each, learners.PPO)}


def make_learner(cell: Cell, sequence: Sequence, policy: str) -> Any:
    """The learner of a cell, before it learns anything."""
    from driftworld.learners import Settings

    arguments = arguments_of(cell, sequence)
    names = {each.name for each in dataclasses.fields(Settings)}
    settings = Settings(**{name: arguments.pop(name) for name in list(arguments) if name in names})
    try:
        return learner_class(cell.learner)(
            len(sequence.options["actions"]), sequence.num_envs, seed=cell.seed, size=sequence.options["size"], policy=policy,
            settings=settings, **arguments,
        )  # fmt: skip
    except TypeError as error:
        if "unexpected keyword argument" not in str(error):
            raise
        raise ValueError(f"{cell.learner}: {error}; expected arguments of the class, or of Settings: {', '.join(sorted(names))}") from error


def arguments_of(cell: Cell, sequence: Sequence) -> dict[str, Any]:
    """Arguments of a cell's learner: PPO's settings and its own arguments, including defaults."""
    from driftworld.learners import Settings

    parameters = inspect.signature(learner_class(cell.learner)).parameters
    own = {
        name: each.default
        for name, each in parameters.items()
        if isinstance(each.default, (int, float, str)) and name not in ("seed", "size", "policy")
    }
    # Methods that need the length of the lifetime in advance get it.
    length = {"max_tasks": len(sequence.tasks), "task_decisions": sequence.decisions}
    own |= {name: value for name, value in length.items() if name in parameters}
    given = {**sequence.learners.get("all", {}), **sequence.learners.get(cell.learner, {}), **dict(cell.arguments)}
    return {**dataclasses.asdict(Settings()), **own, **given}


def _run_cell(cell: Cell, folder: Path) -> None:
    """Runs a whole cell: the lifetime, and the greedy evaluations of the learner after each task."""
    import torch

    torch.set_num_threads(1)
    sequence, work, start = Sequence.load(cell.sequence), folder / "work", time.time()
    kept = work / "kept"
    kept.mkdir(parents=True, exist_ok=True)
    curriculum = sequence.curriculum(cell.seed, cell.split)
    learner = make_learner(cell, sequence, "sampled")
    save = learner.save

    def save_and_keep(path: Path) -> None:
        """Keeps a copy of the learner after each task, named by the number of decisions learned from."""
        save(path)
        shutil.copyfile(path, work / "unfinished")
        (work / "unfinished").rename(kept / f"{learner.decisions:012d}.pt")

    learner.save = save_and_keep
    run = {"num_envs": sequence.num_envs, "num_threads": 1, **sequence.options}
    curriculum.run_vector(learner, work / "sampled", **run)
    evaluations = [block for block in curriculum.scenario["blocks"] if block["type"] == "evaluation"]
    saves = sorted(kept.iterdir())
    if len(saves) < len(evaluations) - 1:
        # The process was killed between a block's last row and the save: the learner's state at that time is lost.
        shutil.rmtree(work)
        _run_cell(cell, folder)
        return
    for number, (block, save_of) in enumerate(zip(evaluations[1:], saves, strict=True), start=1):
        greedy = make_learner(cell, sequence, "greedy")
        greedy.load(save_of)
        alone = Curriculum.from_dict({**curriculum.scenario, "form": "custom", "blocks": [block]})
        alone.run_vector(greedy, work / f"greedy-{number:02d}", check_frozen=False, **run)
    logs = [work / "sampled", *sorted(each for each in work.glob("greedy-*") if not each.name.endswith(".agent"))]
    _finish(cell, sequence, folder, logs, learner.report() | {"weights": learner.digest(), "wall_seconds": round(time.time() - start, 1)})


def digest(logs: Iterable[Path]) -> str:
    """SHA-256 of the logs without time stamps: equal if two runs are bit-identical."""
    sha256 = hashlib.sha256()
    for log in logs:
        columns = read_log(log).columns
        for name in sorted(set(columns) - {"timestamp"}):
            sha256.update(f"{log.name} {name} {columns[name].tolist()!r}".encode())
    return sha256.hexdigest()


def _finish(cell: Cell, sequence: Sequence, folder: Path, logs: list[Path], report: dict[str, Any]) -> None:
    """Packs the logs, writes the report, and then deletes the rest."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:xz", format=tarfile.USTAR_FORMAT) as tar:
        for log in logs:
            for file in sorted(each for each in log.rglob("*") if each.is_file()):
                entry = tarfile.TarInfo(str(Path(log.name) / file.relative_to(log)))
                entry.size = file.stat().st_size
                with file.open("rb") as opened:
                    tar.addfile(entry, opened)
    write_whole(folder / "logs.tar.xz", packed.getvalue())
    contents = {
        "sequence": sequence.name, "split": cell.split, "label": cell.label, "arguments": dict(cell.arguments),
        "made_with": arguments_of(cell, sequence), **({"source": source} if (source := cell.source()) else {}), **report,
        "peak_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, "machine": platform.machine(),
        "digest": digest(logs),
    }  # fmt: skip
    write_whole(folder / "report.json", (json.dumps(contents, indent=1) + "\n").encode())
    shutil.rmtree(folder / "work")


def run_cells(
    cells: Iterable[Cell], results: str | os.PathLike[str], jobs: int = 1, ray: str | None = None,
    watch: Callable[[Cell, dict[str, Any] | None], None] | None = None,
) -> list[dict[str, Any] | None]:  # fmt: skip
    """Runs cells, ``jobs`` at a time; each once, even if other processes run them in the same folder. Finished ones are
    not run again.

    Args:
        cells: The cells to run.
        results: The folder, which several machines may share.
        jobs: Number of local processes.
        ray: The address of a Ray cluster whose nodes share the folder: they run the cells instead of local processes.
        watch: Called with each cell and its report, in order, as soon as the report is available.

    Returns:
        The reports, in order; ``None`` for cells that another process is running.

    Raises:
        ValueError: If a finished cell was run with another learner file.
    """
    cells, folder = list(cells), Path(results).absolute()
    found: list[dict[str, Any] | None] = []

    def note(reports: Iterable[dict[str, Any] | None]) -> list[dict[str, Any] | None]:
        for cell, report in zip(cells, reports, strict=True):
            found.append(report)
            if watch is not None:
                watch(cell, report)
        return found

    if ray is not None:
        return note(_run_by_ray(cells, folder, ray))
    if jobs == 1:
        return note(cell.run(folder) for cell in cells)
    # A separate process for each cell, so that cells cannot affect each other.
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        return note(pool.map(partial(Cell.run, results=folder), cells))


def _run_by_ray(cells: list[Cell], folder: Path, address: str) -> list[dict[str, Any] | None]:
    """Runs cells as Ray tasks: if a node dies, its cells are resumed on another."""
    os.environ.setdefault("RAY_worker_niceness", "0")
    import ray

    ray.init(address=address, ignore_reinit_error=True, log_to_driver=False)

    @ray.remote(num_cpus=1, max_retries=-1, max_calls=1)
    def run(cell: Cell) -> dict[str, Any] | None:
        # The claim of a dead node is no longer touched.
        while (report := cell.run(folder)) is None:
            time.sleep(TOUCH)
        return report

    found: list[dict[str, Any] | None] = ray.get([run.remote(cell) for cell in cells])
    return found
