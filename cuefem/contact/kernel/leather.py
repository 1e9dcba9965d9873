"""The contact of a whole tip in compiled code: the phases and the steps of `cuefem.contact.leather.Leather`."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Iterator, Sequence
from ctypes import c_double, c_int, c_ssize_t, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.contact.kernel.structures import pointer, structure
from cuefem.contact.ringed_patch import RingForces
from cuefem.contact.state import Grip, Phase, Press
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.leather import Leather
    from cuefem.contact.response import Complex, FreeMotion, Rule
    from cuefem.contact.tip_forces import Hold

ENDED, FULL, LATE, NEEDS, STUCK, TOO_DEEP, REFUSED, CROWDED = range(8)
EVENTS = ("touch", "compressed", "apart", "reloaded", "turned", "gripped", "slipped", "slipped back")
SIDES: dict[Grip, int] = {"slip": 1, "slip back": -1, "stick": 0}
GRIPS: dict[int, Grip] = {side: grip for grip, side in SIDES.items()}
HALVINGS, ROWS, WAYS, TAYLOR, MOTIONS, HEAD = 40, 4, 3, 4, 6, 5
# Rings that the kernel has room for (rings.h).
MOST_RINGS = 256
# Steps whose records share an array, and phases.
STEPS, PHASES = 32, 64


_Rule = structure(
    "_Rule",
    (c_int, "power nodes points many_points few_points terms"),
    (c_void_p, "times integral waves between values weights slopes many many_weights few few_weights"),
)
_Free = structure("_Free", (c_int, "modes dampers"), (c_double, "fastest"), (c_void_p, "rates readings drives"))
_Response = structure("_Response", (c_double, "step"), (c_void_p, "answer last turned"))
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
_Touch = structure("_Touch", (c_double * (ROWS * WAYS), "ways"), (c_double * ROWS, "ball"), (c_int * ROWS, "at"))
_Course = structure(
    "_Course",
    (c_double, "time depth angle shear leaving deepest series_step"),
    (c_double * (ROWS * TAYLOR), "series"),
    (c_int, "halvings steps written event needed"),
)
_Rings = structure(
    "_Rings", (c_int, "count"), (c_double, "friction first_gain"), (c_void_p, "edges force_to stiffness_to slope_to")
)
_Leg = structure(
    "_Leg", (c_void_p, "rules free responses law bounds contact course coordinates losses room rings held_by touch")
)
_Blow = structure(
    "_Blow",
    (_Hold, "hold"),
    (c_int, "stage phases first"),
    (c_double, "before start impulse_t impulse_n rubbed sheared peak"),
)
_Phase = structure("_Phase", (c_int, "side loading first steps"), (c_double, "start end impulse_t impulse_n"))


class _Functions(NamedTuple):
    respond: Any
    leg: Any
    blow: Any
    kept: Any
    room: Any
    record: Any


@cache
def _functions(library: ctypes.CDLL) -> _Functions:
    found = _Functions(*(getattr(library, f"cuefem_leather_{name}") for name in _Functions._fields))
    found.respond.argtypes = [c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_void_p]
    found.leg.argtypes = [c_void_p, c_void_p, c_double, c_double, c_int, c_void_p]
    found.blow.argtypes = [c_void_p, c_void_p, c_double, c_int, c_void_p, c_int, c_void_p]
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
    """A flight: its status, or the event that ended it; the coordinates then; what dampers took, J; its steps.

    steps: (n, record), see `Steps.read`.
    """

    status: int
    event: str
    coordinates: Complex
    damped: list[float]
    steps: Array


class Blow(NamedTuple):
    """A contact from a touch on: its status, how it held last, the coordinates then; what friction rubbed off, what the
    spring along the surface lost, and what each damper took, J; the peak, N, or zero; its phases, each with how many
    steps it took; and all steps.
    """

    status: int
    grip: Grip
    press: Press
    coordinates: Complex
    rubbed: float
    sheared: float
    damped: list[float]
    peak: float
    phases: list[tuple[Phase, int]]
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
    """The rules of steps, as `struct rule` of leather.c has them; many, few: Gauss points on (-1, 1) and weights."""

    def __init__(self, rules: Sequence[Rule], many: tuple[Array, Array], few: tuple[Array, Array]) -> None:
        self._kept = list[Array]()
        self.told = (_Rule * len(rules))(*(self._of(rule, many, few) for rule in rules))
        self.nodes = len(rules[0].times)

    def _of(self, rule: Rule, many: tuple[Array, Array], few: tuple[Array, Array]) -> Any:
        counts = len(rule.times), rule.between.shape[1], len(many[0]), len(few[0]), len(rule.slopes)
        parts = (rule.times, rule.integral, rule.waves, rule.between, rule.values, rule.weights, rule.slopes)
        self._kept += (kept := [np.ascontiguousarray(part) for part in (*parts, *many, *few)])
        return _Rule(rule.power, *counts, *map(pointer, kept))


class Shared:
    """What strikes with a cue share: how it moves freely, and the responses of steps that were asked for so far.

    places: of the coordinates that are the ball's velocities along t and n, and its spin's.
    """

    def __init__(
        self,
        library: ctypes.CDLL,
        free: FreeMotion,
        ways: Array,
        damping: Complex,
        places: Sequence[int],
        rules: Rules,
    ) -> None:
        self.call, self.rules, self.places = _functions(library), rules, places
        self.modes, self.dampers = len(free.rates), len(damping)
        readings, drives = np.concatenate([ways @ free.vectors, damping]), free.onto @ ways.T
        self._kept = [np.ascontiguousarray(part) for part in (free.rates, readings, drives)]
        self.free = _Free(self.modes, self.dampers, np.abs(free.rates).max(), *map(pointer, self._kept))
        self._known: dict[tuple[int, int], tuple[Any, Array]] = {}

    def known(self, clock: int) -> Iterator[tuple[int, int, Any]]:
        """(halvings of 2^``clock`` s, rule, response) of the steps that are known."""
        for (halvings, opens), (found, _) in list(self._known.items()):
            if 0 <= halvings + clock < HALVINGS:
                yield halvings + clock, opens, found

    def response(self, halvings: int, opens: int) -> Any:
        """Of a step of a second so often halved, by one of the rules."""
        if (halvings, opens) not in self._known:
            step = 2.0**-halvings
            kept = np.empty(self.call.kept(self.modes, self.dampers))
            room = np.empty(self.call.room(self.modes, self.dampers))
            rule, found = ctypes.addressof(self.rules.told) + opens * ctypes.sizeof(_Rule), _Response()
            status = self.call.respond(
                ctypes.addressof(self.free), rule, step, ctypes.addressof(found), pointer(kept), pointer(room)
            )
            if status:
                raise RuntimeError("the compiled kernel was built for other nodes of a step; install again")
            self._known.setdefault((halvings, opens), (found, kept))  # the first of two threads
        return self._known[halvings, opens][0]


class Steps:
    """The compiled steps of one contact; it keeps the arrays that they work on."""

    def __init__(self, shared: Shared, leather: Leather, numbers: Numbers) -> None:
        self.shared, self.leather, self._kept = shared, leather, list[Any]()
        self.call, self.modes, self.nodes = shared.call, shared.modes, shared.rules.nodes
        law, laws = leather.law, leather.contact.laws
        self.clock = round(math.log2(leather.clock))
        self.series = [(c_double * len(terms))(*terms) for terms in (law.force_terms, law.give_terms)]
        self.law = _Law(
            *map(len, self.series),
            *map(ctypes.addressof, self.series),
            law.restitution,
            law.most,
            law.steady or 0.0,
            law.first_ratio,
        )
        self.contact = _Contact(
            laws.friction, leather.size, leather.impulse, leather.dome, leather.reach, leather.clock, laws.speed
        )
        ball = (laws.ball_mass**-0.5, laws.ball_mass**-0.5, (laws.inertia * laws.ball_mass) ** -0.5, 0.0)
        self.touch = _Touch(tuple(leather.mixing.ravel().tolist()), ball, (*shared.places, 0))
        self.responses = (_Response * (len(shared.rules.told) * HALVINGS))()
        for halvings, opens, found in shared.known(self.clock):
            self.responses[opens * HALVINGS + halvings] = found
        self.course, self.bounds = _Course(), _Bounds(*numbers)
        self.room = np.empty(self.call.room(self.modes, shared.dampers))
        self.coordinates, self.losses = np.empty(2 * self.modes), np.zeros(3 + shared.dampers)
        self.told = _Leg(
            *(ctypes.addressof(part) for part in (shared.rules.told, shared.free, self.responses, self.law)),
            *(ctypes.addressof(part) for part in (self.bounds, self.contact, self.course)),
            *map(pointer, (self.coordinates, self.losses, self.room)),
            *self._ringed(leather),
            ctypes.addressof(self.touch),
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

    def flight(self, hold: Hold, coordinates: Complex, until: float, near: float) -> Taken:
        """Step on while ball and tip are apart, to ``until``, s, or where they overlap by ``near``, m."""
        held = _Hold(SIDES[hold.grip], hold.press == "load", hold.grows, hold.apart)
        self._enter(coordinates)
        status, steps = self._called(
            lambda records: self.call.leg(
                ctypes.addressof(self.told), ctypes.addressof(held), until, near, STEPS, pointer(records)
            )
        )
        self._leave()
        event = EVENTS[self.course.event] if status == ENDED else ""
        return Taken(status, event, self._coordinates(), self.losses[3:].tolist(), steps)

    def blow(self, grip: Grip, press: Press, coordinates: Complex, until: float, most: float) -> Blow:
        """Go through all phases of a contact up to ``until``, s: ``most`` of them, and at most `PHASES` more."""
        blow, phases = _Blow(_Hold(SIDES[grip], press == "load", self.leather.grows, 0)), (_Phase * PHASES)()
        gone = list[tuple[Phase, int]]()
        told, at = ctypes.addressof(self.told), (ctypes.addressof(blow), ctypes.addressof(phases))
        self._enter(coordinates)

        def call(records: Array) -> int:
            status = CROWDED
            while status == CROWDED and len(gone) <= most:
                status = self.call.blow(told, at[0], until, STEPS, pointer(records), PHASES, at[1])
                gone.extend((_phase_of(one), one.steps) for one in phases[: blow.phases])
                blow.phases = 0
            return status

        status, steps = self._called(call)
        self._leave()
        self.leather.grows = bool(blow.hold.grows)
        self.leather.tip_forces.deepest = self.course.deepest
        return Blow(
            status,
            GRIPS[blow.hold.side],
            "load" if blow.hold.loading else "unload",
            self._coordinates(),
            blow.rubbed,
            blow.sheared,
            self.losses[3:].tolist(),
            blow.peak,
            gone,
            steps,
        )

    def _called(self, call: Callable[[Array], int]) -> tuple[int, Array]:
        """Call on until nothing is missing: what came of it, and the records of all steps."""
        record, records, status, course = self.call.record(self.modes), list[Array](), FULL, self.course
        while status in (FULL, NEEDS):
            if status == NEEDS:
                found = self.shared.response(course.halvings - self.clock, course.needed)
                self.responses[course.needed * HALVINGS + course.halvings] = found
            else:
                records.append(np.empty((STEPS, record)))
                course.written = 0
            status = call(records[-1])
        records[-1] = records[-1][: course.written]
        return status, records[0] if len(records) == 1 else np.concatenate(records)

    def _coordinates(self) -> Complex:
        return self.coordinates[: self.modes] + 1j * self.coordinates[self.modes :]

    def _enter(self, coordinates: Complex) -> None:
        self.coordinates[: self.modes], self.coordinates[self.modes :] = coordinates.real, coordinates.imag
        self.losses[:] = 0.0
        course, leather, contact = self.course, self.leather, self.leather.contact
        course.time, (course.depth, course.angle, course.shear) = contact.time, leather.kept
        course.leaving, course.deepest = leather.leaving, leather.tip_forces.deepest
        course.series_step, course.halvings, course.steps = leather.series_step, leather.halvings, leather.taken
        if isinstance(leather.tip_forces, RingForces):
            self.held_by[:] = leather.tip_forces.held_by
        ctypes.memmove(course.series, pointer(np.ascontiguousarray(leather.series)), ctypes.sizeof(course.series))

    def _leave(self) -> None:
        course, leather = self.course, self.leather
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


def _phase_of(one: Any) -> Phase:
    """A phase as the kernel wrote it down."""
    press: Press = "load" if one.loading else "unload"
    return Phase(GRIPS[one.side], press, one.start, one.end, (one.impulse_t, one.impulse_n))
