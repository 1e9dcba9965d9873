"""The solid shaft: exact waves, orders of convergence, pure bending, axial compliance (verification)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import iv, ivp

from cuefem import Cue, Material, Segment
from cuefem.cue.materials import material
from cuefem.solid.meridian_mesh import Fineness, element_ends
from cuefem.solid.shaft import AXIAL, BENDING, SolidBody
from cuefem.solid.tip_table import distance_to_rim
from tests.helpers.orders import assert_order

STEEL = Material(200e9, 200e9 / 2.6, 7850.0)
MAPLE = material("hard maple")
RADIUS, LENGTH = 0.01, 0.06
CYLINDER = Cue((Segment(LENGTH, 2 * RADIUS, 2 * RADIUS, STEEL),))


def traction(omega: float, k: float, motion: int) -> float:
    """The determinant of the surface traction of three potentials (two along the axis), zero for a free wave.

    phi = a I_n(pr) cos nt sin kz, psi = b I_n(qr) sin nt sin kz, chi = c I_n(qr) cos nt cos kz, n 1 or 0, with
    u = grad phi + curl(psi e_z) + curl curl(chi e_z); p^2 = k^2 - (omega/c_L)^2, q^2 = k^2 - (omega/c_T)^2.
    """
    n, r, mu = motion, RADIUS, STEEL.G
    lam = STEEL.E * STEEL.nu / ((1 + STEEL.nu) * (1 - 2 * STEEL.nu))
    p2, q2 = k**2 - omega**2 * STEEL.rho / (lam + 2 * mu), k**2 - omega**2 * STEEL.rho / mu
    p, q = np.sqrt([p2 + 0j, q2 + 0j])
    (P, P1, P2), (Q, Q1, Q2) = ((iv(n, s * r), s * ivp(n, s * r), s**2 * ivp(n, s * r, 2)) for s in (p, q))
    U, dU = np.array([P1, n * Q / r, -k * Q1]), np.array([P2, n * (Q1 / r - Q / r**2), -k * Q2])
    V, dV = np.array([-P / r, -Q1, k * Q / r]), np.array([-P1 / r + P / r**2, -Q2, k * Q1 / r - k * Q / r**2])
    dW = np.array([k * P1, 0.0, -q2 * Q1])
    spread = np.array([(p2 - k**2) * P, 0.0, 0.0])
    rows = np.array([lam * spread + 2 * mu * dU, mu * (dV - (U + V) / r), mu * (k * U + dW)])
    if motion == AXIAL:
        rows = rows[np.ix_([0, 2], [0, 2])]
    return float(np.linalg.det(rows / np.abs(rows).max(axis=0)).real)


def beam_wave(k: float) -> float:
    """omega of Timoshenko's flexural wave."""
    s = CYLINDER.section(0.0)
    a, b = s.rhoI * s.rhoA / s.kGA, s.rhoA + k**2 * (s.rhoI + s.EI * s.rhoA / s.kGA)
    return math.sqrt(float((b - np.sqrt(b**2 - 4 * a * s.EI * k**4)) / (2 * a)))


def love_wave(k: float) -> float:
    """omega of a rod's wave with lateral inertia (Love)."""
    return k * math.sqrt(STEEL.E / STEEL.rho / (1 + (STEEL.nu * k * RADIUS) ** 2 / 2))


def exact_wave(halves: int, motion: int) -> float:
    k = halves * math.pi / LENGTH
    guess = beam_wave(k) if motion == BENDING else love_wave(k)
    return float(brentq(traction, 0.95 * guess, 1.05 * guess, (k, motion), xtol=1e-9, rtol=1e-14))


def standing_wave(halves: int, motion: int, fineness: Fineness) -> float:
    """The mode with ``halves`` half waves between faces that do not move within their planes."""
    omega = SolidBody(CYLINDER, fineness, motion).modes(5, supported=True).omega
    return float(omega[halves - (motion == BENDING)])


@pytest.mark.parametrize(("motion", "halves"), [(BENDING, 1), (BENDING, 3), (AXIAL, 2)])
def test_solid_cylinder_agrees_with_pochhammer_chree_waves(motion: int, halves: int) -> None:
    omega = standing_wave(halves, motion, Fineness(8, 1.0, 0.01))
    assert omega == pytest.approx(exact_wave(halves, motion), rel=1e-9)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("motion", [BENDING, AXIAL], ids=["bending", "axial"])
def test_solid_frequencies_converge_at_twice_the_order(motion: int, order: int) -> None:
    elements = np.array([2, 4, 8])
    waves = [standing_wave(1, motion, Fineness(order, 1e3, LENGTH / n, layers=n // 2)) for n in elements]
    errors = np.array(waves) / exact_wave(1, motion) - 1
    assert np.all(errors > 0)  # from above: the elements are conforming
    assert_order(2 * order, 1 / elements, errors, within=0.3)


@pytest.mark.parametrize("wood", [STEEL, MAPLE], ids=["steel", "maple"])
def test_solid_pure_bending_energy_is_exact(wood: Material) -> None:
    """u_x = (z^2 + nu (x^2 - y^2))/2, u_y = nu x y, u_z = -x z: no stress but E x along the grain."""
    rod = Cue((Segment(LENGTH, 2 * RADIUS, 2 * RADIUS, wood),))
    body = SolidBody(rod, Fineness(2, 1.0, 0.01, layers=2))
    fields = (lambda x: (x[0] ** 2 + wood.nu * x[1] ** 2) / 2, lambda x: wood.nu * x[1] ** 2, lambda x: -x[1] * x[0])
    vector = np.concatenate([body.basis.project(field) for field in fields])
    K, _ = body.matrices
    assert vector @ K @ vector == pytest.approx(float(rod.section(0.0).EI) * LENGTH, rel=1e-10)


@pytest.mark.parametrize("wood", [STEEL, MAPLE], ids=["steel", "maple"])
def test_solid_rod_axial_compliance_agrees_with_section(wood: Material) -> None:
    rod = Cue((Segment(LENGTH, 2 * RADIUS, 2 * RADIUS, wood, RADIUS, RADIUS),))
    compliance = LENGTH / float(rod.section(0.0).EA)
    assert SolidBody(rod, Fineness(4, 1.0, 0.01), AXIAL).compliance == pytest.approx(compliance, rel=1e-10)


@pytest.mark.parametrize("length", np.geomspace(1e-3, 0.7, 8))
def test_elements_of_segment_grow_from_its_ends(length: float) -> None:
    """The shortest are at the ends; none is half as long as its neighbour towards an end, or longer than the limit."""
    fineness = Fineness()
    sizes = length * np.diff(element_ends(length, (0.006, 0.009), fineness))
    assert sizes.sum() == pytest.approx(length, rel=1e-12)
    assert sizes.max() <= fineness.max_length * (1 + 1e-9)
    half = len(sizes) // 2
    assert np.all(sizes[1 : half + 1] > 0.49 * sizes[:half])


@pytest.mark.parametrize("curvature", [0.2, 0.67, 1.1])
@pytest.mark.parametrize("position", [0.0, 0.4, 0.9])
def test_distance_to_rim_is_the_chord_between_two_angles(curvature: float, position: float) -> None:
    """On a sphere of radius 1/curvature, projected on the tangent plane at the position."""
    angle = math.asin(curvature / 2) - math.asin(curvature * position / 2)
    assert distance_to_rim(curvature, position) == pytest.approx(math.sin(angle) / curvature, rel=1e-12)
