"""The steps of the contact of a whole tip in compiled code: what `cuefem.contact.leather.Leather._leg` does."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import c_double, c_int, c_ssize_t, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.contact.kernel.structures import pointer, structure
from cuefem.contact.ringed_patch import RingForces
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.leather import Leather
    from cuefem.contact.response import Complex, Rule
    from cuefem.contact.tip_forces import Hold

ENDED, FULL, LATE, NEEDS, STUCK, TOO_DEEP, REFUSED = range(7)
EVENTS = ("touch", "compressed", "apart", "reloaded", "turned", "gripped", "slipped", "slipped back")
SIDES = {"slip": 1, "slip back": -1, "stick": 0}
HALVINGS, ROWS, MOTIONS, HEAD = 40, 4, 6, 5
# Steps whose records share an array.
STEPS = 32


_Rule = structure(
    "_Rule",
    (c_int, "power nodes points many_points terms"),
    (c_void_p, "times integral waves between values weights slopes many many_weights"),
)
_Free = structure("_Free", (c_int, "modes dampers"), (c_void_p, "rates readings drives"))
_Response = structure("_Response", (c_double, "step"), (c_void_p, "own answer last turned"))
_Law = structure(
    "_Law",
    (c_int, "force_terms give_terms"),
    (c_void_p, "force give"),
    (c_double, "restitution most steady first_ratio"),
)
_Bounds = structure(
    "_Bounds",
    (c_double, "tolerance settled wild opened past rounding"),
    (c_int, "rounds longest shortest crossing most_steps"),
)
_Hold = structure("_Hold", (c_int, "side loading grows apart"))
_Contact = structure("_Contact", (c_double, "friction size impulse dome reach clock speed"))
_Course = structure(
    "_Course",
    (c_double, "time depth angle shear leaving deepest series_step"),
    (c_double * 16, "series"),
    (c_int, "halvings steps written event needed"),
)
_Rings = structure(
    "_Rings", (c_int, "count"), (c_double, "friction first_gain"), (c_void_p, "edges force_to stiffness_to slope_to")
)
_Leg = structure(
    "_Leg", (c_void_p, "rules free responses law bounds contact course coordinates losses room rings held_by")
)


class _Functions(NamedTuple):
    respond: Any
    leg: Any
    kept: Any
    room: Any
    record: Any


@cache
def _functions(library: ctypes.CDLL) -> _Functions:
    found = _Functions(*(getattr(library, f"cuefem_leather_{name}") for name in _Functions._fields))
    found.respond.argtypes = [c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_void_p]
    found.leg.argtypes = [c_void_p, c_void_p, c_double, c_double, c_int, c_void_p]
    for sized, count in ((found.kept, 2), (found.room, 2), (found.record, 1)):
        sized.restype, sized.argtypes = c_ssize_t, [c_int] * count
    return found


class Numbers(NamedTuple):
    """Numbers of `cuefem.contact.leather` that choose steps, as `struct bounds` of leather.c has them."""

    tolerance: float
    settled: float
    wild: float
    opened: float
    past: float
    rounding: float
    rounds: int
    longest: int
    shortest: int
    crossing: int
    most_steps: int


class Taken(NamedTuple):
    """A leg: its status, or the event that ended it; the coordinates then; what it lost; its steps.

    losses: work of the force along the surface, what its spring wasted, what friction rubbed off, and what each damper
    took, J. steps: (n, record), see `Steps.read`.
    """

    status: int
    event: str
    coordinates: Complex
    losses: Array
    steps: Array


class Record(NamedTuple):
    """A step: start and length, s, part of it that was taken, halvings and power of its response; what it knows."""

    start: float
    part: float
    length: float
    halvings: int
    opens: bool
    coordinates: Complex
    forces: Array
    motion: Array


class Rules:
    """The rules of steps, as `struct rule` of leather.c has them; many: Gauss points on (-1, 1) and weights."""

    def __init__(self, rules: Sequence[Rule], many: tuple[Array, Array]) -> None:
        self._kept = list[Array]()
        self.told = (_Rule * len(rules))(*(self._of(rule, many) for rule in rules))
        self.nodes = len(rules[0].times)

    def _of(self, rule: Rule, many: tuple[Array, Array]) -> Any:
        counts = len(rule.times), rule.between.shape[1], len(many[0]), len(rule.slopes)
        parts = (rule.times, rule.integral, rule.waves, rule.between, rule.values, rule.weights, rule.slopes, *many)
        self._kept += (kept := [np.ascontiguousarray(part) for part in parts])
        return _Rule(rule.power, *counts, *map(pointer, kept))


class Steps:
    """The compiled steps of one contact; it keeps the arrays that they work on."""

    def __init__(self, library: ctypes.CDLL, leather: Leather, rules: Rules) -> None:
        self.call, self.leather, self._kept = _functions(library), leather, list[Any]()
        free, law = leather.free, leather.law
        self.modes, self.dampers, self.nodes = len(free.rates), len(leather.damping), rules.nodes
        readings = np.concatenate([free.readings, leather.damping])
        series = [np.array(terms) for terms in (law.force_terms, law.give_terms)]
        contact = leather.contact.laws
        self.rules = rules.told
        self.free = _Free(self.modes, self.dampers, *map(self._at, (free.rates, readings, free.drives)))
        self.law = _Law(
            *map(len, series), *map(self._at, series), law.restitution, law.most, law.steady or 0.0, law.first_ratio
        )
        self.contact = _Contact(
            contact.friction, leather.size, leather.impulse, leather.dome, leather.reach, contact.time, contact.speed
        )
        self.responses = (_Response * (len(rules.told) * HALVINGS))()
        self.course, self.bounds = _Course(), _Bounds()
        self.room = np.empty(self.call.room(self.modes, self.dampers))
        self.coordinates, self.losses = np.empty(2 * self.modes), np.empty(3 + self.dampers)
        self.told = _Leg(
            *(ctypes.addressof(part) for part in (self.rules, self.free, self.responses, self.law, self.bounds)),
            *(ctypes.addressof(part) for part in (self.contact, self.course)),
            *map(pointer, (self.coordinates, self.losses, self.room)),
            *self._ringed(leather),
        )

    def _ringed(self, leather: Leather) -> tuple[int, int]:
        """Where the rings of the patch stand, and what they hold; nowhere if it holds as a whole."""
        forces, self.held_by = leather.tip_forces, np.empty(0)
        if not isinstance(forces, RingForces):
            return 0, 0
        self.held_by = np.zeros_like(forces.held_by)
        parts = forces.edges, forces.force_to, forces.stiffness_to, forces.slope_to
        self.rings = _Rings(len(self.held_by), forces.friction, forces.first_gain, *map(self._at, parts))
        return ctypes.addressof(self.rings), pointer(self.held_by)

    def _at(self, array: Array | Complex) -> int:
        """Where an array's numbers stand; it is kept."""
        self._kept.append(np.ascontiguousarray(array))
        return pointer(self._kept[-1])

    def leg(self, hold: Hold, coordinates: Complex, until: float, near: float, numbers: Numbers) -> Taken:
        """Step on to the first end of a leg, or to ``until``, s; the contact's own numbers follow."""
        self.bounds.__init__(*numbers)
        held = _Hold(SIDES[hold.grip], hold.press == "load", hold.grows, hold.apart)
        course, leather = self.course, self.leather
        self.coordinates[: self.modes], self.coordinates[self.modes :] = coordinates.real, coordinates.imag
        self.losses[:] = 0.0
        self._enter(course, leather)
        record, records, status = self.call.record(self.modes), list[Array](), FULL
        while status in (FULL, NEEDS):
            if status == NEEDS:
                self._respond(course.halvings, course.needed)
            else:
                records.append(np.empty((STEPS, record)))
                course.written = 0
            status = self.call.leg(
                ctypes.addressof(self.told), ctypes.addressof(held), until, near, STEPS, pointer(records[-1])
            )
        records[-1] = records[-1][: course.written]
        self._leave(course, leather)
        found = self.coordinates[: self.modes] + 1j * self.coordinates[self.modes :]
        event = EVENTS[course.event] if status == ENDED else ""
        return Taken(status, event, found, self.losses.copy(), np.concatenate(records))

    def _respond(self, halvings: int, opens: int) -> None:
        """Make the response of a step that is needed."""
        index = opens * HALVINGS + halvings
        kept = np.empty(self.call.kept(self.modes, self.dampers))
        self._kept.append(kept)
        at = ctypes.addressof(self.responses) + index * ctypes.sizeof(_Response)
        rule = ctypes.addressof(self.rules) + opens * ctypes.sizeof(_Rule)
        step = self.contact.clock / 2**halvings
        status = self.call.respond(ctypes.addressof(self.free), rule, step, at, pointer(kept), pointer(self.room))
        if status:
            raise RuntimeError("the compiled kernel was built for other nodes of a step; install again")

    def _enter(self, course: Any, leather: Leather) -> None:
        contact = leather.contact
        course.time, (course.depth, course.angle, course.shear) = contact.time, leather.kept
        course.leaving, course.deepest = leather.leaving, leather.tip_forces.deepest
        course.series_step, course.halvings, course.steps = leather.series_step, leather.halvings, len(leather.pieces)
        if isinstance(leather.tip_forces, RingForces):
            self.held_by[:] = leather.tip_forces.held_by
        ctypes.memmove(course.series, pointer(np.ascontiguousarray(leather.series)), ctypes.sizeof(course.series))

    def _leave(self, course: Any, leather: Leather) -> None:
        if isinstance(leather.tip_forces, RingForces):
            leather.tip_forces.held_by = self.held_by.copy()
        leather.contact.time, leather.leaving = course.time, course.leaving
        leather.contact.put(depth=course.depth, angle=course.angle, shear=course.shear)
        leather.series_step, leather.halvings = course.series_step, course.halvings
        leather.series = np.array(course.series).reshape(-1, ROWS)

    def read(self, record: Array) -> Record:
        """A step's numbers from its record."""
        start, part, length, halvings, opens = record[:HEAD].tolist()
        forces = HEAD + 2 * self.modes
        motion = forces + ROWS * self.nodes
        return Record(
            start,
            part,
            length,
            int(halvings),
            bool(opens),
            record[HEAD:forces].view(complex),
            record[forces:motion].reshape(ROWS, self.nodes),
            record[motion:].reshape(MOTIONS, self.nodes),
        )
