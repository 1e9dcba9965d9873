"""The constants and structures of contact.h, read from it: there is no second declaration."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from cuefem.contact.kernel import HERE

HEADER = re.sub(r"/\*.*?\*/", "", (HERE / "contact.h").read_text(encoding="utf-8"), flags=re.DOTALL)
C_TYPES: dict[str, Any] = {"int": ctypes.c_int, "double": ctypes.c_double}
DECLARATOR = re.compile(r"\s*(?P<pointer>\*?)(?P<name>\w+)(?:\[(?P<size>\w+)\])?\s*")


def enum_constants() -> dict[str, int]:
    """Names and values of all enums; a value is a number or a sum of constants, or one more than the last."""
    values: dict[str, int] = {}
    for body in re.findall(r"enum \{([^}]*)\}", HEADER):
        value = -1
        for entry in filter(str.strip, body.split(",")):
            name, _, expression = entry.partition("=")
            terms = expression.replace(" ", "").split("+") if expression else [str(value + 1)]
            value = sum(values[term] if term in values else int(term) for term in terms)
            values[name.strip()] = value
    return values


CONSTANTS = enum_constants()


def fields_of(structure: str) -> Iterator[tuple[str, Any]]:
    """Names and types of the fields of a structure; a pointer is an address."""
    bodies = {name: body for body, name in re.findall(r"typedef struct \{([^}]*)\} (\w+);", HEADER)}
    for declaration in bodies[structure].split(";")[:-1]:
        c_type, declarators = declaration.replace("const ", "").split(maxsplit=1)
        for declarator in declarators.split(","):
            match = DECLARATOR.fullmatch(declarator)
            assert match is not None, f"contact.h, {structure}: {declarator}"
            one = ctypes.c_void_p if match["pointer"] else C_TYPES[c_type]
            yield match["name"], one * CONSTANTS[match["size"]] if match["size"] else one


class Declared(ctypes.Structure):
    """A structure of contact.h. TypeError for a field that it has not; `ctypes` alone would take it."""

    def __init__(self, **values: Any) -> None:
        names = {name for name, *_ in self._fields_}
        if unknown := sorted(values.keys() - names):
            raise TypeError(f"contact.h: {type(self).__name__} has no field {', '.join(unknown)}")
        super().__init__(**values)


class KernelContact(Declared):
    """Contact."""

    _fields_ = tuple(fields_of("Contact"))


class KernelTables(Declared):
    """StepTables."""

    _fields_ = tuple(fields_of("StepTables"))


class KernelStep(Declared):
    """Step."""

    _fields_ = tuple(fields_of("Step"))


STEP = np.dtype(KernelStep)
