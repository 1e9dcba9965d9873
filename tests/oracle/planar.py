"""The contact in the plane of the cue and the ball's centre: forces 0 along the surface (t) and 1 along the normal (n).

F_n follows a curve over the compression; on the way back from the deepest point D that curve is scaled by e^2, from the
rest (1 - e^2) D on. For e = 0 the tip is rigid there, v_n = 0. Along the surface the contact slips, F_t = side mu F_n,
or it holds: v_t = 0, or by a spring, F_t = -integral of v_t/c.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cuefem.contact.laws import RIGID_PATCH, RINGED_PATCH, SPRING_PATCH
from tests.oracle.contact import WAVES, WITH_START, Contact, Step, at, integral, slope

SIDE = {"slip": 1.0, "slip back": -1.0}


class Planar(Contact):
    kept: float = 0.0

    @property
    def patch(self) -> int:
        return self.model.patch

    def stiffness(self, depth: Any) -> Any:
        """Of leather's patch along the surface, at a virtual compression."""
        root = np.sqrt(np.where(np.real(depth) > 0, depth, 0.0))
        return root / np.polynomial.polynomial.polyval(root, self.model.arrays["give_terms"])

    def residual(self, s: Step) -> Any:
        normal = s.v[..., 1, 1:]
        if self.press != "rigid":
            normal = s.F[..., 1, 1:] - self.normal(self.virtual(s.depth))[..., 1:]
        return np.stack([self.along(s), normal], axis=-2)

    def along(self, s: Step) -> Any:
        F, v, x = s.F[..., 0, 1:], s.v[..., 0, :], s.x[..., 0, 1:]
        if self.grip in SIDE:
            return F - SIDE[self.grip] * self.mu * s.F[..., 1, 1:]
        if self.patch == RIGID_PATCH:
            return v[..., 1:]
        return F - self.shear + x / self.terms["compliance"]

    def sliding(self, s: Step) -> Any:
        """The velocity at which a slipping patch slides on the ball: v_t, and what its spring's force changes by."""
        side = SIDE[self.grip] * self.mu
        if self.patch == RIGID_PATCH:
            return s.v[0]
        if self.press == "rigid":
            waves = np.polynomial.Legendre(WAVES @ s.F[0], [0, 1])
            return s.v[0] + self.terms["compliance"] * waves.deriv()(WITH_START) / s.length
        depth = self.virtual(s.depth)
        per = self.terms["compliance"] * slope(self.normal, depth)
        return s.v[0] - side * per * s.v[1] / self.give

    def stored(self) -> float:
        """Energy that the patch holds."""
        if self.patch == SPRING_PATCH:
            return self.terms["compliance"] * self.shear**2 / 2
        return 0.0

    def guards(self, s: Step) -> list[tuple[str, Any, float]]:
        near = 0.0 if self.linear else 1e-10
        speed, way = near * self.speed, near * self.speed * self.clock
        force = 0.0 if self.linear else max(10 * near * self.size, 20 * self.tolerance * self.impulse / s.length)
        if self.press == "free":
            return [("touched", self.rest + 1e-10 * self.speed * self.clock - s.depth, 0.0)]
        if self.press == "load":
            guards = [("compressed", -s.v[1], speed)]
        elif self.press == "rigid":
            guards = [("apart", s.F[1], force), ("reloaded", self.peak - s.F[1], force)]
        else:
            guards = [("apart", s.depth - self.rest, way), ("reloaded", self.deepest - s.depth, way)]
        if self.patch == RINGED_PATCH:
            return guards
        if self.grip in SIDE:
            guards.append(("gripped", -SIDE[self.grip] * self.sliding(s), speed * self.model.across))
        elif math.isfinite(self.mu):
            bound = self.mu * s.F[1] + 1e-12 * self.size
            guards += [("slip", bound - s.F[0], force), ("slip back", bound + s.F[0], force)]
        return guards

    def first_grip(self, press: str) -> bool:
        """A patch grips at once if its spring's force grows more slowly than friction's bound; a rigid one slips.

        Endless friction begins with a blow, which may throw the two apart.
        """
        v, self.parted, self.grip, self.press = self.velocities(), False, "stick", press
        if v[0] == 0 or self.patch == RINGED_PATCH:
            return True
        side = "slip" if v[0] < 0 else "slip back"
        if math.isfinite(self.mu):
            ratio = self.terms.get("first_ratio", math.inf) * self.give
            if self.patch == RIGID_PATCH or abs(ratio * v[0]) > -self.mu * v[1]:
                self.grip = side
            return True
        if self.patch != RIGID_PATCH:
            return True
        B = self.inverse_mass()
        impulse = -v[0] / B[0, 0]
        if v[1] + B[1, 0] * impulse > 0:
            most = (1 + self.e) * abs(v[1] / B[1, 0])
            impulse, self.parted = math.copysign(min(abs(impulse), most), impulse), True
        self.losses["friction"] += self.push(np.array([impulse, 0.0]))
        self.phases.append(("blow", "load", self.time, self.time))
        return not self.parted

    def settle(self) -> None:
        held = [0] if self.grip == "stick" and self.patch == RIGID_PATCH else []
        self.stop(held + ([1] if self.press == "rigid" else []))

    def begin(self) -> None:
        """A patch that begins to slide has friction's force, wherever its spring was; one that is let go has none."""
        if self.press == "free":
            self.press = "unload"
            self.losses["shear"] += self.stored()
            self.press, self.shear = "free", 0.0
            return
        self.settle()
        if self.grip not in SIDE or self.patch != SPRING_PATCH:
            return
        before = self.stored()
        rigid = self.press == "rigid"
        normal = self.forces_held()[1] if rigid else self.normal(self.virtual(self.depth))
        self.shear = SIDE[self.grip] * self.mu * float(normal)
        self.losses["friction"] += before - self.stored()

    def taken(self, s: Step, part: float) -> None:
        """The compression, the spring's force, and what was lost along the surface."""
        if self.press == "free":
            self.depth = float(at(part, s.depth))
            return
        missing = self.stored() - integral(s, part, s.F[0], s.v[0])
        slips = self.grip in SIDE
        self.shear, self.depth = self.shear_after(s, part), float(at(part, s.depth))
        missing -= self.stored()
        if self.patch == RINGED_PATCH and not math.isfinite(self.mu):
            self.losses["shear"] += missing
        elif self.patch == RINGED_PATCH:
            self.losses["friction"] += missing - self.kept
            self.losses["shear"] += self.kept
        elif slips:
            self.losses["friction"] += missing

    def shear_after(self, s: Step, part: float) -> float:
        return float(at(part, s.F[0]))

    def pressed_together(self) -> bool:
        """Whether a growing tip force drives ball and tip apart, which a rigid tip needs."""
        B = self.inverse_mass()
        return self.grip == "stick" or B[1, 1] + SIDE[self.grip] * self.mu * B[1, 0] > 0

    def grip_at_rest(self) -> str:
        """Stick where friction can hold the contact, else the way it starts to slip."""
        self.grip = "stick"
        if self.patch != RIGID_PATCH or not math.isfinite(self.mu):
            return "stick"
        self.settle()
        F = self.forces_held()
        if F is None or abs(F[0]) <= self.mu * F[1] + 1e-12 * self.size:
            return "stick"
        return "slip" if F[0] > 0 else "slip back"

    def next(self, event: str) -> bool:
        """Whether the contact goes on after an event, and in which hold."""
        if event == "apart":
            return False
        if event == "compressed":
            self.deepest, self.peak = self.depth, float(self.normal(self.depth))
            self.press = "unload" if self.e > 0 else "rigid"
            if self.e > 0:
                return True
            self.settle()  # a dead tip pushes on only as far as the cue presses against the ball
            F = self.forces_held() if self.pressed_together() else None
            return F is not None and F[1] > 1e-8 * self.size
        if event == "reloaded":
            self.press = "load"
            return True
        self.grip = self.grip_at_rest() if event == "gripped" else event
        return self.press != "rigid" or self.pressed_together()
