"""Defaults of public names are the documented ones; dataclasses cannot be changed (regression)."""

import ast
import dataclasses
import inspect
import pkgutil
import re
import tomllib
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import cuefem as cf

LISTED = Path(__file__).with_name("defaults.toml")
VALUES = (bool, int, float, str, tuple)


def defaults(call: Any) -> dict[str, Any]:
    """The defaults of a call's arguments that are values and not empty."""
    values = {name: parameter.default for name, parameter in inspect.signature(call).parameters.items()}
    given = {name: value for name, value in values.items() if isinstance(value, VALUES) and value not in ("", ())}
    return {name: [*value] if isinstance(value, tuple) else value for name, value in given.items()}


def public_calls() -> Iterator[tuple[str, Any]]:
    """Public functions and classes, and the methods of the classes, with their names."""
    for name in sorted(cf.__all__):
        public = getattr(cf, name)
        if not callable(public) or (inspect.isclass(public) and issubclass(public, Warning | Exception)):
            continue
        yield name, public
        for part, member in inspect.getmembers(
            public, lambda found: inspect.isfunction(found) or inspect.ismethod(found)
        ):
            if not part.startswith("_"):
                yield f"{name}.{part}", member


def test_defaults_of_public_names_are_those_documented() -> None:
    documented: dict[str, Any] = tomllib.loads(LISTED.read_text(encoding="utf-8"))
    for name, call in public_calls():
        stated = re.findall(r"^(\w+) : .*, default (.+)$", inspect.getdoc(call) or "", re.M)
        if stated:
            documented[name] = {part: ast.literal_eval(value) for part, value in stated if value != "None"}
    found = {name: defaults(call) for name, call in public_calls()}
    assert {name: row for name, row in found.items() if row} == {name: row for name, row in documented.items() if row}


def dataclasses_of_package() -> Iterator[Any]:
    for module in pkgutil.walk_packages(cf.__path__, "cuefem."):
        with suppress(ImportError):  # an extra that is not installed
            for kind in vars(import_module(module.name)).values():
                if inspect.isclass(kind) and dataclasses.is_dataclass(kind) and kind.__module__ == module.name:
                    yield kind


def test_dataclasses_are_frozen_and_those_with_arrays_do_not_compare_field_by_field() -> None:
    kinds = list(dataclasses_of_package())
    assert [kind.__name__ for kind in kinds if not kind.__dataclass_params__.frozen] == ["Results"]  # of a session
    types = {kind: " ".join(str(field.type) for field in dataclasses.fields(kind)) for kind in kinds}
    with_arrays = [kind for kind in kinds if "Array" in types[kind] or "ndarray" in types[kind]]
    assert [kind.__name__ for kind in with_arrays if kind.__dataclass_params__.eq] == []
