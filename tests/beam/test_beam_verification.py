"""The beam: closed forms, scikit-fem, orders of convergence, round-off error, slices (verification)."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from cuefem import Cue, Joint, Material, PointMass, Resolution, Segment, Support, modes
from cuefem.beam import assembly, eigensolver, weak_forms
from cuefem.beam.meshing import mesh_cue
from cuefem.beam.modes import solve
from cuefem.parameters.parts import split_at
from studies.strokes import NAMES
from studies.strokes import cue as reference_cue
from tests.helpers.cues import CARBON, FOAM, MAPLE, isotropic_kim, kim, rod, stiff_ferrule
from tests.helpers.orders import assert_order

KIM_FREE = np.array([121.4816650127, 328.8249787923, 637.9759377717])  # Hz


def frequencies(cue: Cue, elements: int, order: int, count: int = 3) -> np.ndarray:
    return modes(cue, count, at=Resolution(elements, order, count)).frequencies


def test_frequencies_isotropic_free_cue_equal_kim() -> None:
    np.testing.assert_allclose(frequencies(isotropic_kim(), 2, 20), KIM_FREE, rtol=1e-9)
    np.testing.assert_allclose(modes(isotropic_kim(), 3).frequencies, KIM_FREE, rtol=1e-6)


COMPOSITE = Cue(
    (
        Segment(0.006, 0.013, 0.0128, Material(0.1e9, 0.04e9, 950.0), kappa=0.88),
        Segment(0.3, 0.0128, 0.014, CARBON, 0.009, 0.010, core=FOAM, kappa=0.6),
        Segment(0.4, 0.015, 0.021, MAPLE, 0.0, 0.012, kappa=0.8),
    )
)


EFFECTS = {
    "free": (),
    "mass, springs": (PointMass(position=0.0, mass=2e-3), Support(0.2, stiffness=5e3, rotational_stiffness=3.0)),
    "clamp, joint": (Support(0.55, stiffness=np.inf), Joint(0.31, rotational_compliance=1e-3)),
    "fixed": (Support(0.6, np.inf, np.inf), Joint(0.25, rotational_compliance=2e-3, shear_compliance=1e-6)),
    "stiff joint": (Joint(0.5, 0.0, 3.5e-202),),
}
FREE = [*((reference_cue(name), "free") for name in NAMES), (COMPOSITE, "free")]


@pytest.mark.parametrize(("shaft", "support"), [*FREE, *((kim(), key) for key in EFFECTS if key != "free")], ids=str)
def test_frequencies_equal_scikit_fem_of_same_weak_forms(shaft: Cue, support: str) -> None:
    """Twelve flexible modes on one mesh, to 1e-9: the bases differ, the spaces are the same."""
    order, effects = 8, EFFECTS[support]
    system = assembly.assemble(shaft, Resolution(2, order, 12), effects)
    solution = solve(system, 12)
    beam = weak_forms.assemble(shaft, system.mesh.nodes, order=order, effects=effects)
    frequencies = weak_forms.frequencies(beam, shift=system.shift)[solution.rigid : solution.rigid + 12]
    np.testing.assert_allclose(frequencies, solution.frequencies, rtol=1e-9)


def roots(function: Callable[[float], float], grid: np.ndarray) -> list[float]:
    values = [function(x) for x in grid]
    pairs = pairwise(zip(grid, values, strict=True))
    return [brentq(function, x, y, xtol=1e-300, rtol=1e-14) for (x, fx), (y, fy) in pairs if fx * fy < 0]


def uniform_frequencies(cue: Cue, count: int) -> np.ndarray:
    """The lowest free-free frequencies of a uniform rod, Hz, from its frequency equation.

    With a = rhoA W^2/kGA, b = rhoI W^2/EI, c = rhoA W^2/EI a deflection e^(kx) has k^4 + (a + b) k^2 + ab - c = 0, so
    k^2 = p (above zero below the shear cut-off) or -q, and theta' = w'' + a w. About the middle, h = L/2, the even and
    odd solutions without moment and shear force at the ends satisfy, r = sqrt(p), s = sqrt(q),

        even  (p + a) cosh(rh) sin(sh)/s + (q - a) cos(sh) sinh(rh)/r = 0
        odd   (p + a) p sinh(rh)/r cos(sh) - (q - a) q sin(sh)/s cosh(rh) = 0

    which stay smooth through p = 0.
    """
    section, h = cue.section(0.0), cue.length / 2
    EI, kGA, rhoA, rhoI = (float(x) for x in (section.EI, section.kGA, section.rhoA, section.rhoI))

    def sides(omega: float) -> tuple[float, float]:
        a, b, c = (x * omega**2 for x in (rhoA / kGA, rhoI / EI, rhoA / EI))
        half = math.hypot((a - b) / 2, math.sqrt(c))
        p, q = half - (a + b) / 2, half + (a + b) / 2
        r, s = math.sqrt(abs(p)), math.sqrt(q)
        if p > 0:  # both over e^(rh)
            cosh, sinh = (1 + math.exp(-2 * r * h)) / 2, -math.expm1(-2 * r * h) / 2 / r
        else:
            cosh, sinh = math.cos(r * h), math.sin(r * h) / r
        cos, sin = math.cos(s * h), math.sin(s * h) / s
        return (p + a) * cosh * sin + (q - a) * cos * sinh, (p + a) * p * sinh * cos - (q - a) * q * sin * cosh

    euler = ((np.arange(1, count + 2) + 0.5) * math.pi / cue.length) ** 2 * math.sqrt(EI / rhoA)
    grid = np.geomspace(0.2 * euler[0], euler[-1], 300 * count)
    omegas = roots(lambda omega: sides(omega)[0], grid) + roots(lambda omega: sides(omega)[1], grid)
    return np.sort(omegas)[:count] / (2 * math.pi)


@pytest.mark.parametrize("slenderness", [10, 30, 100, 1e3, 1e4])
def test_frequencies_uniform_rod_equal_closed_form(slenderness: float) -> None:
    """At slenderness 10 the ten modes pass the shear cut-off, where the second branch of waves begins."""
    cue = rod(slenderness)
    exact = uniform_frequencies(cue, 10)
    np.testing.assert_allclose(frequencies(cue, 2, 24, 10), exact, rtol=1e-9)
    np.testing.assert_allclose(modes(cue, 10).frequencies, exact, rtol=1e-6)


LEVELS = {1: [4, 8, 16, 32, 64, 128], 2: [4, 8, 16, 32, 64], 3: [4, 8, 16, 32]}


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_frequency_error_has_order_2p(order: int, mode: int) -> None:
    """The next term of the error is h^2 smaller, so the bound on the order falls like 1/elements^2."""
    exact = frequencies(isotropic_kim(), 2, 20)
    elements = np.array(LEVELS[order])
    errors = [frequencies(isotropic_kim(), int(n), order)[mode] / exact[mode] - 1 for n in elements]
    assert_order(2 * order, 1 / elements, errors, within=20.0 / elements[:-1] ** 2)


@pytest.mark.heavy
@pytest.mark.parametrize(("cue", "tolerance"), [(kim(), 1e-10), (stiff_ferrule(), 1e-6)])
def test_inverse_form_low_modes_have_small_roundoff_error(cue: Cue, tolerance: float) -> None:
    """On every mesh. A 1 mm steel ferrule leaves the round-off error of K."""
    reference = frequencies(cue, 1, 24, 4)
    for elements, order in ((2, 18), (4, 18), (8, 12), (8, 20), (40, 8)):
        np.testing.assert_allclose(frequencies(cue, elements, order, 4), reference, rtol=tolerance)


def test_tip_responds_to_force_and_couple_alike_by_every_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the leading part of the matrix, the whole and a sparse one: free, heavy and stiff tips, which a force hardly
    moves in the lowest modes."""
    joint = Joint(0.01, rotational_compliance=1.0)
    tips = (), (PointMass(position=0.0, mass=0.2),), (Support(0.0, 1e9),), (Support(0.0, 0.0, 1e6), joint)
    for effects in tips:
        results = []
        for rounding, dense in ((eigensolver.ROUNDING, True), (0.0, True), (0.0, False)):
            with monkeypatch.context() as patch:
                patch.setattr(eigensolver, "ROUNDING", rounding)
                patch.setattr(assembly, "is_dense_faster", lambda n_dof, count, dense=dense: dense)
                patch.setattr(eigensolver, "is_dense_faster", lambda n_dof, count, dense=dense: dense)
                system = assembly.assemble(kim(), 30, effects)
                solved = solve(system, 12, n_corrected=2)
            results.append(solved.participation / (solved.omega**2 + system.shift) @ solved.participation.T)
        leading, whole, sparse = results
        scale = np.sqrt(np.outer(np.diag(whole), np.diag(whole)))
        assert np.max(np.abs(leading - whole) / scale) < 1e-10
        assert np.max(np.abs(sparse - whole) / scale) < 1e-8


def test_mesh_sliced_cone_equals_whole_cone() -> None:
    expected = mesh_cue(COMPOSITE, 12)
    slices = reduce(split_at, np.linspace(0.0, COMPOSITE.length, 300)[1:-1], COMPOSITE)
    np.testing.assert_allclose(mesh_cue(slices, 12).nodes, expected.nodes, rtol=1e-12)
    np.testing.assert_allclose(modes(slices, 12).frequencies, modes(COMPOSITE, 12).frequencies, rtol=1e-6)
