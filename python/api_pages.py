"""Makes the pages of the Python API: every public name of the package with its signature and its docstring.

The pages are made from the sources and the stub: nothing is imported, so neither the native module nor NumPy is needed.
They are not committed; `book/build.py` adds them to the book.

    python python/api_pages.py FOLDER     writes the pages into a folder, to read them without the book
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "python" / "package" / "driftworld"

#: The names on each page, in the order of use. Every exported name is on one page.
LAYOUT: dict[str, tuple[str, str, dict[str, list[str]]]] = {
    "environments": (
        "Environments",
        "Gymnasium environments. `gymnasium.make` and `gymnasium.make_vec` make them; importing `driftworld` registers them.",
        {
            "driftworld": [
                "DriftworldEnv",
                "DriftworldVectorEnv",
                "register_envs",
                "spread_seeds",
                "segmentation_classes",
            ],
            "driftworld.check": ["check", "Report", "Finding"],
            "driftworld.miniworld": ["MiniWorldEnv", "Actions", "names", "task"],
        },
    ),
    "tasks": (
        "Tasks, variants and worlds",
        "Task specs as they are written down, and the worlds that are drawn from them.",
        {
            "driftworld": [
                "TaskSpec",
                "Variant",
                "Drift",
                "built_in_tasks",
                "task_groups",
                "variant",
                "variants",
                "validate",
                "elements",
                "studio",
                "Studio",
            ]
        },
    ),
    "distances": (
        "Distances and orders",
        "The measures of `driftworld distance` and `driftworld order`, with the same numbers.",
        {"driftworld": ["distance", "Distance", "distance_matrix", "DistanceMatrix", "order", "Order"]},
    ),
    "curricula": (
        "Curricula and agents",
        "Curricula, and agents of your own that live them.",
        {
            "driftworld": [
                "Curriculum",
                "Block",
                "Experience",
                "Agent",
                "Transition",
                "VectorAgent",
                "VectorTransition",
                "Summary",
                "Recording",
                "replay",
            ]
        },
    ),
    "scores": (
        "Logs and scores",
        "Logs in l2logger's format, and the metrics of `driftworld metrics`.",
        {"driftworld": ["metrics", "Metrics", "report", "read_log", "Log", "LogWriter", "validate_log"]},
    ),
    "adapters": (
        "Adapters to other libraries",
        "Each is imported by its own name, and needs the library that it adapts to.",
        {
            "driftworld.adapters.sb3": ["make_vec_env", "DriftworldVecEnv"],
            "driftworld.adapters.minari": ["collect"],
            "driftworld.adapters.pufferlib": ["DriftworldPuffer"],
        },
    ),
    "learners": (
        "Continual learners",
        "PPO and continual methods for `Curriculum.run_vector`. They need PyTorch. [How they are used](../how-to/learners.md).",
        {
            "driftworld.learners": [
                "PPO",
                "Settings",
                "Learner",
                "Rollout",
                "PatchNetwork",
                "RecurrentNetwork",
                "FineTuning",
                "ResetOptimizer",
                "FromScratch",
                "L2",
                "EWC",
                "OnlineEWC",
                "PackNet",
                "CLEAR",
                "ShrinkAndPerturb",
                "RecurrentPPO",
            ]
        },
    ),
    "errors": (
        "Errors",
        "One base, and one subclass for each part of the toolkit.",
        {
            "driftworld": [
                "DriftworldError",
                "SpecError",
                "TaskError",
                "GeneratorError",
                "SimilarityError",
                "EnvError",
                "MetricsError",
                "CurriculumError",
            ]
        },
    ),
}

#: Names without a page, with a description.
WITHOUT_A_PAGE = {"__version__": "the version of the package, as text"}

WIDTH = 100

Definition = ast.ClassDef | ast.FunctionDef


class Found(NamedTuple):
    """A definition, and whether it is in the stub of the native module."""

    node: Definition
    is_native: bool


def module_file(module: str) -> Path:
    """The source of a module of the package; for the native module, its stub."""
    parts = module.split(".")[1:]
    folder = PACKAGE.joinpath(*parts)
    candidates = [folder / "__init__.py", folder.with_suffix(".py"), folder.with_suffix(".pyi")]
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise SystemExit(f"api_pages: found no source of {module}, expected one of {', '.join(map(str, candidates))}")


def find(module: str, name: str) -> Found:
    """The definition of a name, followed through re-exports."""
    path = module_file(module)
    tree = ast.parse(path.read_text(encoding="utf-8"))
    # The last definition: earlier ones of the same name are overloads.
    own = [node for node in tree.body if isinstance(node, Definition) and node.name == name]
    if own:
        return Found(own[-1], path.suffix == ".pyi")
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("driftworld"):
            for alias in node.names:
                if (alias.asname or alias.name) == name:
                    return find(node.module, alias.name)
    raise SystemExit(f"api_pages: found no definition of {name} in {module}")


def exported() -> set[str]:
    """The names that ``from driftworld import *`` imports."""
    for node in ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    raise SystemExit("api_pages: found no __all__ in driftworld/__init__.py")


def plain(text: str) -> str:
    """Converts reStructuredText markup to Markdown."""
    text = re.sub(r":(?:class|func|meth|mod|attr):`~?([^`]+)`", r"`\1`", text)
    return text.replace("``", "`")


SECTIONS = {
    "Args": "Arguments",
    "Attributes": "Attributes",
    "Returns": "Returns",
    "Raises": "Raises",
    "Yields": "Yields",
}


def docstring(node: Definition) -> Iterator[str]:
    """A docstring as lines of Markdown: its sections become lists."""
    section = ""
    for line in (ast.get_docstring(node) or "").splitlines():
        heading = re.fullmatch(r"(\w+):", line)
        if heading and heading[1] in SECTIONS:
            section = heading[1]
            yield from (f"**{SECTIONS[section]}**", "")
        elif not line.strip():
            yield ""
        elif section and not line.startswith(" "):
            section = ""
            yield plain(line)
        elif section in ("Args", "Attributes", "Raises"):
            named = re.fullmatch(r" {4}(\S[^:]*): (.*)", line)
            yield plain(f"- `{named[1]}`: {named[2]}" if named else f"  {line.strip()}")
        else:
            yield plain(line.strip() if section else line)


def signature(node: ast.FunctionDef, name: str, *, is_method: bool) -> str:
    """A call with the types of its arguments, on several lines if it is long."""
    arguments = [*node.args.posonlyargs, *node.args.args]
    defaults: list[ast.expr | None] = [None] * (len(arguments) - len(node.args.defaults)) + list(node.args.defaults)
    is_bound = is_method and not any(ast.unparse(mark) == "staticmethod" for mark in node.decorator_list)
    parts = [argument(each, default) for each, default in zip(arguments, defaults, strict=True)][1 if is_bound else 0 :]
    if node.args.vararg:
        parts.append("*" + argument(node.args.vararg, None))
    elif node.args.kwonlyargs:
        parts.append("*")
    parts += [
        argument(each, default) for each, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    ]
    if node.args.kwarg:
        parts.append("**" + argument(node.args.kwarg, None))
    is_made = node.name in ("__init__", "__new__") or node.returns is None
    ending = "" if is_made or node.returns is None else f" -> {ast.unparse(node.returns)}"
    short = f"{name}({', '.join(parts)}){ending}"
    return short if len(short) <= WIDTH else "\n".join([f"{name}(", *(f"    {part}," for part in parts), f"){ending}"])


def argument(node: ast.arg, default: ast.expr | None) -> str:
    text = node.arg + (f": {ast.unparse(node.annotation)}" if node.annotation else "")
    return text if default is None else f"{text} = {ast.unparse(default)}"


def marks(node: ast.FunctionDef) -> set[str]:
    return {ast.unparse(mark) for mark in node.decorator_list}


def members(node: ast.ClassDef, *, is_native: bool) -> Iterator[str]:
    """The public methods and properties of a class that have docstrings; for native classes all of them."""
    seen = set()
    methods = [each for each in node.body if isinstance(each, ast.FunctionDef) and not each.name.startswith("_")]
    last = {each.name: each for each in methods if not any(mark.endswith(".setter") for mark in marks(each))}
    for method in methods:
        if method.name in seen or not (is_native or ast.get_docstring(method)):
            continue
        seen.add(method.name)
        method = last.get(method.name, method)
        if marks(method) & {"property", "cached_property"}:
            kind = f": {ast.unparse(method.returns)}" if method.returns else ""
            yield from (f"### `{node.name}.{method.name}`", "", "```py", f"{method.name}{kind}", "```", "")
        else:
            yield from (
                f"### `{node.name}.{method.name}()`",
                "",
                "```py",
                signature(method, method.name, is_method=True),
                "```",
                "",
            )
        yield from (*docstring(method), "")


def entry(module: str, name: str) -> Iterator[str]:
    """The section of a name."""
    node, is_native = find(module, name)
    prefix = "driftworld" if module == "driftworld" else module
    if isinstance(node, ast.FunctionDef):
        yield from (f"## `{name}()`", "", "```py", signature(node, f"{prefix}.{name}", is_method=False), "```", "")
        yield from docstring(node)
        return
    yield from (f"## class `{name}`", "", "```py")
    makers = [each for each in node.body if isinstance(each, ast.FunctionDef) and each.name in ("__init__", "__new__")]
    bases = ", ".join(ast.unparse(base) for base in node.bases)
    yield f"class {prefix}.{name}" + (f"({bases})" if bases else "")
    if makers and not is_error(node):
        yield signature(makers[-1], name, is_method=True)
    elif any("dataclass" in ast.unparse(mark) for mark in node.decorator_list):
        fields = [
            each
            for each in node.body
            if isinstance(each, ast.AnnAssign) and not ast.unparse(each.target).startswith("_")
        ]
        yield from (f"    {ast.unparse(each.target)}: {ast.unparse(each.annotation)}" for each in fields)
    yield from ("```", "")
    yield from (*docstring(node), "")
    yield from members(node, is_native=is_native)


def is_error(node: ast.ClassDef) -> bool:
    """Whether a class is an exception, whose constructor is not documented."""
    return node.name.endswith("Error")


def page(slug: str) -> str:
    """One page as Markdown."""
    title, about, modules = LAYOUT[slug]
    lines = [f"# {title}", "", about, ""]
    for module, names in modules.items():
        for name in names:
            lines += [*entry(module, name), ""]
    text = "\n".join(line.rstrip() for line in lines)
    return re.sub(r"\n{3,}", "\n\n", text).strip() + "\n"


def summary(module: str, name: str) -> str:
    return plain((ast.get_docstring(find(module, name).node) or "").partition("\n")[0])


def contents() -> str:
    """The page that lists all names."""
    lines = [
        "# Python API",
        "",
        "Every public name of the package `driftworld`. [The guide](../python.md) shows how they are used.",
        "",
    ]
    for slug, (title, _, modules) in LAYOUT.items():
        lines += [f"## [{title}]({slug}.md)", "", "| name | what it is |", "|---|---|"]
        for module, names in modules.items():
            for name in names:
                prefix = "" if module == "driftworld" else f"{module}."
                about = summary(module, name).replace("|", "\\|")
                is_class = isinstance(find(module, name).node, ast.ClassDef)
                anchor = f"class-{name.lower()}" if is_class else name.lower()
                lines.append(f"| [`{prefix}{name}`]({slug}.md#{anchor}) | {about} |")
        lines.append("")
    return "\n".join(lines).strip() + "\n"


def pages() -> dict[str, str]:
    """Every page by its file name."""
    named = {name for _, _, modules in LAYOUT.values() for name in modules.get("driftworld", [])}
    missing = exported() - named - set(WITHOUT_A_PAGE)
    if missing:
        raise SystemExit(
            f"api_pages: found {', '.join(sorted(missing))} on no page, expected every exported name in LAYOUT"
        )
    return {"README.md": contents(), **{f"{slug}.md": page(slug) for slug in LAYOUT}}


def main() -> None:
    """Writes the pages."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
