"""The steps of a contact that is not linear in compiled code: what `cuefem.contact.stepped.Stepped._way` does.

scipy's DOP853 with scipy's tables, step by step, so that both take the same steps but for rounding.
"""

from __future__ import annotations

import ctypes
from ctypes import byref, c_double, c_int, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.integrate import DOP853

from cuefem.contact.kernel.structures import pointer, structure
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.raised import Raised
    from cuefem.contact.stepped import Hold, Stepped
    from cuefem.effects.law import TipLaw

ENDED, FULL, LATE, STUCK, REFUSED = range(5)
SIDES = {"slip": 1, "stick": 0, "slip back": -1}
TABLES = ("none", "lifted", "slides", "held")
STAGES, EXTENDED, POWERS = 12, 16, 7
# Steps whose interpolants share an array.
STEPS = 128

_Tables = structure("_Tables", (c_int, "stages extended powers"), (c_void_p, "a b e3 e5 d"))
_Stepped = structure(
    "_Stepped",
    (c_int, "size turning at first modes ball_t ball_n spin depth angle rubbed damped gone shear dampers lossy turns"),
    (c_double, "phi root_mass friction clock dome reach lever_u lever_w compliance"),
    (c_double, "unit speed force rounding relative longest_step stiffness exponent restitution"),
    (c_void_p, "omega c_t c_n damping along across rotation absolute"),
)
_Hold = structure("_Hold", (c_int, "apart side loading"), (c_double, "deepest near"))
_Raised = structure(
    "_Raised",
    (c_int, "size turning at depth rubbed damped gone height scraped tip_way ball_way dampers lossy"),
    (c_double, "friction table_friction clock speed at_rest force rounding relative longest_step"),
    (c_double, "stiffness exponent restitution"),
    (c_void_p, "omega rows gram damping absolute"),
)
_RaisedHold = structure("_RaisedHold", (c_int, "slips loading table"), (c_double, "deepest"))
_Way = structure("_Way", (c_double, "time step end"), (c_int, "written event"))


class Numbers(NamedTuple):
    """Numbers of `cuefem.contact.stepped`: of |F_t| past mu F_n; tolerances; the longest step in contact times."""

    rounding: float
    relative: float
    absolute: Array
    longest_step: float


@cache
def _functions(library: ctypes.CDLL, name: str) -> tuple[Any, Any]:
    room, run = getattr(library, f"cuefem_{name}_room"), getattr(library, f"cuefem_{name}")
    room.restype, room.argtypes = ctypes.c_ssize_t, [c_int]
    run.argtypes = [c_void_p, c_void_p, c_void_p, c_double, c_int, c_void_p, c_void_p, c_int, *[c_void_p] * 4]
    return room, run


@cache
def _tables() -> tuple[Any, list[Array]]:
    """scipy's tables as `struct tables` of stepped.c has them, and the arrays that they are in."""
    A = np.zeros((EXTENDED, EXTENDED))
    A[:STAGES, :STAGES], A[STAGES + 1 :] = DOP853.A, DOP853.A_EXTRA
    kept = [np.ascontiguousarray(part) for part in (A, DOP853.B, DOP853.E3, DOP853.E5, DOP853.D)]
    return _Tables(DOP853.n_stages, DOP853.D.shape[1], 3 + len(DOP853.D), *map(pointer, kept)), kept


class Interpolants:
    """The states over a phase that was stepped, as scipy's ``OdeSolution`` gives them; ts: in units of the clock."""

    def __init__(self, ends: Array, last: float, olds: Array, terms: Array) -> None:
        self.ends, self.olds, self.terms = ends, olds, terms
        self.ts = np.append(ends[:-1], last)

    def __call__(self, t: float | Array) -> Array:
        """States at a time, or at times (states, n)."""
        which = np.clip(np.searchsorted(self.ts, t) - 1, 0, len(self.olds) - 1)
        part = (t - self.ends[which]) / (self.ends[which + 1] - self.ends[which])
        part, terms = np.asarray(part)[..., None], self.terms[which]
        found = np.zeros_like(self.olds[which])
        for i, power in enumerate(range(POWERS - 1, -1, -1)):
            found = (found + terms[..., power, :]) * (1 - part if i % 2 else part)
        return np.asarray((found + self.olds[which]).T)


class Walked(NamedTuple):
    """What ended a phase, by its number, or -1; its time, s; the state then; interpolants."""

    event: int
    end: float
    z: Array
    solution: Interpolants


class Steps:
    """The compiled steps of one contact; it keeps the arrays that they work on.

    name: of the kind of motion in C. told: its numbers, which point to the arrays ``kept``. clock, s.
    """

    def __init__(self, library: ctypes.CDLL, name: str, told: Any, kept: list[Array], *, clock: float) -> None:
        room_of, self.run = _functions(library, name)
        self.told, self._kept, self.size, self.clock = told, kept, told.size, clock
        self.room = np.empty(room_of(self.size))

    def _held(self, hold: Hold | None, deepest: float, near: float) -> Any:
        side, loading = (0, False) if hold is None else (SIDES[hold.grip], hold.press == "load")
        return _Hold(hold is None, side, loading, deepest, near)

    def _walk(
        self, held: Any, start: float, until: float, z: Array, *, ends: bool
    ) -> tuple[int, Any, list[tuple[Array, Array, Array]]]:
        """(status, where it ended, times, states and interpolants of the steps); z moves on."""
        way, walked, status = _Way(start, 0.0, 0.0, 0, -1), list[tuple[Array, Array, Array]](), FULL
        tables, _ = _tables()
        while status == FULL:
            most = STEPS if ends else 1
            own = np.empty(most + 1), np.empty((most, self.size)), np.empty((most, POWERS, self.size))
            status = self.run(
                byref(self.told), byref(held), byref(tables), until, ends, pointer(z), byref(way), most,
                *map(pointer, own), pointer(self.room),
            )  # fmt: skip
            walked.append((own[0][: way.written + 1], own[1][: way.written], own[2][: way.written]))
        return status, way, walked

    def way(
        self, hold: Hold | None, deepest: float, near: float, start: float, until: float, z: Array
    ) -> Walked | None:
        """The way to the first end, or up to ``until``, s; None where the steps get stuck.

        hold: None where ball and tip are apart, to touch where they would overlap by ``near``, m.
        """
        held, z = self._held(hold, deepest, near), z.copy()
        status, way, walked = self._walk(held, start / self.clock, until / self.clock, z, ends=True)
        if status not in (ENDED, LATE):
            return None
        if status == ENDED:  # the interpolant that found the end is of a lower order than the steps
            status, _, _ = self._walk(held, way.time, way.end, z, ends=False)
            if status != LATE:
                return None
        ends = np.concatenate([*(times[:-1] for times, _, _ in walked), walked[-1][0][-1:]])
        olds, terms = (np.concatenate([part[i] for part in walked]) for i in (1, 2))
        return Walked(way.event, way.end * self.clock, z, Interpolants(ends, way.end, olds, terms))


class RaisedSteps(Steps):
    """Those of a raised cue's, which has no flight."""

    def _held(self, hold: Hold | None, deepest: float, near: float) -> Any:
        assert hold is not None
        return _RaisedHold(hold.grip == "slip", hold.press == "load", TABLES.index(hold.table), deepest)


def steps_of(library: ctypes.CDLL, stepped: Stepped, law: TipLaw, numbers: Numbers) -> Steps:
    """The steps of a contact with this power law; what it turns on is domes."""
    contact, turning, slots = stepped.contact, stepped.turning, stepped.contact.slots
    laws, tip = contact.laws, contact.tip
    dome = 0.0 if turning is None else turning.terms.dome_radius
    lever = (0.0, 0.0) if turning is None else turning.terms.lever(laws.phi)
    compliance, unit = stepped.patch.spring
    parts = contact.omega, contact.c_t, contact.c_n, contact.dampers, *tip.amplitude.T, tip.rotation, numbers.absolute
    kept = [np.ascontiguousarray(part) for part in parts]
    places = slots.of("ball_t", "ball_n", "spin", "depth", "angle", "rubbed", "damped", "gone")
    told = _Stepped(
        len(contact.z), len(contact.omega), slots.swinging.start, slots.velocities.start, len(tip.omega), *places,
        slots["shear"] if compliance else -1, len(contact.dampers), contact.lossy, turning is not None,
        laws.phi, laws.ball_mass**-0.5, laws.friction, stepped.clock, dome,
        1.0 if turning is None else turning.reach, *lever, compliance, unit, laws.speed, contact.scale,
        numbers.rounding, numbers.relative, numbers.longest_step, law.stiffness, law.exponent, law.restitution,
        *map(pointer, kept),
    )  # fmt: skip
    return Steps(library, "stepped", told, kept, clock=stepped.clock)


def raised_steps_of(
    library: ctypes.CDLL, raised: Raised, law: TipLaw, numbers: Numbers, *, at_rest: float
) -> RaisedSteps:
    """The steps of a raised cue's contact; at_rest: a speed, m/s, below which a point keeps its direction."""
    contact, slots = raised.contact, raised.contact.slots
    parts = contact.omega, raised.rows, raised.gram, contact.dampers, numbers.absolute
    kept = [np.ascontiguousarray(part) for part in parts]
    places = slots.of("depth", "rubbed", "damped", "gone", "height", "scraped", "tip_way", "ball_way")
    told = _Raised(
        len(contact.z), len(contact.omega), slots.swinging.start, *places, len(contact.dampers), contact.lossy,
        contact.laws.friction, raised.table.friction, raised.clock, contact.laws.speed, at_rest, contact.scale,
        numbers.rounding, numbers.relative, numbers.longest_step, law.stiffness, law.exponent, law.restitution,
        *map(pointer, kept),
    )  # fmt: skip
    return RaisedSteps(library, "raised", told, kept, clock=raised.clock)
