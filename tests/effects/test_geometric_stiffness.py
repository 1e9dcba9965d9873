"""Geometric stiffness: a column's closed form, a geometrically exact chain, the range of validity (verification)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg

import cuefem as cf
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.geometric_stiffness import slope_rows
from cuefem.contact.strike import strike_modes
from cuefem.scene.solved_scene import corrected_tip_modes, tip_modes_of
from studies.strokes import cue as reference_cue
from tests.oracle.chain import Chain, chain_squirt

THRUST = cf.GeometricStiffness()
LENGTH, DIAMETER, E = 0.7, 0.012, 12e9
EI = E * math.pi * DIAMETER**4 / 64


def column(G: float, *supports: cf.Support, count: int = 60) -> tuple[Any, float]:
    """Tip modes of a uniform rod under a constant axial force (a large mass is behind it), and its kGA."""
    cue = cf.Cue((cf.Segment(LENGTH, DIAMETER, DIAMETER, cf.Material(E=E, G=G, rho=700.0)),), body_mass=1e9)
    scene = cf.Scene(cue, effects=(THRUST, *supports))
    return tip_modes_of(scene, cf.Resolution(6, 18, count)), float(cue.section(0.0).kGA)


@pytest.mark.parametrize("G", [1.9e10, 0.84e9])
def test_geometric_stiffness_cantilever_deflection_equals_tangent_formula(G: float) -> None:
    """Deflection under a transverse end load and an axial force: tan(kL)/k, with Engesser's shear."""
    clamp = cf.Support(LENGTH, math.inf, rotational_stiffness=math.inf)
    errors = []
    for count in (20, 40, 80):
        tip, kGA = column(G, clamp, count=count)
        axial_force = 0.7 * math.pi**2 * EI / 4 / LENGTH**2
        k = math.sqrt(axial_force / EI / (1 - axial_force / kGA))
        exact = (kGA / axial_force * (math.tan(k * LENGTH) / k - LENGTH) + LENGTH) / (kGA - axial_force)
        matrix = np.diag(tip.omega**2) - axial_force * tip.geometric
        matrix[0, 0] = 1.0  # the motion along the axis
        deflection = tip.amplitude[:, 1]
        errors.append(abs(deflection @ np.linalg.solve(matrix, deflection) / exact - 1))
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < (1e-5 if G > 1e10 else 3e-3)  # shear under a point load: like 1/count


def test_retained_slopes_hold_the_deflection_under_a_force_at_any_number_of_modes() -> None:
    """Shear waves in the soft ferrule of a carbon shaft do not displace the slopes of the whole shaft."""
    scene = cf.Scene(reference_cue("carbon"), effects=(THRUST,))
    for tip in corrected_tip_modes(scene, 60, 200):
        omega = np.where(tip.omega > 0, tip.omega, math.inf)
        deflection = tip.amplitude[:, 1] / omega**2
        retained = slope_rows(tip, planes=2)[:-1] @ deflection
        assert retained @ retained == pytest.approx(deflection @ tip.geometric @ deflection, rel=1e-3)


STIFFNESS, SHEAR = 6e5, 2e5  # of the tip, N/m


def wood(x: Any) -> Any:
    return 0.00625 + 0.0045 * x / LENGTH


def chain_of(factor: float) -> Chain:
    """A shaft of wood with 430 g at its butt; factor: factor of the axial stiffness."""
    chain = Chain(LENGTH, wood, 700.0, 12.6e9, 0.43, 40)
    chain.stretch = chain.stretch * factor
    return chain


def struck_shaft(speed: float, offset: float) -> cf.Scene:
    """The same shaft as finite elements; a normal and a tangential spring connect tip and ball."""
    material = cf.Material(E=12.6e9, G=60e9, rho=700.0, nu=0.05)
    cue = cf.Cue((cf.Segment(LENGTH, 0.0125, 0.0215, material),), body_mass=1e-9)
    tip = cf.Tip(restitution=1.0, friction=math.inf, stiffness=STIFFNESS)
    effects = (cf.PointMass(position=LENGTH, mass=0.43), cf.AxialWaves(), cf.TipShear(SHEAR / STIFFNESS))
    return cf.Scene(cue, cf.Ball(0.17, 0.028575), tip, cf.Stroke(speed, offset), effects)


def modes_of(chain: Chain) -> TipModes:
    """Modes of the linear chain, with the geometric stiffness of its links."""
    count, displacement = len(chain.mass), 1e-6
    stiffness = np.zeros((2, count, count))
    for axis, i in np.ndindex(2, count):
        positions = chain.rest.copy()
        positions[i, axis] += displacement
        stiffness[axis, :, i] = -chain.forces(positions, exact=False)[:, axis] / displacement
    (axial, u), (lateral, w) = (scipy.linalg.eigh(matrix, np.diag(chain.mass)) for matrix in stiffness)
    axial[0] = lateral[0] = lateral[1] = 0.0
    amplitude, approach = np.zeros((2 * count, 2)), np.zeros(2 * count)
    amplitude[:count, 0], amplitude[count:, 1], approach[0] = u[0], w[0], u[:, 0] @ chain.mass
    share, rotations = 1 - np.cumsum(chain.mass)[:-1] / chain.mass.sum(), np.diff(w, axis=0)
    geometric = np.pad(rotations.T @ ((share / chain.link)[:, None] * rotations), (count, 0))
    omega = np.sqrt(np.concatenate([axial, lateral]))
    return TipModes(omega, amplitude, approach, np.zeros(2 * count), geometric=geometric)


def changes(chain: Chain, scene: cf.Scene) -> float:
    """Relative change of the chain's squirt by exact geometry."""
    linear, exact = (
        chain_squirt(chain, scene.stroke, scene.ball, STIFFNESS, SHEAR, exact=exact) for exact in (False, True)
    )
    return exact / linear - 1


@pytest.mark.heavy
@pytest.mark.parametrize(("speed", "offset"), [(7.0, 0.187), (4.0, 0.6)])
def test_geometric_stiffness_squirt_equals_exact_chain(speed: float, offset: float) -> None:
    """The change of squirt, 12 to 57 %, within 0.1 %: the chain's modes in the package; the chain in small steps."""
    chain, scene = chain_of(factor=16.0), struck_shaft(speed, offset)
    tip = modes_of(chain)
    squirt, straight = (strike_modes(scene, modes).squirt for modes in (tip, replace(tip, geometric=None)))
    assert squirt / straight - 1 == pytest.approx(changes(chain, scene), rel=1e-3)
    assert squirt < 0.95 * straight


def test_end_mass_of_a_velocity_step_is_without_the_axial_force() -> None:
    scene = cf.Scene(reference_cue("carbon"))
    with_thrust, without = (cf.end_mass(replace(scene, effects=of), "stick") for of in ((THRUST,), ()))
    assert with_thrust == without
