"""Force-indentation laws of the tip: a power law; of leather, normal force and tangential stiffness.

The laws of leather are series in y, the square root of the indentation: Hertz's contact of two spheres has the force
y^3 and the patch radius y, and the leather's finite height and width add a power series in the patch over the height.
F = y^3 (f0 + f1 y + ...); tangential compliance y/k_t = g0 + g1 y + ..., a half-space in series with the rest. Both are
smooth from the first touch on.
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
    """A power law (`PowerLawTip`; exponent 1 is the base model's): F = stiffness d^exponent during loading, N.

    Unloading follows the loading curve with the indentation scaled by e^2, which returns the part e^2 of the work; e is
    the restitution.
    """

    stiffness: float
    exponent: float
    restitution: float

    @classmethod
    def for_contact_time(cls, exponent: float, restitution: float, *, mass: float, speed: float, time: float) -> TipLaw:
        """The law whose central impact of a reduced mass, kg, at a speed, m/s, lasts ``time``, s.

        Loading to the depth D takes D/U times `loading_time`, unloading e times that; D^(n + 1) = (n + 1) m U^2/(2 k').
        """
        depth = speed * time / ((1 + restitution) * loading_time(exponent))
        return cls((exponent + 1) * mass * speed**2 / (2 * depth ** (exponent + 1)), exponent, restitution)

    def loss(self, deepest: float) -> float:
        """Energy dissipated by loading to an indentation, m, and unloading, J."""
        power = self.exponent + 1
        return (1 - self.restitution**2) * self.stiffness * deepest**power / power


def loading_time(exponent: float) -> float:
    """Time to the maximum indentation, in depth over speed: the integral of 1/sqrt(1 - s^(n + 1)) over 0..1."""
    from scipy.special import gamma  # loaded when used: a scene alone needs no scipy

    power = 1 / (exponent + 1)
    return float(math.sqrt(math.pi) * gamma(1 + power) / gamma(0.5 + power))


def contact_time_ratio(exponent: float, ratio: float) -> float:
    """Contact time at ``ratio`` times a speed, over that at the speed: ratio^((1 - n)/(1 + n))."""
    return float(ratio ** ((1 - exponent) / (1 + exponent)))


# Terms of the two series.
TERMS = 7
TINY = 1e-300  # stands for nothing in a divisor
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_ANGLES = (1 + _GAUSS) * math.pi / 4


class IndentationOutOfRange(ValueError):
    """A leather tip is indented beyond the range of its law."""


class Curves(NamedTuple):
    """Computed curves of a leather tip, (n,) each, ascending, without zero.

    depth, force: of a central impact, m and N. shear: tangential stiffness of the patch at that depth, N/m.
    """

    depth: Array
    force: Array
    shear: Array


@dataclass(frozen=True)
class LeatherLaw:
    """The law of leather: series of F and k_t in the root of the indentation, restitution e, and range of validity, m.

    Unloading follows the loading curve with the indentation scaled by e^2, which returns the part e^2 of the work. The
    virtual indentation is that of the loading curve at the same force.
    """

    force_terms: tuple[float, ...]
    compliance_terms: tuple[float, ...]
    restitution: float
    depth_limit: float

    def __post_init__(self) -> None:
        if len(self.force_terms) != len(self.compliance_terms):  # the kernel reads as many of one as of the other
            counts = f"{len(self.force_terms)} and {len(self.compliance_terms)}"
            raise ValueError(f"LeatherLaw takes as many force_terms as compliance_terms; got {counts}")

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
        terms[0, 2:], terms[1, : len(self.compliance_terms)] = self.force_terms, self.compliance_terms
        return terms

    def _powers(self, depth: Array) -> Array:
        """Powers of y, 1 and up, at virtual compressions (n,): (powers, n)."""
        powers = np.empty((self._terms.shape[1], *np.shape(depth)))
        powers[:] = np.sqrt(np.maximum(depth, 0.0))
        return np.asarray(np.multiply.accumulate(powers, axis=0, out=powers))

    def at(self, depth: Array) -> tuple[Array, Array]:
        """(F, k_t), N and N/m, at virtual indentations, m, (n,); zero where negative."""
        powers = self._powers(depth)
        force, give = self._terms @ powers
        return force, powers[1] / (give + TINY)

    def slope(self, depth: Array) -> Array:
        """Slope of F over the virtual indentation, N/m, (n,)."""
        powers = self._powers(depth)
        force = self._terms[0] * np.arange(1, len(powers) + 1) @ powers  # y times what it is over y
        by = 2 * powers[1]
        return np.divide(force, by, out=np.zeros_like(force), where=by > 0)

    def work(self, depth: Any) -> Any:
        """Work of loading to an indentation, J."""
        y = np.sqrt(np.maximum(depth, 0.0))
        return sum(2 / (5 + k) * term * y ** (5 + k) for k, term in enumerate(self.force_terms))

    def loss(self, deepest: float) -> float:
        """Energy dissipated by loading to ``deepest``, m, and unloading, J."""
        return (1 - self.restitution**2) * float(self.work(deepest))

    def central_impact(self, mass: Any, speed: Any) -> tuple[Any, Any]:
        """(maximum indentation, m, time to it, s) of a central impact of a reduced mass, kg, at a speed, m/s."""
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
        """Indentation of this loading work, by Newton's method in logarithms, where the law is nearly straight."""
        depth = np.full(energy.shape, self.depth_limit)
        for _ in range(60):
            work = self.work(depth)
            step = np.log(work / energy) * work / (depth * self.at(depth.ravel())[0].reshape(depth.shape))
            depth = depth * np.exp(-np.clip(step, -1.0, 1.0))
            if np.all(np.abs(step) < 1e-14):
                break
        return depth

    def too_deep(self, depth: float) -> IndentationOutOfRange:
        """The error of an indentation beyond the law's range."""
        return IndentationOutOfRange(
            f"the tip's leather is indented by {1e3 * depth:.3g} mm, beyond the range of its law "
            f"({1e3 * self.depth_limit:.3g} mm): raise LeatherTip.height or E, or lower Stroke.speed"
        )


def _series(y: Array, values: Array, *, lowest: int) -> tuple[float, ...]:
    """Coefficients of y^lowest and up by least squares of relative differences."""
    scale = float(y[-1])
    powers = lowest + np.arange(min(TERMS, len(y)))
    rows = (y[:, None] / scale) ** powers / values[:, None]
    coefficients = np.linalg.lstsq(rows, np.ones(len(y)), rcond=None)[0] / scale**powers
    return tuple(float(term) for term in coefficients)
