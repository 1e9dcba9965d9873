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
from cuefem.contact.strike import strike_modes
from cuefem.scene.solved_scene import tip_modes_of
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
    off = []
    for count in (20, 40, 80):
        tip, kGA = column(G, clamp, count=count)
        thrust = 0.7 * math.pi**2 * EI / 4 / LENGTH**2
        k = math.sqrt(thrust / EI / (1 - thrust / kGA))
        exact = (kGA / thrust * (math.tan(k * LENGTH) / k - LENGTH) + LENGTH) / (kGA - thrust)
        matrix = np.diag(tip.omega**2) - thrust * tip.geometric
        matrix[0, 0] = 1.0  # the motion along the axis
        across = tip.amplitude[:, 1]
        off.append(abs(across @ np.linalg.solve(matrix, across) / exact - 1))
    assert off[0] > off[1] > off[2]
    assert off[2] < (1e-5 if G > 1e10 else 3e-3)  # shear under a point load: like 1/count


STIFFNESS, SHEAR = 6e5, 2e5  # of the tip, N/m


def wood(x: Any) -> Any:
    return 0.00625 + 0.0045 * x / LENGTH


def chain_of(stiffer: float) -> Chain:
    """A shaft of wood with 430 g at its butt; stiffer: factor of the axial stiffness."""
    chain = Chain(LENGTH, wood, 700.0, 12.6e9, 0.43, 60)
    chain.stretch = chain.stretch * stiffer
    return chain


def struck_shaft(speed: float, offset: float) -> cf.Scene:
    """The same shaft as finite elements; a normal and a tangential spring connect tip and ball."""
    material = cf.Material(E=12.6e9, G=60e9, rho=700.0, nu=0.05)
    cue = cf.Cue((cf.Segment(LENGTH, 0.0125, 0.0215, material),), body_mass=1e-9)
    tip = cf.Tip(restitution=1.0, friction=math.inf, stiffness=STIFFNESS)
    effects = (cf.PointMass(LENGTH, 0.43), cf.AxialWaves(), cf.TipShear(SHEAR / STIFFNESS))
    return cf.Scene(cue, cf.Ball(0.17, 0.028575), tip, cf.Stroke(speed, offset), effects)


def modes_of(chain: Chain) -> TipModes:
    """Modes of the linear chain, with the geometric stiffness of its links."""
    count, nudge = len(chain.mass), 1e-6
    stiffness = np.zeros((2, count, count))
    for axis, i in np.ndindex(2, count):
        at = chain.rest.copy()
        at[i, axis] += nudge
        stiffness[axis, :, i] = -chain.forces(at, exact=False)[:, axis] / nudge
    (along, u), (across, w) = (scipy.linalg.eigh(matrix, np.diag(chain.mass)) for matrix in stiffness)
    along[0] = across[0] = across[1] = 0.0
    amplitude, approach = np.zeros((2 * count, 2)), np.zeros(2 * count)
    amplitude[:count, 0], amplitude[count:, 1], approach[0] = u[0], w[0], u[:, 0] @ chain.mass
    share, turns = 1 - np.cumsum(chain.mass)[:-1] / chain.mass.sum(), np.diff(w, axis=0)
    geometric = np.pad(turns.T @ ((share / chain.link)[:, None] * turns), (count, 0))
    omega = np.sqrt(np.concatenate([along, across]))
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
    chain, scene = chain_of(stiffer=16.0), struck_shaft(speed, offset)
    tip = modes_of(chain)
    bends, straight = (strike_modes(scene, each).squirt for each in (tip, replace(tip, geometric=None)))
    assert bends / straight - 1 == pytest.approx(changes(chain, scene), rel=1e-3)
    assert bends < 0.95 * straight


def test_geometric_stiffness_out_of_range_raises_with_its_force() -> None:
    thin = cf.Cue((cf.Segment(0.7, 0.005, 0.006, cf.Material(E=12.6e9, G=0.84e9, rho=700.0)),), body_mass=0.5)
    scene = cf.Scene(thin, tip=cf.Tip(contact_time=4e-3), stroke=cf.Stroke(20.0, 0.5), effects=(THRUST,))
    with pytest.raises(ValueError, match=r"the axial force of \S+ N bends the shaft by 0\.\d+ rad"):
        cf.strike(scene)
