"""The contact of a raised cue, stepped in time; its equations stand in `cuefem.contact.elevation`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from cuefem.contact.history import SteppedHistory
from cuefem.contact.linear import ROUNDING, Grip, Phase, Press
from cuefem.contact.stepped import PAST, SteppedContact
from cuefem.cue import Array
from cuefem.effects.terms import Table

OnTable = Literal["slides", "held", "lifted"]
# Rows of the contact, in this order: the tip's velocities against the ball, and the ball's lowest point's.
T, N, P, UP, ASIDE, AHEAD = range(6)
SLIDING = ([T, P], [ASIDE, AHEAD])  # of the tip on the ball, and of the ball on the table
# A point that slides more slowly than this part of the stroke's speed keeps its direction.
REST = 1e-6
# Events of which a phase may have been past from its start, and those that change how the table holds the ball.
AT_ONCE, AT_TABLE = ("compressed", "slipped", "slid", "lifted"), ("lifted", "landed", "stopped", "slid")
# A compression, in strokes' lengths, at which a touch shows which way its forces go.
PROBE = 1e-6


class RaisedHold(NamedTuple):
    """How the contact holds in a phase: at the tip, and at the table."""

    grip: Grip
    press: Press
    deepest: float
    table: OnTable


@dataclass(frozen=True)
class RaisedHistory(SteppedHistory):
    """A stepped history, and the ball as it left: velocity, m/s, and spin, rad/s, as vectors (right, forward, up)."""

    velocity: Array = field(default_factory=lambda: np.zeros(3))
    spin: Array = field(default_factory=lambda: np.zeros(3))


@dataclass
class RaisedContact(SteppedContact):
    """The contact of a cue raised as ``raised`` says; its tip modes are `cuefem.contact.elevation.in_both_planes`.

    across: their displacement of the contact along p. radius: of the ball, m.
    """

    raised: Table = field(default_factory=lambda: Table(0.0, 0.0))
    across: Array = field(default_factory=lambda: np.zeros(0))
    radius: float = 1.0
    table: OnTable = "slides"
    table_loss: float = 0.0

    extra_states: ClassVar[int] = 12

    def __post_init__(self) -> None:
        super().__post_init__()
        size = len(self.z)
        self.ball_p, self.spin_t, self.spin_n, self.height, self.scraped, *self.ways = range(size - 7, size)
        self.losses = [*self.losses, self.scraped]
        self.sizes[self.height], self.sizes[self.scraped] = self.sizes[self.depth], self.sizes[self.rubbed]
        self.sizes[self.ways] = 1.0
        self.rows = self._rows()
        self.gram = self.rows @ self.rows.T

    @property
    def axes(self) -> tuple[Array, Array, Array]:
        """Right, forward and up in (t, n, p)."""
        s, c = math.sin(self.laws.phi), math.cos(self.laws.phi)
        sin_a, cos_a = math.sin(self.raised.angle), math.cos(self.raised.angle)
        right, forward = np.array([c, -s, 0]), np.array([cos_a * s, cos_a * c, sin_a])
        return right, forward, np.array([-sin_a * s, -sin_a * c, cos_a])

    def _rows(self) -> Array:
        rows, (right, forward, up) = np.zeros((6, len(self.z))), self.axes
        root, turn = self.laws.ball_mass**-0.5, (self.laws.inertia * self.laws.ball_mass) ** -0.5
        rows[T], rows[N] = self.c_t, self.c_n
        rows[P, self.velocities], rows[P, self.ball_p], rows[P, self.spin_t] = -self.across, root, -turn
        for row, way in ((UP, up), (ASIDE, right), (AHEAD, forward)):
            rows[row, self.ball] = root * way
        for row, way in ((ASIDE, right), (AHEAD, forward)):
            rows[row, self.turns] = -turn * np.cross(up, way)
        return rows

    @property
    def ball(self) -> list[int]:
        """Where the ball's velocity (t, n, p) stands in the state."""
        return [self.ball_t, self.ball_n, self.ball_p]

    @property
    def turns(self) -> list[int]:
        """Where the ball's spin (t, n, p) stands in the state."""
        return [self.spin_t, self.spin_n, self.spin]

    def _hold(self, grip: Grip, press: Press) -> Any:
        return RaisedHold(grip, press, self.deepest, self.table)

    def _slip(self, z: Array, i: int) -> tuple[Array, float]:
        """Unit vector along which the tip (0) or the ball's lowest point (1) slides, and its speed along it, m/s."""
        angle = float(z[self.ways[i]])
        along = np.array([math.cos(angle), math.sin(angle)])
        return along, float(along @ (self.rows[SLIDING[i]] @ z))

    def _turning(self, z: Array, rate: Array, i: int) -> float:
        """Rate at which that direction turns, rad/s: its speed, not its components, then falls through zero at an end.

        A point that hardly moves keeps its direction.
        """
        (x, y), speed = self._slip(z, i)
        aside = float(np.array([-y, x]) @ (self.rows[SLIDING[i]] @ rate))
        return aside * speed / (speed**2 + (REST * self.laws.speed) ** 2)

    def _head(self, i: int, way: Array) -> None:
        """Say which way a point slides, or is about to."""
        self.z = self.z.copy()
        self.z[self.ways[i]] = math.atan2(way[1], way[0])

    def contact_forces(self, z: Array, hold: Any, free: Array) -> Array:
        """The six forces, N, in the order of the rows."""
        push = np.zeros((6, 0))  # columns: what each unknown adds to the forces
        known, keep = np.zeros(6), []
        known[N] = self._pressing(float(z[self.depth]), hold)
        unit = np.eye(6)
        if hold.grip == "stick":
            push, keep = unit[:, [T, P]], [T, P]
        else:
            known[[T, P]] = -self.laws.friction * known[N] * self._slip(z, 0)[0]
        if hold.table != "lifted":
            column = unit[:, [UP]].copy()
            if hold.table == "slides":
                column[[ASIDE, AHEAD], 0] = -self.raised.friction * self._slip(z, 1)[0]
            else:
                column = np.hstack([column, unit[:, [ASIDE, AHEAD]]])
            push, keep = np.hstack([push, column]), [*keep, UP, *([ASIDE, AHEAD] if hold.table == "held" else [])]
        if not keep:
            return known
        falling = (self.rows @ free + self.gram @ known)[keep]
        return known - push @ np.linalg.solve((self.gram @ push)[keep], falling)

    def change(self, z: Array, hold: Any) -> Array:
        """Rate of change of the state, 1/s."""
        rate = self.free @ z
        forces, velocities = self.contact_forces(z, hold, rate), self.rows @ z
        rate = rate + self.rows.T @ forces
        rate[self.depth] = -velocities[N]
        rate[self.height] = velocities[UP]
        rate[self.rubbed] = -forces[[T, P]] @ velocities[[T, P]]
        rate[self.scraped] = -forces[[UP, ASIDE, AHEAD]] @ velocities[[UP, ASIDE, AHEAD]]
        if hold.grip == "slip":
            rate[self.ways[0]] = self._turning(z, rate, 0)
        if hold.table == "slides":
            rate[self.ways[1]] = self._turning(z, rate, 1)
        if len(self.dampers):
            powers = (self.dampers @ z) ** 2
            rate[self.damped], rate[self.gone] = powers[: self.lossy].sum(), powers[self.lossy :].sum()
        return rate

    def reading(self, z: Array, hold: Any) -> tuple[float, float, float, float]:
        """(v_t, v_n, F_t, F_n) of a state."""
        forces = self.contact_forces(z, hold, self.free @ z)
        return float(self.rows[T] @ z), float(self.rows[N] @ z), float(forces[T]), float(forces[N])

    def force(self, grip: Grip, press: Press) -> Array:
        """(F_t, F_n) now, N, if the contact gripped and pressed in this way."""
        return np.array(self.reading(self.z, self._hold(grip, press))[2:])

    def _presses_on(self, grip: Grip) -> bool:
        """Not known without a phase of a rigid tip: one that rings is given up after `MOST_RATES`."""
        return False

    def _keep(self, hold: Any) -> list[int]:
        """Rows whose velocities a phase keeps at zero."""
        tip = [T, P] if hold.grip == "stick" else []
        table = {"lifted": [], "slides": [UP], "held": [UP, ASIDE, AHEAD]}[hold.table]
        return [*tip, *table]

    def _stop(self, rows: Array) -> float:
        """A blow that takes the velocities that ``rows`` read away; the energy that it takes, J."""
        if not len(rows):
            return 0.0
        taken = rows.T @ np.linalg.solve(rows @ rows.T, rows @ self.z)  # orthogonal to what is left
        self.z = self.z - taken
        return float(taken @ taken) / 2

    def _now(self, hold: Any) -> Array:
        """The six forces, or at a touch, where there are none yet, those of a slight compression."""
        z = self.z.copy()
        if abs(self._pressing(float(z[self.depth]), hold)) < ROUNDING * self.scale:
            z[self.depth] += PROBE * self.laws.speed * self.clock
        return self.contact_forces(z, hold, self.free @ z)

    def first_grip(self, press: Press = "load") -> Grip:
        """How the first touch grips at the tip, and at the table."""
        velocity = self.rows[[T, P]] @ self.z
        grip: Grip = "slip"
        self.table = "held"
        if math.hypot(*velocity) == 0:
            grip = self.grip_at_rest(press)
        elif math.isfinite(self.laws.friction):
            self._head(0, velocity)
        else:
            self.friction_loss += self._stop(self.rows[[T, P, UP]])
            grip = "stick"
        self._rest_on_table(grip, press)
        return grip

    def grip_at_rest(self, press: Press) -> Grip:
        """Stick where friction can hold the contact, else the way it starts to slip."""
        forces = self._now(self._hold("stick", press))
        if math.hypot(*forces[[T, P]]) <= self.laws.friction * forces[N] + ROUNDING * self.scale:
            return "stick"
        self._head(0, -forces[[T, P]])
        return "slip"

    def _rest_on_table(self, grip: Grip, press: Press) -> None:
        """How the table holds the ball, whose lowest point is at rest: held, sliding away, or not at all."""
        self.table = "held"
        forces = self._now(self._hold(grip, press))
        if math.hypot(*forces[[ASIDE, AHEAD]]) > self.raised.friction * forces[UP] + ROUNDING * self.scale:
            self.table = "slides"
            self._head(1, -forces[[ASIDE, AHEAD]])
            forces = self._now(self._hold(grip, press))
        if forces[UP] < -ROUNDING * self.scale:
            self.table = "lifted"

    def go(self, grip: Grip, press: Press) -> tuple[str, Grip, Press] | None:
        """Follow one phase to its end; what ended it, and what comes next (None: the ball has left)."""
        hold = self._hold(grip, press)
        ends = self._ends(hold)
        event = next((name for name in AT_ONCE if name in ends and ends[name](self.z) < -PAST), None)
        if event is None:
            event, *way = self._way(hold, ends, until=self.longest)
            if event is None:
                raise self.endless(grip, press)
            self._follow(hold, *way)
        else:
            self.phases.append(Phase(grip, press, self.time, self.time, (0.0, 0.0)))
        if event in AT_TABLE:
            self._at_table(event, hold)
            return event, grip, press
        if event == "slipped":
            self._head(0, -self._now(hold)[[T, P]])
        step = self._next(event, grip, press)
        if step is not None:
            self._settle(self._hold(*step[1:]))
        return step

    def _at_table(self, event: str, hold: Any) -> None:
        """What follows where the ball is lifted off the table, lands on it, stops sliding on it or starts to."""
        if event == "lifted":
            self.table = "lifted"
        elif event == "slid":
            self.table = "slides"
            self._head(1, -self._now(hold)[[ASIDE, AHEAD]])
        elif event == "landed":
            self.table = "slides"
            self.table_loss += self._stop(self.rows[self._keep(self._hold(*hold[:2]))])
            self._head(1, self.rows[SLIDING[1]] @ self.z)
            self.z[self.height] = 0.0
        else:
            self._rest_on_table(*hold[:2])
            self._settle(self._hold(*hold[:2]))

    def _ends(self, hold: Any) -> dict[str, Callable[[Array], float]]:
        """What ends a phase, by name: functions of the state, of the order of 1, that fall through zero there."""
        speed, depth, scale = self.laws.speed, self.laws.speed * self.clock, self.scale

        def margin(friction: float, normal: int, *sides: int) -> Callable[[Array], float]:
            def left(z: Array) -> float:
                forces = self.contact_forces(z, hold, self.free @ z)
                return (friction * float(forces[normal]) - math.hypot(*forces[list(sides)])) / scale + ROUNDING

            return left

        ends: dict[str, Callable[[Array], float]] = {}
        if hold.press == "load":
            ends["compressed"] = lambda z: -float(self.rows[N] @ z) / speed
        else:
            ends["apart"] = lambda z: (float(z[self.depth]) - self.law.rest(hold.deepest)) / depth
            ends["reloaded"] = lambda z: (hold.deepest - float(z[self.depth])) / depth
        if hold.grip == "slip":
            ends["gripped"] = lambda z: self._slip(z, 0)[1] / speed
        elif math.isfinite(self.laws.friction):
            ends["slipped"] = margin(self.laws.friction, N, T, P)
        if hold.table == "lifted":
            return ends | {"landed": lambda z: float(z[self.height]) / depth}
        ends["lifted"] = lambda z: float(self.contact_forces(z, hold, self.free @ z)[UP]) / scale + ROUNDING
        if hold.table == "slides":
            return ends | {"stopped": lambda z: self._slip(z, 1)[1] / speed}
        return ends | {"slid": margin(self.raised.friction, UP, ASIDE, AHEAD)}

    def _follow(self, hold: Any, end: float, z: Array, solution: Any) -> None:
        super()._follow(hold, end, z, solution)
        self.table_loss += float(z[self.scraped])

    def _settle(self, hold: Any) -> None:
        """Take out of the directions that a phase holds what rounding, and a slip's last turn, left there."""
        self.friction_loss += self._stop(self.rows[self._keep(hold)])

    def _vectors(self) -> tuple[Array, Array]:
        """Velocity, m/s, and spin times radius, m/s, of the ball: (right, forward, up)."""
        axes, mass = np.array(self.axes), self.laws.ball_mass
        return axes @ self.z[self.ball] * mass**-0.5, axes @ self.z[self.turns] * (self.laws.inertia * mass) ** -0.5

    @property
    def impulse(self) -> tuple[float, float]:
        """Impulse on the ball along the table, in (t, n) of the level stroke, N s; the table's part is in it."""
        s, c = math.sin(self.laws.phi), math.cos(self.laws.phi)
        right, forward, _ = self._vectors()[0] * self.laws.ball_mass
        return float(s * forward + c * right), float(c * forward - s * right)

    @property
    def along(self) -> float:
        """What the cue gave along its axis, N s."""
        return float(self.tip.approach @ (self.laws.speed * self.tip.approach - self.z[self.velocities]))

    @property
    def twist(self) -> float:
        """The part of the impulse that turned the ball about the vertical, N s."""
        return float(self._vectors()[1][2]) * self.laws.inertia * self.laws.ball_mass

    def other_losses(self) -> dict[str, float]:
        """The ball's turning about level axes, its motion upwards, and what the table took, J."""
        (_, _, hop), turning = self._vectors()
        mass = self.laws.ball_mass
        return {
            **super().other_losses(),
            "ball roll": float(turning[:2] @ turning[:2]) * self.laws.inertia * mass / 2,
            "ball hop": float(hop) ** 2 * mass / 2,
            "table loss": self.table_loss,
        }

    def history(self, mirror: float) -> RaisedHistory:  # type: ignore[override]
        """Forces and velocities so far, and the ball's; mirror: -1 for a stroke on the other side."""
        velocity, turning = self._vectors()
        side = np.array([mirror, 1.0, 1.0])
        return RaisedHistory(tuple(self.stretches), mirror, velocity * side, turning / self.radius * side * mirror)
