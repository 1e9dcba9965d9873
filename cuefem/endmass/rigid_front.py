"""The front of a shaft as a rigid body: the length that has an effective end mass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.cue import Array, Cue

SECTIONS = 2000  # along the shaft; the relative error of the end mass of a tenth of it is about 1e-5


class RigidFront(NamedTuple):
    """The first x m of a shaft as a rigid body, for every x: mass and effective end mass, kg.

    Struck across at its end, a rigid body has 1/m_e = 1/m + xc^2/I about its centre of mass, or, with the moments
    m, S and J about its end, m_e = m - S^2/J.
    """

    x: Array
    mass: Array
    end_mass: Array

    @classmethod
    def of(cls, cue: Cue) -> RigidFront:
        """Of the drawn segments, with rotary inertia, by the trapezoidal rule."""
        x = np.linspace(0.0, cue.length, SECTIONS + 1)
        section = cue.section(x)
        densities = np.array([section.rhoA, section.rhoA * x, section.rhoA * x**2 + section.rhoI])
        steps = (densities[:, 1:] + densities[:, :-1]) / 2 * np.diff(x)
        mass, first_moment, second_moment = np.cumsum(steps, axis=1)
        return cls(x[1:], mass, mass - first_moment**2 / second_moment)

    def length_of(self, end_mass: float) -> float | None:
        """The length with this end mass, m; None if the whole shaft has less."""
        return None if end_mass > self.end_mass[-1] else float(np.interp(end_mass, self.end_mass, self.x))

    def mass_ratio(self, length: float) -> float | None:
        """Mass over end mass of the first ``length`` m, [Kim]'s (1 + nu_c)/nu_c; None if the shaft is shorter."""
        return None if length > self.x[-1] else float(np.interp(length, self.x, self.mass / self.end_mass))
