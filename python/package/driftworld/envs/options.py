"""The options of environments: checked once, then passed to the native batch as overrides of each world."""

from __future__ import annotations

import difflib
import inspect
import json
import math
import numbers
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import Annotated, Any, TypedDict, TypeVar, get_args, get_type_hints

import numpy as np

from driftworld import _native
from driftworld._files import read_bytes
from driftworld._literals import ActionsName, DepthForm, InfoFor, Modality, RendererName, TaskLabel
from driftworld.errors import SpecError

#: The modalities that an observation may have.
MODALITIES: tuple[Modality, ...] = get_args(Modality)
DEPTHS: tuple[DepthForm, ...] = get_args(DepthForm)
RENDERERS: tuple[RendererName, ...] = get_args(RendererName)
LABELS: tuple[TaskLabel, ...] = get_args(TaskLabel)
INFOS: tuple[InfoFor, ...] = get_args(InfoFor)
#: The overrides of worlds' actions; ``"task"`` leaves a table as it is, and scales numbers to −1..1.
ACTIONS: dict[str, str | None] = {
    "task": None,
    "normalized": "normalized",
    "continuous": "continuous",
    "discrete": "default_discrete",
}


class EnvOptions(TypedDict, total=False):
    """The common options of single and vector environments, with types and defaults.

    They are documented in :class:`driftworld.DriftworldEnv`.
    """

    modalities: Annotated[Modality | Sequence[Modality] | None, None]
    blank: Annotated[bool, False]
    size: Annotated[int | tuple[int, int] | None, None]
    depth: Annotated[DepthForm, "uint8"]
    actions: Annotated[ActionsName | Sequence[Sequence[float]] | None, "task"]
    interact: Annotated[bool | None, None]
    frame_skip: Annotated[int | None, None]
    max_steps: Annotated[int | None, None]
    supersampling: Annotated[int | None, None]
    renderer: Annotated[RendererName, "cpu"]
    drift: Annotated[Mapping[str, Any] | None, None]
    task_label: Annotated[TaskLabel, "none"]
    info: Annotated[InfoFor, "agent"]
    assets: Annotated[str | PathLike[str] | Iterable[str | PathLike[str]], ()]


_DEFAULTS: dict[str, Any] = {
    name: hint.__metadata__[0] for name, hint in get_type_hints(EnvOptions, include_extras=True).items()
}
_Init = TypeVar("_Init", bound=Callable[..., None])


def shows_options(init: _Init) -> _Init:
    """Lists a constructor's ``**options`` in its signature by name, with types and defaults, before ``render_mode``,
    for ``help`` and tools.
    """
    signature, hints = inspect.signature(init), get_type_hints(EnvOptions)
    keyword = inspect.Parameter.KEYWORD_ONLY
    options = [
        inspect.Parameter(name, keyword, default=default, annotation=hints[name]) for name, default in _DEFAULTS.items()
    ]
    named = [parameter for name, parameter in signature.parameters.items() if name != "options"]
    place = list(signature.parameters).index("render_mode")
    shown = signature.replace(parameters=[*named[:place], *options, *named[place:]])
    init.__signature__ = shown  # type: ignore[attr-defined]
    init.__annotations__ = {**{name: hint for name, hint in init.__annotations__.items() if name != "options"}, **hints}
    return init


@dataclass(frozen=True)
class Options:
    """Checked options of an environment; single and vector environments share them.

    Attributes:
        modalities: The modalities of an observation, in this order; ``None`` for those that the worlds ask for.
        is_dict: Whether an observation is a dictionary, or its one modality alone.
        depth: The format of depth images.
        renderer: The renderer.
        task_label: Where the agent gets the label of its variant.
        names_variant: Whether infos name task and variant.
        has_infos: Whether infos contain anything.
        libraries: The bytes of asset libraries; the last one is searched first.
        max_steps: The step limit set for each world, if any.
        overrides: Overrides of each world, as JSON.
    """

    modalities: tuple[str, ...] | None
    is_dict: bool
    depth: str
    renderer: str
    task_label: str
    names_variant: bool
    has_infos: bool
    libraries: tuple[bytes, ...]
    max_steps: int | None
    overrides: str

    @classmethod
    def read(cls, given: EnvOptions) -> Options:
        """Checks the options, and fills in defaults.

        Raises:
            ValueError: For an unknown value of an option; lists the allowed ones.
        """
        options = {**_DEFAULTS, **given}
        modalities, task_label = options["modalities"], options["task_label"]
        is_dict = not isinstance(modalities, str)
        if modalities is not None and not isinstance(modalities, Sequence):
            raise ValueError(f"modalities: found {modalities!r}, expected one of {', '.join(MODALITIES)}, or a list")
        kinds: tuple[str, ...] | None = None
        if modalities is not None:
            kinds = (modalities,) if isinstance(modalities, str) else tuple(modalities)
        if isinstance(modalities, str) and "," in modalities:
            raise ValueError(f"modalities: found {modalities!r}, expected a list: {[kind.strip() for kind in modalities.split(',')]!r}")
        if kinds is not None:
            for kind in kinds:
                _one_of("modalities", kind, MODALITIES)
            if not kinds or len(set(kinds)) < len(kinds):
                raise ValueError(f"modalities: found {modalities!r}, expected some of {', '.join(MODALITIES)}, each once")
        blank = _flag("blank", options["blank"])
        _one_of("depth", options["depth"], DEPTHS)
        _one_of("renderer", options["renderer"], RENDERERS)
        if task_label == "obs":
            raise ValueError('task_label: found "obs": removed in 0.3; use "observation"')
        _one_of("task_label", task_label, LABELS)
        _one_of("info", options["info"], INFOS)
        if options["info"] == "none" and (task_label == "info" or task_label == "observation" and not is_dict):
            raise ValueError(f'info: found "none" with task_label={task_label!r}, which needs infos, expected "agent" or "full"')
        if blank and kinds is None:
            raise ValueError(
                'blank: found True without modalities, expected a list of them, such as modalities=["rgb", "depth", "state"]: by '
                "default, they are those that the worlds ask for"
            )
        overrides = {
            "modalities": None if kinds is None or blank else images_among(kinds),
            "stateless": None if kinds is None or "state" in kinds else True,
            "size": _size(options["size"]),
            "actions": _actions(options["actions"]),
            "normalizes": isinstance(options["actions"], str) and options["actions"] == "task",
            "interact": _flag("interact", options["interact"]),
            **{name: whole(name, options[name]) for name in ("frame_skip", "max_steps", "supersampling")},
        }
        return cls(
            modalities=kinds,
            is_dict=is_dict,
            depth=options["depth"],
            renderer=options["renderer"],
            task_label=task_label,
            names_variant=task_label != "none" or options["info"] == "full",
            has_infos=options["info"] != "none",
            libraries=library_bytes(options["assets"]),
            max_steps=overrides["max_steps"],
            overrides=json.dumps({name: value for name, value in overrides.items() if value is not None}),
        )

    def layouts(self, stream: _native.Stream) -> list[dict[str, Any]]:
        """The layout of each variant of a stream.

        Raises:
            SpecError: If an option is out of range, or does not fit the worlds.
        """
        try:
            return [json.loads(text) for text in stream.layouts(self.overrides)]
        except SpecError as error:
            raise _as_options(error) from None

    @property
    def images(self) -> str | None:
        """The images in observations, as JSON, if the options specify them."""
        return None if self.modalities is None else json.dumps(images_among(self.modalities))

    def shown(self, layouts: Iterable[dict[str, Any]]) -> Options:
        """Fills in the modalities that worlds of these layouts ask for, if none are given.

        Raises:
            ValueError: If they ask for none at all.
        """
        if self.modalities is not None:
            return self
        asked = {kind for layout in layouts for kind in modalities_of(layout)}
        if not asked:
            raise ValueError(f"modalities: found worlds that show nothing, expected some of {', '.join(MODALITIES)}")
        return replace(self, modalities=tuple(kind for kind in MODALITIES if kind in asked))


#: Advice for each option that hides differences between variants.
_INSTEAD = {
    "modalities": "; to show each variant its own images, list all their modalities and set blank=True",
    "actions": "; actions=None keeps the actions of each variant",
}


def coverings(found: str) -> dict[str, str]:
    """Messages, by option, about the differences between variants that options hide, from the native module's
    findings.
    """
    messages = {}
    for each in json.loads(found):
        option, values = each["option"], [(name, json.dumps(value)) for name, value in each["said"]]
        if "hidden" in each:
            messages[option] = (
                f"{option}: found it hiding {each['hidden']}, in which {values[0][0]} and {values[1][0]} differ and which only rgb images "
                "show, expected rgb among them, or variants that differ in other ways: with this option they are the same"
            )
            continue
        if len(values) == 1:
            difference = f"{values[0][0]} draws anew in each world"
        else:
            difference = "differs between " + " and ".join(f"{name} ({value})" for name, value in values)
        messages[option] = (
            f"{option}: found it hiding {each['key']}, which {difference}, expected no such option, or variants that agree there: "
            f"with this option they are the same{_INSTEAD.get(option, '')}"
        )
    return messages


def images_among(kinds: Iterable[str]) -> list[str]:
    """The modalities that are images."""
    return [kind for kind in kinds if kind != "state"]


def modalities_of(layout: dict[str, Any]) -> list[str]:
    """The modalities of worlds with this layout."""
    return [*layout["modalities"], *(["state"] if layout["state_len"] else [])]


#: The option behind each world value that options override.
_OPTIONS = {
    "/agent_params/modalities": "modalities",
    "/agent_params/observation_size": "size",
    "/agent_params/observation_width": "size",
    "/agent_params/actions": "actions",
    "/agent_params/interact": "interact",
    "/agent_params/frame_skip": "frame_skip",
    "/agent_params/supersampling": "supersampling",
    "/max_steps": "max_steps",
}


def _as_options(error: SpecError) -> SpecError:
    """Rewrites an error to name the option instead of the world value that it overrides."""
    lines = []
    for problem in error.problems:
        option = next((name for pointer, name in _OPTIONS.items() if problem["pointer"].startswith(pointer)), None)
        if option is None:
            return error
        expected = problem["expected"].replace(
            '{"discrete": [[3, 4, 0], [-3, 4, 0]]}', "actions=[[3, 4, 0], [-3, 4, 0]]"
        )
        advice = f"; {problem['advice']}" if problem["advice"] else ""
        lines.append(f"{option}: found {problem['found']}, expected {expected}{advice}")
    if not lines:
        return error
    problems = [{**problem, "line": None, "column": None} for problem in error.problems]
    return SpecError("\n".join(lines), code=error.code, problems=problems)


def expect_same_spaces(ours: dict[str, Any], theirs: dict[str, Any], modalities: Sequence[str]) -> None:
    """Checks that worlds of another variant fit the spaces of an environment with these modalities.

    Raises:
        ValueError: Names the difference.
    """
    for key in ("height", "width", "state_features", "instruction_len"):
        if ours[key] != theirs[key]:
            advice = "make" if key in ("state_features", "instruction_len") else "pass option size, or make"
            raise ValueError(
                f"variant: found {key} {theirs[key]}, expected {ours[key]}, as when the environment was made; {advice} a separate "
                "environment"
            )
    missing = [kind for kind in theirs["modalities"] if kind not in modalities]
    if missing:
        raise ValueError(
            f"variant: found images of {', '.join(missing)}, expected some of {', '.join(modalities)}, as when the environment was "
            "made; pass option modalities with all of them, and blank=True if each variant should show only its own"
        )
    if not fits_into(theirs["action"], ours["action"]):
        raise ValueError(
            f"variant: found actions of {_words(theirs['action'])}, expected {_words(ours['action'])}, as when the environment was "
            "made; pass a table of rows as option actions: the third number has an effect in variants where the agent can interact"
        )


def fits_into(action: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether actions of one kind are valid as the other kind: the same kind, or one without its last numbers.

    If worlds randomize a bound of the other kind, any narrower bound fits into it.
    """
    if action == other:
        return True
    bounds, outer = action.get("bounds"), other.get("bounds", [])
    if bounds is None or len(outer) < len(bounds):
        return False
    return all(
        one == most or (other["drawn"] and most[0] <= one[0] and one[1] <= most[1])
        for one, most in zip(bounds, outer, strict=False)
    )


def widest_action(layouts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The actions of these layouts that all others fit into; the first layout's if there are none."""
    actions: list[dict[str, Any]] = [layout["action"] for layout in layouts]
    return next((one for one in actions if all(fits_into(action, one) for action in actions)), actions[0])


def _words(action: dict[str, Any]) -> str:
    if "n" in action:
        return f"{action['n']} rows"
    return "numbers in " + ", ".join(f"{low:g}..{high:g}" for low, high in action["bounds"])


def refuse_unknown(made: type, given: Iterable[str]) -> None:
    """Refuses options that a class's constructor does not have.

    Raises:
        TypeError: Names them, and suggests the closest option.
    """
    parameters = inspect.signature(made.__init__).parameters  # type: ignore[misc]
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in parameters.values()):
        return
    known = [name for name in parameters if name != "self"]
    for name in given:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            advice = f"; did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"{made.__name__}: found the option {name!r}, expected one of {', '.join(known)}{advice}")


def _one_of(option: str, found: Any, known: Sequence[str]) -> None:
    if found not in known:
        raise ValueError(f"{option}: found {found!r}, expected one of {', '.join(known)}")


def whole(option: str, found: Any) -> int | None:
    """A whole number that fits into 32 bits, or ``None``.

    Raises:
        ValueError: For anything else.
    """
    if found is None:
        return None
    if isinstance(found, bool) or not isinstance(found, numbers.Integral) or not 0 <= int(found) < 2**32:
        raise ValueError(f"{option}: found {found!r}, expected a whole number in 0..{2**32 - 1}")
    return int(found)


def _flag(option: str, found: Any) -> bool | None:
    if found is None or isinstance(found, (bool, np.bool_)):
        return None if found is None else bool(found)
    raise ValueError(f"{option}: found {found!r}, expected True, False or None")


def _size(size: Any) -> list[int] | None:
    if size is None:
        return None
    sides = list(size) if isinstance(size, (tuple, list)) else [size, size]
    if len(sides) != 2 or any(isinstance(side, bool) or not isinstance(side, numbers.Integral) for side in sides):
        raise ValueError(f"size: found {size!r}, expected pixels, or (height, width)")
    return [whole("size", side) or 0 for side in sides]


def _actions(actions: Any) -> Any:
    if actions is None:
        return None
    if isinstance(actions, str):
        _one_of("actions", actions, tuple(ACTIONS))
        return ACTIONS[actions]
    try:
        table = [[float(number) for number in row] for row in actions]
    except (TypeError, ValueError):
        table = []
    if not table or any(len(row) != 3 or not all(map(math.isfinite, row)) for row in table):
        raise ValueError(
            f"actions: found {actions!r}, expected one of {', '.join(ACTIONS)}, or a table of rows of three numbers, as in "
            "[[10, 0, 0], [0, 90, 0]]"
        )
    return {"discrete": table}


def library_bytes(assets: Any) -> tuple[bytes, ...]:
    paths = [assets] if isinstance(assets, (str, PathLike)) else list(assets or ())
    return tuple(read_bytes(path, "library") for path in paths)
