"""A whole contact with linear laws in compiled code: the phases that `cuefem.contact.linear.Exact` goes through."""

from __future__ import annotations

import ctypes
import math
from ctypes import byref, c_double, c_int, c_void_p
from functools import cache
from typing import Any, NamedTuple

from cuefem.contact.kernel.linear import FOUND
from cuefem.contact.kernel.structures import Room, structure
from cuefem.contact.state import Contact, Phase
from cuefem.cue import Array

SIDES = {"slip": 1, "stick": 0, "slip back": -1}
GRIPS = {side: grip for grip, side in SIDES.items()}
PRESSES = ("load", "unload")
PHASES = 64  # room for so many

_Plain = structure(
    "_Plain",
    (c_int, "size turning at spring shear ball_t ball_n dampers most_phases most_cells"),
    (c_double, "root restitution friction compliance unit fastest slack longest reach"),
    (c_void_p, "omega c_t c_n damping"),
)
_Phase = structure("_Phase", (c_int, "side press first cells"), (c_double, "start end rate impulse_t impulse_n"))
_Phases = _Phase * PHASES
_room = Room()
_Outcome = structure("_Outcome", (c_double, "time peak rubbed"), (c_int, "phases cells"))


class Limits(NamedTuple):
    """Of a contact: terms of a series, phases and cells at most, time, s, |A| times the length of a first cell."""

    terms: int
    most_phases: float
    most_cells: float
    longest: float
    reach: float
    slack: float  # by which |F_t| may pass mu F_n, N


class Whole(NamedTuple):
    """A contact that is over: time, s, state, peak, N, what friction rubbed off and each damper took, J; its phases.

    starts: the state at the start of each phase (phases, size). lengths: of all cells, s. cells: (outputs, terms,
    cells).
    """

    time: float
    state: Array
    peak: float
    rubbed: float
    damped: list[float]
    phases: list[Phase]
    starts: Array
    lengths: Array
    cells: Array


@cache
def _functions(library: ctypes.CDLL) -> tuple[Any, Any]:
    room, run = library.cuefem_contact_room, library.cuefem_contact
    room.restype, room.argtypes = ctypes.c_ssize_t, [c_int] * 3
    run.argtypes = [c_void_p, c_int, c_int, *[c_void_p] * 8]
    return room, run


def contact(
    library: ctypes.CDLL, contact: Contact, grip: str, press: str, *, compliance: float, unit: float, limits: Limits
) -> Whole | None:
    """Run a contact from its first grip to its end; None where Python has to go through its phases.

    compliance, m/N, and unit: of the spring at the patch; zero where it has none.
    """
    room_of, run = _functions(library)
    laws, slots, dampers = contact.laws, contact.slots, len(contact.dampers)
    size, root, outputs = len(contact.z), math.sqrt(laws.stiffness), 4 + bool(compliance) + dampers
    norm_t, norm_n = math.sqrt(contact.c_t @ contact.c_t), math.sqrt(contact.c_n @ contact.c_n)
    rate = contact.fastest + root / laws.restitution * (norm_n + min(laws.friction, 2.0) * norm_t)
    rate += norm_t / unit if compliance else 0.0
    if not math.isfinite(rate):  # Python says what has no bounds
        return None
    cells = int(
        min(100 + 100 * (laws.time * rate // (100 * limits.reach)), limits.most_cells)
    )  # few lengths of an array
    if cells * outputs > 2**20:  # a nearly dead tip, followed swing by swing
        return None
    most = int(max(0, min(PHASES, limits.most_phases)))
    n, width = len(contact.omega), outputs * limits.terms
    parts, at = _room.of(
        n,
        size,
        size,
        dampers * size,
        size,
        dampers,
        cells,
        PHASES * size,
        cells * width,
        room_of(size, outputs, dampers),
    )
    omega, c_t, c_n, damping, z, damped, lengths, starts, found, _ = parts
    omega[:], c_t[:], c_n[:], z[:] = contact.omega, contact.c_t, contact.c_n, contact.z
    if dampers:
        damping[:], damped[:] = contact.dampers.ravel(), 0.0
    plain = _Plain(
        size, n, slots.swinging.start, slots["spring"], slots["shear"] if compliance else -1,
        slots["ball_t"], slots["ball_n"], dampers, most, cells,
        root, laws.restitution, laws.friction, compliance, unit, contact.fastest, limits.slack, limits.longest,
        limits.reach, *at[:4],
    )  # fmt: skip
    told, phases = _Outcome(contact.time, contact.peak, 0.0, 0, 0), _Phases()
    at_z, at_damped, at_lengths, at_starts, at_found, at_room = at[4:]
    status = run(
        byref(plain), SIDES[grip], PRESSES.index(press), at_z, byref(told), phases, at_starts, at_found, at_lengths,
        at_damped, at_room,
    )  # fmt: skip
    if status != FOUND:
        return None
    gone = [
        Phase(GRIPS[one.side], PRESSES[one.press], one.start, one.end, (one.impulse_t, one.impulse_n))
        for one in phases[: told.phases]
    ]
    starts, lengths = starts[: told.phases * size].copy().reshape(-1, size), lengths[: told.cells].copy()
    cells_of = found[: told.cells * width].copy().reshape(-1, outputs, limits.terms).transpose(1, 2, 0)
    return Whole(told.time, z.copy(), told.peak, told.rubbed, damped.tolist(), gone, starts, lengths, cells_of)
