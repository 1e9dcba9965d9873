"""Laws of the tip along the normal: the force over the compression, loaded and unloaded."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class TipLaw:
    """A power law (the effect PowerLawTip; exponent 1 is the base model's): F = stiffness d^exponent while loaded, N.

    Unloading follows the loading curve with its compression scaled by e^2, so that the work given back is e^2 of that
    spent; e is the restitution.
    """

    stiffness: float
    exponent: float
    restitution: float

    @classmethod
    def timed(cls, exponent: float, restitution: float, *, mass: float, speed: float, time: float) -> TipLaw:
        """The law with which a head-on blow of a reduced mass, kg, at a speed, m/s, lasts ``time``, s.

        Loading to the depth D takes D/U times `loading_time`, unloading e times that; D^(n + 1) = (n + 1) m U^2/(2 k').
        """
        depth = speed * time / ((1 + restitution) * loading_time(exponent))
        return cls((exponent + 1) * mass * speed**2 / (2 * depth ** (exponent + 1)), exponent, restitution)

    def loss(self, deepest: float) -> float:
        """Work that loading to a compression, m, took and unloading did not give back, J."""
        power = self.exponent + 1
        return (1 - self.restitution**2) * self.stiffness * deepest**power / power


def loading_time(exponent: float) -> float:
    """Time to the greatest compression, in depth over speed: the integral of 1/sqrt(1 - s^(n + 1)) over 0..1."""
    from scipy.special import gamma  # loaded when used: a scene alone needs no scipy

    power = 1 / (exponent + 1)
    return float(math.sqrt(math.pi) * gamma(1 + power) / gamma(0.5 + power))


def slowed(exponent: float, ratio: float) -> float:
    """Contact time at ``ratio`` times a speed, over that at the speed: ratio^((1 - n)/(1 + n))."""
    return float(ratio ** ((1 - exponent) / (1 + exponent)))
