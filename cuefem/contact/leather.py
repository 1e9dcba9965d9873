"""The contact of a whole tip, given by its geometry and its leather (the effect LeatherTip); forces: `TipForces`.

The normal turns as the contact rolls over ball and dome, as in `cuefem.contact.nonlinear`. Between the forces every
mode turns exactly (`cuefem.contact.response`). What is left to find are the forces at the nodes of a step. They are
iterated: forces move the ball and the tip, which are pressed together and sheared, which makes forces. That converges
faster than geometrically, because a force moves things only with the square of time. A step is halved until the last
terms of its forces' series are below `TipForces.tolerance`, and ends where the phase does.
"""

from __future__ import annotations

import ctypes
import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.flow import first_fall
from cuefem.contact.history import MarchedHistory
from cuefem.contact.kernel import leather as compiled
from cuefem.contact.kernel import library
from cuefem.contact.marched import Marched, Motion, Piece
from cuefem.contact.phases import ROUNDING, Step, Stretch, endless, next_phase
from cuefem.contact.response import (
    EVEN,
    FEW,
    FEW_WEIGHTS,
    MANY,
    MANY_WEIGHTS,
    NODES,
    OPENING,
    TAYLOR,
    Complex,
    Response,
)
from cuefem.contact.ringed_patch import RingForces
from cuefem.contact.state import APART, SIDE, Grip, Laws, Press
from cuefem.contact.stretches import free_course
from cuefem.contact.tip_forces import Hold, TipForces
from cuefem.contact.turns import Turns, mixing
from cuefem.cue import Array
from cuefem.effects.leather_law import LeatherLaw
from cuefem.effects.terms import ContactTerms
from cuefem.quantity import scalar
from cuefem.scene import Scene

# Where the iteration of a step has settled, of the force's size, in so many rounds at most.
SETTLED, ROUNDS = 1e-9, 14
# An iteration whose forces run away by this, squared and in units of the force's size, does not settle any more.
WILD = 1e6
# A step is the contact's time over a power of two: the longest, the first and the shortest.
LONGEST, FIRST, SHORTEST = 4, 5, 30
# A step that goes past the parting is this short.
CROSSING = 9
# Steps that a contact may take before it is given up: some ten seconds.
MOST_STEPS = 20_000
# A tip that gives back less than this part of the speed presses on past its peak, and rings.
LEAST_RESTITUTION = 0.1
# A phase that starts past an end by this part of its size is over at once.
PAST = 1e-10
# The patch has just opened where the compression is below this part of the law's greatest.
OPENED = 1e-6
RULES = compiled.Rules((EVEN, OPENING), (MANY, MANY_WEIGHTS), (FEW, FEW_WEIGHTS))
_LAST = np.eye(NODES)[-1]
_ACROSS, _SPIN, _ROTATION = slice(0, 2 * NODES), slice(2 * NODES, 3 * NODES), slice(3 * NODES, 4 * NODES)


def whole_tip_contact(
    scene: Scene, tip: TipModes, laws: Laws, terms: ContactTerms, turns: Turns | None = None
) -> Leather:
    """The contact of a scene with a whole tip; ValueError for one that gives next to nothing back.

    turns: of the cue, whose modes ``tip`` are, at the place of the contact; if other strikes share them.
    """
    assert terms.tip is not None
    if laws.restitution < LEAST_RESTITUTION:
        raise ValueError(
            f"Tip.restitution must be in [{LEAST_RESTITUTION}, 1] beside LeatherTip; got {laws.restitution}: leather "
            "that gives back less rings on the ball while it is unloaded, which is not computed (cue tips: 0.7 to 0.85)"
        )
    radius = scalar("Ball.radius", scene.ball.radius)
    law = terms.tip.law(radius, abs(scalar("Stroke.offset", scene.stroke.offset)), laws.restitution)
    return Leather(tip, laws, law=law, radius=radius, terms=terms, turns=turns)


class Leather:
    """A kind of contact: a tip of leather as its geometry makes it, stepped with the exact turns of all modes.

    Slots: "spin", the ball's turning; "depth", the tip's compression, m; "angle" that the contact has turned through;
    "shear", the force F_t, N. grows: whether the patch does. sheared: energy that the spring along the surface lost, J.
    """

    haste = 1.0

    def __init__(
        self,
        tip: TipModes,
        laws: Laws,
        *,
        law: LeatherLaw,
        radius: float,
        terms: ContactTerms,
        turns: Turns | None = None,
    ) -> None:
        assert terms.tip is not None
        # the tip modes are those of the place of the touch, which the lever takes off that of the modes that are shared
        lever = (0.0, 0.0) if turns is None else terms.lever(laws.phi)
        turns = turns or Turns(tip)
        contact = self.contact = turns.contact(tip, laws, ("spin", "depth", "angle", "shear"))
        self.law = law
        self.tip_forces = (RingForces if terms.tip.partial_slip else TipForces)(law, laws.friction)
        self.terms, self.dome = terms, terms.tip.rolling_radius(laws.phi)
        self.reach = radius + self.dome if terms.turns else math.inf
        self.grows, self.sheared, self.longest = True, 0.0, contact.patience
        # steps have the lengths that those at other speeds have, whose contacts take longer or shorter
        self.clock = 2.0 ** round(math.log2(laws.time))
        self.free = turns.free(contact, self._rows())
        self.mixing = mixing(laws.phi, lever)
        self.impulse = laws.speed * laws.ball_mass  # about that of the blow, N s,
        self.size = self.impulse / laws.time  # and its force, N
        self.pieces: list[Piece] = []
        self.marches: list[Marched] = []
        self.records: list[tuple[float, Array]] = []  # of phases and flights: start, s, and steps
        self.responses: dict[tuple[int, bool], Response] = {}
        self.halvings = FIRST
        self.leaving = 0.0  # v_n at the end of the last step, m/s
        # the forces on the rows, by Taylor's series at the end of the last step in units of its length; or by their
        # last values alone
        self.series, self.series_step = np.zeros((TAYLOR, 4)), 0.0
        # levers are functions, and Python's; so are more rings than the kernel has room for
        rings = len(self.tip_forces.held_by) if isinstance(self.tip_forces, RingForces) else 0
        found = None if terms.levers or rings > compiled.MOST_RINGS else library()
        self.steps = None if found is None else compiled.Steps(self._shared(found, turns), self, self._numbers)
        self.kernel = "python" if self.steps is None else "c"

    def _shared(self, found: ctypes.CDLL, turns: Turns) -> compiled.Shared:
        """What the compiled kernel keeps of the cue."""
        if turns.compiled is None:
            places = [self.free.place(slot) for slot in self.contact.slots.of("ball_t", "ball_n", "spin")]
            turns.compiled = compiled.Shared(found, self.free, turns.ways(self.contact), self.damping, places, RULES)
        return turns.compiled

    @property
    def _numbers(self) -> compiled.Numbers:
        tolerance = self.tip_forces.tolerance
        return compiled.Numbers(
            tolerance, SETTLED, WILD, OPENED, PAST, ROUNDING, ROUNDS, LONGEST, SHORTEST, CROSSING, MOST_STEPS
        )

    @cached_property
    def damping(self) -> Complex:
        """What reads the dampers from the coordinates."""
        return np.asarray(self.contact.dampers @ self.free.vectors)

    @property
    def taken(self) -> int:
        """How many steps."""
        return len(self.pieces) + sum(len(records) for _, records in self.records)

    def _rows(self) -> Array:
        """The velocities that forces act on: ball less tip along (t, n) of the first touch, spin, the tip's turning."""
        contact, slots = self.contact, self.contact.slots
        rows = np.zeros((4, len(contact.z)))
        rows[0], rows[1] = contact.c_t, contact.c_n
        rows[0, slots["spin"]], rows[2, slots["spin"]] = 0.0, contact.c_t[slots["spin"]]
        rows[3, slots.velocities] = -contact.tip.rotation
        return rows

    def _lever(self, angle: Array, turn: Array) -> Array:
        """How far the contact's lever has moved, t + i n, m; turn: exp(-i angle)."""
        moved = self.dome * (turn - 1)
        for lever in self.terms.levers:
            phi = self.contact.laws.phi
            u, w = (np.array([lever(phi + float(each)) for each in angle]) - lever(phi)).T
            moved = moved + (w + 1j * u) * np.exp(-1j * (phi + angle))
        return np.asarray(moved)

    # What a step is

    def _solved(self, hold: Hold, coordinates: Complex, response: Response) -> tuple[Array, Motion] | None:
        """Forces on the rows at the nodes of a step, and what moves there; None if the iteration does not settle.

        t + i n stands for a vector; seen from the contact it turns by exp(-i angle).
        """
        own, integral, answer = (response.own @ coordinates).real, response.integral, response.answer
        depth_0, angle_0, held = self.kept
        loads, most = self._guess(response), (SETTLED * self.size) ** 2
        fixed, before = loads[_ACROSS].view(complex), np.zeros(NODES, complex)
        angle = np.full(NODES, angle_0)
        turn = np.exp(-1j * angle)
        lever = self._lever(angle, turn)
        for _ in range(ROUNDS):
            y = answer @ loads
            y += own
            v = y[_ACROSS].view(complex) * turn + lever * y[_ROTATION]
            v_t, v_n = v.real + y[_SPIN], v.imag
            depth = depth_0 - integral @ v_n
            if self.reach < math.inf:
                angle = angle_0 - integral @ (v.real + self.dome * y[_ROTATION]) / self.reach
                turn = np.exp(-1j * angle)
                lever = self._lever(angle, turn)
            if hold.apart:  # nothing acts; only the angle is to settle
                loads, most, force = np.zeros(4 * NODES), SETTLED**2, angle + 0j
            else:
                F_t, F_n = self.tip_forces.at(hold, held, v_t, depth, integral)
                force = F_t + 1j * F_n
                np.multiply(force, turn.conj(), out=fixed)
                loads[_SPIN], loads[_ROTATION] = F_t, (force * lever.conj()).real
            off = (force - before).view(float)
            if off @ off > WILD * self.size**2:
                return None
            if off @ off <= most:
                force = force * (not hold.apart)
                return loads, Motion(v_t, v_n, force.real, force.imag, depth, angle)
            before = force
        return None

    def _guess(self, response: Response) -> Array:
        """What the forces of a step may be, from those of the step before."""
        if self.series_step:
            times = response.rule.times * (response.step / self.series_step)
            values = times[:, None] ** np.arange(TAYLOR) @ self.series
        else:
            values = np.broadcast_to(self.series[0], (NODES, 4))
        return np.concatenate([values[:, :2].ravel(), values[:, 2], values[:, 3]])

    @property
    def kept(self) -> list[float]:
        """Compression, m, angle, and force of the spring along the surface, N: the slots that are no coordinates."""
        found: list[float] = self.contact.z[self.contact.slots.of("depth", "angle", "shear")].tolist()
        return found

    def _response(self, halvings: int, opens: bool) -> Response:
        key = halvings, opens
        if key not in self.responses:
            self.responses[key] = Response.of(self.free, self._length(halvings), OPENING if opens else EVEN)
        return self.responses[key]

    def _length(self, halvings: int) -> float:
        """Of a step, s."""
        return self.clock / 2**halvings

    def _step(self, hold: Hold, coordinates: Complex) -> Piece:
        """The longest step that holds the tolerance."""
        opens = self._opens(hold)
        self._shorten(hold)
        while self.halvings <= SHORTEST:
            key = self.halvings, opens
            response = self._response(*key)
            found = self._solved(hold, coordinates, response)
            if found is None:
                self.halvings += 2
                continue
            loads, motion = found
            forces = np.concatenate([loads[_ACROSS].reshape(NODES, 2).T, loads[2 * NODES :].reshape(2, NODES)])
            last = float(np.abs(response.rule.waves[-2:] @ forces[:3].T).max())
            error = last * response.step / (self.tip_forces.tolerance * self.impulse)
            if error > 1:
                self.halvings += 2 if error > 1e3 else 1
                continue
            if error < 1e-3 and self.halvings > LONGEST:
                self.halvings -= 1
            slots = self.contact.slots.of("depth", "angle")
            return Piece(
                self.contact.time,
                1.0,
                response.step,
                response.rule,
                key,
                self._response,
                coordinates,
                forces,
                motion,
                slots,
            )
        raise self._stuck(hold)

    def _shorten(self, hold: Hold) -> None:
        """No step past the parting, where forces fall with a root of time, but for the last."""
        if hold.apart or hold.press == "load" or hold.grows or self.leaving <= 0:
            return
        depth = float(self.contact.z[self.contact.slots["depth"]])
        left = (depth - self.law.rest(self.tip_forces.deepest)) / self.leaving / self.clock
        if left < 2.0**-LONGEST:
            least = CROSSING if left < 2.0**-CROSSING else math.ceil(-math.log2(0.85 * left))
            self.halvings = max(self.halvings, least)

    def _opens(self, hold: Hold) -> bool:
        """Whether the patch is but opening, so that forces grow with a power of the root of time."""
        depth = self.contact.z[self.contact.slots.of("depth")]
        virtual = float(self.tip_forces.virtual(hold.press, depth)[0])
        return not hold.apart and hold.grows and virtual < OPENED * self.law.most

    # What ends a leg: a part of a phase in which the patch only grows, or only shrinks

    def _ends(self, hold: Hold, motion: Motion, near: float) -> dict[str, Array]:
        """What ends a leg, by name: values at the nodes, of the order of 1, that fall through zero there."""
        laws, deepest = self.contact.laws, self.tip_forces.deepest
        mu, speed, depth, rest = laws.friction, laws.speed, laws.speed * self.clock, self.law.rest(deepest)
        if hold.apart:
            return {"touch": (rest + near - motion.depth) / depth}
        ends: dict[str, Array] = {}
        if hold.press == "load":
            ends["compressed"] = -motion.v_n / speed
        else:
            ends["apart"] = (motion.depth - rest) / depth
            ends["reloaded"] = (deepest - motion.depth) / depth
            ends["turned"] = motion.v_n * (-1.0 if hold.grows else 1.0) / speed
        if hold.grip != "stick":
            ends["gripped"] = -SIDE[hold.grip] * self.tip_forces.slides(hold, motion) / speed
        elif math.isfinite(mu):
            for name, side in (("slipped", 1.0), ("slipped back", -1.0)):
                ends[name] = (mu * motion.F_n - side * motion.F_t) / self.size + ROUNDING
        return ends

    def _crossing(self, piece: Piece, ends: dict[str, Array]) -> tuple[str, float] | None:
        """The first end in a step, and the part of the step at which it is."""
        rule, first, until = piece.rule, None, math.inf
        if np.min(list(ends.values())) >= -PAST:
            return None
        for name, values in ends.items():
            past = np.flatnonzero((values < -PAST) & (rule.times <= until))
            if len(past) == 0:
                continue
            i = int(past[0])
            at = first_fall(rule.function(values), float(rule.times[i - 1]), float(rule.times[i])) if i else 0.0
            if first is None or at < first[1]:
                first = name, at
            if name == "apart":  # behind it the others mean nothing
                until = at
        return first

    def _leg(self, hold: Hold, coordinates: Complex, until: float, near: float = 0.0) -> tuple[str, Complex]:
        """Steps up to the first end of a leg, or to ``until``, s, and what was lost in them."""
        before = self._stored(hold)
        first, event = len(self.pieces), ""
        while not event and self.contact.time < until:
            if len(self.pieces) > MOST_STEPS:
                raise self._stuck(hold)
            piece = self._step(hold, coordinates)
            event, part = self._crossing(piece, self._ends(hold, piece.motion, near)) or ("", 1.0)
            if part > 0:
                coordinates = self._take(replace(piece, part=part), hold)
        if len(self.pieces) > first:
            self._lose(hold, self._losses(hold, self.pieces[first:]), before)
        return event or "late", coordinates

    def _compiled_blow(self, steps: compiled.Steps, grip: Grip, press: Press, most: float) -> None:
        """All phases from a touch on in the compiled kernel, as `run` goes through them; most: so many."""
        contact = self.contact
        found = steps.blow(grip, press, self.free.onto @ contact.z, self.longest, most)
        self._settle(found.coordinates)
        contact.peak = found.peak or contact.peak
        contact.friction_loss += found.rubbed
        self.sheared += found.sheared
        self._damp(found.damped)
        first = 0
        for phase, count in found.phases:
            contact.phases.append(phase)
            self.records.append((phase.start, found.steps[first : first + count]))
            first += count
        if first < len(found.steps):  # of a phase that did not end
            self.records.append((contact.time, found.steps[first:]))
        if found.status in (compiled.LATE, compiled.CROWDED):
            raise endless(self, found.grip, found.press)
        self._check(found.status, Hold(found.grip, found.press, self.grows))

    def _check(self, status: int, hold: Hold) -> None:
        if status == compiled.TOO_DEEP:
            raise self.law.too_deep(self.kept[0])
        if status not in (compiled.ENDED, compiled.LATE):
            raise self._stuck(hold)

    def _piece(self, steps: compiled.Steps, numbers: Array) -> Piece:
        """A step that the compiled kernel took."""
        record, slots = steps.read(numbers), self.contact.slots.of("depth", "angle")
        rule, key = OPENING if record.opens else EVEN, (record.halvings, record.opens)
        moved = Motion(*record.motion)
        start, part, length, coordinates, forces = (
            record.start, record.part, record.length, record.coordinates, record.forces,
        )  # fmt: skip
        return Piece(start, part, length, rule, key, self._response, coordinates, forces, moved, slots)

    def _marches(self) -> list[Marched]:
        """The phases and flights so far."""
        steps = self.steps
        if steps is None:
            return self.marches
        return [Marched(start, tuple(self._piece(steps, one) for one in records)) for start, records in self.records]

    def _take(self, piece: Piece, hold: Hold) -> Complex:
        """Go to the end of a piece; the coordinates there."""
        response, motion, rule = piece.response, piece.motion, piece.response.rule
        whole = piece.part == 1.0
        if whole:
            coordinates, values = response.coordinates(piece.coordinates, piece.forces), _LAST
        else:
            coordinates = self.free.shift(piece.coordinates, response.step, rule, piece.forces, piece.part)
            values = rule.polynomials(piece.part)
        depth, angle, self.leaving = (values @ part for part in (motion.depth, motion.angle, motion.v_n))
        held = 0.0 if hold.apart else self.tip_forces.go(hold, piece)
        if depth > self.law.most:
            raise self.law.too_deep(float(depth))
        self.contact.time = piece.end
        self.contact.put(depth=float(depth), angle=float(angle), shear=held)
        if hold.grip != "stick":
            self.contact.put(shear=float(self.force(hold.grip, hold.press)[0]))
        self.series[0], self.series_step = piece.forces @ values, 0.0
        if whole and rule is EVEN:
            self.series, self.series_step = rule.slopes @ piece.forces.T, response.step
        self.pieces.append(piece)
        return coordinates

    def _losses(self, hold: Hold, pieces: list[Piece]) -> Array:
        """Integrals over a leg, J: the work of F_t, what its spring wasted, what was rubbed off, and each damper's."""
        found = np.zeros(3 + len(self.damping))
        for piece in pieces if len(self.damping) else []:
            nodes = piece.response.all_coordinates(piece.coordinates, piece.forces)
            found[3:] += (self.damping @ nodes).real ** 2 @ piece.sums(piece.part)
        if hold.apart:
            return found
        motion = Motion(*(np.concatenate(parts) for parts in zip(*(piece.motion for piece in pieces), strict=True)))
        sums = np.concatenate([piece.sums(piece.part) for piece in pieces])
        found[0] = sums @ (motion.F_t * motion.v_t)
        if hold.grip != "stick" or hold.grows:
            found[1] = sums @ self.tip_forces.wasted(hold, motion)
        if hold.grip != "stick":
            found[2] = sums @ (motion.F_t * self.tip_forces.slides(hold, motion))
        return found

    def _lose(self, hold: Hold, losses: Array, before: float) -> None:
        """Note what was lost in a leg; before: what the spring along the surface held at its start, J."""
        contact, (worked, wasted, rubbed, *damped) = self.contact, losses.tolist()
        self._damp(damped)
        if hold.apart:
            return
        missing = before - self._stored(hold) - worked
        if self.tip_forces.whole_account:
            contact.friction_loss += missing if math.isfinite(contact.laws.friction) else 0.0
            self.sheared += 0.0 if math.isfinite(contact.laws.friction) else missing
            return
        if hold.grip == "stick" and not hold.grows:  # by parts: it may stick to the end, where k_t falls with a root
            self.sheared += missing  # of time
            return
        self.sheared += wasted
        contact.friction_loss -= rubbed

    def _damp(self, damped: list[float]) -> None:
        """Note what each damper took, J."""
        contact = self.contact
        contact.damping_loss += math.fsum(damped[: contact.lossy])
        contact.radiated += math.fsum(damped[contact.lossy :])

    def _stored(self, hold: Hold) -> float:
        """Energy that the spring along the surface holds now, J."""
        depth, held = self.contact.z[self.contact.slots.of("depth", "shear")].tolist()
        return self.tip_forces.stored(hold.press, depth, held)

    def _stuck(self, hold: Hold) -> RuntimeError:
        return RuntimeError(
            f"the contact could not be stepped on from {self.contact.time:.6g} s, after {self.taken} steps, in "
            f"{hold.grip}, {hold.press}; keep fewer modes, or a Tip.restitution further from 0"
        )

    # What every kind of contact gives

    def first_grip(self, press: Press) -> Grip:
        """The patch sticks from a touch on where the spring's force grows more slowly than friction's bound."""
        contact, friction = self.contact, self.contact.laws.friction
        c_t, c_n = self.facing()
        ratio = self.law.first_ratio * (self.law.restitution**2 if press == "unload" else 1.0)
        pull, bound = -float(c_t @ contact.z), -friction * float(c_n @ contact.z)
        if pull == 0 or math.isinf(friction) or ratio * abs(pull) <= bound:
            return "stick"
        return "slip" if pull > 0 else "slip back"

    def grip_at_rest(self, press: Press) -> Grip:
        """A patch that stops sliding holds: the spring's force is continuous."""
        return "stick"

    def at_once(self, grip: Grip, press: Press, most: float) -> bool:
        """In the compiled kernel; in Python they are stepped one by one."""
        if self.steps is None:
            return False
        self._compiled_blow(self.steps, grip, press, most)
        return True

    def follow(self, grip: Grip, press: Press) -> str:
        """Step through one phase, leg by leg."""
        contact = self.contact
        before, start, first = contact.impulse, contact.time, len(self.pieces)
        self.grows = self.grows or press == "load"
        if grip != "stick":
            self._bound(Hold(grip, press, self.grows))
        coordinates, event = self.free.onto @ contact.z, "turned"
        while event == "turned":
            event, coordinates = self._leg(Hold(grip, press, self.grows), coordinates, self.longest)
            if event == "turned":
                self.grows = not self.grows
        self._settle(coordinates)
        if event == "late":
            raise endless(self, grip, press)
        self.marches.append(Marched(start, tuple(self.pieces[first:])))
        contact.end_phase(grip, press, start, before)
        return event

    def _bound(self, hold: Hold) -> None:
        """Put F_t on friction's bound, which the stick before went past by rounding: a slip over at once keeps it."""
        held = self._stored(hold)
        self.contact.put(shear=float(self.force(hold.grip, hold.press)[0]))
        self.sheared += held - self._stored(hold)

    def _settle(self, coordinates: Complex) -> None:
        """Put the coordinates into the state."""
        kept = self.contact.slots.of("depth", "angle", "shear")
        z = self.free.state(coordinates)
        z[kept] = self.contact.z[kept]
        self.contact.z = z

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """What follows."""
        return next_phase(self, event, grip, press)

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        slots = self.contact.slots
        F_n = float(self.law.at(self.tip_forces.virtual(press, self.contact.z[slots.of("depth")]))[0][0])
        held = float(self.contact.z[slots["shear"]])
        return np.array([held if grip == "stick" else SIDE[grip] * self.contact.laws.friction * F_n, F_n])

    def facing(self) -> tuple[Array, Array]:
        """(c_t, c_n) where the contact has turned to."""
        angle, rows = self.contact.z[self.contact.slots.of("angle")], self.free.rows
        turn = np.exp(-1j * angle)
        across = turn * (rows[0] + 1j * rows[1]) + self._lever(angle, turn) * rows[3]
        return across.real + rows[2], across.imag

    def compressed(self, grip: Grip) -> None:
        """Note the greatest compression; from now on the patch shrinks."""
        self.tip_forces.deepest, self.grows = float(self.contact.z[self.contact.slots["depth"]]), False

    def press_anew(self, old: Press, new: Press) -> None:
        """The compression is the state: nothing to keep."""

    def fly(self, until: float, near: float) -> bool:
        """Step through the flight; they touch where they would overlap by ``near``, m."""
        contact, start, first = self.contact, self.contact.time, len(self.pieces)
        self.sheared += self._stored(Hold("stick", "unload", grows=False))  # a constant spring alone still holds any
        contact.put(shear=0.0)
        self.tip_forces.let_go()
        self.halvings, self.series, self.series_step = FIRST, np.zeros((TAYLOR, 4)), 0.0
        state, lost = contact.z, (contact.damping_loss, contact.radiated)
        flight = Hold("stick", "unload", grows=True, apart=True)
        if self.steps is not None:
            found = self.steps.flight(flight, self.free.onto @ state, until, near)
            self._check(found.status, flight)
            self._damp(found.damped)
            event, coordinates, records = found.event, found.coordinates, found.steps
        else:
            event, coordinates = self._leg(flight, self.free.onto @ state, until, near)
        if event != "touch" or contact.time > until:
            contact.time, contact.z = start, state
            contact.damping_loss, contact.radiated = lost
            del self.pieces[first:]
            return False
        self._settle(coordinates)
        if self.steps is not None:
            self.records.append((start, records))
        else:
            self.marches.append(Marched(start, tuple(self.pieces[first:])))
        self.grows = True
        contact.end_phase(*APART, start, contact.impulse)
        return True

    def stretches(self) -> list[Stretch]:
        """The phases so far, and the free motion from now on."""
        return [*self._marches(), free_course(self.contact)]

    def history(self, mirror: float) -> MarchedHistory:
        """Forces and velocities so far; mirror: -1 for a stroke on the other side."""
        return MarchedHistory(self._marches, mirror)

    def tip_loss(self) -> float:
        """Energy that the tip did not give back along the normal, J."""
        return self.law.loss(self.tip_forces.deepest)

    def other_losses(self) -> dict[str, float]:
        """What the cue damped, and what the tip lost along the surface."""
        damped = {"damping loss": self.contact.damping_loss} if self.contact.lossy else {}
        return damped | {"tip shear": self.sheared + self._stored(Hold("stick", "unload", grows=False))}
