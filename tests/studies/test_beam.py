"""The solid of studies/beam against exact elasticity, the beam against the solid, and what leather_elasticity.py claims
(verification)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import iv, ivp

from cuefem import Cue, Material, Segment, modes
from cuefem.cue import shear_coefficient
from studies.beam import leather_elasticity, solid
from studies.beam.solid_body import Body, Fineness
from studies.strokes import NAMES, cue
from tests.helpers.orders import assert_order
from tests.helpers.study_tables import rows

STEEL = Material(200e9, 200e9 / 2.6, 7850.0)
RADIUS, LENGTH = 0.01, 0.06
CYLINDER = Cue((Segment(LENGTH, 2 * RADIUS, 2 * RADIUS, STEEL),))


def pochhammer(material: Material, *, radius: float, k: float, guess: float) -> float:
    """omega of the lowest flexural wave of an isotropic cylinder: the traction of three potentials on the surface is 0.

    phi = a I(pr) cos t sin kz, psi = b I(qr) sin t sin kz, chi = c I(qr) cos t cos kz, I of order 1, with
    u = grad phi + curl(psi e_z) + curl curl(chi e_z); p^2 = k^2 - (omega/c_L)^2, q^2 = k^2 - (omega/c_T)^2.
    """
    mu = material.G
    lam = material.E * material.nu / ((1 + material.nu) * (1 - 2 * material.nu))

    def traction(omega: float) -> float:
        p2, q2 = k**2 - omega**2 * material.rho / (lam + 2 * mu), k**2 - omega**2 * material.rho / mu
        p, q, r = math.sqrt(p2), math.sqrt(q2), radius
        (P, P1, P2), (Q, Q1, Q2) = ((iv(1, s * r), s * ivp(1, s * r), s**2 * ivp(1, s * r, 2)) for s in (p, q))
        U, dU = np.array([P1, Q / r, -k * Q1]), np.array([P2, Q1 / r - Q / r**2, -k * Q2])
        V, dV = np.array([-P / r, -Q1, k * Q / r]), np.array([-P1 / r + P / r**2, -Q2, k * Q1 / r - k * Q / r**2])
        dW = np.array([k * P1, 0.0, -q2 * Q1])
        spread = np.array([(p2 - k**2) * P, 0.0, 0.0])
        rows = np.array([lam * spread + 2 * mu * dU, mu * (dV - (U + V) / r), mu * (k * U + dW)])
        return float(np.linalg.det(rows / np.abs(rows).max(axis=0)))

    return float(brentq(traction, 0.9 * guess, 1.1 * guess, xtol=1e-9, rtol=1e-14))


def beam_wave(whole: Cue, k: float) -> float:
    """omega of Timoshenko's flexural wave."""
    s = whole.section(0.0)
    a, b = s.rhoI * s.rhoA / s.kGA, s.rhoA + k**2 * (s.rhoI + s.EI * s.rhoA / s.kGA)
    return math.sqrt(float((b - np.sqrt(b**2 - 4 * a * s.EI * k**4)) / (2 * a)))


def standing_wave(halves: int, how: Fineness) -> float:
    return float(Body(CYLINDER, {}, how).modes(3, supported=True).omega[halves - 1])


def exact_wave(halves: int) -> float:
    k = halves * math.pi / LENGTH
    return pochhammer(STEEL, radius=RADIUS, k=k, guess=beam_wave(CYLINDER, k))


@pytest.mark.parametrize("halves", [1, 2])
def test_a_cylinder_carries_pochhammers_waves(halves: int) -> None:
    assert standing_wave(halves, Fineness(8, 1.0, 0.01)) == pytest.approx(exact_wave(halves), rel=2e-11)


@pytest.mark.parametrize("order", [2, 3])
def test_frequencies_converge_with_twice_the_order(order: int) -> None:
    elements = np.array([2, 4, 8])
    found = [standing_wave(1, Fineness(order, 1e3, LENGTH / n, layers=n // 2)) for n in elements]
    errors = np.array(found) / exact_wave(1) - 1
    assert np.all(errors > 0)  # from above: the elements are conforming
    assert_order(2 * order, 1 / elements, errors, within=0.25)


@pytest.mark.parametrize("wood", [STEEL, solid.WOOD], ids=["steel", "maple"])
def test_bending_by_couples_is_held_exactly(wood: Material) -> None:
    """u_x = (z^2 + nu (x^2 - y^2))/2, u_y = nu x y, u_z = -x z: no stress but E x along the grain."""
    rod = Cue((Segment(LENGTH, 2 * RADIUS, 2 * RADIUS, wood),))
    body = Body(rod, solid.ACROSS, Fineness(2, 1.0, 0.01, layers=2))
    fields = (lambda x: (x[0] ** 2 + wood.nu * x[1] ** 2) / 2, lambda x: wood.nu * x[1] ** 2, lambda x: -x[1] * x[0])
    bent = np.concatenate([body.basis.project(field) for field in fields])
    K, _ = body.matrices
    assert bent @ K @ bent == pytest.approx(float(rod.section(0.0).EI) * LENGTH, rel=1e-10)


@pytest.mark.parametrize("name", NAMES)
def test_rigid_motions_have_the_cues_mass_and_no_energy(name: str) -> None:
    """U = 1, S = W = 0, and U = z, W = -r; the drawing's mass to rounding holds the mesh of every piece."""
    body = Body(cue(name), solid.ACROSS, Fineness(3, 2.0, 0.2))
    K, M = body.matrices
    mesh, N = body.cells[0], body.basis.N
    vertices = body.basis.nodal_dofs[0]
    motions = np.zeros((body.unknowns, 2))
    motions[vertices, 0] = 1.0
    motions[vertices, 1], motions[2 * N + vertices, 1] = mesh.p[0], -mesh.p[1]
    mass = motions.T @ (M @ motions)
    assert mass[0, 0] == pytest.approx(cue(name).shaft_mass, rel=1e-12)
    assert mass[0, 1] == pytest.approx(cue(name).shaft_mass * cue(name).balance_point, rel=1e-12)
    assert np.abs(K @ motions).max() < 1e-12 * abs(K).max()
    assert body.tip @ motions == pytest.approx([1.0, 0.0], abs=1e-14)


def test_a_free_body_has_two_modes_without_frequency() -> None:
    found = Body(solid.kim(solid.KIM_WOOD), solid.ACROSS, solid.ROUGH).modes(4).omega
    assert np.all(found[:2] < 1e-6 * found[2])
    assert found[2] > 700


@pytest.mark.heavy
@pytest.mark.parametrize("name", ["solid, E/G 15", "bore 0.8, maple"])
def test_the_shear_coefficient_of_the_long_wave(name: str) -> None:
    """Hutchinson's at the effective Poisson ratio; Cowper's is off by half a per cent and more."""
    wood, bore = solid.SECTIONS[name]
    rule = float(shear_coefficient(wood.effective_poisson_ratio, bore))
    assert solid.kappa(name) == pytest.approx(rule, rel=1e-8)
    assert abs(solid.cowper(wood.effective_poisson_ratio, bore) / rule - 1) > 5e-3


@pytest.mark.parametrize(("wood", "bound"), [(solid.KIM_ISOTROPIC, 1e-5), (solid.KIM_WOOD, 2e-4)], ids=["iso", "wood"])
def test_the_beam_of_kims_cone(wood: Material, bound: float) -> None:
    """Six free modes within 1e-5 (isotropic) and 2e-4 (wood) of the solid; with Cowper's coefficient not."""
    body = Body(solid.kim(wood), solid.ACROSS, solid.ROUGH).modes(8).frequencies
    off = np.abs(modes(solid.kim(wood), 6).frequencies / body - 1)
    assert bound / 10 < off.max() < bound
    assert np.abs(modes(solid.kim(wood, solid.cowper(wood.nu)), 6).frequencies / body - 1).max() > 5 * bound


def test_a_cones_error_goes_with_its_slope_squared() -> None:
    off = []
    for half in (0.003, 0.006):
        whole = Cue((Segment(0.7, 0.0165 - half, 0.0165 + half, solid.KIM_WOOD),))
        found = Body(whole, solid.ACROSS, solid.ROUGH).modes(3).frequencies[0]
        off.append(modes(whole, 1).frequencies[0] / found - 1)
    assert off[1] / off[0] == pytest.approx(4, rel=0.1)


def test_what_is_left_on_kims_cone_is_understood() -> None:
    """Shear made by the taper, derived, and what a uniform rod of the mean width is off by: together to 8e-6."""
    cone, straight = (
        modes(whole, 6).frequencies / Body(whole, solid.ACROSS, solid.ROUGH).modes(8).frequencies - 1
        for whole in (solid.kim(solid.KIM_WOOD), solid.uniform(solid.KIM_WOOD))
    )
    shear = solid.taper(solid.kim(solid.KIM_WOOD))
    assert np.all(shear > 4e-5)
    assert np.abs(cone - shear - straight).max() < 8e-6


def test_constants_across_the_grain_hardly_matter() -> None:
    whole = solid.kim(solid.KIM_WOOD)
    found = [
        Body(whole, {solid.KIM_WOOD: replace(solid.MAPLE, E_ratio=E)}, solid.ROUGH).modes(8).frequencies
        for E in (0.05, 0.2)
    ]
    assert np.abs(found[1] / found[0] - 1).max() < 1e-4


# the table of leather tips


def quantiles(column: int) -> dict[tuple[str, str], float]:
    """A column of the page's table of errors, by what they are of."""
    found = [cells for cells in rows(leather_elasticity.STUDY.committed) if len(cells) == 6 and cells[2].isdigit()]
    assert len(found) == 8
    return {(cells[0], cells[1]): float(cells[column]) for cells in found}


@pytest.mark.heavy
def test_the_table_at_the_first_tips_again() -> None:
    """Of the random tips of the page, the first two: none further off than the page's largest."""
    largest = quantiles(5)
    again = list(leather_elasticity.measured(leather_elasticity.errors(2)))
    assert len(again) == 8
    assert all(float(cells[5]) <= largest[cells[0], cells[1]] + 0.01 for cells in again)


def test_the_table_is_within_half_a_per_cent() -> None:
    """Of the compliance of whole patches and of the head-on law, in 95 of 100 random tips."""
    assert all(value < 0.5 for (what, _), value in quantiles(4).items() if what != "patches that the rim cuts")
