"""The stub of the native module declares exactly the module's names."""

from __future__ import annotations

import ast
import inspect
from pathlib import Path
from types import ModuleType
from typing import Any

import driftworld
import pytest
from driftworld import _native

#: Attributes that Python gives to every class, and those that PyO3 adds for comparisons.
EVERY_CLASS_HAS = set(dir(object)) | {"__module__", "__doc__"}


def stub() -> ast.Module:
    path = Path(driftworld.__file__).with_name("_native.pyi")
    return ast.parse(path.read_text(encoding="utf-8"))


def named(body: list[ast.stmt]) -> set[str]:
    names: set[str] = set()
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.add(node.target.id)
    return {name for name in names if not name.startswith("_") or name.endswith("__")}


def defined(thing: type | ModuleType) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_") or name.endswith("__")}


def test_stub_has_the_modules_names() -> None:
    module_attributes = {"__name__", "__doc__", "__package__", "__loader__", "__spec__", "__file__", "__all__"}
    assert named(stub().body) == defined(_native) - module_attributes


def classes() -> list[ast.ClassDef]:
    return [node for node in stub().body if isinstance(node, ast.ClassDef)]


@pytest.mark.parametrize("declaration", classes(), ids=lambda node: node.name)
def test_stub_has_each_classs_names(declaration: ast.ClassDef) -> None:
    real = getattr(_native, declaration.name)
    assert named(declaration.body) - EVERY_CLASS_HAS == defined(real) - EVERY_CLASS_HAS


def functions() -> list[tuple[str, ast.FunctionDef, Any]]:
    """Every callable: its name, its declaration in the stub, and the object."""
    found: list[tuple[str, ast.FunctionDef, Any]] = []
    for node in stub().body:
        if isinstance(node, ast.FunctionDef):
            found.append((node.name, node, getattr(_native, node.name)))
        elif isinstance(node, ast.ClassDef):
            for member in node.body:
                is_property = isinstance(member, ast.FunctionDef) and any(
                    isinstance(decorator, ast.Name) and decorator.id == "property"
                    for decorator in member.decorator_list
                )
                if isinstance(member, ast.FunctionDef) and not is_property and not member.name.startswith("__"):
                    found.append(
                        (f"{node.name}.{member.name}", member, getattr(getattr(_native, node.name), member.name))
                    )
    return found


@pytest.mark.parametrize(
    ("name", "declaration", "real"), functions(), ids=lambda value: value if isinstance(value, str) else ""
)
def test_stub_has_the_parameters_and_their_defaults(
    name: str, declaration: ast.FunctionDef, real: Any
) -> None:
    arguments = declaration.args
    positional = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
    with_defaults = positional[len(positional) - len(arguments.defaults) :]
    with_defaults += [
        arg.arg for arg, default in zip(arguments.kwonlyargs, arguments.kw_defaults) if default is not None
    ]
    expected = [name for name in positional + [arg.arg for arg in arguments.kwonlyargs] if name not in ("self", "cls")]
    signature = inspect.signature(real).parameters.values()
    plain = [
        parameter for parameter in signature if parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL)
    ]
    found = [parameter.name for parameter in plain if parameter.name not in ("self", "cls", "slf")]
    assert found == expected
    assert [p.name for p in plain if p.default is not p.empty] == with_defaults
    # `help()` shows `Ellipsis` for a default that it cannot represent.
    defaults = [*arguments.defaults, *(default for default in arguments.kw_defaults if default is not None)]
    assert [p.default for p in plain if p.default is not p.empty] == [ast.literal_eval(default) for default in defaults]
