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
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyder, polyval

from cuefem.cue import Array
from cuefem.quantity.display_units import with_unit


@dataclass(frozen=True)
class TipLaw:
    """A power law (`PowerLawTip`; exponent 1 is the base model's): F = stiffness d^exponent during loading, N.

    Unloading follows the loading curve with the indentation scaled by e^2, which returns the part e^2 of the work; e is
    the restitution. compliance: of a tangential spring, m/N; 0 for a rigid patch. The patch sticks or slips as a whole.
    """

    stiffness: float
    exponent: float
    restitution: float
    compliance: float = 0.0
    slips_in_parts: ClassVar[bool] = False

    @property
    def is_rigid(self) -> bool:
        """Whether the patch has no tangential compliance."""
        return self.compliance == 0

    @classmethod
    def for_contact_time(cls, exponent: float, restitution: float, *, mass: float, speed: float, time: float) -> TipLaw:
        """The law whose central impact of a reduced mass, kg, at a speed, m/s, lasts ``time``, s.

        Loading to the depth D takes D/U times `loading_time`, unloading e times that; D^(n + 1) = (n + 1) m U^2/(2 k').
        """
        depth = speed * time / ((1 + restitution) * loading_time(exponent))
        return cls((exponent + 1) * mass * speed**2 / (2 * depth ** (exponent + 1)), exponent, restitution)

    def loss(self, max_indentation: float) -> float:
        """Energy dissipated by loading to an indentation, m, and unloading, J."""
        power = self.exponent + 1
        return (1 - self.restitution**2) * self.stiffness * max_indentation**power / power


def loading_time(exponent: float) -> float:
    """Time to the maximum indentation, in depth over speed: the integral of 1/sqrt(1 - s^(n + 1)) over 0..1."""
    power = 1 / (exponent + 1)
    return float(math.sqrt(math.pi) * math.gamma(1 + power) / math.gamma(0.5 + power))


def contact_time_ratio(exponent: float, ratio: float) -> float:
    """Contact time at ``ratio`` times a speed, over that at the speed: ratio^((1 - n)/(1 + n))."""
    return float(ratio ** ((1 - exponent) / (1 + exponent)))


TERMS = 7  # of the two series
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_ANGLES = (1 + _GAUSS) * math.pi / 4


class IndentationOutOfRange(ValueError):
    """The indentation of a leather tip exceeds the valid range of its law."""


@dataclass(frozen=True)
class LeatherLaw:
    """The law of leather: series of F and k_t in the root of the indentation, restitution e, and range of validity, m.

    surface_restitution: square root of the part of the tangential strain energy that the leather returns. The patch
    slips annulus by annulus.
    Unloading follows the loading curve with the indentation scaled by e^2, which returns the part e^2 of the work. The
    virtual indentation is that of the loading curve at the same force.
    """

    force_terms: tuple[float, ...]
    compliance_terms: tuple[float, ...]
    restitution: float
    indentation_limit: float
    surface_restitution: float
    slips_in_parts: ClassVar[bool] = True
    is_rigid: ClassVar[bool] = False

    @cached_property
    def _force(self) -> Polynomial:
        """F in y, the root of the virtual indentation."""
        return Polynomial([0, 0, 0, *self.force_terms])

    def at(self, depth: Any) -> tuple[Any, Any]:
        """(F, k_t), N and N/m, at virtual indentations, m; zero where negative."""
        y = np.sqrt(np.maximum(depth, 0.0))
        return self._force(y), y / polyval(y, self.compliance_terms)

    def slope(self, depth: Any) -> Any:
        """Slope of F over the virtual indentation, N/m: dF/dy over 2 y."""
        return polyval(np.sqrt(np.maximum(depth, 0.0)), polyder(self._force.coef)[1:]) / 2

    @cached_property
    def _work(self) -> Polynomial:
        return Polynomial([0, *2 * self._force.coef]).integ()

    def work(self, depth: Any) -> Any:
        """Work of loading to an indentation, J: the integral of 2 y F."""
        return self._work(np.sqrt(np.maximum(depth, 0.0)))

    def loss(self, max_indentation: float) -> float:
        """Energy dissipated by loading to ``max_indentation``, m, and unloading, J."""
        return (1 - self.restitution**2) * float(self.work(max_indentation))

    def central_impact(self, mass: float, speed: float) -> tuple[float, float]:
        """(maximum indentation, m, time to it, s) of a central impact of a reduced mass, kg, at a speed, m/s."""
        energy, max_indentation = mass * speed**2 / 2, self.indentation_limit
        for _ in range(60):  # Newton's method in logarithms, where the law is nearly straight
            work = float(self.work(max_indentation))
            step = math.log(work / energy) * work / (max_indentation * float(self.at(max_indentation)[0]))
            max_indentation *= math.exp(-min(max(step, -1.0), 1.0))
            if abs(step) < 1e-12:
                break
        if max_indentation > self.indentation_limit:
            raise self.out_of_range(max_indentation)
        cosine, sine = np.cos(_ANGLES), np.sin(_ANGLES)
        kinetic_energy = self.work(max_indentation) - self.work(max_indentation * cosine**2)
        slowness = 2 * max_indentation * cosine * sine / np.sqrt(2 * kinetic_energy / mass)
        return max_indentation, float(slowness @ _WEIGHTS) * math.pi / 4

    def out_of_range(self, depth: float) -> IndentationOutOfRange:
        """The error of an indentation beyond the law's range."""
        return IndentationOutOfRange(
            f"tip too soft or stroke too fast: indentation {with_unit(depth, 'm', 3)} exceeds the valid range "
            f"({with_unit(self.indentation_limit, 'm', 3)}); raise height or E of the leather, or lower the speed"
        )


def series_terms(y: Array, values: Array, *, lowest: int) -> tuple[float, ...]:
    """Coefficients of y^lowest and up, through values at ascending y > 0, by least squares of relative differences."""
    scale = float(y[-1])
    powers = lowest + np.arange(min(TERMS, len(y)))
    rows = (y[:, None] / scale) ** powers / values[:, None]
    coefficients = np.linalg.lstsq(rows, np.ones(len(y)), rcond=None)[0] / scale**powers
    return tuple(float(term) for term in coefficients)
