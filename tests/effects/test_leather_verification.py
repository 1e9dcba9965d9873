"""The leather tip's elasticity against exact solutions, and its table against the elastic solution (verification)."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

from cuefem import LeatherTip
from cuefem.solid import tip_table as tt
from cuefem.solid.tip_compliance import (
    Patch,
    Shape,
    TipSolid,
    central_contact,
    contact_fineness,
    graded_fineness,
    tip_table,
)
from studies.beam.leather import COUNTS, by_solid, curvatures, shape_at, stuck

TIP, DIAMETER = LeatherTip(6e-3, 9.5e-3, 100e6), 12.75e-3


# --- the solid --------------------------------------------------------------------------------------------------------


def test_leather_long_tip_equals_rod() -> None:
    """EA/h along the axis, from the difference of two lengths, which cancels the local compliance; 3EI/h^3 across it
    on a slender rod. Over D: EA is pi/4, EI pi/64."""
    fineness = graded_fineness(4, 4, 6, 1)
    short, long, slender = (by_solid(Shape(h, 0.0), 0.3, Patch(0.0, 0.45), fineness) for h in (4.0, 6.0, 30.0))
    assert abs((long - short)[0, 0] * math.pi / 4 / 2 - 1) < 1e-3
    assert abs(slender[1, 1] * 3 * math.pi / 64 / 30**3 - 1) < 5e-3


@pytest.mark.heavy
def test_leather_small_patch_equals_half_space() -> None:
    """Within 5 % at a/h = 1/16, and the difference falls as a/h."""
    errors = []
    for radius in (1 / 32, 1 / 64, 1 / 128):
        shape, fineness = Shape(0.5, 0.0), contact_fineness(0.5, radius, 4)._replace(harmonics=1)
        computed = np.diagonal(by_solid(shape, 0.4, Patch(0.0, radius), fineness))
        errors.append(1 - computed / tt.half_space(0.4, radius))
    assert np.all(np.abs(errors[0]) < 0.05)
    np.testing.assert_allclose(np.divide(errors[0], errors[1]), 2, rtol=0.05)
    np.testing.assert_allclose(np.divide(errors[1], errors[2]), 2, rtol=0.05)


@pytest.mark.heavy
def test_leather_central_impact_equals_hertz() -> None:
    """Force and indentation of a small contact, for gaps of second and fourth order."""
    shape, fineness = Shape(1.0, 0.0), contact_fineness(1.0, 0.01)
    computed = central_contact(shape, TipSolid(shape, fineness).surface(0.3, 0), 0.01, fineness)
    np.testing.assert_allclose(computed / tt.half_space_head_on(0.3, np.array(0.01)), 1, rtol=5e-3)


# --- the table --------------------------------------------------------------------------------------------------------


def test_leather_compliance_equals_computed_values() -> None:
    """h 6, D 12.75, r 9.5 mm, nu 0.4, E 100 MPa, b/R 0.375, a 2 mm: an independent solution with scikit-fem and
    quadratic elements."""
    compliance = 1e6 * TIP.compliance(DIAMETER, 0.375, 2e-3)
    np.testing.assert_allclose(np.diagonal(compliance), [1.938, 4.597], rtol=3e-3)
    assert abs(abs(compliance[0, 1]) - 0.129) < 1e-3 * math.sqrt(compliance[0, 0] * compliance[1, 1])
    assert compliance[0, 1] == compliance[1, 0] < 0


RANDOM = [  # height, diameter, dome radius, mm; nu; b/R; patch, mm
    (3.4, 11.8, 8.95, 0.33, 0.21, 1.2),
    (8.0, 13.6, 10.6, 0.25, 0.5, 2.5),
    (2.3, 9.3, 12.0, 0.44, 0.1, 3.1),
    (11.0, 9.0, 6.2, 0.28, 0.58, 0.9),
    (5.0, 14.2, math.inf, 0.37, 0.0, 4.4),
]


@pytest.mark.heavy
@pytest.mark.parametrize(("height", "diameter", "dome", "nu", "offset", "patch"), RANDOM)
def test_leather_table_equals_solution(
    height: float, diameter: float, dome: float, nu: float, offset: float, patch: float
) -> None:
    position = 2 * offset * dome / diameter if offset else 0.0
    tip = LeatherTip(1e-3 * height, 1e-3 * dome, 1.0, nu)
    exact = by_solid(Shape(height / diameter, diameter / dome), nu, Patch(position, patch / diameter))
    compliance = 1e-3 * diameter * tip.compliance(1e-3 * diameter, offset, 1e-3 * patch)
    np.testing.assert_allclose(np.diagonal(compliance), np.diagonal(exact), rtol=5e-3)
    assert abs(compliance[0, 1] - exact[0, 1]) < 5e-3 * math.sqrt(exact[0, 0] * exact[1, 1])


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
@pytest.mark.parametrize(("height", "diameter", "dome", "nu", "offset", "patch"), RANDOM[:2])
def test_leather_central_impact_table_equals_solution(
    height: float, diameter: float, dome: float, nu: float, offset: float, patch: float
) -> None:
    tip, shape, ball = (
        LeatherTip(1e-3 * height, 1e-3 * dome, 1.0, nu),
        Shape(height / diameter, diameter / dome),
        28.575,
    )
    fineness = contact_fineness(shape.height, patch / diameter)
    gaps = np.array([shape.curvature, diameter / ball, (diameter / ball) ** 3])
    force, depth = central_contact(shape, TipSolid(shape, fineness).surface(nu, 0), patch / diameter, fineness) @ gaps
    radii, depths, forces = tip.head_on(1e-3 * diameter, 1e-3 * ball)
    assert abs(np.interp(1e-3 * patch, radii, depths) / (depth * 1e-3 * diameter) - 1) < 5e-3
    assert abs(np.interp(1e-3 * patch, radii, forces) / (force * (1e-3 * diameter) ** 2) - 1) < 5e-3


@pytest.mark.heavy
def test_leather_table_equals_its_program() -> None:
    """One tip of the table: all its patches and contacts."""
    panel, i, j, u = 1, 2, 3, 1
    k = curvatures(panel, COUNTS["curvature"])[i]
    nu = (1 - np.exp(-tt.chebyshev_nodes(*tt.NU, COUNTS["nu"])[u])) / 2
    tip = tip_table(shape_at(k, tt.chebyshev_nodes(*tt.heights(k), COUNTS["height"])[j]), nu)
    for values, tabulated in zip((tip.patches, tip.head_on), tt.table(), strict=True):
        np.testing.assert_allclose(values, tabulated[panel, i, j, u], rtol=1e-5, atol=1e-6)


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.4])
@pytest.mark.parametrize("dome", [math.inf, 10.605e-3, 8.955e-3], ids=["flat", "nickel", "dime"])
def test_leather_sticking_patch_equals_rigid_punch(dome: float, nu: float) -> None:
    """The traction is the sum of Hertz's and a punch's with the least complementary energy."""
    for height, patch in product((0.3, 0.47, 0.7), (0.1, 0.2, 0.25)):
        radius, stiffness = LeatherTip(height * DIAMETER, dome, 1e9, nu).shear_stiffness(DIAMETER, 0.0)
        _, rigid = stuck(Shape(height, DIAMETER / dome), nu, patch)
        assert np.interp(patch * DIAMETER, radius, stiffness) * rigid / (1e9 * DIAMETER) == pytest.approx(1, abs=0.01)
