"""The contact of a tip that sticks from the first touch, with an axial force, and its end mass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.cue import Array
from cuefem.endmass.impulse_response import PULSE_STEPS, imposed_velocity_impulse
from cuefem.scene import Scene


class StickLimit(NamedTuple):
    """The limit b -> 0 of the coupled strike: the tip sticks to the ball from the first touch.

    The tip's velocity relative to the ball is K P(t) - 1 times its initial value, P the fraction of the normal impulse.
    c = (1 + 1/nu)/M, 1/kg. K = (1 + e)(1 + 1/nu + 1/Q0)/(1 + 1/Q0). T: contact time, s. e: restitution. reduced_mass,
    kg. J, kg, is the transverse impulse over U phi.
    """

    c: float
    K: float
    e: float
    T: float
    reduced_mass: float

    @classmethod
    def of(cls, scene: Scene) -> StickLimit:
        """The limit of a scene."""
        c, e = (1 + 1 / scene.ball.inertia) / scene.ball.mass, scene.tip.restitution
        K = (1 + e) * scene.reduced_mass * (c + 1 / scene.axial_mass)
        return cls(c, K, e, scene.contact_time, scene.reduced_mass)

    @property
    def normal(self) -> float:
        """The normal impulse over U, kg."""
        return (1 + self.e) * self.reduced_mass

    def normal_impulse(self, t: Array) -> Array:
        """P at times t, s: the impulse of the bilinear tip in a centre-ball impact over its total.

        Two quarter periods: (1 - cos)/(1 + e) in compression, T/(1 + e) long, then (1 + e sin)/(1 + e).
        """
        x = np.pi / 2 * (1 + self.e) * np.clip(t / self.T, 0.0, 1.0)
        unloading = np.sin((x - np.pi / 2) / (self.e or 1.0))
        return np.asarray(np.where(x < np.pi / 2, 1 - np.cos(x), 1 + self.e * unloading) / (1 + self.e))

    def transverse_impulse(self, tip: TipModes) -> float:
        """J, kg."""
        P = self.normal_impulse(self.T * np.linspace(0.0, 1.0, PULSE_STEPS + 1))
        return imposed_velocity_impulse(tip, self.T, self.K * P - 1, self.c)

    def end_mass(self, J: float) -> float:
        """The end mass of a lumped cue with the transverse impulse J, kg: (K - 1)/J = 1/m + c.

        ValueError if no end mass has this squirt: squirt is negative if the end of the cue is so light that its tip
        moves faster than the ball.
        """
        if not 0 < J < (self.K - 1) / self.c:
            most, got = (self.K - 1) / self.c / self.normal, J / self.normal
            bounds = f"squirt of a sticking tip must be in (0, {most:.4g}) times the contact's angle; got {got:.4g}"
            raise ValueError(f"end_mass: {bounds}: no end mass has it; see cuefem.lump")
        return 1 / ((self.K - 1) / J - self.c)
