"""The contact of a tip that sticks to the ball from the first touch, in the limit of small offsets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.endmass.impulse_response import means
from cuefem.quantity.fields import scalar
from cuefem.scene import Scene


@dataclass(frozen=True)
class StickLimit:
    """The limit b -> 0 of the coupled strike: the tip sticks to the ball from the first touch.

    The tip's velocity against the ball is K P(t) - 1 times what it was, P the part of the normal impulse given so far.
    c = (1 + 1/nu)/M, 1/kg. K = (1 + e)(1 + 1/nu + 1/Q0)/(1 + 1/Q0). T: contact time, s. e: restitution. head_on_mass,
    kg. All may be stacks. J, kg, is the transverse impulse over U phi.
    """

    c: Any
    K: Any
    e: Any
    T: Any
    head_on_mass: Any

    @classmethod
    def of(cls, scene: Scene, axial_mass: Any = None) -> StickLimit:
        """The limit of a scene; axial_mass, kg: of other cues in the scene's place."""
        M, nu = scalar("Ball.mass", scene.ball.mass), scalar("Ball.inertia", scene.ball.inertia)
        e = scalar("Tip.restitution", scene.tip.restitution)
        axial_mass = scene.axial_mass if axial_mass is None else axial_mass
        return cls.law(M, nu, e, scene.contact_time, axial_mass)

    @classmethod
    def of_each(cls, scenes: Sequence[Scene], axial_mass: Array) -> StickLimit:
        """The stack of the limits of scenes with cues of ``axial_mass`` kg, (scenes,)."""
        limits = [cls.of(scene, m) for scene, m in zip(scenes, axial_mass, strict=True)]
        return cls(*(np.array([getattr(limit, part.name) for limit in limits]) for part in fields(cls)))

    @classmethod
    def law(cls, ball_mass: Any, inertia: Any, restitution: Any, contact_time: Any, axial_mass: Any) -> StickLimit:
        """The limit from numbers in kg and s, or from stacks of them that broadcast: thousands of contacts at once."""
        c = (1 + 1 / inertia) / ball_mass
        head_on_mass = 1 / (1 / ball_mass + 1 / axial_mass)
        K = (1 + restitution) * head_on_mass * (c + 1 / axial_mass)
        return cls(c, K, restitution, contact_time, head_on_mass)

    def __getitem__(self, part: slice) -> StickLimit:
        """A part of a stack; a field that is one number holds for all."""
        values = (getattr(self, each.name) for each in fields(self))
        return StickLimit(*(value[part] if np.ndim(value) else value for value in values))

    def normal_impulse(self, t: Array) -> Array:
        """P at times t, s, (..., times): the head-on impulse of the bilinear tip over its total.

        It is two quarter periods: (1 - cos)/(1 + e) while the tip is loaded, T/(1 + e) long, then (1 + e sin)/(1 + e).
        """
        e, T = (np.asarray(value)[..., None] for value in (self.e, self.T))
        peak = T / (1 + e)
        x = np.pi / 2 * np.clip(t, 0.0, T) / peak
        unloaded = np.sin((x - np.pi / 2) / np.where(e > 0, e, 1.0))
        return np.asarray(np.where(x < np.pi / 2, 1 - np.cos(x), 1 + e * unloaded) / (1 + e))

    def transverse_impulse(self, held: Array, until: Any) -> Any:
        """J, kg, of the tip that takes ``held``, over 0..until s (`ImpulseResponse.held`), to move at 1 m/s.

        One cue in contacts that end by then; or a stack of cues, each in its own contact, which ends then.
        """
        u = np.asarray(until)[..., None] * np.linspace(0.0, 1.0, held.shape[-1])
        given = self.normal_impulse(np.asarray(self.T)[..., None] - u)
        swung = -(np.diff(given, axis=-1) * means(held)).sum(axis=-1)
        return self.K * swung - (held[..., -1] if held.ndim > 1 else np.interp(self.T, u, held))

    def impulse(self, slope: Any) -> Any:
        """J of a strike whose squirt is ``slope`` times phi, kg."""
        return slope * (1 + self.e) * self.head_on_mass

    def slope(self, J: Any) -> Any:
        """Squirt over phi of a strike with the transverse impulse J."""
        return J / ((1 + self.e) * self.head_on_mass)

    def end_mass(self, J: Any) -> Any:
        """The end mass of a lumped cue that takes the transverse impulse J, kg: (K - 1)/J = 1/m + c.

        ValueError, with the reason of `stick_reason`, if no end mass does.
        """
        masses = self.end_masses(J)
        for i in np.argwhere(np.isnan(masses))[:1]:
            slope = float(np.broadcast_to(self.slope(J), np.shape(masses))[tuple(i)])
            raise ValueError(f"end_mass drive 'stick': {stick_reason(slope)}; see cuefem.lump")
        return masses

    def end_masses(self, J: Any) -> Any:
        """As `end_mass`, for a stack: nan where no end mass gives J; `stick_reason` then says why."""
        rest = np.divide(self.K - 1, J, out=np.full(np.shape(J), np.nan), where=np.asarray(J) > 0) - self.c
        masses = np.divide(1.0, rest, out=np.full(np.shape(rest), np.nan), where=rest > 0)
        return masses if np.ndim(masses) else masses[()]


def stick_reason(slope: float) -> str:
    """The reason why no end mass has this squirt over phi."""
    if not np.isfinite(slope):
        return "the squirt is not a number"
    if slope < 0:
        return f"the squirt is {slope:.4g} times phi, below that of any end mass: so light a cue runs ahead of the ball"
    if slope == 0:
        return "there is no squirt, which asks for an end mass of 0"
    return f"the squirt is {slope:.4g} times phi, larger than that of any end mass"
