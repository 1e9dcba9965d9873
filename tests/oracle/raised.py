"""The contact of a cue raised over a table: six forces, of which two pairs are frictions in a plane.

T, N, P stand for the tip's: along the surface in the plane of the cue and the ball's centre, along the normal, across
that plane; UP, ASIDE, AHEAD for the lowest point of the ball on the table. Friction is against the velocity in its
plane. The table holds the ball, lets it slide, or has let it go ("lifted").
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cuefem.contact.laws import table_axes
from tests.oracle.contact import Contact, Step, at, integral

T, N, P, UP, ASIDE, AHEAD = range(6)
PLANES = ((T, P, N), (ASIDE, AHEAD, UP))  # two directions of friction, and what presses
REST = 1e-8  # a point that slides more slowly than this part of the stroke's speed keeps its direction
ROUNDING = 1e-9  # of the contact's force, by which friction's bound may be passed


def margin(mu: float, pressing: Any, x: Any, y: Any) -> Any:
    """What is left to friction's bound; where friction is great, in units of what presses."""
    return pressing - np.hypot(x, y) / mu if mu > 1 else mu * pressing - np.hypot(x, y)


def held_back(mu: float, tiny: float, pressing: Any, x: Any, y: Any) -> Any:
    """The margin as a guard: in squares, which are smooth where all three forces vanish, as they do at parting."""
    return (mu * pressing + tiny) ** 2 - x**2 - y**2


class Raised(Contact):
    ways: tuple[Any, Any] = (np.zeros(2), np.zeros(2))

    @property
    def frictions(self) -> tuple[float, float]:
        return self.mu, self.terms["table_friction"]

    @property
    def slips(self) -> tuple[bool, bool]:
        return self.grip == "slip", self.table == "slides"

    def point(self, plane: int, x: float, y: float) -> None:
        size = math.hypot(x, y)
        if size > 0:
            ways = list(self.ways)
            ways[plane] = np.array([x, y]) / size
            self.ways = (ways[0], ways[1])

    def residual(self, s: Step) -> Any:
        F, v, g = s.F[..., 1:], s.v[..., 1:], [None] * 6
        g[N] = F[..., N, :] - self.normal(self.virtual(s.depth))[..., 1:]
        for f in (UP, ASIDE, AHEAD):
            g[f] = F[..., f, :] if self.table == "lifted" else v[..., f, :]
        for (a, b, n), mu, slips, way in zip(PLANES, self.frictions, self.slips, self.ways, strict=True):
            if not slips:
                if n == N:
                    g[a], g[b] = v[..., a, :], v[..., b, :]
                continue
            # against the velocity; past a stop, where it turns back, along it, so that all is smooth there
            x, y = (v[..., f, :] - REST * self.speed * part for f, part in zip((a, b), way, strict=True))
            size = np.sqrt(x * x + y * y + 1e-60)
            side = np.where((x * way[0] + y * way[1]).real > 0, -mu, mu) * F[..., n, :] / size
            g[a], g[b] = F[..., a, :] + side * x, F[..., b, :] + side * y
        return np.stack(g, axis=-2)

    def against(self, s: Step, plane: int) -> Any:
        """The speed at which a point slides against its friction."""
        a, b, n = PLANES[plane]
        ways = s.F[[a, b]] * np.where(s.F[n] < 0, -1.0, 1.0)
        ways = ways / (np.hypot(*ways) + 1e-300)
        ways[:, 0] = self.ways[plane]
        return -(s.v[[a, b]] * ways).sum(axis=0)

    def guards(self, s: Step) -> list[tuple[str, Any, float]]:
        tiny = max(ROUNDING * self.size, 20 * self.tolerance * self.impulse / s.length)
        speed, way = 1e-11 * self.speed, 1e-11 * self.speed * self.clock
        if self.press == "load":
            guards = [("compressed", -s.v[N], speed)]
        else:
            guards = [("apart", s.depth - self.rest, way), ("reloaded", self.deepest - s.depth, way)]
        if self.grip == "slip":
            guards += [("gripped", self.against(s, 0), speed)] if self.mu > 0 else []
        elif math.isfinite(self.mu):
            guards.append(("slipped", held_back(self.mu, max(1, self.mu) * tiny, s.F[N], s.F[T], s.F[P]), 0.0))
        if self.table == "lifted":
            return [*guards, ("landed", self.height + s.x[UP], way)]
        guards.append(("lifted", s.F[UP] + tiny, 0.0))
        of_table = self.frictions[1]
        if self.table == "held":
            bound = max(1, of_table) * tiny
            return [*guards, ("slid", held_back(of_table, bound, s.F[UP], s.F[ASIDE], s.F[AHEAD]), 0.0)]
        return [*guards, ("stopped", self.against(s, 1), speed)] if of_table > 0 else guards

    def forces_now(self, **hold: str) -> Any:
        """Of a hold; at the first touch, where there are none yet, those of a slight compression."""
        return self.forces_held(0 if self.depth > 0 else -1, **hold)

    def settle(self, grip: str) -> float:
        at_table = {"held": [UP, ASIDE, AHEAD], "slides": [UP], "lifted": []}[self.table]
        return self.stop(([] if grip == "slip" else [T, P]) + at_table)

    def rest_on_table(self) -> None:
        """How the table holds the ball, whose lowest point is at rest: held, sliding away, or not at all."""
        self.table = "held"
        F, slack = self.forces_now(), ROUNDING * self.size
        if margin(self.frictions[1], F[UP], F[ASIDE], F[AHEAD]) < -slack:
            self.table = "slides"
            self.point(1, F[ASIDE], F[AHEAD])
            F = self.forces_now()
        if F[UP] < -slack:
            self.table = "lifted"

    def grip_at_rest(self) -> str:
        self.losses["friction"] += self.settle("stick")
        F = self.forces_now(grip="stick")
        if F is None or margin(self.mu, F[N], F[T], F[P]) >= -ROUNDING * self.size:
            return "stick"
        self.point(0, F[T], F[P])
        return "slip"

    def first_grip(self, press: str) -> bool:
        v, self.grip, self.press, self.table = self.velocities(), "slip", press, "held"
        if math.hypot(v[T], v[P]) == 0:
            self.grip = self.grip_at_rest()
        elif math.isfinite(self.mu):
            self.point(0, -v[T], -v[P])
        else:
            self.losses["friction"] += self.stop([T, P, UP])
            self.grip = "stick"
        self.rest_on_table()
        return True

    def begin(self) -> None:
        if self.press != "free":
            self.losses["friction"] += self.settle(self.grip)

    def taken(self, s: Step, part: float) -> None:
        work = [float(integral(s, part, F, v)) for F, v in zip(s.F, s.v, strict=True)]
        self.losses["friction"] -= work[T] + work[P]
        self.losses["table"] -= sum(work[UP:])
        if self.table == "lifted":
            self.height += float(at(part, s.x[UP]))
        F = at(part, s.F)
        for plane, (a, b, n) in enumerate(PLANES):
            if self.slips[plane]:
                self.point(plane, *(F[[a, b]] * (-1.0 if F[n] < 0 else 1.0)))
        self.depth = float(at(part, s.depth))

    def next(self, event: str) -> bool:
        if event == "compressed":
            self.deepest, self.press = self.depth, "unload"
        elif event == "reloaded":
            self.press = "load"
        elif event == "gripped":
            self.grip = self.grip_at_rest()
        elif event == "lifted":
            self.table = "lifted"
        elif event in ("slipped", "slid"):
            F = self.forces_now()
            plane = 0 if event == "slipped" else 1
            self.point(plane, *F[list(PLANES[plane][:2])])
            self.grip, self.table = ("slip", self.table) if plane == 0 else (self.grip, "slides")
        elif event == "landed":
            self.table, self.height = "slides", 0.0
            self.losses["table"] += self.settle(self.grip)
            self.point(1, *-self.velocities()[[ASIDE, AHEAD]])
        elif event == "stopped":
            self.table = "held"
            self.losses["table"] += self.settle(self.grip)
            self.rest_on_table()
        return event != "apart"

    @property
    def impulse_on_ball(self) -> tuple[float, float]:
        """Along the table, in the directions (t, n) of a level stroke."""
        right, forward, _ = table_axes(self.model.phi, self.model.table.angle)
        s, c, velocity = math.sin(self.model.phi), math.cos(self.model.phi), self.model.ball_mass * self.ball[:3]
        return float((s * forward + c * right) @ velocity), float((c * forward - s * right) @ velocity)

    @property
    def twist(self) -> float:
        return float(table_axes(self.model.phi, self.model.table.angle)[2] @ self.ball[3:])
