"""A linear phase in compiled code: what `cuefem.contact.flow.march` does cell by cell."""

from __future__ import annotations

import ctypes
from ctypes import c_double, c_int, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.contact.kernel.structures import pointer, structure
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.flow import Flow, Guards

FOUND, MORE, LATE, NOT_FINITE, REFUSED = range(5)
# Cells whose outputs are kept in one array; the first of them is smaller.
CELLS, FIRST_CELLS = 512, 128


_Flow = structure(
    "_Flow",
    (c_int, "size turning at outputs pushed guards cells_a_block terms"),
    (c_double, "step"),
    (c_void_p, "omega rows pushes weights constants"),
)
_Place = structure("_Place", (c_double, "start fraction"), (c_int, "cell block guard written"))


class Marched(NamedTuple):
    """The end of a phase: status; time, s; state; guard; (start, s, cell length, s, coefficients) of its stretches."""

    status: int
    time: float
    state: Array
    guard: int
    stretches: list[tuple[float, float, Array]]


@cache
def _functions(library: ctypes.CDLL) -> tuple[Any, Any]:
    room, run = library.cuefem_march_room, library.cuefem_march
    room.restype, room.argtypes = ctypes.c_ssize_t, [c_int] * 3
    run.restype = c_int
    run.argtypes = [c_void_p, c_void_p, c_void_p, c_double, c_int, c_void_p, c_void_p]
    return room, run


def march(
    library: ctypes.CDLL, flow: Flow, z: Array, guards: Guards, *, start: float, limit: float, block: int, terms: int
) -> Marched:
    """Follow a flow that has a drive from ``z`` at ``start``, s, to a guard's sign change, or to the limit, s.

    block: cells between two looks at the time. terms: of a Taylor series.
    """
    drive = flow.drive
    assert drive is not None
    room_of, run = _functions(library)
    outputs = len(flow.rows)
    rows = np.concatenate([flow.rows, drive.rows])
    kept = [np.ascontiguousarray(part) for part in (drive.omega, rows, drive.pushes, *guards)]
    told = _Flow(
        len(z), len(drive.omega), drive.turning.start, outputs, len(drive.pushes), len(guards.constants), block, terms,
        flow.step, *map(pointer, kept),
    )  # fmt: skip
    place, state = _Place(start, 0.0, 0, 0, -1, 0), z.copy()
    room = np.empty(room_of(len(z), outputs, len(drive.pushes)))
    stretches: list[tuple[float, float, Array]] = []
    arguments = ctypes.addressof(told), pointer(state), ctypes.addressof(place)
    status, most = MORE, FIRST_CELLS
    while status == MORE:
        before = place.start + place.cell * flow.step
        cells = np.empty((most, outputs, terms))
        status = run(*arguments, limit, most, pointer(cells), pointer(room))
        found = cells[: place.written].transpose(1, 2, 0)
        whole = place.written - (status == FOUND)
        if whole:
            stretches.append((before, flow.step, found[:, :, :whole]))
        most = CELLS
    end = place.start + (place.cell + place.fraction) * flow.step
    if status == FOUND and place.fraction:
        stretches.append((place.start + place.cell * flow.step, flow.step * place.fraction, found[:, :, whole:]))
    return Marched(status, end, state, place.guard, stretches)
