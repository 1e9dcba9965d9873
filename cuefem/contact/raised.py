"""The contact of a raised cue, stepped in time; its equations stand in `cuefem.contact.elevation`."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass, field

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.history import SteppedHistory
from cuefem.contact.kernel.stepped import Numbers, Steps, raised_steps_of
from cuefem.contact.patch import RigidPatch
from cuefem.contact.phases import ROUNDING, Step, next_phase
from cuefem.contact.state import Contact, Grip, Laws, Press
from cuefem.contact.stepped import PAST, SLOTS, End, Ends, Hold, OnTable, Stepped, Way
from cuefem.cue import Array
from cuefem.effects.law import NormalLaw, TipLaw
from cuefem.effects.terms import Table

# Rows of the contact, in this order: the tip's velocities against the ball, and the ball's lowest point's.
T, N, P, UP, ASIDE, AHEAD = range(6)
SLIDING = ([T, P], [ASIDE, AHEAD])  # of the tip on the ball, and of the ball on the table
UNIT = np.eye(6)
# A point that slides more slowly than this part of the stroke's speed keeps its direction.
REST = 1e-6
# Rows whose velocities are held at zero, by how the table holds the ball.
HELD: dict[OnTable, list[int]] = {"none": [], "lifted": [], "slides": [UP], "held": [UP, ASIDE, AHEAD]}
# Ends that may be behind already when a phase starts, and ends that change how the table holds the ball.
AT_ONCE, AT_TABLE = ("compressed", "slipped", "slid", "lifted"), ("lifted", "landed", "stopped", "slid")
# The compression, as a part of the stroke's length, at which a touch shows the direction of its forces.
PROBE = 1e-6


@dataclass(frozen=True)
class RaisedHistory(SteppedHistory):
    """A stepped history, and the ball as it left: velocity, m/s, and spin, rad/s, as vectors (right, forward, up)."""

    velocity: Array = field(default_factory=lambda: np.zeros(3))
    spin: Array = field(default_factory=lambda: np.zeros(3))


class Raised(Stepped):
    """The stepped contact of a cue raised over a table; its tip modes are `cuefem.contact.elevation.in_both_planes`.

    Slots beside those of a stepped contact: "ball_p", "spin_t" and "spin_n", the ball's velocity and spin across the
    plane; "height" of the ball over the table, m; "scraped", what the table rubs off in a phase, J; "tip_way" and
    "ball_way", the angles of the directions in which tip and ball slide, rad. across: the modes' displacement of the
    contact along p. radius: of the ball, m. hold_on_table: how the table holds the ball.
    """

    lost_in = ("rubbed", "damped", "gone", "scraped")

    def __init__(
        self,
        tip: TipModes,
        laws: Laws,
        *,
        law: NormalLaw,
        clock: float,
        table: Table,
        across: Array,
        radius: float,
    ) -> None:
        more = ("ball_p", "spin_t", "spin_n", "height", "scraped", "tip_way", "ball_way")
        super().__init__(Contact(tip, laws, (*SLOTS, *more)), RigidPatch(), law=law, clock=clock)
        self.table, self.across, self.radius = table, across, radius
        self.on_table: OnTable = "slides"
        self.table_loss = 0.0
        slots = self.contact.slots
        self.ball = slots.of("ball_t", "ball_n", "ball_p")  # where the ball's velocity (t, n, p) stands in the state
        self.turns = slots.of("spin_t", "spin_n", "spin")  # and its spin
        self.ways = slots.of("tip_way", "ball_way")
        self.sizes[slots["height"]], self.sizes[slots["scraped"]] = self.sizes[slots.of("depth", "rubbed")]
        self.sizes[self.ways] = 1.0
        self.rows = self._rows()
        self.sliding = tuple(self.rows[rows] for rows in SLIDING)
        self.gram = self.rows @ self.rows.T
        self._read_along_table()
        self.compile()

    def compiled(self, found: ctypes.CDLL, law: TipLaw, numbers: Numbers) -> Steps | None:
        """The compiled steps; None as long as what they ask for is not there yet."""
        if type(self) is not Raised or not hasattr(self, "gram"):
            return None
        return raised_steps_of(found, self, law, numbers, at_rest=REST * self.contact.laws.speed)

    def _read_along_table(self) -> None:
        """Impulses are read along the table, in (t, n) of the level stroke; the table's part is in them."""
        contact, laws = self.contact, self.contact.laws
        s, c = math.sin(laws.phi), math.cos(laws.phi)
        right, forward, up = self.axes
        root = math.sqrt(laws.ball_mass)
        read, per = contact.readings
        read[:], per[:] = 0.0, 1.0
        read[0, self.ball] = root * (s * forward + c * right)
        read[1, self.ball] = root * (c * forward - s * right)
        read[2, self.turns] = math.sqrt(laws.inertia * laws.ball_mass) * up  # what turned it about the vertical
        read[3, contact.slots.velocities] = -contact.tip.approach  # what the cue gave along its axis
        contact.along_before = laws.speed * float(contact.tip.approach @ contact.tip.approach)

    @property
    def axes(self) -> tuple[Array, Array, Array]:
        """Right, forward and up in (t, n, p)."""
        s, c = math.sin(self.contact.laws.phi), math.cos(self.contact.laws.phi)
        sin_a, cos_a = math.sin(self.table.angle), math.cos(self.table.angle)
        right, forward = np.array([c, -s, 0]), np.array([cos_a * s, cos_a * c, sin_a])
        return right, forward, np.array([-sin_a * s, -sin_a * c, cos_a])

    def _rows(self) -> Array:
        contact, slots, (right, forward, up) = self.contact, self.contact.slots, self.axes
        rows, mass = np.zeros((6, len(contact.z))), contact.laws.ball_mass
        root, turn = mass**-0.5, (contact.laws.inertia * mass) ** -0.5
        rows[T], rows[N] = contact.c_t, contact.c_n
        rows[P, slots.velocities], rows[P, slots["ball_p"]], rows[P, slots["spin_t"]] = -self.across, root, -turn
        for row, way in ((UP, up), (ASIDE, right), (AHEAD, forward)):
            rows[row, self.ball] = root * way
        for row, way in ((ASIDE, right), (AHEAD, forward)):
            rows[row, self.turns] = -turn * np.cross(up, way)
        return rows

    def hold(self, grip: Grip, press: Press) -> Hold:
        """The hold of a phase that starts now, at the tip and at the table."""
        return Hold(grip, press, self.deepest, self.on_table)

    def _way_of(self, z: Array, i: int) -> tuple[float, float]:
        """Unit vector along which the tip (0) or the ball's lowest point (1) slides."""
        angle = float(z[self.ways[i]])
        return math.cos(angle), math.sin(angle)

    def _slip(self, z: Array, i: int) -> float:
        """Speed along it, m/s."""
        (x, y), (a, b) = self._way_of(z, i), self.sliding[i] @ z
        return float(x * a + y * b)

    def _turning(self, z: Array, velocities: Array, rates: Array, i: int) -> float:
        """Rate at which it turns, rad/s: the speed, not its components, then falls through zero at an end.

        velocities, rates: the six of the contact, and how they change. A point that hardly moves keeps its direction.
        """
        (x, y), (a, b) = self._way_of(z, i), SLIDING[i]
        aside, speed = float(x * rates[b] - y * rates[a]), float(x * velocities[a] + y * velocities[b])
        return aside * speed / (speed**2 + (REST * self.contact.laws.speed) ** 2)

    def _head(self, i: int, way: Array) -> None:
        """Set the direction in which a point slides, or is about to slide."""
        contact = self.contact
        contact.z = contact.z.copy()
        contact.z[self.ways[i]] = math.atan2(way[1], way[0])

    def contact_forces(self, z: Array, hold: Hold, free: Array) -> Array:
        """The six forces, N, in the order of the rows; free: the rate of the state without them."""
        return self._forces_against(z, hold, self.rows @ free)

    def _forces_against(self, z: Array, hold: Hold, falling: Array) -> Array:
        """The six forces, N; falling: rates of the six velocities without them, m/s2."""
        known, F_n = np.zeros(6), self.pressing(z, hold)
        known[N] = F_n
        if hold.grip != "stick":
            x, y = self._way_of(z, 0)
            known[T], known[P] = -self.contact.laws.friction * F_n * x, -self.contact.laws.friction * F_n * y
        keep = self._keep(hold)
        if not keep:
            return known
        kept, push = self.gram[keep], UNIT[:, keep]
        if hold.table == "slides":  # the last of the unknown forces is the table's push upwards, which brings friction
            x, y = self._way_of(z, 1)
            push[ASIDE, -1], push[AHEAD, -1] = -self.table.friction * x, -self.table.friction * y
        return known - push @ np.linalg.solve(kept @ push, falling[keep] + kept @ known)

    def change(self, z: Array, hold: Hold | None) -> Array:
        """Rate of change of the state, 1/s; ball and tip touch."""
        assert hold is not None
        free, slots = self.contact.free @ z, self.contact.slots
        velocities, falling = self.rows @ z, self.rows @ free
        forces = self._forces_against(z, hold, falling)
        rate = free + forces @ self.rows
        rate[slots["depth"]] = -velocities[N]
        rate[slots["height"]] = velocities[UP]
        powers = -forces * velocities
        rate[slots["rubbed"]] = powers[T] + powers[P]
        rate[slots["scraped"]] = powers[UP] + powers[ASIDE] + powers[AHEAD]
        rates = falling + self.gram @ forces
        if hold.grip == "slip":
            rate[self.ways[0]] = self._turning(z, velocities, rates, 0)
        if hold.table == "slides":
            rate[self.ways[1]] = self._turning(z, velocities, rates, 1)
        self._damped(rate, z)
        return rate

    def reading(self, z: Array, hold: Hold | None) -> tuple[float, float, float, float]:
        """(v_t, v_n, F_t, F_n) of a state; ball and tip touch."""
        assert hold is not None
        forces = self.contact_forces(z, hold, self.contact.free @ z)
        return float(self.rows[T] @ z), float(self.rows[N] @ z), float(forces[T]), float(forces[N])

    def _presses_on(self, grip: Grip) -> bool:
        """Only a phase of a rigid tip could tell; a tip that rings is given up after `MOST_RATES`."""
        return False

    def _keep(self, hold: Hold) -> list[int]:
        """Rows whose velocities a phase keeps at zero."""
        tip = [T, P] if hold.grip == "stick" else []
        return [*tip, *HELD[hold.table]]

    def _stop(self, rows: Array) -> float:
        """A blow that takes the velocities that ``rows`` read away; the energy that it takes, J."""
        if not len(rows):
            return 0.0
        taken = rows.T @ np.linalg.solve(rows @ rows.T, rows @ self.contact.z)  # orthogonal to what is left
        self.contact.z = self.contact.z - taken
        return float(taken @ taken) / 2

    def _now(self, hold: Hold) -> Array:
        """The six forces; at first touch, where there are none yet, those of a slight compression."""
        contact = self.contact
        z = contact.z.copy()
        if abs(self.pressing(z, hold)) < ROUNDING * contact.scale:
            z[contact.slots["depth"]] += PROBE * contact.laws.speed * self.clock
        return self.contact_forces(z, hold, contact.free @ z)

    def first_grip(self, press: Press) -> Grip:
        """How the first touch grips at the tip, and at the table."""
        velocity = self.rows[[T, P]] @ self.contact.z
        grip: Grip = "slip"
        self.on_table = "held"
        if math.hypot(*velocity) == 0:
            grip = self.grip_at_rest(press)
        elif math.isfinite(self.contact.laws.friction):
            self._head(0, velocity)
        else:
            self.contact.friction_loss += self._stop(self.rows[[T, P, UP]])
            grip = "stick"
        self._rest_on_table(grip, press)
        return grip

    def grip_at_rest(self, press: Press) -> Grip:
        """Stick where friction can hold the contact, else the way it starts to slip."""
        forces = self._now(self.hold("stick", press))
        if math.hypot(*forces[[T, P]]) <= self.contact.laws.friction * forces[N] + ROUNDING * self.contact.scale:
            return "stick"
        self._head(0, -forces[[T, P]])
        return "slip"

    def _rest_on_table(self, grip: Grip, press: Press) -> None:
        """How the table holds the ball, whose lowest point is at rest: held, sliding away, or not at all."""
        self.on_table = "held"
        slack = ROUNDING * self.contact.scale
        forces = self._now(self.hold(grip, press))
        if math.hypot(*forces[[ASIDE, AHEAD]]) > self.table.friction * forces[UP] + slack:
            self.on_table = "slides"
            self._head(1, -forces[[ASIDE, AHEAD]])
            forces = self._now(self.hold(grip, press))
        if forces[UP] < -slack:
            self.on_table = "lifted"

    def _at_once(self, ends: Ends) -> str | None:
        """The first end in `AT_ONCE` that the state has already passed when the phase starts."""
        return next((name for name in AT_ONCE if name in ends and ends[name](self.contact.z) < -PAST), None)

    def next(self, event: str, grip: Grip, press: Press) -> Step | None:
        """What follows; a change at the table leaves grip and press as they are."""
        if event in AT_TABLE:
            self._at_table(event, self.hold(grip, press))
            return Step(event, grip, press)
        if event == "slipped":
            self._head(0, -self._now(self.hold(grip, press))[[T, P]])
        step = next_phase(self, event, grip, press)
        if step is not None:
            self._settle(self.hold(step.grip, step.press))
        return step

    def _at_table(self, event: str, hold: Hold) -> None:
        """What follows where the ball is lifted off the table, lands on it, stops sliding on it or starts to."""
        if event == "lifted":
            self.on_table = "lifted"
        elif event == "slid":
            self.on_table = "slides"
            self._head(1, -self._now(hold)[[ASIDE, AHEAD]])
        elif event == "landed":
            self.on_table = "slides"
            self.table_loss += self._stop(self.rows[self._keep(self.hold(hold.grip, hold.press))])
            self._head(1, self.rows[SLIDING[1]] @ self.contact.z)
            self.contact.put(height=0.0)
        else:
            self._rest_on_table(hold.grip, hold.press)
            self._settle(self.hold(hold.grip, hold.press))

    def _ends(self, hold: Hold) -> Ends:
        """What ends a phase, by name: functions of the state, of the order of 1, that fall through zero there."""
        contact, slots = self.contact, self.contact.slots
        speed, depth, scale = contact.laws.speed, contact.laws.speed * self.clock, contact.scale

        def margin(friction: float, normal: int, *sides: int) -> End:
            def left(z: Array) -> float:
                forces = self.contact_forces(z, hold, contact.free @ z)
                return (friction * float(forces[normal]) - math.hypot(*forces[list(sides)])) / scale + ROUNDING

            return left

        ends: Ends = {}
        if hold.press == "load":
            ends["compressed"] = lambda z: -float(self.rows[N] @ z) / speed
        else:
            ends["apart"] = lambda z: (float(z[slots["depth"]]) - self.law.rest(hold.deepest)) / depth
            ends["reloaded"] = lambda z: (hold.deepest - float(z[slots["depth"]])) / depth
        if hold.grip == "slip":
            ends["gripped"] = lambda z: self._slip(z, 0) / speed
        elif math.isfinite(contact.laws.friction):
            ends["slipped"] = margin(contact.laws.friction, N, T, P)
        if hold.table == "lifted":
            return ends | {"landed": lambda z: float(z[slots["height"]]) / depth}
        ends["lifted"] = lambda z: float(self.contact_forces(z, hold, contact.free @ z)[UP]) / scale + ROUNDING
        if hold.table == "slides":
            return ends | {"stopped": lambda z: self._slip(z, 1) / speed}
        return ends | {"slid": margin(self.table.friction, UP, ASIDE, AHEAD)}

    def _take(self, hold: Hold | None, way: Way) -> None:
        super()._take(hold, way)
        self.table_loss += float(way.z[self.contact.slots["scraped"]])

    def _settle(self, hold: Hold) -> None:
        """Remove what rounding, or the last turn of a slip, left in the directions that the phase holds."""
        self.contact.friction_loss += self._stop(self.rows[self._keep(hold)])

    def _vectors(self) -> tuple[Array, Array]:
        """Velocity, m/s, and spin times radius, m/s, of the ball: (right, forward, up)."""
        axes, laws, z = np.array(self.axes), self.contact.laws, self.contact.z
        mass = laws.ball_mass
        return axes @ z[self.ball] * mass**-0.5, axes @ z[self.turns] * (laws.inertia * mass) ** -0.5

    def other_losses(self) -> dict[str, float]:
        """The ball's turning about level axes, its motion upwards, and what the table took, J."""
        (_, _, hop), turning = self._vectors()
        laws = self.contact.laws
        mass = laws.ball_mass
        return {
            **super().other_losses(),
            "ball roll": float(turning[:2] @ turning[:2]) * laws.inertia * mass / 2,
            "ball hop": float(hop) ** 2 * mass / 2,
            "table loss": self.table_loss,
        }

    def history(self, mirror: float) -> RaisedHistory:
        """Forces and velocities so far, and the ball's; mirror: -1 for a stroke on the other side."""
        velocity, turning = self._vectors()
        side = np.array([mirror, 1.0, 1.0])
        return RaisedHistory(tuple(self.steppings), mirror, velocity * side, turning / self.radius * side * mirror)
