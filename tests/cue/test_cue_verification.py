"""The cue: section properties, masses and shear coefficients against exact values (verification)."""

import numpy as np
import pytest

from cuefem import Cue, LumpedCue, Material, Segment
from cuefem.cue.geometry import shear_coefficient
from tests.helpers.cues import CARBON, FAMILY, FOAM, LEATHER, MAPLE, soft_tip

POINTS, WEIGHTS = (half / 2 for half in np.polynomial.legendre.leggauss(8))


def integral(cue: Cue, property_: str, power: int = 0) -> float:
    """The integral of a section property times x^power over the cue, by Gauss quadrature in every segment."""
    total = 0.0
    for segment, start in zip(cue.segments, cue.nodes, strict=False):
        s = segment.length * (POINTS + 0.5)
        total += segment.length * WEIGHTS @ (getattr(segment.section(s), property_) * (start + s) ** power)
    return total


@pytest.mark.parametrize("name", FAMILY)
def test_mass_and_balance_point_equal_quadrature(name: str) -> None:
    cue = FAMILY[name]
    np.testing.assert_allclose(cue.shaft_mass, integral(cue, "rhoA"), rtol=1e-13)
    np.testing.assert_allclose(cue.balance_point, integral(cue, "rhoA", 1) / cue.shaft_mass, rtol=1e-13)
    np.testing.assert_allclose(cue.mass, cue.shaft_mass + cue.body_mass, rtol=1e-15)


def test_section_tapered_tube_with_core_equals_closed_form() -> None:
    """At 1/4 of the segment: radii 5.5 and 3.5 mm; shell and core add, each with its own constants."""
    s = Segment(0.4, 0.010, 0.014, CARBON, 0.006, 0.010, core=FOAM).section(0.1)
    outer, inner = 0.0055, 0.0035
    shell, disc = np.pi * (outer**2 - inner**2), np.pi * inner**2
    second_moment, core_moment = np.pi / 4 * (outer**4 - inner**4), np.pi / 4 * inner**4
    shear = shear_coefficient(CARBON.effective_poisson_ratio, inner / outer) * CARBON.G * shell
    core_shear = shear_coefficient(FOAM.effective_poisson_ratio) * FOAM.G * disc
    expected = [
        CARBON.E * shell + FOAM.E * disc,
        CARBON.E * second_moment + FOAM.E * core_moment,
        shear + core_shear,
        CARBON.rho * shell + FOAM.rho * disc,
        CARBON.rho * second_moment + FOAM.rho * core_moment,
    ]
    np.testing.assert_allclose(s, expected, rtol=1e-13)


def test_section_at_jump_is_butt_side() -> None:
    cue = soft_tip()
    s = cue.section([0.0, 0.006 - 1e-12, 0.006, cue.length])
    area = np.pi / 4 * np.array([0.013, 0.013, 0.013, 0.021]) ** 2
    stiffness = np.array([LEATHER.E, LEATHER.E, MAPLE.E, MAPLE.E])
    np.testing.assert_allclose(s.EA, stiffness * area, rtol=1e-12)


# Hutchinson 2001, to three digits; quoted in handbook: The beam
@pytest.mark.parametrize(
    ("material", "kappa"), [(Material(2.6e9, 1e9, 700.0, nu=0.3), 0.925), (Material(15e9, 1e9, 700.0, nu=0.3), 0.867)]
)
def test_shear_coefficient_solid_circle_equals_published(material: Material, kappa: float) -> None:
    np.testing.assert_allclose(shear_coefficient(material.effective_poisson_ratio), kappa, rtol=0.0005 / kappa)


@pytest.mark.parametrize("nu", [0.0, 0.1, 0.3, 0.5])
def test_shear_coefficient_small_bore_and_thin_wall_limits(nu: float) -> None:
    """Without a bore: the solid circle's; a thin tube: (1 + nu)/(2 + nu), with an error of order wall squared."""
    solid = 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)
    np.testing.assert_allclose(shear_coefficient(nu, 0.0), solid, rtol=1e-15)
    np.testing.assert_allclose(shear_coefficient(nu, 1e-9), solid, rtol=1e-15)
    np.testing.assert_allclose(shear_coefficient(nu, 1 - 1e-6), (1 + nu) / (2 + nu), rtol=1e-11)


def test_lumped_cue_end_mass_equals_kim() -> None:
    """m_e = m_c nu_c/(1 + nu_c): a quarter at nu_c = 1/3; of a rigid cue M_c 0.136/1.136."""
    np.testing.assert_allclose(LumpedCue.two_part(0.54, 0.012).end_mass, 0.003, rtol=1e-15)
    np.testing.assert_allclose(LumpedCue.rigid(0.54).end_mass, 0.54 * 0.136 / 1.136, rtol=1e-15)
