"""How Python hands numbers to C."""

from __future__ import annotations

import ctypes
import threading
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array


def structure(name: str, *fields: tuple[Any, str]) -> Any:
    """A structure of C: types, each with the names of its fields, in order."""
    named = [(each, kind) for kind, names in fields for each in names.split()]
    return type(name, (ctypes.Structure,), {"_fields_": named})


def pointer(array: NDArray[Any]) -> int:
    """Where an array's numbers stand; it has to be in C's order."""
    assert array.flags.c_contiguous
    return int(array.__array_interface__["data"][0])


class Room(threading.local):
    """Room for the numbers that C works on, kept between calls: one a thread, since asking where it is takes long."""

    def __init__(self) -> None:
        self._numbers, self._at = np.empty(0), 0
        self._last: tuple[tuple[int, ...], tuple[list[Array], list[int]]] = (), ([], [])

    def of(self, *counts: int) -> tuple[list[Array], list[int]]:
        """Arrays of so many doubles, whose values are anything, and where they stand; good until the next call."""
        if self._last[0] != counts:
            ends = list(accumulate(counts, initial=0))
            if ends[-1] > len(self._numbers):
                self._numbers = np.empty(ends[-1])
                self._at = pointer(self._numbers)
            places = list(pairwise(ends))
            parts = [self._numbers[first:end] for first, end in places]
            self._last = counts, (parts, [self._at + 8 * first for first, _ in places])
        return self._last[1]
