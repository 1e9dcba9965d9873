"""Laws of the tip: a power law along the normal; of leather, the force and the stiffness along the surface.

Those of leather are fitted in y, the root of the compression: Hertz's contact of two spheres has the force y^3 and the
patch y, and what the leather's finite height and width add is a power series in the patch over the height: F = y^3 (f0
+ f1 y + ...), and for the give along the surface, that of a half-space in series with the rest, y/k_t = g0 + g1 y +
... Both are smooth from the first touch on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import Array


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
    """Time to the maximum indentation, in depth over speed: the integral of 1/sqrt(1 - s^(n + 1)) over 0..1."""
    from scipy.special import gamma  # loaded when used: a scene alone needs no scipy

    power = 1 / (exponent + 1)
    return float(math.sqrt(math.pi) * gamma(1 + power) / gamma(0.5 + power))


def slowed(exponent: float, ratio: float) -> float:
    """Contact time at ``ratio`` times a speed, over that at the speed: ratio^((1 - n)/(1 + n))."""
    return float(ratio ** ((1 - exponent) / (1 + exponent)))


# Terms of the two series.
TERMS = 7
TINY = 1e-300  # stands for nothing in a divisor
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_ANGLES = (1 + _GAUSS) * math.pi / 4


class TooDeep(ValueError):
    """A tip of leather is compressed further than its law is known: there is no contact to speak of."""


class Curves(NamedTuple):
    """What a tip of leather gives, (n,) each, ascending, without zero.

    depth, force: of a head-on blow, m and N. shear: stiffness along the surface, N/m, of the patch that it then has.
    """

    depth: Array
    force: Array
    shear: Array


@dataclass(frozen=True)
class LeatherLaw:
    """A tip's law: the series of F and k_t in the root of the compression, the restitution e, and how deep they hold.

    Unloading follows the loading curve with its compression scaled by e^2, so that the work given back is e^2 of that
    spent. The compression that the loading curve has at the same force is called the virtual one.
    """

    force_terms: tuple[float, ...]
    give_terms: tuple[float, ...]
    restitution: float
    depth_limit: float

    def __post_init__(self) -> None:
        if len(self.force_terms) != len(self.give_terms):  # the kernel reads as many of one as of the other
            counts = f"{len(self.force_terms)} and {len(self.give_terms)}"
            raise ValueError(f"LeatherLaw takes as many force_terms as give_terms; got {counts}")

    @classmethod
    def fitted(cls, curves: Curves, restitution: float) -> LeatherLaw:
        """The law through the curves, by least squares of relative differences."""
        root = np.sqrt(curves.depth)
        force, give = _series(root, curves.force, lowest=3), _series(root, root / curves.shear, lowest=0)
        return cls(force, give, restitution, float(curves.depth[-1]))

    @cached_property
    def _terms(self) -> Array:
        """F and y^2/k_t in the powers of y, 1 and up: (2, powers)."""
        terms = np.zeros((2, 2 + len(self.force_terms)))
        terms[0, 2:], terms[1, : len(self.give_terms)] = self.force_terms, self.give_terms
        return terms

    def _powers(self, depth: Array) -> Array:
        """Powers of y, 1 and up, at virtual compressions (n,): (powers, n)."""
        powers = np.empty((self._terms.shape[1], *np.shape(depth)))
        powers[:] = np.sqrt(np.maximum(depth, 0.0))
        return np.asarray(np.multiply.accumulate(powers, axis=0, out=powers))

    def at(self, depth: Array) -> tuple[Array, Array]:
        """(F, k_t), N and N/m, at virtual compressions, m, (n,): zero where these are negative."""
        powers = self._powers(depth)
        force, give = self._terms @ powers
        return force, powers[1] / (give + TINY)

    def slope(self, depth: Array) -> Array:
        """Slope of F over the virtual compression, N/m, (n,)."""
        powers = self._powers(depth)
        force = self._terms[0] * np.arange(1, len(powers) + 1) @ powers  # y times what it is over y
        by = 2 * powers[1]
        return np.divide(force, by, out=np.zeros_like(force), where=by > 0)

    def work(self, depth: Any) -> Any:
        """Work that loading to a compression takes, J."""
        y = np.sqrt(np.maximum(depth, 0.0))
        return sum(2 / (5 + k) * term * y ** (5 + k) for k, term in enumerate(self.force_terms))

    def loss(self, deepest: float) -> float:
        """Work that loading to ``deepest`` took and unloading did not give back, J."""
        return (1 - self.restitution**2) * float(self.work(deepest))

    def blow(self, mass: Any, speed: Any) -> tuple[Any, Any]:
        """(maximum indentation, m, time to it, s) of a head-on blow of a reduced mass, kg, at a speed, m/s."""
        mass, speed = np.broadcast_arrays(np.asarray(mass, float), np.asarray(speed, float))
        energy = mass * speed**2 / 2
        deepest = self._deepest(energy)
        if np.max(deepest) > self.depth_limit:
            raise self.too_deep(float(np.max(deepest)))
        cosine, sine = np.cos(_ANGLES), np.sin(_ANGLES)
        left = self.work(deepest)[..., None] - self.work(deepest[..., None] * cosine**2)
        rates = 2 * deepest[..., None] * cosine * sine / np.sqrt(2 * left / mass[..., None])
        time = rates @ _WEIGHTS * math.pi / 4
        return deepest[()], time[()]

    def _deepest(self, energy: Array) -> Array:
        """The compression that takes this work, by Newton's method in logarithms, where the law is nearly straight."""
        depth = np.full(energy.shape, self.depth_limit)
        for _ in range(60):
            work = self.work(depth)
            step = np.log(work / energy) * work / (depth * self.at(depth.ravel())[0].reshape(depth.shape))
            depth = depth * np.exp(-np.clip(step, -1.0, 1.0))
            if np.all(np.abs(step) < 1e-14):
                break
        return depth

    def too_deep(self, depth: float) -> TooDeep:
        """The error of a tip that is compressed further than its curves go."""
        return TooDeep(
            f"the tip's leather is compressed by {1e3 * depth:.3g} mm, further than its law is known "
            f"({1e3 * self.depth_limit:.3g} mm): give LeatherTip a larger height or E, or Stroke a lower speed"
        )


def _series(y: Array, values: Array, *, lowest: int) -> tuple[float, ...]:
    """Coefficients of y^lowest and up that reach the values with the least relative differences."""
    scale = float(y[-1])
    powers = lowest + np.arange(min(TERMS, len(y)))
    rows = (y[:, None] / scale) ** powers / values[:, None]
    coefficients = np.linalg.lstsq(rows, np.ones(len(y)), rcond=None)[0] / scale**powers
    return tuple(float(term) for term in coefficients)
