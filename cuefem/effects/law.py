"""Laws of the tip along the normal: the force over the compression, loaded and unloaded."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol


class NormalLaw(Protocol):
    """What a contact asks of a nonlinear tip: forces, N, over the compression, m; deepest: the last greatest one, m."""

    @property
    def restitution(self) -> float:
        """Energetic coefficient of restitution."""

    def load(self, compression: float) -> float:
        """Force while the tip is pressed deeper than ever before, N; it passes zero smoothly."""

    def unload(self, compression: float, deepest: float) -> float:
        """Force on the way back from ``deepest``, N."""

    def rest(self, deepest: float) -> float:
        """Compression at which the force has gone on the way back from ``deepest``, m."""

    def slope(self, compression: float, deepest: float | None = None) -> float:
        """Stiffness, N/m: while loaded, or on the way back from ``deepest``."""

    def loss(self, deepest: float) -> float:
        """Work that loading to ``deepest`` took and unloading does not give back, J."""


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

    def load(self, compression: float) -> float:
        """Force on the loading curve, N; odd, so that it passes zero smoothly where the tip lets go."""
        return self.stiffness * math.copysign(abs(compression) ** self.exponent, compression)

    def rest(self, deepest: float) -> float:
        """Compression, m, at which a tip unloaded from ``deepest`` has lost its force."""
        return (1 - self.restitution**2) * deepest

    def unload(self, compression: float, deepest: float) -> float:
        """Force on the curve that ends at ``deepest``, N: the loading curve, its compression scaled by e^2."""
        return self.load((compression - self.rest(deepest)) / self.restitution**2)

    def slope(self, compression: float, deepest: float | None = None) -> float:
        """Stiffness, N/m: on the loading curve, or on the way back from ``deepest``."""
        if deepest is None:
            return self.stiffness * self.exponent * abs(compression) ** (self.exponent - 1)
        squared = self.restitution**2
        return self.slope((compression - self.rest(deepest)) / squared) / squared

    def loss(self, deepest: float) -> float:
        """Work that loading to ``deepest`` took and unloading did not give back, J."""
        return (1 - self.restitution**2) * self.load(deepest) * deepest / (self.exponent + 1)


def loading_time(exponent: float) -> float:
    """Time to the greatest compression, in depth over speed: the integral of 1/sqrt(1 - s^(n + 1)) over 0..1."""
    from scipy.special import gamma  # loaded when used: a scene alone needs no scipy

    power = 1 / (exponent + 1)
    return float(math.sqrt(math.pi) * gamma(1 + power) / gamma(0.5 + power))


def slowed(exponent: float, ratio: float) -> float:
    """Contact time at ``ratio`` times a speed, over that at the speed: ratio^((1 - n)/(1 + n))."""
    return float(ratio ** ((1 - exponent) / (1 + exponent)))
