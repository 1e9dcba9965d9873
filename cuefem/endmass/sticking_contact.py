"""The contact of a tip that sticks to the ball from the first touch, in the limit of small offsets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.endmass.impulse_response import step_means
from cuefem.scene import Scene


@dataclass(frozen=True)
class StickLimit:
    """The limit b -> 0 of the coupled strike: the tip sticks to the ball from the first touch.

    The tip's velocity relative to the ball is K P(t) - 1 times its initial value, P the fraction of the normal impulse.
    c = (1 + 1/nu)/M, 1/kg. K = (1 + e)(1 + 1/nu + 1/Q0)/(1 + 1/Q0). T: contact time, s. e: restitution. reduced_mass,
    kg. K and T may be arrays (offsets,). J, kg, is the transverse impulse over U phi.
    """

    c: Any
    K: Any
    e: Any
    T: Any
    reduced_mass: Any

    @classmethod
    def of(cls, scene: Scene) -> StickLimit:
        """The limit of a scene."""
        M, nu = scene.ball.mass, scene.ball.inertia
        e, axial_mass = scene.tip.restitution, scene.axial_mass
        c = (1 + 1 / nu) / M
        reduced_mass = 1 / (1 / M + 1 / axial_mass)
        return cls(c, (1 + e) * reduced_mass * (c + 1 / axial_mass), e, scene.contact_time, reduced_mass)

    def normal_impulse(self, t: Array) -> Array:
        """P at times t, s, (..., times): the impulse of the bilinear tip in a centre-ball impact over its total.

        Two quarter periods: (1 - cos)/(1 + e) in compression, T/(1 + e) long, then (1 + e sin)/(1 + e).
        """
        e, T = (np.asarray(value)[..., None] for value in (self.e, self.T))
        peak = T / (1 + e)
        x = np.pi / 2 * np.clip(t, 0.0, T) / peak
        unloaded = np.sin((x - np.pi / 2) / np.where(e > 0, e, 1.0))
        return np.asarray(np.where(x < np.pi / 2, 1 - np.cos(x), 1 + e * unloaded) / (1 + e))

    def transverse_impulse(self, step_impulse: Array, until: float) -> Any:
        """J, kg, from the impulse of a velocity step over 0..until s (`ImpulseResponse.velocity_step_impulse`).

        The contacts end by then.
        """
        u = until * np.linspace(0.0, 1.0, len(step_impulse))
        P = self.normal_impulse(np.asarray(self.T)[..., None] - u)
        swung = -(np.diff(P, axis=-1) * step_means(step_impulse)).sum(axis=-1)
        return self.K * swung - np.interp(self.T, u, step_impulse)

    def impulse(self, slope: Any) -> Any:
        """J of a strike whose squirt is ``slope`` times phi, kg."""
        return slope * (1 + self.e) * self.reduced_mass

    def slope(self, J: Any) -> Any:
        """Squirt over phi of a strike with the transverse impulse J."""
        return J / ((1 + self.e) * self.reduced_mass)

    def end_mass(self, J: Any) -> Any:
        """The end mass of a lumped cue with the transverse impulse J, kg: (K - 1)/J = 1/m + c.

        ValueError if there is none: squirt is negative if the end of the cue is so light that it runs ahead of the
        ball.
        """
        rest = np.divide(self.K - 1, J, out=np.full(np.shape(J), np.nan), where=np.asarray(J) > 0) - self.c
        for i in np.argwhere(~(rest > 0))[:1]:
            slope = float(np.broadcast_to(self.slope(J), np.shape(rest))[tuple(i)])
            raise ValueError(f"end_mass drive 'stick': no end mass has a squirt of {slope:.4g} phi; see cuefem.lump")
        return 1 / rest
