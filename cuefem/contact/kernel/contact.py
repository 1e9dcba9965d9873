"""A whole contact with linear laws in compiled code: the phases that `cuefem.contact.linear.Exact` goes through."""

from __future__ import annotations

import ctypes
import math
from ctypes import c_double, c_int, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.contact.kernel.linear import FOUND
from cuefem.contact.kernel.structures import pointer, structure
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.state import Contact

SIDES = {"slip": 1, "stick": 0, "slip back": -1}
GRIPS = {side: grip for grip, side in SIDES.items()}
PRESSES = ("load", "unload")
PHASES = 64  # room for so many

_Plain = structure(
    "_Plain",
    (c_int, "size turning at spring shear dampers cells_a_block most_phases most_cells"),
    (c_double, "root restitution friction compliance unit fastest slack longest reach"),
    (c_void_p, "omega c_t c_n damping"),
)
_Phase = structure("_Phase", (c_int, "side press first cells"), (c_double, "start end step fraction"))
_Outcome = structure("_Outcome", (c_double, "time peak rubbed"), (c_int, "phases cells"))


class Limits(NamedTuple):
    """Of a contact: cells a block, terms of a series, phases and cells at most, time, s, |A| times a cell's length."""

    cells_a_block: int
    terms: int
    most_phases: float
    most_cells: float
    longest: float
    reach: float
    slack: float  # by which |F_t| may pass mu F_n, N


class Gone(NamedTuple):
    """A phase that was gone through: grip, press, start, end, length of a cell, s, fraction of the last one, its state.

    cells: of the outputs (outputs, terms, cells).
    """

    grip: Any
    press: Any
    start: float
    end: float
    step: float
    fraction: float
    cells: Array
    state: Array


class Whole(NamedTuple):
    """A contact that is over: time, s, state, peak, N, what friction rubbed off and each damper took, J; its phases."""

    time: float
    state: Array
    peak: float
    rubbed: float
    damped: Array
    phases: list[Gone]


@cache
def _functions(library: ctypes.CDLL) -> tuple[Any, Any]:
    room, run = library.cuefem_contact_room, library.cuefem_contact
    room.restype, room.argtypes = ctypes.c_ssize_t, [c_int] * 3
    run.argtypes = [c_void_p, c_int, c_int, *[c_void_p] * 7]
    return room, run


def contact(
    library: ctypes.CDLL, contact: Contact, grip: str, press: str, *, compliance: float, unit: float, limits: Limits
) -> Whole | None:
    """Run a contact from its first grip to its end; None where Python has to go through its phases.

    compliance, m/N, and unit: of the spring at the patch; zero where it has none.
    """
    room_of, run = _functions(library)
    laws, slots, dampers = contact.laws, contact.slots, len(contact.dampers)
    root, outputs = math.sqrt(laws.stiffness), 4 + bool(compliance) + dampers
    norms = math.sqrt(contact.c_t @ contact.c_t), math.sqrt(contact.c_n @ contact.c_n)
    rate = contact.fastest + root / laws.restitution * (norms[1] + min(laws.friction, 2.0) * norms[0])
    rate += norms[0] / unit if compliance else 0.0
    cells = int(min(2 * laws.time * rate / limits.reach + 100, limits.most_cells))
    if cells * outputs > 2**20:  # a nearly dead tip, followed swing by swing
        return None
    most = int(max(0, min(PHASES, limits.most_phases)))
    plain = _Plain(
        len(contact.z), len(contact.omega), slots.swinging.start, slots["spring"],
        slots["shear"] if compliance else -1, dampers, limits.cells_a_block, most, cells,
        root, laws.restitution, laws.friction, compliance, unit, contact.fastest, limits.slack, limits.longest,
        limits.reach, *map(pointer, (contact.omega, contact.c_t, contact.c_n, contact.dampers)),
    )  # fmt: skip
    told, phases = _Outcome(contact.time, contact.peak, 0.0, 0, 0), (_Phase * PHASES)()
    z, damped = contact.z.copy(), np.zeros(dampers)
    starts, found = np.empty((PHASES, len(z))), np.empty((cells, outputs, limits.terms))
    room = np.empty(room_of(len(z), outputs, dampers))
    parts = (ctypes.addressof(part) for part in (told, phases))
    status = run(
        ctypes.addressof(plain), SIDES[grip], PRESSES.index(press), pointer(z), *parts,
        *map(pointer, (starts, found, damped, room)),
    )  # fmt: skip
    if status != FOUND:
        return None
    gone = []
    for one, state in zip(phases[: told.phases], starts, strict=False):
        own = found[one.first : one.first + one.cells].transpose(1, 2, 0)
        names = GRIPS[one.side], PRESSES[one.press]
        gone.append(Gone(*names, one.start, one.end, one.step, one.fraction, own, state))
    return Whole(told.time, z, told.peak, told.rubbed, damped, gone)
