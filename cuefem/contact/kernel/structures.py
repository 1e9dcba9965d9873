"""How Python hands numbers to C."""

from __future__ import annotations

import ctypes
from typing import Any

from numpy.typing import NDArray


def structure(name: str, *fields: tuple[Any, str]) -> Any:
    """A structure of C: types, each with the names of its fields, in order."""
    named = [(each, kind) for kind, names in fields for each in names.split()]
    return type(name, (ctypes.Structure,), {"_fields_": named})


def pointer(array: NDArray[Any]) -> int:
    """Where an array's numbers stand; it has to be in C's order."""
    assert array.flags.c_contiguous
    return int(array.__array_interface__["data"][0])
